// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// MetaImage headers (.mha, .mhd), which no C library reads. Based on: Kitware, "MetaIO: MetaImage", itk.org,
// the tables of tags.
#include "base/base.h"
#include "io/volume/file.h"
#include "io/volume/text.h"

#include <math.h>

enum { MAX_AXES = 10 };

typedef struct meta {
    const ewa_volume_input *in;
    ewa_volume_header *header;
    uint64_t axis_count, sizes[MAX_AXES], channel_count;
    double spacings[MAX_AXES], offset[MAX_AXES], matrix[MAX_AXES * MAX_AXES];
    bool has_sizes, has_spacings, has_offset, has_matrix, packed, text, at_end;
    char data_file[EWA_LINE_BYTES];
} meta;

static const ewa_text_word types[] = {
    {"MET_CHAR", EWA_I8},
    {"MET_UCHAR", EWA_U8},
    {"MET_SHORT", EWA_I16},
    {"MET_USHORT", EWA_U16},
    {"MET_INT", EWA_I32},
    {"MET_UINT", EWA_U32},
    {"MET_LONG", EWA_I32},
    {"MET_ULONG", EWA_U32},
    {"MET_LONG_LONG", EWA_FILE_I64},
    {"MET_FLOAT", EWA_F32},
    {"MET_ULONG_LONG", EWA_FILE_U64},
    {"MET_DOUBLE", EWA_F64},
};

static ewa_status broken(const meta *file, const char *key, const char *value) {
    return ewa_volume_fail(file->in, EWA_ERROR_FORMAT, "MetaImage: %s = '%.80s' cannot be read", key, value);
}

/// "True" or anything that begins like it.
static bool is_true(const char *value) { return value[0] == 'T' || value[0] == 't' || value[0] == '1'; }

/// Takes numbers, those that are wanted and, of slices that say where they are in space, some more.
static ewa_status take_numbers(meta *file, const char *key, const char *value, uint64_t wanted, uint64_t maximum,
                               double *numbers, bool *has) {
    if (!file->axis_count)
        return ewa_volume_fail(file->in, EWA_ERROR_FORMAT, "MetaImage: %s before NDims", key);
    *has = true;
    const int count = ewa_text_numbers(value, MAX_AXES * MAX_AXES, numbers);
    return count >= 0 && (uint64_t)count >= wanted && (uint64_t)count <= maximum ? EWA_OK : broken(file, key, value);
}

static bool is_one_of(const char *key, const char *const *keys) {
    while (*keys && strcmp(*keys, key) != 0) keys++;
    return *keys != NULL;
}

/// Takes one "key = value"; tags that say nothing of the voxels and their places are passed over.
static ewa_status take_tag(meta *file, const char *key, const char *value) {
    static const char *const offsets[] = {"Offset", "Origin", "Position", NULL};
    static const char *const matrices[] = {"TransformMatrix", "Rotation", "Orientation", NULL};
    static const char *const orders[] = {"BinaryDataByteOrderMSB", "ElementByteOrderMSB", NULL};
    ewa_volume_header *header = file->header;
    const uint64_t n = file->axis_count;
    double numbers[MAX_AXES * MAX_AXES];
    uint64_t count;
    if (strcmp(key, "NDims") == 0) {
        if (ewa_text_counts(value, 1, &file->axis_count) != 1 || file->axis_count < 1 ||
            file->axis_count > MAX_AXES)
            return broken(file, key, value);
    } else if (strcmp(key, "DimSize") == 0) {
        file->has_sizes = true;
        const int read = ewa_text_counts(value, MAX_AXES, file->sizes);
        if (!n || read < 0 || (uint64_t)read != n) return broken(file, key, value);
    } else if (strcmp(key, "ElementSpacing") == 0 ||
               (strcmp(key, "ElementSize") == 0 && !file->has_spacings)) {
        EWA_TRY(take_numbers(file, key, value, n, MAX_AXES, numbers, &file->has_spacings));
        memcpy(file->spacings, numbers, n * sizeof *numbers);
    } else if (is_one_of(key, offsets)) {
        EWA_TRY(take_numbers(file, key, value, n, MAX_AXES, numbers, &file->has_offset));
        memcpy(file->offset, numbers, n * sizeof *numbers);
    } else if (is_one_of(key, matrices)) {
        return take_numbers(file, key, value, n * n, n * n, file->matrix, &file->has_matrix);
    } else if (strcmp(key, "AnatomicalOrientation") == 0) {
        header->anatomical = strchr(value, '?') == NULL;
    } else if (is_one_of(key, orders)) {
        header->big_endian = is_true(value);
    } else if (strcmp(key, "BinaryData") == 0) {
        file->text = !is_true(value);
    } else if (strcmp(key, "CompressedData") == 0) {
        file->packed = is_true(value);
    } else if (strcmp(key, "ElementNumberOfChannels") == 0) {
        if (ewa_text_counts(value, 1, &file->channel_count) != 1) return broken(file, key, value);
    } else if (strcmp(key, "HeaderSize") == 0) {
        file->at_end = strcmp(value, "-1") == 0;
        if (!file->at_end && ewa_text_counts(value, 1, &count) != 1) return broken(file, key, value);
        if (!file->at_end) header->skipped_bytes = count;
    } else if (strcmp(key, "ElementType") == 0) {
        header->number = ewa_text_find(types, sizeof types / sizeof types[0], value);
        if (header->number < 0)
            return ewa_volume_fail(file->in, EWA_ERROR_UNSUPPORTED, "MetaImage: ElementType = '%.80s'",
                                   value);
    } else if (strcmp(key, "ElementDataFile") == 0) {
        if (!*value) return broken(file, key, value);
        snprintf(file->data_file, sizeof file->data_file, "%s", value);
    }
    return EWA_OK;
}

/// Splits "key = value" in place; false when there is no '='.
static bool split_line(char *line, char **key, char **value) {
    char *equals = strchr(line, '=');
    if (!equals) return false;
    char *end = equals;
    while (end > line && (end[-1] == ' ' || end[-1] == '\t')) end--;
    *end = 0;
    *key = (char *)(uintptr_t)ewa_text_skip_blanks(line);
    *value = (char *)(uintptr_t)ewa_text_skip_blanks(equals + 1);
    return true;
}

static ewa_status read_tags(meta *file, ewa_reader *reader) {
    char line[EWA_LINE_BYTES], *key, *value;
    while (ewa_text_line(reader, line)) {
        if (!line[0]) continue;
        if (!split_line(line, &key, &value)) return broken(file, "the line", line);
        EWA_TRY(take_tag(file, key, value));
        if (file->data_file[0]) return EWA_OK; // that tag is the last
    }
    return ewa_volume_fail(file->in, EWA_ERROR_FORMAT, "MetaImage: the header ends without ElementDataFile");
}

static ewa_status take_axes(meta *file) {
    ewa_volume_header *header = file->header;
    const uint64_t n = file->axis_count;
    for (uint64_t axis = 0; axis < n; axis++) {
        const uint64_t size = file->sizes[axis];
        if (axis >= 3 && size != 1) {
            if (size == 0) return ewa_volume_fail(file->in, EWA_ERROR_FORMAT, "MetaImage: an axis of 0");
            ewa_report(file->in->context, EWA_SEVERITY_WARNING, "%s: the first of %llu volumes is read",
                       file->in->name, (unsigned long long)size);
        }
        if (axis >= 3) continue;
        header->dims[axis] = size;
        const double spacing = file->has_spacings ? fabs(file->spacings[axis]) : 1;
        double *direction = header->directions[axis];
        // Each row of the matrix is the direction of one axis.
        for (uint64_t k = 0; k < 3; k++)
            direction[k] = spacing * (file->has_matrix && k < n ? file->matrix[n * axis + k] : k == axis);
        if (spacing == 0) return ewa_volume_fail(file->in, EWA_ERROR_FORMAT, "MetaImage: a spacing of zero");
        header->first_world[axis] = file->offset[axis];
    }
    header->axis_count = n < 3 ? (uint32_t)n : 3;
    header->placed = file->has_offset;
    return EWA_OK;
}

static ewa_status add_data(meta *file, ewa_reader *reader) {
    const ewa_volume_input *in = file->in;
    const char *name = file->data_file, *rest = (const char *)in->bytes + reader->at_bytes;
    ewa_volume_pieces *pieces = &file->header->pieces;
    if (strcmp(name, "LOCAL") == 0 || strcmp(name, "Local") == 0 || strcmp(name, "local") == 0)
        return ewa_volume_add_bytes(in, (const uint8_t *)rest, ewa_reader_left(reader), pieces);
    if (strncmp(name, "LIST", 4) == 0)
        return ewa_volume_add_list(in, rest, rest + ewa_reader_left(reader), pieces);
    return strchr(name, '%') ? ewa_volume_add_pattern(in, name, pieces)
                             : ewa_volume_add_file(in, name, pieces);
}

bool ewa_meta_recognise(const uint8_t *bytes, size_t size_bytes) {
    static const char *const first[] = {"ObjectType", "NDims", "Comment", "TransformType", "ObjectSubType"};
    for (size_t i = 0; i < sizeof first / sizeof first[0]; i++) {
        const size_t length = strlen(first[i]);
        if (size_bytes > length && memcmp(bytes, first[i], length) == 0 &&
            (bytes[length] == ' ' || bytes[length] == '='))
            return true;
    }
    return false;
}

ewa_status ewa_meta_parse(const ewa_volume_input *in, ewa_volume_header *header) {
    meta file = {.in = in, .header = header, .channel_count = 1};
    ewa_reader reader = {.bytes = in->bytes, .size_bytes = in->size_bytes};
    EWA_TRY(read_tags(&file, &reader));
    if (!file.has_sizes || header->number < 0)
        return ewa_volume_fail(in, EWA_ERROR_FORMAT, "MetaImage: no %s",
                               file.has_sizes ? "ElementType" : "DimSize");
    if (file.channel_count != 1 && file.channel_count != 3 && file.channel_count != 4)
        return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED,
                               "MetaImage: %llu numbers per voxel; one, or a colour, can be drawn",
                               (unsigned long long)file.channel_count);
    header->component_count = (uint32_t)file.channel_count;
    header->packing = file.packed ? EWA_PACKING_DEFLATE : file.text ? EWA_PACKING_TEXT : EWA_PACKING_NONE;
    header->at_end = file.at_end;
    if (file.at_end && header->packing != EWA_PACKING_NONE)
        return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED, "MetaImage: HeaderSize -1 of packed data");
    EWA_TRY(take_axes(&file));
    return add_data(&file, &reader);
}
