// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Wavefront OBJ. The text is read twice: first what is numbered (places, texture coordinates, normals), then
// the faces over it, so that a face may name what stands behind it.
//
// Based on: Wavefront Technologies, "Advanced Visualizer manual, appendix B1: object files", 1995. Beyond it,
// as files have it: colours behind places, byte order marks, UTF-16, names with blanks.
#include "base/base.h"
#include "image/srgb.h"
#include "io/mesh/formats.h"
#include "io/number.h"

#include <math.h>

typedef struct obj_reader {
    ewa_mesh_build *build;
    ewa_cursor cursor;
    bool codes;            ///< colours are numbers up to 255
    uint64_t seen[3];      ///< places, texture coordinates, normals so far in the second reading
    ewa_mesh_list corners; ///< of the present face
    ewa_mtl *materials;
    bool names_materials;    ///< some `mtllib` or `usemtl`
    uint64_t lost_materials; ///< `usemtl` names that no library has
} obj_reader;

typedef enum statement {
    OBJ_OTHER,
    OBJ_PLACE,
    OBJ_TEXCOORD,
    OBJ_NORMAL,
    OBJ_FACE,
    OBJ_LINE,
    OBJ_POINT,
    OBJ_LIBRARY,
    OBJ_MATERIAL,
} statement;

/// Negative means none.
static const float no_color[4] = {-1, -1, -1, -1};

/// Takes the word that a line begins with.
static statement take_statement(ewa_cursor *cursor) {
    static const struct {
        const char *word;
        statement kind;
    } known[] = {{"v", OBJ_PLACE},   {"f", OBJ_FACE},         {"vt", OBJ_TEXCOORD},
                 {"vn", OBJ_NORMAL}, {"fo", OBJ_FACE},        {"l", OBJ_LINE},
                 {"p", OBJ_POINT},   {"mtllib", OBJ_LIBRARY}, {"usemtl", OBJ_MATERIAL}};
    const ewa_text word = ewa_cursor_word(cursor);
    for (size_t i = 0; i < sizeof known / sizeof known[0] && word.length; i++)
        if (ewa_text_is(word, known[i].word)) return known[i].kind;
    return OBJ_OTHER;
}

/// Whether nothing but a remark follows on the line.
static bool line_ends(ewa_cursor *cursor) {
    ewa_cursor_skip_blanks(cursor);
    return cursor->at == cursor->end || ewa_is_line_end(*cursor->at) || *cursor->at == '#';
}

static ewa_status read_place(obj_reader *reader) {
    ewa_mesh_build *build = reader->build;
    double values[8];
    const uint64_t line = reader->cursor.line;
    const uint32_t count = ewa_cursor_numbers(&reader->cursor, 8, values);
    for (uint32_t c = count; c < 3; c++) values[c] = NAN;
    // What is no number makes the place none: those behind it keep their numbers.
    if (count < 3 || !line_ends(&reader->cursor)) {
        ewa_mesh_note_unread(build, line);
        values[0] = NAN;
    }
    EWA_TRY(ewa_mesh_add_position(build, values));
    if (count < 6) return EWA_OK;
    // Three or four behind the place are a colour; a lone fourth is a weight, which surfaces of planes have
    // not.
    float color[4] = {(float)values[3], (float)values[4], (float)values[5],
                      count == 7 ? (float)values[6] : -1};
    for (int c = 0; c < 3; c++) reader->codes = reader->codes || color[c] > 1;
    return ewa_mesh_add_color(build, no_color, color);
}

/// The first reading: everything that faces count.
static ewa_status read_numbered(obj_reader *reader) {
    ewa_mesh_build *build = reader->build;
    ewa_status status = EWA_OK;
    double values[3];
    while (reader->cursor.at < reader->cursor.end && status == EWA_OK) {
        const uint64_t line = reader->cursor.line;
        uint32_t count;
        switch (take_statement(&reader->cursor)) {
        case OBJ_PLACE:
            status = read_place(reader);
            break;
        case OBJ_TEXCOORD:
            count = ewa_cursor_numbers(&reader->cursor, 3, values);
            if (!count) ewa_mesh_note_unread(build, line);
            status = ewa_mesh_add_texcoord(build, count ? values[0] : NAN, count > 1 ? values[1] : 0);
            break;
        case OBJ_NORMAL:
            count = ewa_cursor_numbers(&reader->cursor, 3, values);
            for (uint32_t c = count; c < 3; c++) values[c] = 0; // none
            status = ewa_mesh_add_normal(build, values);
            break;
        case OBJ_LIBRARY:
        case OBJ_MATERIAL:
            reader->names_materials = true;
            break;
        default:
            break;
        }
        ewa_cursor_next_line(&reader->cursor);
    }
    return status;
}

/// Colours of the file, sRGB in shares or up to 255, to linear light.
static void finish_colors(obj_reader *reader) {
    float *color = reader->build->colors.items;
    const double scale = reader->codes ? 1.0 / 255 : 1;
    for (uint64_t i = 0; i < 4 * reader->build->colors.count; i++) {
        const double value = (double)color[i] * scale;
        if (i % 4 == 3)
            color[i] = value >= 0 && value < 1 ? (float)value : 1;
        else
            color[i] = value >= 0 ? (float)ewa_srgb_decode(fmin(value, 1)) : 1;
    }
}

/// Reads a number of a corner, counted from 1, or back from the last so far when negative. Returns what
/// follows; NULL when there is none.
static const char *read_index(const char *text, const char *end, uint64_t seen, uint32_t *index) {
    int64_t number;
    const char *after = ewa_number_read_i64(text, end, &number);
    if (!after) return NULL;
    if (number < 0) number += (int64_t)seen + 1;
    *index = number > 0 && number < (int64_t)EWA_MESH_NONE ? (uint32_t)(number - 1) : EWA_MESH_NONE;
    return after;
}

/// Reads "place[/[texcoord][/[normal]]]"; false when the word is not of that form.
static bool read_corner(const obj_reader *reader, ewa_text word, ewa_mesh_corner *corner) {
    const char *end = word.chars + word.length;
    uint32_t index[3] = {EWA_MESH_NONE, EWA_MESH_NONE, EWA_MESH_NONE};
    const char *at = read_index(word.chars, end, reader->seen[0], &index[0]);
    for (int k = 1; k < 3 && at && at < end; k++) {
        if (*at != '/') return false;
        const char *after = ++at < end && *at != '/' ? read_index(at, end, reader->seen[k], &index[k]) : at;
        at = after;
    }
    *corner = (ewa_mesh_corner){index[0], index[1], index[2]};
    return at == end;
}

static ewa_status read_line(obj_reader *reader) {
    const uint64_t lines = reader->build->line_count;
    ewa_mesh_corner corner = {0}, last = {.position = EWA_MESH_NONE};
    for (ewa_text word; (word = ewa_cursor_word(&reader->cursor)).length; last = corner) {
        if (!read_corner(reader, word, &corner)) corner.position = EWA_MESH_NONE;
        EWA_TRY(ewa_mesh_add_line(reader->build, (const uint32_t[2]){last.position, corner.position}, 2));
    }
    reader->build->line_count = lines + 1;
    return EWA_OK;
}

static ewa_status read_face(obj_reader *reader) {
    ewa_mesh_build *build = reader->build;
    ewa_status status = EWA_OK;
    reader->corners.count = 0;
    for (;;) {
        const ewa_text word = ewa_cursor_word(&reader->cursor);
        if (!word.length) break;
        ewa_mesh_corner *corner = ewa_mesh_list_add(build, &reader->corners, &status);
        if (!corner) return status;
        // A corner that cannot be read is one that is not there.
        if (!read_corner(reader, word, corner)) corner->position = EWA_MESH_NONE;
    }
    return ewa_mesh_add_polygon(build, reader->corners.items, reader->corners.count);
}

static ewa_status use_material(obj_reader *reader) {
    uint32_t look = EWA_MESH_NONE;
    const ewa_text name = ewa_cursor_rest(&reader->cursor);
    const ewa_status status = ewa_mtl_look(reader->build, reader->materials, name, &look);
    if (look == EWA_MESH_NONE && reader->materials) reader->lost_materials++;
    reader->build->look = look;
    return status;
}

/// The second reading: faces and what they look like.
static ewa_status read_faces(obj_reader *reader) {
    ewa_mesh_build *build = reader->build;
    ewa_status status = EWA_OK;
    while (reader->cursor.at < reader->cursor.end && status == EWA_OK) {
        switch (take_statement(&reader->cursor)) {
        case OBJ_PLACE:
            reader->seen[0]++;
            break;
        case OBJ_TEXCOORD:
            reader->seen[1]++;
            break;
        case OBJ_NORMAL:
            reader->seen[2]++;
            break;
        case OBJ_FACE:
            status = read_face(reader);
            break;
        case OBJ_LINE:
            status = read_line(reader);
            break;
        case OBJ_POINT:
            build->point_count++;
            break;
        case OBJ_LIBRARY:
            status = ewa_mtl_read(build, ewa_cursor_rest(&reader->cursor), &reader->materials);
            break;
        case OBJ_MATERIAL:
            status = use_material(reader);
            break;
        default:
            break;
        }
        ewa_cursor_next_line(&reader->cursor);
    }
    return status;
}

ewa_status ewa_mesh_read_obj(ewa_mesh_build *build) {
    const ewa_mesh_source *source = build->source;
    obj_reader reader = {.build = build, .corners = {.item_bytes = sizeof(ewa_mesh_corner)}};
    char *owned;
    size_t owned_bytes;
    EWA_TRY(ewa_text_open(build->context, source->name, source->bytes, source->size_bytes, &reader.cursor,
                          &owned, &owned_bytes));
    const ewa_cursor start = reader.cursor;
    ewa_status status = read_numbered(&reader);
    if (status == EWA_OK) {
        finish_colors(&reader);
        reader.cursor = start;
        status = ewa_progress(build->context, "read", 0.4);
    }
    // Exporters and people leave the line out that names the library.
    if (status == EWA_OK && !reader.names_materials && build->texcoords.count)
        status = ewa_mtl_look_of_own(build, &reader.materials, &build->look);
    if (status == EWA_OK) status = read_faces(&reader);
    if (status == EWA_OK && reader.lost_materials)
        ewa_report(build->context, EWA_SEVERITY_WARNING, "%s: %llu uses of materials that no library has",
                   source->name, (unsigned long long)reader.lost_materials);
    ewa_release(build->context, reader.corners.items, reader.corners.capacity, reader.corners.item_bytes);
    ewa_mtl_free(build, &reader.materials);
    ewa_release(build->context, owned, owned_bytes, 1);
    return status == EWA_OK ? ewa_progress(build->context, "read", 1) : status;
}
