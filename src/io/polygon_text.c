// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Outlines from text: corners, WKT, GeoJSON.
// Based on: OGC 06-103r4, "Simple feature access - Part 1", 2011, section 7 (WKT).
#include "ewa/select.h"
#include "io/file.h"
#include "io/number.h"
#include "io/polygon.h"

enum { MAX_TEXT_BYTES = 1 << 26 };

static ewa_status fail_line(const ewa_rings *rings, const ewa_cursor *cursor, const char *what) {
    return ewa_fail(rings->context, EWA_ERROR_FORMAT, "%s: line %llu: %s", rings->name,
                    (unsigned long long)cursor->line, what);
}

/// Steps over blanks and line ends.
static void skip_space(ewa_cursor *cursor) {
    while (cursor->at < cursor->end)
        if (ewa_is_line_end(*cursor->at))
            ewa_cursor_step_line(cursor);
        else if (ewa_is_blank(*cursor->at))
            cursor->at++;
        else
            break;
}

static bool take(ewa_cursor *cursor, char sign) {
    skip_space(cursor);
    if (cursor->at == cursor->end || *cursor->at != sign) return false;
    cursor->at++;
    return true;
}

/// Takes a word of letters; none (length 0) where there is no letter.
static ewa_text take_letters(ewa_cursor *cursor) {
    skip_space(cursor);
    const char *start = cursor->at;
    while (cursor->at < cursor->end && ((*cursor->at | 32) >= 'a' && (*cursor->at | 32) <= 'z')) cursor->at++;
    return (ewa_text){start, (size_t)(cursor->at - start)};
}

/// Reads "x y [z [m]]" of WKT.
static ewa_status read_position(ewa_rings *rings, ewa_cursor *cursor) {
    double numbers[4];
    uint32_t count = 0;
    for (;; count++) {
        skip_space(cursor);
        double number;
        const char *next = ewa_number_read_f64(cursor->at, cursor->end, &number);
        if (!next) break;
        if (count == 4) return fail_line(rings, cursor, "more than four numbers in a place of WKT");
        numbers[count] = number;
        cursor->at = next;
    }
    if (count < 2) return fail_line(rings, cursor, "two numbers of a corner wanted");
    return ewa_rings_add(rings, numbers[0], numbers[1]);
}

/// Reads "(...)": corners of a ring at depth 1, else groups one level lower.
static ewa_status read_group(ewa_rings *rings, ewa_cursor *cursor, int depth) {
    if (!take(cursor, '(')) return fail_line(rings, cursor, "'(' of WKT wanted");
    do {
        EWA_TRY(depth == 1 ? read_position(rings, cursor) : read_group(rings, cursor, depth - 1));
    } while (take(cursor, ','));
    if (!take(cursor, ')')) return fail_line(rings, cursor, "',' or ')' of WKT wanted");
    return depth == 1 ? ewa_rings_close(rings) : EWA_OK;
}

/// Reads one POLYGON or MULTIPOLYGON, with the dimensions of its places behind its name or without.
static ewa_status read_wkt(ewa_rings *rings, ewa_cursor *cursor) {
    ewa_text word = take_letters(cursor);
    if (ewa_text_is_any_case(word, "SRID")) {
        while (cursor->at < cursor->end && *cursor->at != ';') cursor->at++;
        if (!take(cursor, ';')) return fail_line(rings, cursor, "';' behind SRID wanted");
        word = take_letters(cursor);
    }
    static const char *const names[] = {"POLYGON", "MULTIPOLYGON"}, *const dimensions[] = {"Z", "M", "ZM"};
    int depth = 0;
    for (int k = 0; k < 2; k++)
        if (ewa_text_is_any_case(word, names[k])) depth = 2 + k;
    if (!depth) return fail_line(rings, cursor, "POLYGON or MULTIPOLYGON of WKT wanted");
    word = take_letters(cursor);
    for (int k = 0; k < 3; k++)
        if (ewa_text_is_any_case(word, dimensions[k])) word = take_letters(cursor);
    if (ewa_text_is_any_case(word, "EMPTY")) return EWA_OK;
    if (word.length) return fail_line(rings, cursor, "'(' of WKT wanted");
    return read_group(rings, cursor, depth);
}

/// Reads corners "x y" or "x,y" that lines or semicolons part; a piece without numbers ends a ring.
static ewa_status read_corners(ewa_rings *rings, ewa_cursor *cursor) {
    while (cursor->at < cursor->end) {
        double numbers[2];
        uint32_t count = 0;
        for (; cursor->at < cursor->end && !ewa_is_line_end(*cursor->at) && *cursor->at != ';';) {
            if (*cursor->at == '#' || (*cursor->at == '>' && count == 0)) {
                while (cursor->at < cursor->end && !ewa_is_line_end(*cursor->at)) cursor->at++;
            } else if (ewa_is_blank(*cursor->at) || *cursor->at == ',') {
                cursor->at++;
            } else {
                double number;
                const char *next = ewa_number_read_f64(cursor->at, cursor->end, &number);
                if (!next) return fail_line(rings, cursor, "what is no number");
                if (count < 2) numbers[count] = number;
                count++;
                cursor->at = next;
            }
        }
        if (count == 1) return fail_line(rings, cursor, "two numbers of a corner wanted");
        EWA_TRY(count ? ewa_rings_add(rings, numbers[0], numbers[1]) : ewa_rings_close(rings));
        if (cursor->at < cursor->end && *cursor->at == ';')
            cursor->at++;
        else
            ewa_cursor_step_line(cursor);
    }
    return ewa_rings_close(rings);
}

static ewa_status read_text(ewa_rings *rings, ewa_cursor *cursor) {
    skip_space(cursor);
    const char first = cursor->at < cursor->end ? *cursor->at : 0;
    if (first == '{')
        return ewa_rings_read_json(rings, (ewa_text){cursor->at, (size_t)(cursor->end - cursor->at)});
    if (!((first | 32) >= 'a' && (first | 32) <= 'z')) return read_corners(rings, cursor);
    ewa_status status = EWA_OK;
    for (; status == EWA_OK && cursor->at < cursor->end; skip_space(cursor)) status = read_wkt(rings, cursor);
    return status;
}

ewa_status ewa_polygon_read(ewa_context *context, const char *name, const void *text, size_t size_bytes,
                            ewa_polygon **polygon) {
    if (!polygon) return EWA_ERROR_ARGUMENT;
    *polygon = NULL;
    if (!context || !name || (size_bytes && !text)) return EWA_ERROR_ARGUMENT;
    if (size_bytes > MAX_TEXT_BYTES)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%s: %zu bytes, more than an outline may have (%d)", name,
                        size_bytes, MAX_TEXT_BYTES);
    ewa_cursor cursor;
    char *owned = NULL;
    size_t owned_bytes = 0;
    EWA_TRY(ewa_text_open(context, name, text, size_bytes, &cursor, &owned, &owned_bytes));
    ewa_rings rings = {.context = context, .name = name};
    ewa_status status = read_text(&rings, &cursor);
    if (status == EWA_OK && rings.ring_count == 0)
        status = ewa_fail(context, EWA_ERROR_FORMAT, "%s: there is no polygon", name);
    if (status == EWA_OK)
        status =
            ewa_polygon_create(context, rings.corners.data, rings.counts.data, rings.ring_count, polygon);
    ewa_buffer_free(context, &rings.corners);
    ewa_buffer_free(context, &rings.counts);
    ewa_release(context, owned, owned_bytes, 1);
    return status;
}

ewa_status ewa_polygon_load(ewa_context *context, const char *path, ewa_polygon **polygon) {
    if (!polygon) return EWA_ERROR_ARGUMENT;
    *polygon = NULL;
    if (!context || !path) return EWA_ERROR_ARGUMENT;
    ewa_file file;
    EWA_TRY(ewa_file_map(context, path, &file));
    ewa_status status = ewa_polygon_read(context, path, file.bytes, file.size_bytes, polygon);
    ewa_file_unmap(context, &file);
    return status;
}
