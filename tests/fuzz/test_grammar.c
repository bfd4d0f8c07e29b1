// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The edits of inputs: trees stay trees, the lengths around them fit, the same seed is the same edit, and what readers were once
// broken by is met soon.
#include "check.h"
#include "grammar.h"

#include <cjson/cJSON.h>
#include <expat.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROOM = 8192, SEEDS = 3000 };

static size_t load(const char *name, uint8_t bytes[ROOM]) {
    char path[1024];
    snprintf(path, sizeof path, "%s/tests/fuzz/corpus/%s", getenv("EWA_SOURCE_DIR"), name);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    const size_t size_bytes = fread(bytes, 1, ROOM, file);
    fclose(file);
    assert_true(size_bytes > 0 && size_bytes < ROOM);
    return size_bytes;
}

static uint32_t get_u32(const uint8_t *at) { return at[0] | at[1] << 8 | at[2] << 16 | (uint32_t)at[3] << 24; }

/// Deeper than cJSON goes is no error of the edit.
static bool is_json(uint8_t *bytes, size_t size_bytes) {
    size_t depth = 0, deepest = 0;
    for (size_t i = 0; i < size_bytes; i++) {
        depth += bytes[i] == '[' || bytes[i] == '{';
        depth -= depth && (bytes[i] == ']' || bytes[i] == '}');
        deepest = depth > deepest ? depth : deepest;
    }
    cJSON *tree = cJSON_ParseWithLength((const char *)bytes, size_bytes);
    cJSON_Delete(tree);
    return tree || deepest >= CJSON_NESTING_LIMIT;
}

static bool is_xml(const uint8_t *bytes, size_t size_bytes) {
    XML_Parser parser = XML_ParserCreate(NULL);
    const bool whole = XML_Parse(parser, (const char *)bytes, (int)size_bytes, 1) != XML_STATUS_ERROR;
    XML_ParserFree(parser);
    return whole;
}

/// Of edits that leave the length of a GLB's header as it was in relation to the bytes, most are of JSON.
TEST(glb) {
    static uint8_t original[ROOM], bytes[ROOM];
    const size_t original_bytes = load("gaussians/degree1.glb", original);
    int whole_count = 0, huge_count = 0, changed_count = 0;
    for (uint64_t seed = 0; seed < 4 * SEEDS; seed++) {
        size_t size_bytes = original_bytes;
        memcpy(bytes, original, size_bytes);
        changed_count += fuzz_grammar_edit(bytes, &size_bytes, ROOM, seed);
        if (memcmp(bytes, "glTF", 4) != 0 || get_u32(bytes + 8) != size_bytes || get_u32(bytes + 12) > size_bytes - 20) continue;
        const size_t chunk_bytes = get_u32(bytes + 12);
        if (chunk_bytes % 4 || !is_json(bytes + 20, chunk_bytes)) continue;
        whole_count++;
        // What ended every command once (issue 38): a count that nothing can hold, in a file that is whole.
        char text[ROOM];
        memcpy(text, bytes + 20, chunk_bytes);
        text[chunk_bytes] = 0;
        huge_count += strstr(text, "\"count\":4294967295") != NULL;
    }
    assert_true(changed_count > 4 * SEEDS * 9 / 10);
    assert_true(whole_count > 4 * SEEDS * 3 / 4);
    assert_true(huge_count > 0);
}

/// Three of four edits of a file leave it whole.
static void stays_whole(const char *name, bool (*is_whole)(uint8_t *bytes, size_t size_bytes)) {
    static uint8_t original[ROOM], bytes[ROOM];
    const size_t original_bytes = load(name, original);
    int whole_count = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        size_t size_bytes = original_bytes;
        memcpy(bytes, original, size_bytes);
        fuzz_grammar_edit(bytes, &size_bytes, ROOM, seed);
        whole_count += is_whole(bytes, size_bytes);
    }
    assert_true(whole_count > SEEDS * 3 / 4);
}

TEST(json) {
    stays_whole("camera/transforms", is_json);
    stays_whole("camera/open3d", is_json);
    stays_whole("scene/saved", is_json);
}

static bool is_e57(uint8_t *bytes, size_t size_bytes) {
    fuzz_input plain;
    const fuzz_input input = {.bytes = bytes, .size_bytes = size_bytes, .room_bytes = ROOM};
    if (get_u32(bytes + 16) != size_bytes || !fuzz_e57_open(&input, &plain)) return false;
    const size_t begin = get_u32(bytes + 24) / 1024 * 1020 + get_u32(bytes + 24) % 1024, length = get_u32(bytes + 32);
    const bool whole =
        begin <= plain.size_bytes && length <= plain.size_bytes - begin && is_xml(plain.bytes + begin, length);
    free(plain.bytes);
    return whole;
}

TEST(e57) { stays_whole("e57/scans.e57", is_e57); }

/// Whether the directory of an archive whose meta.json is stored leads to it, however long it became.
static bool is_zip(uint8_t *bytes, size_t size_bytes) {
    const uint8_t *last = bytes + size_bytes - 22;
    if (memcmp(last, "PK\5\6", 4) != 0 || get_u32(last + 16) > size_bytes - 46) return false;
    size_t at = get_u32(last + 16);
    for (int entry = 0; entry < last[10]; entry++) {
        if (at + 46 >= size_bytes || memcmp(bytes + at, "PK\1\2", 4) != 0) return false;
        const size_t local = get_u32(bytes + at + 42), length = get_u32(bytes + at + 20);
        if (local + 30 >= size_bytes || memcmp(bytes + local, "PK\3\4", 4) != 0) return false;
        if (length >= size_bytes - local) return false;
        if (memcmp(bytes + at + 46, "meta.json", 9) == 0 &&
            !is_json(bytes + local + 30 + bytes[local + 26] + bytes[local + 28], length))
            return false;
        at += 46u + bytes[at + 28] + bytes[at + 30] + bytes[at + 32];
    }
    return true;
}

TEST(zip) { stays_whole("gaussians/sog_stored", is_zip); }

/// Every kind of file: the same seed is the same edit, and no byte beyond the room is touched.
TEST(bounds) {
    static uint8_t original[ROOM];
    static const char *const names[] = {"gaussians/degree1.glb", "gaussians/sog", "e57/short.e57",     "ept/parts",
                                        "las/format_6.laz",      "ply/ascii",     "camera/colmap_text", "camera/colmap_binary",
                                        "volume/a.nrrd",       "image/head.png"};
    for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
        const size_t original_bytes = load(names[n], original);
        for (uint64_t seed = 0; seed < SEEDS / 3; seed++) {
            const size_t room_bytes = original_bytes + seed % 64;
            uint8_t *once = malloc(room_bytes), *twice = malloc(room_bytes);
            size_t once_bytes = original_bytes, twice_bytes = original_bytes;
            memcpy(once, original, original_bytes);
            memcpy(twice, original, original_bytes);
            assert_int_equal(fuzz_grammar_edit(once, &once_bytes, room_bytes, seed),
                             fuzz_grammar_edit(twice, &twice_bytes, room_bytes, seed));
            assert_true(once_bytes <= room_bytes && once_bytes == twice_bytes && memcmp(once, twice, once_bytes) == 0);
            free(once);
            free(twice);
        }
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
