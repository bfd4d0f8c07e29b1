// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which format a file of points or triangles has: by what it begins with, and by the suffix only where bytes
// of two formats look alike.
#include "io/foreign.h"
#include "io/mesh/formats.h"
#include "io/number.h"
#include "io/reader.h"

#include <strings.h>

enum { LOOKED_BYTES = 1 << 16, LOOKED_LETTERS = 1 << 11, STL_HEAD_BYTES = 84, STL_RECORD_BYTES = 50 };

const char *ewa_model_format_name(ewa_model_format format) {
    static const char *const names[] = {"unknown", "PLY", "OBJ", "STL", "OFF", "glTF",
                                        "LAS",     "E57", "PCD", "PTX", "text", "ASCII grid", "GeoTIFF", "terrain picture", "VTK"};
    return (unsigned)format < sizeof names / sizeof names[0] ? names[format] : names[0];
}

static bool has_suffix(const char *name, const char *suffix) {
    const size_t length = strlen(name), suffix_length = strlen(suffix);
    return length > suffix_length && strcasecmp(name + length - suffix_length, suffix) == 0;
}

/// The first word that is no remark.
static ewa_text first_word(ewa_cursor cursor) {
    ewa_text word = ewa_cursor_word(&cursor);
    for (; !word.length && cursor.at < cursor.end; word = ewa_cursor_word(&cursor))
        ewa_cursor_next_line(&cursor);
    return word;
}

static bool is_off(ewa_text word) {
    static const char *const letters[] = {"ST", "C", "N", "4", "n"};
    for (size_t i = 0; i < sizeof letters / sizeof letters[0]; i++) {
        const size_t length = strlen(letters[i]);
        if (word.length < length || memcmp(word.chars, letters[i], length) != 0) continue;
        word.chars += length;
        word.length -= length;
    }
    return word.length >= 3 && memcmp(word.chars, "OFF", 3) == 0 &&
           (word.length == 3 || (word.chars[3] >= '0' && word.chars[3] <= '9'));
}

/// Whether the first line with something on it is a statement of OBJ, followed by what belongs there.
static bool is_obj(ewa_cursor cursor) {
    static const char *const with_numbers[] = {"v", "vt", "vn", "vp", "f", "l", "p", "s"};
    static const char *const with_names[] = {"mtllib", "usemtl", "o", "g"};
    for (; cursor.at < cursor.end; ewa_cursor_next_line(&cursor)) {
        const ewa_text word = ewa_cursor_word(&cursor);
        if (!word.length) continue;
        for (size_t i = 0; i < sizeof with_names / sizeof with_names[0]; i++)
            if (ewa_text_is(word, with_names[i])) return true;
        for (size_t i = 0; i < sizeof with_numbers / sizeof with_numbers[0]; i++) {
            if (!ewa_text_is(word, with_numbers[i])) continue;
            const ewa_text next = ewa_cursor_word(&cursor);
            double number;
            return next.length && (ewa_number_read_f64(next.chars, next.chars + next.length, &number) ||
                                   ewa_text_is(word, "s"));
        }
        return false;
    }
    return false;
}

static bool is_binary_stl(const uint8_t *bytes, size_t size_bytes) {
    return size_bytes > STL_HEAD_BYTES && (size_bytes - STL_HEAD_BYTES) % STL_RECORD_BYTES == 0 &&
           (size_bytes - STL_HEAD_BYTES) / STL_RECORD_BYTES == ewa_bytes_u32(bytes + 80);
}

/// Whether a text is JSON with a member "asset" or "meshes", as glTF has.
static bool is_gltf(ewa_cursor cursor) {
    while (cursor.at < cursor.end && (ewa_is_blank(*cursor.at) || ewa_is_line_end(*cursor.at))) cursor.at++;
    if (cursor.at == cursor.end || *cursor.at != '{') return false;
    for (const char *at = cursor.at; (at = memchr(at, '"', (size_t)(cursor.end - at))); at++) {
        if (cursor.end - at >= 7 && memcmp(at, "\"asset\"", 7) == 0) return true;
        if (cursor.end - at >= 8 && memcmp(at, "\"meshes\"", 8) == 0) return true;
    }
    return false;
}

/// Letters of UTF-16 behind its mark, those that are no ASCII as '?'; returns how many.
static size_t narrow(const uint8_t *bytes, size_t size_bytes, size_t room, char *letters) {
    const size_t high = bytes[0] == 0xfe ? 0 : 1;
    size_t count = 0;
    for (size_t i = 2; i + 2 <= size_bytes && count < room; i += 2)
        letters[count++] = bytes[i + high] || bytes[i + 1 - high] > '~' ? '?' : (char)bytes[i + 1 - high];
    return count;
}

ewa_model_format ewa_mesh_probe(const char *name, const uint8_t *bytes, size_t size_bytes) {
    if (ewa_bytes_begin(bytes, size_bytes, "ply")) return EWA_MODEL_PLY;
    if (size_bytes >= 4 && memcmp(bytes, "glTF", 4) == 0) return EWA_MODEL_GLTF;
    const uint32_t mark = ewa_bytes_mark(bytes, size_bytes);
    const uint8_t *marked = mark ? bytes + mark : bytes; // there may be no bytes
    if (ewa_mesh_is_vtk(marked, size_bytes - mark) || ewa_mesh_is_vtk_xml(marked, size_bytes - mark) ||
        ewa_mesh_is_vtk_list(marked, size_bytes - mark))
        return EWA_MODEL_VTK;
    if (is_binary_stl(bytes, size_bytes)) return EWA_MODEL_STL;
    const char *text = size_bytes ? (const char *)bytes : "";
    char letters[LOOKED_LETTERS];
    ewa_cursor cursor = {text, text + size_bytes, 1};
    cursor.at += mark;
    if (size_bytes >= 2 && (memcmp(text, "\xfe\xff", 2) == 0 || memcmp(text, "\xff\xfe", 2) == 0))
        cursor = (ewa_cursor){letters, letters + narrow(bytes, size_bytes, sizeof letters, letters), 1};
    if (is_gltf(cursor)) return EWA_MODEL_GLTF;
    if (cursor.end - cursor.at > LOOKED_BYTES) cursor.end = cursor.at + LOOKED_BYTES;
    const ewa_text word = first_word(cursor);
    if (ewa_text_is_any_case(word, "solid")) return EWA_MODEL_STL;
    if (is_off(word)) return EWA_MODEL_OFF;
    if (is_obj(cursor)) return EWA_MODEL_OBJ;
    if (ewa_foreign_kind(bytes, size_bytes)) return EWA_MODEL_UNKNOWN;
    // Remarks only, numbers without a head, sizes that do not fit: the name knows.
    static const struct {
        const char *suffix;
        ewa_model_format format;
    } suffixes[] = {{".obj", EWA_MODEL_OBJ},   {".stl", EWA_MODEL_STL},  {".off", EWA_MODEL_OFF},
                    {".gltf", EWA_MODEL_GLTF}, {".glb", EWA_MODEL_GLTF}, {".ply", EWA_MODEL_PLY}};
    for (size_t i = 0; i < sizeof suffixes / sizeof suffixes[0]; i++)
        if (has_suffix(name, suffixes[i].suffix)) return suffixes[i].format;
    return EWA_MODEL_UNKNOWN;
}
