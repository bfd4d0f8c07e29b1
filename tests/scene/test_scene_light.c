// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scenes that say nothing of lights: form without colours is lit from above left, photographed points are drawn as they are.
#include "check_scene.h"

#include <math.h>

static planes first, second;

/// By how much the left half is brighter than the right one, the upper than the lower one, in shares of all light.
static void measure_slant(const planes *of, double slant[2]) {
    double sum = 0;
    slant[0] = slant[1] = 0;
    for (int i = 0; i < PIXELS; i++) {
        const double light = of->coverage[i] > 0.99f ? (double)of->rgba[4 * i] : 0;
        sum += light;
        slant[0] += i % WIDTH < WIDTH / 2 ? light : -light;
        slant[1] += i / WIDTH < HEIGHT / 2 ? light : -light;
    }
    for (int k = 0; k < 2; k++) slant[k] /= sum;
}

/// Adds a cloud, or the surfels made of it.
static ewa_surfels *add_as(ewa_context *context, ewa_scene *scene, const ewa_cloud *cloud, bool resident) {
    if (!resident) {
        add_cloud(context, scene, cloud, NULL);
        return NULL;
    }
    OWNED(ewa_asset_release) ewa_asset *asset = NULL;
    ewa_surfels *surfels = check_surfels(cloud, NULL);
    assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.surfels = surfels}, NULL, &asset), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
    return surfels;
}

/// A sphere without colours is lit from above left, wherever it is seen from, as points and as resident surfels; one with
/// colours, or by lights that are given, is not.
TEST(test_bare_light) {
    (void)state;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_object(context, EWA_OBJECT_SPHERE, 0);
    ewa_cloud_remove(cloud, EWA_COLOR);
    for (int round = 0; round < 6; round++) {
        const int kind = round % 3;
        uint8_t(*colors)[3] = NULL;
        if (kind == 1) {
            assert_int_equal(ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, (void **)&colors), EWA_OK);
            memset(colors, 200, 3 * POINTS);
        }
        ewa_scene *scene = make_scene(context);
        ewa_surfels *surfels = add_as(context, scene, cloud, round >= 3);
        ewa_scene_options options;
        ewa_scene_get_options(scene, &options);
        options.render.light_count = kind == 2; // the headlight
        ewa_light_init(&options.render.lights[0]);
        assert_int_equal(ewa_scene_set_options(scene, &options), EWA_OK);
        const ewa_camera camera = place(scene);
        double slant[2];
        draw(context, scene, &camera, &first);
        measure_slant(&first, slant);
        for (int k = 0; k < 2; k++) assert_true(kind ? fabs(slant[k]) < 0.01 : slant[k] > 0.1);
        ewa_scene_destroy(&scene);
        ewa_surfels_destroy(&surfels);
        if (kind == 1) ewa_cloud_remove(cloud, EWA_COLOR);
    }
}

/// An octahedron of one colour is lit as what has none, since its form is all there is to see; one of many, one that is
/// tinted, and one coloured by its heights keep the headlight.
TEST_ON(test_plain_mesh, 1) {
    static const double corners[18] = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
    static const uint32_t faces[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    enum { BARE, PLAIN, MANY, TINTED, HEIGHTS, KINDS };
    for (int kind = 0; kind < KINDS; kind++) {
        ewa_mesh mesh;
        assert_int_equal(ewa_mesh_create(context, 6, 8, 0, kind == BARE ? 0 : EWA_MESH_COLORS, &mesh), EWA_OK);
        memcpy(mesh.positions, corners, sizeof corners);
        memcpy(mesh.triangles, faces, sizeof faces);
        for (int i = 0; mesh.colors && i < 24; i++)
            mesh.colors[i] = i % 4 == 3 ? 1 : kind == MANY ? 0.5f + 0.2f * (float)(i / 8) : 0.5f;
        ewa_asset *asset = NULL;
        assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.mesh = &mesh}, NULL, &asset), EWA_OK);
        ewa_mesh_free(&mesh);
        OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene(context);
        WITH_DEFAULTS(ewa_instance, instance);
        instance.coloring.tinted = kind == TINTED;
        if (kind == HEIGHTS) snprintf(instance.coloring.attribute, sizeof instance.coloring.attribute, "z");
        assert_int_equal(ewa_scene_add(scene, asset, &instance), EWA_OK);
        ewa_asset_release(&asset);
        const ewa_camera camera = place(scene);
        draw(context, scene, &camera, &first);
        ewa_scene_options options;
        ewa_scene_get_options(scene, &options);
        options.render.light_count = 1; // the headlight
        ewa_light_init(&options.render.lights[0]);
        assert_int_equal(ewa_scene_set_options(scene, &options), EWA_OK);
        draw(context, scene, &camera, &second);
        assert_true((memcmp(first.rgba, second.rgba, sizeof first.rgba) == 0) == (kind > PLAIN));
    }
}

/// A sloping wall in steps of depth as a depth camera at the origin sees it, of one colour, linear.
static ewa_cloud *make_photograph(ewa_context *context, float color) {
    enum { COLUMNS = 80, ROWS = 60 };
    float(*position)[3] = NULL, (*colors)[3] = NULL;
    ewa_cloud *cloud = check_cloud_of(context, COLUMNS * ROWS);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, (void **)&position), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_COLOR, EWA_F32, 3, (void **)&colors), EWA_OK);
    for (int i = 0; i < COLUMNS * ROWS; i++) {
        const float x = ((float)(i % COLUMNS) - 39.5f) / 80, y = ((float)(i / COLUMNS) - 29.5f) / 80;
        const float z = 0.1f * roundf((3 + 2 * x + y) / 0.1f);
        position[i][0] = x * z, position[i][1] = y * z, position[i][2] = z;
        for (int c = 0; c < 3; c++) colors[i][c] = color;
    }
    return cloud;
}

/// The colours of photographed points are drawn as they are, but by lights that are given, with normals of the file's, where
/// the camera was elsewhere, or beside what has no colours.
TEST_ON(test_photographed, 1) {
    enum { PLAIN, LIT, NORMALS, ELSEWHERE, BESIDE_BARE, KINDS };
    for (int kind = 0; kind < KINDS; kind++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_photograph(context, 0.5f);
        if (kind == NORMALS) {
            WITH_DEFAULTS(ewa_estimate_options, options);
            assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
        }
        const double away[16] = {1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        if (kind == ELSEWHERE) assert_int_equal(ewa_cloud_transform(cloud, away), EWA_OK);
        OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene(context);
        add_cloud(context, scene, cloud, NULL);
        ewa_scene_options options;
        ewa_scene_get_options(scene, &options);
        options.render.light_count = kind == LIT;
        ewa_light_init(&options.render.lights[0]);
        assert_int_equal(ewa_scene_set_options(scene, &options), EWA_OK);
        const ewa_camera camera = place(scene);
        OWNED(ewa_cloud_destroy)
        ewa_cloud *bare = kind == BESIDE_BARE ? make_object(context, EWA_OBJECT_SPHERE, 0) : NULL;
        if (bare) {
            ewa_cloud_remove(bare, EWA_COLOR);
            add_cloud(context, scene, bare, NULL);
        }
        draw(context, scene, &camera, &first);
        int inner = 0, shaded = 0;
        for (int i = 0; i < PIXELS; i++) {
            if (!(first.coverage[i] > 0.99f)) continue;
            inner++;
            shaded += fabsf(first.rgba[4 * i] - 0.5f * first.rgba[4 * i + 3]) > 1e-4f;
        }
        assert_true(inner > PIXELS / 4);
        assert_true(kind == PLAIN ? shaded < inner / 100 : shaded > inner / 10); // pixels of edges have a little less
        options.render.light_count = 1; // the headlight
        assert_int_equal(ewa_scene_set_options(scene, &options), EWA_OK);
        draw(context, scene, &camera, &second);
        assert_true((memcmp(first.rgba, second.rgba, sizeof first.rgba) == 0) == (kind != PLAIN));
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
