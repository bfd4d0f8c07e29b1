// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// VTK's legacy structured points.
// Based on: Kitware, "VTK File Formats", The VTK User's Guide, 2010, pages 3 to 17.
#include "base/base.h"
#include "io/mesh/formats.h"
#include "io/volume/file.h"
#include "io/volume/text.h"

enum { WORDS = 4, WORD_BYTES = 64, HEAD_LINES = 64 };

static ewa_status broken(const ewa_volume_input *in, const char *what, const char *text) {
    return ewa_volume_fail(in, EWA_ERROR_FORMAT, "VTK: %s '%.80s' cannot be read", what, text);
}

static const ewa_text_word legacy_types[] = {
    {"char", EWA_I8},       {"unsigned_char", EWA_U8},       {"short", EWA_I16}, {"unsigned_short", EWA_U16},
    {"int", EWA_I32},       {"unsigned_int", EWA_U32},       {"float", EWA_F32}, {"double", EWA_F64},
    {"long", EWA_FILE_I64}, {"unsigned_long", EWA_FILE_U64},
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
        if (count > 1 && ewa_mesh_is_vtk(in->bytes, in->size_bytes))
            return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED, "VTK: a mesh (%.40s), no grid of voxels", words[1]);
        if (count < 2 || strcasecmp(words[1], "STRUCTURED_POINTS") != 0)
            return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED,
                                   "VTK: dataset '%.40s' is no STRUCTURED_POINTS; resampled to them it is read",
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
        EWA_TRY(take_line(in, line, &has_dims, &ready, header));
    }
    if (!has_dims || header->number < 0)
        return ewa_volume_fail(in, EWA_ERROR_FORMAT, "VTK: no %s", has_dims ? "SCALARS" : "DIMENSIONS");
    return ewa_volume_add_bytes(in, in->bytes + reader.at_bytes, ewa_reader_left(&reader), &header->pieces);
}
