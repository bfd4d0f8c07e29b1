// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours of surfels from meshes: of vertices, materials and pictures, and what memory these take.
#include "io/scratch.h"
#include "mesh_shapes.h"

TEST_ON(test_colors, 0) {
    static const double positions[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    static const float texcoords[8] = {0, 0, 1, 0, 1, 1, 0, 1};
    static const uint32_t triangles[6] = {0, 1, 2, 0, 2, 3};
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    assert_int_equal(ewa_mesh_create(context, 4, 2, 1, EWA_MESH_COLORS | EWA_MESH_TEXCOORDS, &mesh), EWA_OK);
    memcpy(mesh.positions, positions, sizeof positions);
    memcpy(mesh.texcoords, texcoords, sizeof texcoords);
    memcpy(mesh.triangles, triangles, sizeof triangles);
    for (int i = 0; i < 16; i++) mesh.colors[i] = i % 4 == 1 ? 0.5f : 1;
    for (int c = 0; c < 4; c++) mesh.materials[0].base_color[c] = 1;
    // Left half black, right half white; rows from the top: the upper right quarter is red.
    assert_int_equal(ewa_image_create(context, 64, 64, 3, &mesh.textures[0]), EWA_OK);
    float *pixels = mesh.textures[0].pixels;
    for (int i = 0; i < 64 * 64; i++)
        for (int c = 0; c < 3; c++) pixels[3 * i + c] = i % 64 >= 32 && (c == 0 || i / 64 >= 32) ? 1 : 0;
    ewa_mesh_sample_options options = shape_options(400);
    options.texture_filter = EWA_TEXTURE_EWA;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = shape_sample(&mesh, &options);
    assert_null(ewa_cloud_find(cloud, EWA_TEXCOORD));
    const ewa_attribute *color = ewa_cloud_find(cloud, EWA_COLOR);
    assert_int_equal(color->component_count, 3);
    const float *p = shape_stream(cloud, EWA_POSITION);
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        const float *rgb = (const float *)color->data + 3 * i;
        const float x = p[3 * i], y = p[3 * i + 1];
        if (fabsf(x - 0.5f) < 0.1f || fabsf(y - 0.5f) < 0.1f || x < 0.1f || x > 0.9f || y < 0.1f || y > 0.9f)
            continue;
        assert_float_equal(rgb[0], x > 0.5f ? 1 : 0, 1e-5);
        assert_float_equal(rgb[1], x > 0.5f && y < 0.5f ? 0.5 : 0, 1e-5); // linear light
        assert_float_equal(rgb[2], x > 0.5f && y < 0.5f ? 1 : 0, 1e-5);
    }
    ewa_cloud_destroy(&cloud);
    mesh.materials[0].base_color[3] = 0.5f;
    cloud = shape_sample(&mesh, &options);
    color = ewa_cloud_find(cloud, EWA_COLOR);
    assert_int_equal(color->component_count, 4);
    assert_float_equal(((const float *)color->data)[3], 0.5, 1e-6);
}

/// A picture in place of materials and vertex colours; its coordinates stay when asked for.
TEST_ON(test_picture, 0) {
    static const double positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const float texcoords[6] = {0, 0, 1, 0, 0, 1};
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    OWNED(ewa_image_free) ewa_image picture;
    assert_int_equal(ewa_mesh_create(context, 3, 1, 2, EWA_MESH_COLORS | EWA_MESH_TEXCOORDS, &mesh), EWA_OK);
    memcpy(mesh.positions, positions, sizeof positions);
    memcpy(mesh.texcoords, texcoords, sizeof texcoords);
    for (uint32_t i = 0; i < 3; i++) mesh.triangles[i] = i;
    assert_int_equal(ewa_image_create(context, 4, 4, 3, &picture), EWA_OK);
    for (int i = 0; i < 48; i++) picture.pixels[i] = 0.25f;
    assert_int_equal(ewa_mesh_set_picture(&mesh, &picture), EWA_OK);
    assert_null(picture.pixels);
    assert_null(mesh.colors);
    ewa_mesh_sample_options options = shape_options(400);
    options.texcoords = true;
    ewa_cloud *cloud = shape_sample(&mesh, &options);
    const ewa_attribute *color = ewa_cloud_find(cloud, EWA_COLOR);
    assert_int_equal(color->component_count, 3);
    assert_non_null(ewa_cloud_find(cloud, EWA_TEXTURE));
    const float *at = shape_stream(cloud, EWA_TEXCOORD), *by_s = shape_stream(cloud, EWA_TEXCOORD_S),
                *p = shape_stream(cloud, EWA_POSITION);
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        assert_float_equal(((const float *)color->data)[3 * i], 0.25, 1e-5);
        assert_float_equal(at[2 * i], p[3 * i], 1e-6);
        assert_float_equal(at[2 * i + 1], p[3 * i + 1], 1e-6);
        assert_float_equal(by_s[3 * i], 1, 1e-6);
        assert_float_equal(by_s[3 * i + 1], 0, 1e-6);
    }
    ewa_cloud_destroy(&cloud);
    ewa_mesh_free(&mesh);

    shape_cube(context, &mesh); // no coordinates to put one on
    assert_int_equal(ewa_image_create(context, 4, 4, 3, &picture), EWA_OK);
    assert_int_equal(ewa_mesh_set_picture(&mesh, &picture), EWA_ERROR_ARGUMENT);
    assert_non_null(picture.pixels);
    assert_int_equal(ewa_mesh_sample(&mesh, &options, &cloud), EWA_ERROR_ARGUMENT);
}

/// A quad of two triangles for each of `count` materials, which all have the picture shared.png; OBJ.
static void write_atlas(const char *name, int count) {
    char path[512], text[8192] = "mtllib shared.mtl\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n", materials[4096] = "";
    for (int i = 0; i < count; i++) {
        const size_t length = strlen(text), more = strlen(materials);
        snprintf(text + length, sizeof text - length,
                 "v %d 0 0\nv %d.5 0 0\nv %d.5 1 0\nv %d 1 0\nusemtl m%d\nf -4/1 -3/2 -2/3 -1/4\n", i, i, i, i, i);
        snprintf(materials + more, sizeof materials - more, "newmtl m%d\nmap_Kd shared.png\n", i);
    }
    scratch_write(scratch_path(name, path), text, strlen(text));
    scratch_write(scratch_path("shared.mtl", path), materials, strlen(materials));
}

/// The most memory that loading and sampling an atlas takes.
static int64_t peak_of(int material_count) {
    char path[512];
    check_memory held = {.calls_left = -1};
    WITH_DEFAULTS(ewa_context_options, options);
    options.thread_count = 1;
    options.allocator = check_allocator(&held);
    ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    write_atlas("atlas.obj", material_count);
    ewa_mesh mesh;
    assert_int_equal(ewa_mesh_load(context, scratch_path("atlas.obj", path), &mesh), EWA_OK);
    assert_int_equal(mesh.material_count, material_count);
    const ewa_mesh_sample_options sampling = shape_options(2000);
    ewa_cloud *cloud = shape_sample(&mesh, &sampling);
    const float *color = shape_stream(cloud, EWA_COLOR);
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) // every material shows the picture: grey
        if (!(fabsf(color[3 * i] - 0.2158605f) < 1e-3f)) fail_msg("point %d: %g", (int)i, (double)color[3 * i]);
    ewa_cloud_destroy(&cloud);
    ewa_mesh_free(&mesh);
    ewa_context_destroy(&context);
    assert_int_equal(held.held_bytes, 0);
    return held.peak_bytes;
}

/// A picture that many materials have is held once, with its smaller copies.
TEST(test_shared_picture) {
    enum { SIDE = 512 };
    static uint8_t pixels[SIDE * SIDE * 3];
    char path[512];
    memset(pixels, 128, sizeof pixels);
    ewa_context *context = check_context(1, NULL);
    assert_int_equal(
        ewa_png_save(context, scratch_path("shared.png", path), SIDE, SIDE, 3, pixels, 3 * SIDE), EWA_OK);
    ewa_context_destroy(&context);
    const int64_t one = peak_of(1), many = peak_of(20);
    if (many > one + one / 10) fail_msg("%lld bytes for 20 materials, %lld for one", (long long)many, (long long)one);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
