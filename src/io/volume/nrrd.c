// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// NRRD headers. Based on: G. Kindlmann, "Definition of NRRD File Format",
// teem.sourceforge.net/nrrd/format.html, 2009, sections 3 to 7.
#include "base/base.h"
#include "io/volume/file.h"
#include "io/volume/text.h"

#include <math.h>

enum { MAX_AXES = 16, WORD_BYTES = 64 };

typedef enum axis_kind { AXIS_SPACE, AXIS_OTHER, AXIS_COLOR3, AXIS_COLOR4 } axis_kind;

/// What the fields say, before it is known which axes are those of space.
typedef struct nrrd {
    const ewa_volume_input *in;
    ewa_volume_header *header;
    uint32_t axis_count, space_count;
    uint64_t sizes[MAX_AXES];
    double spacings[MAX_AXES], directions[MAX_AXES][3], origin[3];
    bool directed[MAX_AXES];
    axis_kind kinds[MAX_AXES];
    bool has_sizes, has_spacings, has_directions, has_origin, has_kinds, has_encoding, has_endian;
    double mirror[3]; // from the file's space to left-posterior-superior
    char data_file[EWA_LINE_BYTES];
} nrrd;

static const ewa_text_word types[] = {
    {"signed char", EWA_I8},
    {"int8", EWA_I8},
    {"int8_t", EWA_I8},
    {"uchar", EWA_U8},
    {"unsigned char", EWA_U8},
    {"uint8", EWA_U8},
    {"uint8_t", EWA_U8},
    {"short", EWA_I16},
    {"short int", EWA_I16},
    {"signed short", EWA_I16},
    {"signed short int", EWA_I16},
    {"int16", EWA_I16},
    {"int16_t", EWA_I16},
    {"ushort", EWA_U16},
    {"unsigned short", EWA_U16},
    {"unsigned short int", EWA_U16},
    {"uint16", EWA_U16},
    {"uint16_t", EWA_U16},
    {"int", EWA_I32},
    {"signed int", EWA_I32},
    {"int32", EWA_I32},
    {"int32_t", EWA_I32},
    {"uint", EWA_U32},
    {"unsigned int", EWA_U32},
    {"uint32", EWA_U32},
    {"uint32_t", EWA_U32},
    {"longlong", EWA_FILE_I64},
    {"long long", EWA_FILE_I64},
    {"long long int", EWA_FILE_I64},
    {"signed long long", EWA_FILE_I64},
    {"int64", EWA_FILE_I64},
    {"int64_t", EWA_FILE_I64},
    {"ulonglong", EWA_FILE_U64},
    {"unsigned long long", EWA_FILE_U64},
    {"uint64", EWA_FILE_U64},
    {"uint64_t", EWA_FILE_U64},
    {"float", EWA_F32},
    {"double", EWA_F64},
    {"signed long long int", EWA_FILE_I64},
    {"unsigned long long int", EWA_FILE_U64},
};

static const ewa_text_word encodings[] = {
    {"raw", EWA_PACKING_NONE},  {"gz", EWA_PACKING_DEFLATE},  {"gzip", EWA_PACKING_DEFLATE},
    {"bz2", EWA_PACKING_BZIP2}, {"bzip2", EWA_PACKING_BZIP2}, {"txt", EWA_PACKING_TEXT},
    {"text", EWA_PACKING_TEXT}, {"ascii", EWA_PACKING_TEXT},  {"hex", EWA_PACKING_HEX},
};

static const ewa_text_word kinds[] = {
    {"domain", AXIS_SPACE},      {"space", AXIS_SPACE},      {"???", AXIS_SPACE},
    {"none", AXIS_SPACE},        {"RGB-color", AXIS_COLOR3}, {"3-color", AXIS_COLOR3},
    {"RGBA-color", AXIS_COLOR4}, {"4-color", AXIS_COLOR4},
};

/// Which of the world axes are turned, and how many axes the space has.
static const struct {
    const char *name, *letters;
    uint32_t axis_count;
    double mirror[3];
} spaces[] = {
    {"right-anterior-superior", "RAS", 3, {-1, -1, 1}},
    {"left-anterior-superior", "LAS", 3, {1, -1, 1}},
    {"left-posterior-superior", "LPS", 3, {1, 1, 1}},
    {"scanner-xyz", "", 3, {1, 1, 1}},
    {"3D-right-handed", "", 3, {1, 1, 1}},
    {"3D-left-handed", "", 3, {1, -1, 1}},
};

#define COUNT(table) (sizeof(table) / sizeof(table)[0])

static ewa_status broken(const nrrd *file, const char *field, const char *value) {
    return ewa_volume_fail(file->in, EWA_ERROR_FORMAT, "NRRD: %s '%.80s' cannot be read", field, value);
}

static ewa_status take_space(nrrd *file, const char *value) {
    for (size_t i = 0; i < COUNT(spaces); i++) {
        if (strcasecmp(value, spaces[i].name) != 0 && strcasecmp(value, spaces[i].letters) != 0) continue;
        file->space_count = spaces[i].axis_count;
        memcpy(file->mirror, spaces[i].mirror, sizeof file->mirror);
        file->header->anatomical = spaces[i].letters[0] != 0;
        return EWA_OK;
    }
    return ewa_volume_fail(file->in, EWA_ERROR_UNSUPPORTED, "NRRD: space '%.80s'", value);
}

/// Reads "(a,b,c)" with as many numbers as the space has axes; NULL when it is none such.
static const char *read_vector(const char *text, uint32_t count, double vector[3]) {
    const char *end = text + strlen(text);
    if (*text++ != '(') return NULL;
    for (uint32_t k = 0; k < count; k++) {
        text = ewa_number_read_f64(ewa_text_skip_blanks(text), end, &vector[k]);
        if (!text) return NULL;
        text = ewa_text_skip_blanks(text);
        if (*text++ != (k + 1 < count ? ',' : ')')) return NULL;
    }
    return text;
}

static ewa_status take_directions(nrrd *file, const char *value) {
    if (!file->axis_count)
        return ewa_volume_fail(file->in, EWA_ERROR_FORMAT, "NRRD: space directions before dimension");
    if (!file->space_count) file->space_count = 3; // missing in files of some writers
    const char *text = value;
    for (uint32_t axis = 0; axis < file->axis_count; axis++) {
        text = ewa_text_skip_blanks(text);
        file->directed[axis] = strncasecmp(text, "none", 4) != 0;
        text = file->directed[axis] ? read_vector(text, file->space_count, file->directions[axis]) : text + 4;
        if (!text) return broken(file, "space directions", value);
    }
    file->has_directions = true;
    return *ewa_text_skip_blanks(text) ? broken(file, "space directions", value) : EWA_OK;
}

static ewa_status take_kinds(nrrd *file, const char *value) {
    const char *text = value;
    for (uint32_t axis = 0; axis < file->axis_count; axis++) {
        char word[WORD_BYTES];
        text = ewa_text_skip_blanks(text);
        const size_t length = strcspn(text, " \t");
        if (!length || length >= sizeof word) return broken(file, "kinds", value);
        memcpy(word, text, length);
        word[length] = 0;
        const int kind = ewa_text_find(kinds, COUNT(kinds), word);
        file->kinds[axis] = kind < 0 ? AXIS_OTHER : (axis_kind)kind;
        text += length;
    }
    file->has_kinds = true;
    return EWA_OK;
}

static ewa_status take_skip(nrrd *file, const char *field, const char *value, bool lines) {
    if (!lines && strcmp(value, "-1") == 0) {
        file->header->at_end = true;
        return EWA_OK;
    }
    uint64_t count;
    if (ewa_text_counts(value, 1, &count) != 1) return broken(file, field, value);
    *(lines ? &file->header->skipped_lines : &file->header->skipped_bytes) = count;
    return EWA_OK;
}

static ewa_status take_numbers(nrrd *file, const char *field, const char *value) {
    const int axis_count = (int)file->axis_count;
    if (!axis_count) return ewa_volume_fail(file->in, EWA_ERROR_FORMAT, "NRRD: %s before dimension", field);
    const bool sizes = strcasecmp(field, "sizes") == 0;
    const int count = sizes ? ewa_text_counts(value, MAX_AXES, file->sizes)
                            : ewa_text_numbers(value, MAX_AXES, file->spacings);
    *(sizes ? &file->has_sizes : &file->has_spacings) = true;
    return count == axis_count ? EWA_OK : broken(file, field, value);
}

/// Takes one field of the header; those that say nothing of the voxels and their places are passed over.
static ewa_status take_field(nrrd *file, const char *field, const char *value) {
    ewa_volume_header *header = file->header;
    uint64_t count;
    if (strcasecmp(field, "type") == 0) {
        header->number = ewa_text_find(types, COUNT(types), value);
        if (header->number < 0)
            return ewa_volume_fail(file->in, EWA_ERROR_UNSUPPORTED, "NRRD: type '%.80s'", value);
    } else if (strcasecmp(field, "encoding") == 0) {
        const int packing = ewa_text_find(encodings, COUNT(encodings), value);
        if (packing < 0)
            return ewa_volume_fail(file->in, EWA_ERROR_UNSUPPORTED, "NRRD: encoding '%.80s'", value);
        header->packing = (ewa_packing)packing;
        file->has_encoding = true;
    } else if (strcasecmp(field, "endian") == 0) {
        header->big_endian = strcasecmp(value, "big") == 0;
        file->has_endian = true;
        if (!header->big_endian && strcasecmp(value, "little") != 0) return broken(file, field, value);
    } else if (strcasecmp(field, "dimension") == 0) {
        if (ewa_text_counts(value, 1, &count) != 1 || count < 1 || count > MAX_AXES)
            return broken(file, field, value);
        file->axis_count = (uint32_t)count;
    } else if (strcasecmp(field, "space dimension") == 0) {
        if (ewa_text_counts(value, 1, &count) != 1) return broken(file, field, value);
        if (count < 1 || count > 3)
            return ewa_volume_fail(file->in, EWA_ERROR_UNSUPPORTED, "NRRD: a space of %llu dimensions",
                                   (unsigned long long)count);
        file->space_count = (uint32_t)count;
    } else if (strcasecmp(field, "sizes") == 0 || strcasecmp(field, "spacings") == 0) {
        return take_numbers(file, field, value);
    } else if (strcasecmp(field, "space") == 0) {
        return take_space(file, value);
    } else if (strcasecmp(field, "space directions") == 0) {
        return take_directions(file, value);
    } else if (strcasecmp(field, "space origin") == 0) {
        file->has_origin = true;
        if (!file->space_count) file->space_count = 3;
        if (!read_vector(value, file->space_count, file->origin)) return broken(file, field, value);
    } else if (strcasecmp(field, "kinds") == 0) {
        return take_kinds(file, value);
    } else if (strcasecmp(field, "line skip") == 0 || strcasecmp(field, "lineskip") == 0) {
        return take_skip(file, field, value, true);
    } else if (strcasecmp(field, "byte skip") == 0 || strcasecmp(field, "byteskip") == 0) {
        return take_skip(file, field, value, false);
    } else if (strcasecmp(field, "data file") == 0 || strcasecmp(field, "datafile") == 0) {
        if (!*value) return broken(file, field, value);
        snprintf(file->data_file, sizeof file->data_file, "%s", value);
    }
    return EWA_OK;
}

/// Reads the lines up to the empty one, or to the end when the voxels are elsewhere; "data file: LIST" ends
/// them too.
static ewa_status read_fields(nrrd *file, ewa_reader *reader) {
    char line[EWA_LINE_BYTES];
    ewa_text_line(reader, line); // the magic
    while (ewa_text_line(reader, line)) {
        if (!line[0]) return EWA_OK;
        if (line[0] == '#' || strstr(line, ":=")) continue;
        char *colon = strchr(line, ':');
        if (!colon) return broken(file, "the line", line);
        *colon = 0;
        EWA_TRY(take_field(file, line, ewa_text_skip_blanks(colon + 1)));
        if (strncmp(file->data_file, "LIST", 4) == 0) return EWA_OK;
    }
    if (reader->failed)
        return ewa_volume_fail(file->in, EWA_ERROR_FORMAT, "NRRD: a line of over %d bytes",
                               EWA_LINE_BYTES - 1);
    if (!file->data_file[0])
        return ewa_volume_fail(file->in, EWA_ERROR_FORMAT, "NRRD: the header does not end");
    return EWA_OK;
}

static bool is_spatial(const nrrd *file, uint32_t axis) {
    if (file->has_directions) return file->directed[axis];
    return !file->has_kinds || file->kinds[axis] == AXIS_SPACE;
}

/// Puts axis `axis` of the file in the place of axis `to` of the volume.
static void place_axis(const nrrd *file, uint32_t axis, uint32_t to) {
    double *direction = file->header->directions[to];
    file->header->dims[to] = file->sizes[axis];
    if (file->has_directions) {
        for (int k = 0; k < 3; k++) direction[k] = file->mirror[k] * file->directions[axis][k];
    } else {
        // A NaN stands for "not known" in the format.
        const bool known = file->has_spacings && !isnan(file->spacings[axis]);
        for (uint32_t k = 0; k < 3; k++) direction[k] = 0;
        direction[to] = file->mirror[to] * (known ? fabs(file->spacings[axis]) : 1);
    }
}

/// Pictures of early writers do not say that three bytes side by side are a colour.
static void guess_colors(nrrd *file) {
    const ewa_volume_header *header = file->header;
    if (file->has_kinds || file->has_directions || file->has_spacings || file->axis_count != 3 ||
        file->sizes[0] != 3 || file->sizes[1] <= 3 || file->sizes[2] <= 3 || header->number != EWA_U8)
        return;
    file->has_kinds = true;
    file->kinds[0] = AXIS_COLOR3;
    file->kinds[1] = file->kinds[2] = AXIS_SPACE;
    ewa_report(file->in->context, EWA_SEVERITY_INFO, "%s: three bytes for each place: taken for colours",
               file->in->name);
}

/// Sorts the file's axes into components, space and the rest, of which the first entry is taken.
static ewa_status sort_axes(nrrd *file) {
    ewa_volume_header *header = file->header;
    uint32_t placed = 0;
    guess_colors(file);
    for (uint32_t axis = 0; axis < file->axis_count; axis++) {
        const uint64_t size = file->sizes[axis];
        const axis_kind kind = file->kinds[axis];
        const uint64_t color = kind == AXIS_COLOR3 ? 3 : kind == AXIS_COLOR4 ? 4 : 0;
        if (is_spatial(file, axis) && placed < 3) {
            place_axis(file, axis, placed++);
        } else if (size == 0) {
            return ewa_volume_fail(file->in, EWA_ERROR_FORMAT, "NRRD: axis %u has no entries", axis);
        } else if (axis == 0 && color == size) {
            header->component_count = (uint32_t)size;
        } else if (size > 1 && placed == 0) {
            return ewa_volume_fail(file->in, EWA_ERROR_UNSUPPORTED,
                                   "NRRD: %llu numbers per voxel; one, or a colour, can be drawn",
                                   (unsigned long long)size);
        } else if (size > 1 && axis + 1 < file->axis_count && placed < 3) {
            return ewa_volume_fail(file->in, EWA_ERROR_UNSUPPORTED,
                                   "NRRD: axis %u of %llu entries lies between those of space", axis,
                                   (unsigned long long)size);
        } else if (size > 1) {
            ewa_report(file->in->context, EWA_SEVERITY_WARNING, "%s: the first of %llu volumes is read",
                       file->in->name, (unsigned long long)size);
        }
    }
    if (!placed) return ewa_volume_fail(file->in, EWA_ERROR_FORMAT, "NRRD: no axis of space");
    header->axis_count = placed;
    header->placed = file->has_origin;
    for (int k = 0; k < 3; k++) header->first_world[k] = file->mirror[k] * file->origin[k];
    return EWA_OK;
}

static ewa_status add_data(nrrd *file, const ewa_reader *reader) {
    const ewa_volume_input *in = file->in;
    const char *name = file->data_file, *rest = (const char *)in->bytes + reader->at_bytes;
    ewa_volume_pieces *pieces = &file->header->pieces;
    if (!name[0]) return ewa_volume_add_bytes(in, (const uint8_t *)rest, ewa_reader_left(reader), pieces);
    if (strncmp(name, "LIST", 4) == 0)
        return ewa_volume_add_list(in, rest, rest + ewa_reader_left(reader), pieces);
    return strchr(name, '%') ? ewa_volume_add_pattern(in, name, pieces)
                             : ewa_volume_add_file(in, name, pieces);
}

bool ewa_nrrd_recognise(const uint8_t *bytes, size_t size_bytes) {
    return size_bytes >= 8 && memcmp(bytes, "NRRD000", 7) == 0 && bytes[7] >= '1' && bytes[7] <= '5';
}

ewa_status ewa_nrrd_parse(const ewa_volume_input *in, ewa_volume_header *header) {
    nrrd file = {.in = in, .header = header, .mirror = {1, 1, 1}};
    ewa_reader reader = {.bytes = in->bytes, .size_bytes = in->size_bytes};
    EWA_TRY(read_fields(&file, &reader));
    const char *missing = !file.axis_count     ? "dimension"
                          : !file.has_sizes    ? "sizes"
                          : header->number < 0 ? "type"
                          : !file.has_encoding ? "encoding"
                                               : NULL;
    if (missing) return ewa_volume_fail(in, EWA_ERROR_FORMAT, "NRRD: no field '%s'", missing);
    const bool bytes = header->packing != EWA_PACKING_TEXT && ewa_file_number_bytes(header->number) > 1;
    if (bytes && !file.has_endian) return ewa_volume_fail(in, EWA_ERROR_FORMAT, "NRRD: no field 'endian'");
    if (header->at_end && header->packing != EWA_PACKING_NONE)
        return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED, "NRRD: byte skip -1 of packed data");
    EWA_TRY(sort_axes(&file));
    return add_data(&file, &reader);
}
