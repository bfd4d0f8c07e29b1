// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// VTK's legacy structured points and the image files of its XML formats with appended raw data.
// Based on: Kitware, "VTK File Formats", The VTK User's Guide, 2010, pages 3 to 17.
#include "base/base.h"
#include "io/volume_file.h"
#include "io/volume_text.h"

enum { WORDS = 4, WORD_BYTES = 64, HEAD_LINES = 64, ATTRIBUTE_BYTES = 256 };

static ewa_status broken(const ewa_volume_input *in, const char *what, const char *text) {
    return ewa_volume_fail(in, EWA_ERROR_FORMAT, "VTK: %s '%.80s' cannot be read", what, text);
}

static const ewa_text_word legacy_types[] = {
    {"char", EWA_I8},       {"unsigned_char", EWA_U8},       {"short", EWA_I16}, {"unsigned_short", EWA_U16},
    {"int", EWA_I32},       {"unsigned_int", EWA_U32},       {"float", EWA_F32}, {"double", EWA_F64},
    {"long", EWA_FILE_I64}, {"unsigned_long", EWA_FILE_U64},
};

static const ewa_text_word xml_types[] = {
    {"Int8", EWA_I8},     {"UInt8", EWA_U8},    {"Int16", EWA_I16},      {"UInt16", EWA_U16},
    {"Int32", EWA_I32},   {"UInt32", EWA_U32},  {"Int64", EWA_FILE_I64}, {"UInt64", EWA_FILE_U64},
    {"Float32", EWA_F32}, {"Float64", EWA_F64},
};

/// Splits a line at its blanks into at most WORDS words; returns how many.
static int split(const char *line, char words[WORDS][WORD_BYTES]) {
    int count = 0;
    while (count < WORDS) {
        line = ewa_text_skip_blanks(line);
        const size_t length = strcspn(line, " \t");
        if (!length || length >= WORD_BYTES) return count;
        memcpy(words[count], line, length);
        words[count++][length] = 0;
        line += length;
    }
    return count;
}

static ewa_status take_spacings(const ewa_volume_input *in, const double spacings[3],
                                ewa_volume_header *header) {
    for (int axis = 0; axis < 3; axis++) {
        if (spacings[axis] == 0) return ewa_volume_fail(in, EWA_ERROR_FORMAT, "VTK: a spacing of zero");
        header->directions[axis][axis] = spacings[axis];
    }
    return EWA_OK;
}

/// Takes one line of a legacy header; `*ready` after the one behind which the numbers begin.
static ewa_status take_line(const ewa_volume_input *in, const char *line, bool *has_dims, bool *ready,
                            ewa_volume_header *header) {
    char words[WORDS][WORD_BYTES];
    const int count = split(line, words);
    if (!count) return EWA_OK;
    const char *rest = ewa_text_skip_blanks(line) + strlen(words[0]);
    if (strcasecmp(words[0], "DATASET") == 0) {
        if (count < 2 || strcasecmp(words[1], "STRUCTURED_POINTS") != 0)
            return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED, "VTK: dataset '%.40s' is no STRUCTURED_POINTS",
                                   count > 1 ? words[1] : "");
    } else if (strcasecmp(words[0], "DIMENSIONS") == 0) {
        *has_dims = ewa_text_counts(rest, 3, header->dims) == 3;
        if (!*has_dims) return broken(in, "the line", line);
    } else if (strcasecmp(words[0], "SPACING") == 0 || strcasecmp(words[0], "ASPECT_RATIO") == 0) {
        double spacings[3];
        if (ewa_text_numbers(rest, 3, spacings) != 3) return broken(in, "the line", line);
        return take_spacings(in, spacings, header);
    } else if (strcasecmp(words[0], "ORIGIN") == 0) {
        header->placed = true;
        if (ewa_text_numbers(rest, 3, header->first_world) != 3) return broken(in, "the line", line);
    } else if (strcasecmp(words[0], "SCALARS") == 0) {
        header->number =
            count > 2 ? ewa_text_find(legacy_types, sizeof legacy_types / sizeof legacy_types[0], words[2])
                      : -1;
        if (header->number < 0) return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED, "VTK: '%.80s'", line);
        if (count > 3 && strcmp(words[3], "3") != 0 && strcmp(words[3], "4") != 0 &&
            strcmp(words[3], "1") != 0)
            return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED, "VTK: '%.80s' numbers per voxel", words[3]);
        header->component_count = count > 3 ? (uint32_t)(words[3][0] - '0') : 1;
    } else if (strcasecmp(words[0], "LOOKUP_TABLE") == 0) {
        *ready = true;
    } else if (strcasecmp(words[0], "POINT_DATA") != 0) {
        return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED, "VTK: '%.80s'", line);
    }
    return EWA_OK;
}

bool ewa_vtk_recognise(const uint8_t *bytes, size_t size_bytes) {
    static const char magic[] = "# vtk DataFile Version";
    return size_bytes >= sizeof magic - 1 && memcmp(bytes, magic, sizeof magic - 1) == 0;
}

ewa_status ewa_vtk_parse(const ewa_volume_input *in, ewa_volume_header *header) {
    ewa_reader reader = {.bytes = in->bytes, .size_bytes = in->size_bytes};
    char line[EWA_LINE_BYTES] = "";
    ewa_text_line(&reader, line); // magic
    ewa_text_line(&reader, line); // title
    line[0] = 0;
    while (!line[0] && ewa_text_line(&reader, line)) continue;
    const bool text = strcasecmp(line, "ASCII") == 0;
    if (!text && strcasecmp(line, "BINARY") != 0) return broken(in, "the encoding", line);
    header->packing = text ? EWA_PACKING_TEXT : EWA_PACKING_NONE;
    header->big_endian = true;
    bool has_dims = false, ready = false;
    for (int count = 0; !ready; count++) {
        if (count == HEAD_LINES || !ewa_text_line(&reader, line))
            return ewa_volume_fail(in, EWA_ERROR_FORMAT, "VTK: the header does not end in LOOKUP_TABLE");
        const ewa_status status = take_line(in, line, &has_dims, &ready, header);
        if (status != EWA_OK) return status;
    }
    if (!has_dims || header->number < 0)
        return ewa_volume_fail(in, EWA_ERROR_FORMAT, "VTK: no %s", has_dims ? "SCALARS" : "DIMENSIONS");
    return ewa_volume_add_bytes(in, in->bytes + reader.at_bytes, ewa_reader_left(&reader), &header->pieces);
}

/// Finds ` name="value"` in the tag at `tag` and copies the value; false when there is none.
static bool find_attribute(const char *tag, const char *end, const char *name, char value[ATTRIBUTE_BYTES]) {
    const size_t length = strlen(name);
    for (const char *at = tag; at < end && *at != '>'; at++) {
        if ((size_t)(end - at) < length + 3 || (*at != ' ' && *at != '\n' && *at != '\t') ||
            memcmp(at + 1, name, length) != 0 || at[length + 1] != '=' || at[length + 2] != '"')
            continue;
        const char *from = at + length + 3, *quote = memchr(from, '"', (size_t)(end - from));
        if (!quote || quote - from >= ATTRIBUTE_BYTES) return false;
        memcpy(value, from, (size_t)(quote - from));
        value[quote - from] = 0;
        return true;
    }
    return false;
}

/// Finds the first tag "<name" from `text` on; NULL when there is none.
static const char *find_tag(const char *text, const char *end, const char *name) {
    const size_t length = strlen(name);
    while (text < end) {
        const char *open = memchr(text, '<', (size_t)(end - text));
        if (!open || (size_t)(end - open) <= length + 1) return NULL;
        const char after = open[length + 1];
        if (memcmp(open + 1, name, length) == 0 && strchr(" \t\r\n>", after)) return open;
        text = open + 1;
    }
    return NULL;
}

/// Where the pieces of an XML file are.
typedef struct vti {
    const ewa_volume_input *in;
    const char *text, *end;
    const char *image, *array, *appended; // tags
    bool wide;                            // block headers have 64 bits
    bool packed, big_endian;
} vti;

static uint64_t read_word(const vti *file, const uint8_t *bytes) {
    const size_t size_bytes = file->wide ? 8 : 4;
    uint64_t word = 0;
    for (size_t i = 0; i < size_bytes; i++)
        word = word << 8 | bytes[file->big_endian ? i : size_bytes - 1 - i];
    return word;
}

/// Steps over the sizes in front of the data: of all bytes, or of every zlib stream.
static ewa_status add_data(const vti *file, uint64_t offset, ewa_volume_header *header) {
    const ewa_volume_input *in = file->in;
    const char *mark = memchr(file->appended, '_', (size_t)(file->end - file->appended));
    const uint64_t word_bytes = file->wide ? 8 : 4;
    ewa_reader reader = {.bytes = in->bytes, .size_bytes = in->size_bytes};
    ewa_reader_take(&reader, mark ? (uint64_t)(mark + 1 - file->text) : 0);
    ewa_reader_take(&reader, offset);
    const uint8_t *first = ewa_reader_take(&reader, word_bytes);
    if (!mark || !first) return ewa_volume_fail(in, EWA_ERROR_FORMAT, "VTI: the appended data end early");
    if (file->packed) {
        const uint64_t block_count = read_word(file, first);
        if (block_count > in->size_bytes / word_bytes || block_count == 0 ||
            !ewa_reader_take(&reader, (block_count + 2) * word_bytes))
            return ewa_volume_fail(in, EWA_ERROR_FORMAT, "VTI: %llu blocks", (unsigned long long)block_count);
        header->packing = EWA_PACKING_DEFLATE;
    }
    return ewa_volume_add_bytes(in, in->bytes + reader.at_bytes, ewa_reader_left(&reader), &header->pieces);
}

static ewa_status find_tags(vti *file) {
    const char *root = find_tag(file->text, file->end, "VTKFile");
    file->appended = find_tag(file->text, file->end, "AppendedData");
    const char *end = file->appended ? file->appended : file->end;
    file->image = find_tag(file->text, end, "ImageData");
    const char *points = find_tag(file->text, end, "PointData");
    file->array = points ? find_tag(points, end, "DataArray") : NULL;
    char value[ATTRIBUTE_BYTES];
    if (!root || !file->image || !file->array)
        return ewa_volume_fail(file->in, EWA_ERROR_UNSUPPORTED, "VTI: no ImageData with PointData");
    if (!file->appended || !find_attribute(file->array, end, "format", value) ||
        strcmp(value, "appended") != 0 || !find_attribute(file->appended, file->end, "encoding", value) ||
        strcmp(value, "raw") != 0)
        return ewa_volume_fail(file->in, EWA_ERROR_UNSUPPORTED, "VTI: only appended raw data can be read");
    file->wide = find_attribute(root, end, "header_type", value) && strcmp(value, "UInt64") == 0;
    file->big_endian = find_attribute(root, end, "byte_order", value) && strcmp(value, "BigEndian") == 0;
    file->packed = find_attribute(root, end, "compressor", value);
    if (file->packed && strcmp(value, "vtkZLibDataCompressor") != 0)
        return ewa_volume_fail(file->in, EWA_ERROR_UNSUPPORTED, "VTI: compressor '%.80s'", value);
    return EWA_OK;
}

bool ewa_vti_recognise(const uint8_t *bytes, size_t size_bytes) {
    return size_bytes > 8 && (memcmp(bytes, "<?xml", 5) == 0 || memcmp(bytes, "<VTKFile", 8) == 0);
}

ewa_status ewa_vti_parse(const ewa_volume_input *in, ewa_volume_header *header) {
    vti file = {.in = in, .text = (const char *)in->bytes};
    file.end = file.text + in->size_bytes;
    ewa_status status = find_tags(&file);
    if (status != EWA_OK) return status;
    char value[ATTRIBUTE_BYTES] = "";
    double extent[6], spacings[3], origin[3] = {0};
    if (!find_attribute(file.image, file.end, "WholeExtent", value) ||
        ewa_text_numbers(value, 6, extent) != 6)
        return broken(in, "WholeExtent", value);
    const bool has_origin = find_attribute(file.image, file.end, "Origin", value);
    if (has_origin && ewa_text_numbers(value, 3, origin) != 3) return broken(in, "Origin", value);
    if (!find_attribute(file.image, file.end, "Spacing", value) || ewa_text_numbers(value, 3, spacings) != 3)
        return broken(in, "Spacing", value);
    for (int axis = 0; axis < 3; axis++) {
        const double side = extent[2 * axis + 1] - extent[2 * axis] + 1;
        if (!(side >= 1 && side <= 4294967295.0)) return broken(in, "WholeExtent of a side", "below 1");
        header->dims[axis] = (uint64_t)side;
        header->first_world[axis] = origin[axis] + extent[2 * axis] * spacings[axis];
    }
    header->placed = has_origin;
    status = take_spacings(in, spacings, header);
    if (status != EWA_OK) return status;
    if (!find_attribute(file.array, file.end, "type", value)) value[0] = 0;
    header->number = ewa_text_find(xml_types, sizeof xml_types / sizeof xml_types[0], value);
    if (header->number < 0) return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED, "VTI: type '%.80s'", value);
    if (find_attribute(file.array, file.end, "NumberOfComponents", value) && strcmp(value, "1") != 0)
        return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED, "VTI: '%.40s' numbers per voxel", value);
    header->big_endian = file.big_endian;
    uint64_t offset = 0;
    if (!find_attribute(file.array, file.end, "offset", value) || ewa_text_counts(value, 1, &offset) != 1)
        return broken(in, "offset", value);
    return add_data(&file, offset, header);
}
