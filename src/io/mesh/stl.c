// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// STL, binary and ascii: triangles one by one, with the colours that two programs put into binary ones.
//
// Based on: 3D Systems Inc., "StereoLithography interface specification", 1989; the colours as Materialise
// Magics ("COLOR=" in the header) and VisCAM (a bit per triangle) write them.
#include "base/base.h"
#include "image/srgb.h"
#include "io/mesh/formats.h"
#include "io/reader.h"

enum { HEADER_BYTES = 80, RECORD_BYTES = 50, TEXT_BYTES = 1024 };

static double read_float(const uint8_t *bytes) {
    const uint32_t bits = ewa_bytes_u32(bytes);
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

/// Adds a triangle of the last three places.
static ewa_status add_last(ewa_mesh_build *build) {
    const uint32_t end = (uint32_t)build->positions.count;
    const ewa_mesh_corner corners[3] = {{end - 3, EWA_MESH_NONE, EWA_MESH_NONE},
                                        {end - 2, EWA_MESH_NONE, EWA_MESH_NONE},
                                        {end - 1, EWA_MESH_NONE, EWA_MESH_NONE}};
    return ewa_mesh_add_polygon(build, corners, 3);
}

/// How colours are stored, which the header or the first coloured triangle tells.
typedef struct stl_colors {
    bool magics, viscam;
    bool own;        ///< of Magics: some triangle's code is not zero, which programs that know none leave
    float common[4]; ///< of triangles without one of their own
} stl_colors;

static float linear_of_5_bits(uint32_t code) { return (float)ewa_srgb_decode((code & 31) / 31.0); }

static stl_colors find_colors(const uint8_t *bytes, uint64_t count) {
    stl_colors colors = {.common = {1, 1, 1, 1}};
    for (uint32_t i = 0; i + 10 <= HEADER_BYTES && !colors.magics; i++) {
        if (memcmp(bytes + i, "COLOR=", 6) != 0) continue;
        colors.magics = true;
        for (uint32_t c = 0; c < 3; c++) colors.common[c] = ewa_srgb_decoded[bytes[i + 6 + c]];
    }
    const uint8_t *record = bytes + HEADER_BYTES + 4;
    for (uint64_t t = 0; t < count && colors.magics && !colors.own; t++)
        colors.own = record[t * RECORD_BYTES + 48] || record[t * RECORD_BYTES + 49];
    for (uint64_t t = 0; t < count && !colors.magics && !colors.viscam; t++)
        colors.viscam = record[t * RECORD_BYTES + 49] & 0x80;
    return colors;
}

static void set_color(ewa_mesh_build *build, const stl_colors *colors, uint32_t code) {
    build->has_face_color = colors->magics || colors->viscam;
    const bool own = colors->magics ? colors->own && !(code & 0x8000) : (code & 0x8000) != 0;
    memcpy(build->face_color, colors->common, sizeof build->face_color);
    // The two count the components from opposite ends.
    for (uint32_t c = 0; c < 3 && own; c++)
        build->face_color[c] = linear_of_5_bits(code >> 5 * (colors->magics ? c : 2 - c));
}

static ewa_status read_binary(ewa_mesh_build *build) {
    const ewa_mesh_source *source = build->source;
    if (source->size_bytes < HEADER_BYTES + 4)
        return ewa_fail(build->context, EWA_ERROR_FORMAT, "%s: %zu bytes; the header of a binary STL has %d",
                        source->name, source->size_bytes, HEADER_BYTES + 4);
    const uint64_t count = ewa_bytes_u32(source->bytes + HEADER_BYTES),
                   there = (source->size_bytes - HEADER_BYTES - 4) / RECORD_BYTES;
    if (count > there)
        return ewa_fail(build->context, EWA_ERROR_FORMAT, "%s: the file ends in triangle %llu of %llu",
                        source->name, (unsigned long long)there, (unsigned long long)count);
    const stl_colors colors = find_colors(source->bytes, count);
    build->float_positions = true;
    ewa_status status = ewa_mesh_list_grow(build, &build->positions, 3 * count);
    if (status == EWA_OK) status = ewa_mesh_list_grow(build, &build->corners, count);
    for (uint64_t t = 0; t < count && status == EWA_OK; t++) {
        const uint8_t *record = source->bytes + HEADER_BYTES + 4 + t * RECORD_BYTES;
        for (uint32_t v = 0; v < 3 && status == EWA_OK; v++) {
            double place[3];
            for (uint32_t c = 0; c < 3; c++) place[c] = read_float(record + 12 * (v + 1) + 4 * c);
            status = ewa_mesh_add_position(build, place);
        }
        set_color(build, &colors, (uint32_t)record[48] | (uint32_t)record[49] << 8);
        if (status == EWA_OK) status = add_last(build);
    }
    build->has_face_color = false;
    return status;
}

/// Takes the next word of any line; none at the end.
static ewa_text take_word(ewa_cursor *cursor) {
    for (;;) {
        const ewa_text word = ewa_cursor_word(cursor);
        if (word.length || cursor->at == cursor->end) return word;
        ewa_cursor_next_line(cursor);
    }
}

static ewa_status fail_ascii(const ewa_mesh_build *build, const ewa_cursor *cursor, const char *what,
                             ewa_text word) {
    char quote[EWA_QUOTE_BYTES];
    return ewa_fail(build->context, EWA_ERROR_FORMAT, "%s: line %llu: %s, not %s", build->source->name,
                    (unsigned long long)cursor->line, what, word.length ? ewa_quote(word, quote) : "the end");
}

/// Reads the words from behind "facet" to "endfacet": places become a polygon, normals are left.
static ewa_status read_facet(ewa_mesh_build *build, ewa_cursor *cursor, ewa_mesh_list *corners) {
    ewa_status status = EWA_OK;
    corners->count = 0;
    for (;;) {
        const ewa_text word = take_word(cursor);
        if (ewa_text_is_any_case(word, "endfacet")) break;
        double place[3];
        if (ewa_text_is_any_case(word, "normal")) {
            for (int c = 0; c < 3; c++) take_word(cursor);
            continue;
        }
        if (ewa_text_is_any_case(word, "outer") || ewa_text_is_any_case(word, "loop") ||
            ewa_text_is_any_case(word, "endloop"))
            continue;
        if (!ewa_text_is_any_case(word, "vertex"))
            return fail_ascii(build, cursor, "'vertex' or 'endfacet' is wanted", word);
        const uint64_t line = cursor->line;
        for (int c = 0; c < 3; c++)
            if (!ewa_text_number(take_word(cursor), &place[c])) ewa_mesh_note_unread(build, line);
        ewa_mesh_corner *corner = ewa_mesh_list_add(build, corners, &status);
        if (corner) {
            *corner = (ewa_mesh_corner){(uint32_t)build->positions.count, EWA_MESH_NONE, EWA_MESH_NONE};
            status = ewa_mesh_add_position(build, place);
        }
        EWA_TRY(status);
    }
    return ewa_mesh_add_polygon(build, corners->items, corners->count);
}

static ewa_status read_ascii(ewa_mesh_build *build, ewa_cursor cursor, ewa_mesh_list *corners) {
    bool inside = false;
    while (true) {
        const ewa_text word = take_word(&cursor);
        if (!word.length) {
            if (inside) return fail_ascii(build, &cursor, "'endsolid' is wanted", word);
            break;
        }
        if (ewa_text_is_any_case(word, "solid") || ewa_text_is_any_case(word, "endsolid")) {
            inside = ewa_text_is_any_case(word, "solid");
            ewa_cursor_next_line(&cursor); // the rest is a name
        } else if (ewa_text_is_any_case(word, "facet")) {
            EWA_TRY(read_facet(build, &cursor, corners));
        } else {
            return fail_ascii(build, &cursor, "'facet', 'solid' or 'endsolid' is wanted", word);
        }
    }
    return EWA_OK;
}

ewa_status ewa_mesh_read_stl(ewa_mesh_build *build) {
    const ewa_mesh_source *source = build->source;
    const bool exact =
        source->size_bytes >= HEADER_BYTES + 4 &&
        (source->size_bytes - HEADER_BYTES - 4) / RECORD_BYTES == ewa_bytes_u32(source->bytes + HEADER_BYTES) &&
        (source->size_bytes - HEADER_BYTES - 4) % RECORD_BYTES == 0;
    ewa_cursor cursor;
    char *owned;
    size_t owned_bytes;
    EWA_TRY(ewa_text_open(build->context, source->name, source->bytes, source->size_bytes, &cursor, &owned,
                          &owned_bytes));
    // Some binary ones begin with "solid" too; then the size tells, or a byte that no text has.
    ewa_cursor peek = cursor;
    const size_t looked = source->size_bytes < TEXT_BYTES ? source->size_bytes : TEXT_BYTES;
    ewa_status status = EWA_OK;
    if (exact || !ewa_text_is_any_case(take_word(&peek), "solid") ||
        (!owned && memchr(source->bytes, 0, looked))) {
        status = read_binary(build);
    } else {
        ewa_mesh_list corners = {.item_bytes = sizeof(ewa_mesh_corner)};
        status = read_ascii(build, cursor, &corners);
        ewa_release(build->context, corners.items, corners.capacity, corners.item_bytes);
    }
    ewa_release(build->context, owned, owned_bytes, 1);
    return status;
}
