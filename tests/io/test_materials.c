// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/io/mesh/materials.c.
#include "ewa/io.h"
#include "io/mesh/materials.h"
#include "scratch.h"

static ewa_status read_text(ewa_context *context, const char *text, ewa_material *materials,
                            uint32_t *count) {
    return ewa_materials_read(context, "m.json", (const uint8_t *)text, strlen(text), materials, count);
}

TEST_ON(test_known_table, 1) {
    ewa_material materials[EWA_MAX_MATERIALS], initial;
    ewa_material_init(&initial);
    uint32_t count;
    static const char *const texts[] = {
        "[{\"specular\": 0.5, \"name\": \"x\"}, {}, {\"ambient\": 0, \"diffuse\": 2, \"shininess\": 100, "
        "\"reflection\": 0.75}]",
        "{\"materials\": [{\"specular\": 0.5}, {\"name\": 7}, {\"ambient\": 0, \"diffuse\": 2, "
        "\"shininess\": 100, \"reflection\": 0.75}], \"version\": 1}\n"};
    char path[512];
    for (int i = 0; i < 4; i++) {
        if (i < 2) {
            assert_int_equal(read_text(context, texts[i], materials, &count), EWA_OK);
        } else {
            scratch_write(scratch_path("materials.json", path), texts[i - 2], strlen(texts[i - 2]));
            assert_int_equal(ewa_materials_load(context, path, materials, &count), EWA_OK);
        }
        assert_int_equal(count, 3);
        assert_true(materials[0].specular == 0.5f && materials[0].diffuse == initial.diffuse &&
                    materials[0].shininess == initial.shininess);
        assert_memory_equal(&materials[1], &initial, sizeof initial);
        assert_true(materials[2].ambient == 0 && materials[2].diffuse == 2 && materials[2].shininess == 100 &&
                    materials[2].reflection == 0.75f && materials[2].specular == initial.specular);
    }
    assert_int_equal(ewa_materials_load(context, "/nowhere/m.json", materials, &count), EWA_ERROR_IO);
    assert_int_equal(count, 0);
}

TEST(test_broken_tables) {
    static const struct {
        const char *text, *words;
    } tables[] = {
        {"", "m.json:1:1: not JSON"},
        {"[{}", "m.json:1:"},
        {"[{}] x", "m.json:1:6: not JSON"},
        {"[]", "array of materials"},
        {"{}", "array of materials"},
        {"7", "array of materials"},
        {"{\"materials\": {}}", "array of materials"},
        {"[{}, 3]", "material 1 is not an object"},
        {"[{\"shiny\": 3}]", "material 0 has an unknown member 'shiny'"},
        {"[{\"diffuse\": \"3\"}]", "diffuse of material 0 is not a number"},
        {"[{}, {\"diffuse\": -1}]", "diffuse of material 1 is -1, allowed is [0, 1000]"},
        {"[{\"shininess\": 0}]", "shininess of material 0 is 0, allowed is [1, 65536]"},
        {"[{\"ambient\": 1e999}]", "ambient of material 0"},
    };
    check_log log = {0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    ewa_material materials[EWA_MAX_MATERIALS];
    for (size_t i = 0; i < sizeof tables / sizeof tables[0]; i++) {
        uint32_t count = 9;
        assert_int_equal(read_text(context, tables[i].text, materials, &count), EWA_ERROR_FORMAT);
        if (!strstr(log.text, tables[i].words)) fail_msg("'%s' does not say '%s'", log.text, tables[i].words);
        assert_int_equal(count, 0);
    }
}

TEST_ON(test_as_many_as_indices, 1) {
    ewa_material materials[EWA_MAX_MATERIALS];
    for (uint32_t wanted = EWA_MAX_MATERIALS; wanted <= EWA_MAX_MATERIALS + 1; wanted++) {
        char text[4 * EWA_MAX_MATERIALS] = "[{}";
        for (uint32_t i = 1; i < wanted; i++) strcat(text, ",{}");
        strcat(text, "]");
        uint32_t count;
        const bool fits = wanted == EWA_MAX_MATERIALS;
        assert_int_equal(read_text(context, text, materials, &count), fits ? EWA_OK : EWA_ERROR_LIMIT);
        assert_int_equal(count, fits ? wanted : 0);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
