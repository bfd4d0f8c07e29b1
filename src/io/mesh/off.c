// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// OFF in text, with texture coordinates, colours, normals and a fourth coordinate as the letters before OFF
// say.
//
// Based on: S. Levy, T. Munzner, M. Phillips, "Geomview manual: OFF files", The Geometry Center, 1996.
#include "base/base.h"
#include "image/srgb.h"
#include "io/mesh/formats.h"

#include <math.h>

typedef struct off_reader {
    ewa_mesh_build *build;
    ewa_cursor cursor;
    bool texcoords, colors, normals, homogeneous;
    ewa_mesh_list corners;
} off_reader;

static ewa_status fail_line(const off_reader *reader, const char *what) {
    return ewa_fail(reader->build->context, EWA_ERROR_FORMAT, "%s: line %llu: %s",
                    reader->build->source->name, (unsigned long long)reader->cursor.line, what);
}

/// Steps to the next line with something on it; false at the end.
static bool find_line(off_reader *reader) {
    ewa_cursor *cursor = &reader->cursor;
    for (;;) {
        ewa_cursor_skip_blanks(cursor);
        if (cursor->at == cursor->end) return false;
        if (!ewa_is_line_end(*cursor->at) && *cursor->at != '#') return true;
        ewa_cursor_next_line(cursor);
    }
}

/// Takes numbers across lines; false when the text ends or something else stands there.
static bool take_numbers(off_reader *reader, uint32_t count, double *values) {
    for (uint32_t got = 0; got < count;) {
        const uint32_t more =
            find_line(reader) ? ewa_cursor_numbers(&reader->cursor, count - got, values + got) : 0;
        if (!more) return false;
        got += more;
    }
    return true;
}

/// Takes what the letters before OFF say; the word may have the first count right behind it.
static ewa_status read_keyword(off_reader *reader) {
    if (!find_line(reader)) return fail_line(reader, "the file is empty");
    ewa_cursor *cursor = &reader->cursor;
    const ewa_cursor before = *cursor;
    const ewa_text word = ewa_cursor_word(cursor);
    size_t at = 0;
    const char *c = word.chars;
    if (word.length - at >= 2 && c[at] == 'S' && c[at + 1] == 'T') reader->texcoords = true, at += 2;
    if (word.length > at && c[at] == 'C') reader->colors = true, at++;
    if (word.length > at && c[at] == 'N') reader->normals = true, at++;
    if (word.length > at && c[at] == '4') reader->homogeneous = true, at++;
    const bool other_dimension = word.length > at && c[at] == 'n';
    if (word.length < at + 3 + other_dimension || memcmp(c + at + other_dimension, "OFF", 3) != 0) {
        *cursor = before; // the word may be left out
        reader->texcoords = reader->colors = reader->normals = reader->homogeneous = false;
        return EWA_OK;
    }
    if (other_dimension)
        return ewa_fail(reader->build->context, EWA_ERROR_UNSUPPORTED,
                        "%s: OFF of another dimension than 3 (nOFF) is not read",
                        reader->build->source->name);
    cursor->at = c + at + 3;
    const ewa_cursor behind = *cursor;
    const ewa_text next = ewa_cursor_word(cursor);
    if (ewa_text_is(next, "BINARY"))
        return ewa_fail(reader->build->context, EWA_ERROR_UNSUPPORTED,
                        "%s: binary OFF is not read; ascii OFF is", reader->build->source->name);
    *cursor = behind;
    return EWA_OK;
}

/// Colours are shares or codes up to 255, sRGB both; true when there was one.
static bool color_of(const double *values, uint32_t count, float color[4]) {
    if (count != 3 && count != 4) return false;
    bool codes = false;
    for (uint32_t c = 0; c < count; c++) {
        if (!(values[c] >= 0)) return false;
        codes = codes || values[c] > 1;
    }
    const double scale = codes ? 1.0 / 255 : 1;
    for (uint32_t c = 0; c < 3; c++) color[c] = (float)ewa_srgb_decode(fmin(values[c] * scale, 1));
    color[3] = count == 4 ? (float)fmin(values[3] * scale, 1) : 1;
    return true;
}

static ewa_status read_vertex(off_reader *reader) {
    ewa_mesh_build *build = reader->build;
    static const float white[4] = {1, 1, 1, 1};
    double place[4], normal[3] = {0, 0, 0}, rest[6];
    if (!take_numbers(reader, reader->homogeneous ? 4 : 3, place) ||
        (reader->normals && !take_numbers(reader, 3, normal)))
        return fail_line(reader, "the numbers of a vertex are wanted");
    for (int c = 0; c < 3 && reader->homogeneous; c++) place[c] /= place[3];
    // Files differ in how many numbers a colour has: it is what is left on the line.
    const uint32_t count = ewa_cursor_numbers(&reader->cursor, 6, rest), behind = reader->texcoords ? 2 : 0;
    if (count < behind) return fail_line(reader, "texture coordinates are wanted");
    ewa_status status = ewa_mesh_add_position(build, place);
    if (status == EWA_OK && reader->normals) status = ewa_mesh_add_normal(build, normal);
    if (status == EWA_OK && behind) status = ewa_mesh_add_texcoord(build, rest[count - 2], rest[count - 1]);
    float color[4];
    if (status == EWA_OK && color_of(rest, count - behind, color))
        status = ewa_mesh_add_color(build, white, color);
    ewa_cursor_next_line(&reader->cursor);
    return status;
}

static ewa_status read_face(off_reader *reader) {
    ewa_mesh_build *build = reader->build;
    ewa_status status = EWA_OK;
    double count, number, rest[4];
    if (!take_numbers(reader, 1, &count) || !(count >= 0 && count < 1e9) || count != floor(count))
        return fail_line(reader, "the number of a face's corners is wanted");
    reader->corners.count = 0;
    for (uint64_t i = 0; i < (uint64_t)count; i++) {
        if (!take_numbers(reader, 1, &number)) return fail_line(reader, "the number of a vertex is wanted");
        const uint32_t vertex =
            number >= 0 && number < (double)EWA_MESH_NONE ? (uint32_t)number : EWA_MESH_NONE;
        ewa_mesh_corner *corner = ewa_mesh_list_add(build, &reader->corners, &status);
        if (!corner) return status;
        *corner = (ewa_mesh_corner){vertex, reader->texcoords ? vertex : EWA_MESH_NONE,
                                    reader->normals ? vertex : EWA_MESH_NONE};
    }
    // One number behind the corners is an index into a table of colours that is not in the file.
    build->has_face_color = !build->colors.count &&
                            color_of(rest, ewa_cursor_numbers(&reader->cursor, 4, rest), build->face_color);
    ewa_cursor_next_line(&reader->cursor);
    return ewa_mesh_add_polygon(build, reader->corners.items, reader->corners.count);
}

static ewa_status read_body(off_reader *reader) {
    ewa_mesh_build *build = reader->build;
    double counts[2], edges;
    EWA_TRY(read_keyword(reader));
    if (!take_numbers(reader, 2, counts) || !(counts[0] >= 0 && counts[1] >= 0))
        return fail_line(reader, "the numbers of vertices and faces are wanted");
    ewa_cursor_numbers(&reader->cursor, 1, &edges); // of edges, which is often wrong
    ewa_cursor_next_line(&reader->cursor);
    ewa_status status = EWA_OK;
    for (double i = 0; i < counts[0] && status == EWA_OK; i++) status = read_vertex(reader);
    for (double i = 0; i < counts[1] && status == EWA_OK; i++) status = read_face(reader);
    build->has_face_color = false;
    return status;
}

ewa_status ewa_mesh_read_off(ewa_mesh_build *build) {
    const ewa_mesh_source *source = build->source;
    off_reader reader = {.build = build, .corners = {.item_bytes = sizeof(ewa_mesh_corner)}};
    char *owned;
    size_t owned_bytes;
    ewa_status status = ewa_text_open(build->context, source->name, source->bytes, source->size_bytes,
                                      &reader.cursor, &owned, &owned_bytes);
    if (status == EWA_OK) status = read_body(&reader);
    ewa_release(build->context, reader.corners.items, reader.corners.capacity, reader.corners.item_bytes);
    ewa_release(build->context, owned, owned_bytes, 1);
    return status;
}
