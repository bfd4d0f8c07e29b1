// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Meshes of the data set, which others' programs have written, and broken ones. Only where that is there:
// what is read of each format, and what is refused, is held by files that the other tests make.
#include "io/mesh_fixture.h"

CASE(test_ply) {
    static const struct {
        const char *path;
        uint32_t triangles;
        double area; ///< 0: not known
        bool closed;
    } files[] = {{"models/variants/assimp_cube_binary.ply", 12, 6, true},
                 {"models/variants/assimp_cube_binary_header_with_RN_newline.ply", 12, 6, true},
                 {"models/variants/assimp_cube_binary_starts_with_nl.ply", 12, 6, true},
                 {"models/variants/assimp_cube_uv.ply", 12, 24, true},
                 {"models/variants/draco_cube_att.ply", 12, 6, true},
                 {"models/variants/draco_cube_quads.ply", 12, 6, true},
                 {"models/variants/draco_delim_test.ply", 12, 0, false}, // two faces are turned
                 {"models/variants/dolphins.ply", 1689, 0, false},
                 {"models/variants/dolphins_be.ply", 1689, 0, false},
                 {"models/variants/dolphins_le.ply", 1689, 0, false},
                 {"models/igea_tristrips.ply", 268686, 0, true},
                 {"models/lucy_100k_tri.ply", 99970, 0, true},
                 {"models/rangemap_lato000.ply", 86766, 0, false},
                 {"models/pepper_artec_multitexture.ply", 29956, 0, true}};
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        char path[512];
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        bool closed;
        if (!check_data(files[i].path, path, sizeof path)) skip();
        assert_int_equal(ewa_mesh_load(context, path, &mesh), EWA_OK);
        if (mesh.triangle_count != files[i].triangles)
            fail_msg("%s: %u triangles", path, mesh.triangle_count);
        if (files[i].area > 0) assert_float_equal(mesh_area(&mesh, NULL), files[i].area, 1e-3);
        assert_int_equal(ewa_mesh_is_closed(&mesh, &closed), EWA_OK);
        if (closed != files[i].closed) fail_msg("%s: closed %d", path, closed);
    }
    assert_string_equal(messages.text, "");
}

CASE(test_obj) {
    static const struct {
        const char *path;
        uint32_t triangles;
        double area; ///< 0: not known
        const char *said;
    } files[] = {{"models/variants/assimp_box_UTF16BE.obj", 12, 6, ""},
                 {"models/variants/assimp_box_without_lineending.obj", 12, 6, ""},
                 {"models/variants/assimp_concave_polygon.obj", 64, 0, "concave_polygon.mtl' is left out"},
                 {"models/variants/assimp_cube_with_vertexcolors.obj", 12, 6, ""},
                 {"models/variants/assimp_only_a_part_of_vertexcolors.obj", 3, 0, ""},
                 {"models/variants/assimp_number_formats.obj", 1, 0, "line 11: not a number; 6 in the file"},
                 {"models/variants/assimp_testmixed.obj", 12, 6, "6 lines, 6 points"},
                 {"models/variants/draco_cube_quads.obj", 12, 6, ""},
                 {"models/variants/draco_octagon.obj", 6, 0, ""},
                 {"models/variants/draco_eof_test.obj", 1, 0, ""},
                 {"models/fuze/fuze.obj", 0, 0, ""},
                 {"models/meshlab_textured/bunny10k_textured.obj", 0, 0, ""},
                 {"models/head_lps/LeePerrySmith.obj", 17684, 0, "Infinite-Level_02.mtl' is left out"},
                 {"models/armadillo_86k_tri.obj", 86482, 0, ""}};
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        char path[512];
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        if (!check_data(files[i].path, path, sizeof path)) skip();
        messages = (mesh_messages){.errors = 0};
        assert_int_equal(ewa_mesh_load(context, path, &mesh), EWA_OK);
        if (files[i].said[0])
            mesh_says(&messages, files[i].said);
        else
            assert_string_equal(messages.text, "");
        if (files[i].triangles && mesh.triangle_count != files[i].triangles)
            fail_msg("%s: %u", path, mesh.triangle_count);
        if (files[i].area > 0) assert_float_equal(mesh_area(&mesh, NULL), files[i].area, 1e-4);
        if (strstr(path, "fuze") || strstr(path, "bunny10k")) assert_non_null(mesh_texture(&mesh, 0));
    }
}

CASE(test_stl) {
    static const struct {
        const char *path;
        uint32_t triangles;
    } files[] = {{"models/variants/assimp_triangle.stl", 1},
                 {"models/variants/assimp_triangle_with_empty_solid.stl", 1},
                 {"models/variants/assimp_triangle_with_two_solids.stl", 2},
                 {"models/variants/colored.stl", 2156},
                 {"models/variants/draco_test_sphere.stl", 224},
                 {"models/variants/draco_test_sphere_ascii.stl", 224}};
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        char path[512];
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        if (!check_data(files[i].path, path, sizeof path)) skip();
        assert_int_equal(ewa_mesh_load(context, path, &mesh), EWA_OK);
        assert_int_equal(mesh.triangle_count, files[i].triangles);
        assert_true((mesh.colors != NULL) == (i == 3));
        bool closed;
        assert_int_equal(ewa_mesh_is_closed(&mesh, &closed), EWA_OK);
        assert_int_equal(closed, i >= 3);
    }
    assert_string_equal(messages.text, "");
}

static void load_hostile(void *user, const char *path) {
    (void)user;
    ewa_model model;
    messages = (mesh_messages){.errors = 0};
    const ewa_status status = ewa_model_load(context, path, EWA_MODEL_MESH, NULL, &model);
    if (status == EWA_OK)
        ewa_model_free(&model);
    else
        assert_true(messages.errors > 0 && strncmp(messages.text, path, strlen(path)) == 0);
}

CASE(test_hostile_files) {
    static const char *const folders[] = {"hostile/mesh", "hostile/img", "hostile/text"};
    for (size_t i = 0; i < sizeof folders / sizeof folders[0]; i++)
        assert_true(scratch_each(folders[i], load_hostile, NULL) > 0);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
