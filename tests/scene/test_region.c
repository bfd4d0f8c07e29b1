// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Regions: which points they hide is a closed form on a grid; a picture of what is left is that of a cloud of it.
#include "check.h"
#include "ewa/scene_file.h"
#include "ewa/select.h"
#include "io/scratch.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { SIDE = 21, POINTS = SIDE * SIDE, WIDTH = 80, HEIGHT = 60 };

static ewa_context *context;

static int enter(void **state) {
    (void)state;
    char folder[512];
    assert_int_equal(chdir(scratch_path("", folder)), 0);
    context = check_context(0, NULL);
    return 0;
}

static int leave(void **state) {
    (void)state;
    ewa_context_destroy(&context);
    return 0;
}

/// Surfels on a grid over [0, 20] x [0, 20], of classes 0 to 4 by x mod 5, in colours.
static ewa_cloud *make_grid(void) {
    void *places, *normals, *radii, *classes, *colors;
    ewa_cloud *cloud = check_cloud_of(context, POINTS);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, &places), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_NORMAL, EWA_F32, 3, &normals), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, &radii), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, &colors), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, "classification", EWA_U8, 1, &classes), EWA_OK);
    for (int i = 0; i < POINTS; i++) {
        const float place[3] = {(float)(i % SIDE), (float)(i / SIDE), 0};
        memcpy((float *)places + 3 * i, place, sizeof place);
        memcpy((float *)normals + 3 * i, (const float[3]){0, 0, 1}, sizeof place);
        ((float *)radii)[i] = 1.2f;
        ((uint8_t *)classes)[i] = (uint8_t)(i % SIDE % 5);
        for (int c = 0; c < 3; c++) ((uint8_t *)colors)[3 * i + c] = (uint8_t)(10 * (i % SIDE) + 20 * c);
    }
    return cloud;
}

static ewa_scene *make_scene(const ewa_cloud *cloud) {
    ewa_scene *scene = NULL;
    OWNED(ewa_asset_release) ewa_asset *asset = NULL;
    assert_int_equal(ewa_scene_create(context, NULL, &scene), EWA_OK);
    assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.cloud = cloud}, NULL, &asset), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
    return scene;
}

static void set_regions(ewa_scene *scene, const ewa_region *regions, uint32_t count) {
    static ewa_scene_options options;
    ewa_scene_get_options(scene, &options);
    if (count) memcpy(options.regions, regions, count * sizeof *regions);
    options.region_count = count;
    assert_int_equal(ewa_scene_set_options(scene, &options), EWA_OK);
}

static ewa_camera make_camera(bool flat) {
    ewa_camera camera = check_camera(WIDTH, HEIGHT);
    camera.cx_px = WIDTH / 2, camera.cy_px = HEIGHT / 2;
    if (flat) {
        camera.projection = EWA_ORTHOGRAPHIC;
        camera.fx_px = camera.fy_px = 2;
    } else {
        camera.fx_px = camera.fy_px = 80;
    }
    // From 40 above the middle, down, x to the right and y upward.
    const double m[16] = {1, 0, 0, -10, 0, -1, 0, 10, 0, 0, -1, 40, 0, 0, 0, 1};
    memcpy(camera.world_to_camera, m, sizeof m);
    return camera;
}

static uint64_t count_left(const ewa_region *regions, uint32_t count) {
    ewa_cloud *cloud = make_grid(), *left = NULL;
    ewa_scene *scene = make_scene(cloud);
    set_regions(scene, regions, count);
    assert_int_equal(ewa_scene_points(scene, &left), EWA_OK);
    const uint64_t found = ewa_cloud_point_count(left);
    ewa_cloud_destroy(&left);
    ewa_scene_destroy(&scene);
    ewa_cloud_destroy(&cloud);
    return found;
}

/// Boxes hold their faces; classes are those of the codes; several regions hide together.
TEST(test_known_counts) {
    (void)state;
    ewa_region box = {.has_box = true, .box_world = {2, 3, -1, 5, 9, 1}}, kept = box, classes = {.has_classes = true};
    kept.kept = true;
    assert_int_equal(count_left(NULL, 0), POINTS);
    assert_int_equal(count_left(&box, 1), POINTS - 4 * 7);
    assert_int_equal(count_left(&kept, 1), 4 * 7);
    classes.classes[0] = 1u << 0 | 1u << 3; // x = 0, 5, 10, 15, 20 and 3, 8, 13, 18
    assert_int_equal(count_left(&classes, 1), POINTS - 9 * SIDE);
    const ewa_region both[2] = {kept, classes};
    assert_int_equal(count_left(both, 2), 2 * 7); // x = 2 and 4
    ewa_region one = kept; // of one region, all has to hold: x = 3 and 5 of the box
    one.has_classes = true;
    one.classes[0] = classes.classes[0];
    assert_int_equal(count_left(&one, 1), 2 * 7);
    const ewa_region nothing = {.kept = true}, none = {.kept = false};
    assert_int_equal(count_left(&nothing, 1), 0);
    assert_int_equal(count_left(&none, 1), POINTS);
}

/// A box whose axes are those of the world, in another order, has the points of the box that says so; one across the corner of
/// the grid those of x + y <= 4; what is no number is refused.
TEST(test_turned_boxes) {
    (void)state;
    const double half = sqrt(0.5);
    ewa_region box = {.kept = true, .has_box = true, .box_world = {3, -1, 2, 9, 1, 4}, .box_axes_world = {0, 1, 0, 0, 0, 1, 1, 0, 0}};
    assert_int_equal(count_left(&box, 1), 3 * 7); // y of 3 to 9, x of 2 to 4
    ewa_region corner = {.kept = true, .has_box = true, .box_world = {-1, -100, -1, 4.5 * half, 100, 1},
                         .box_axes_world = {half, half, 0, half, -half, 0, 0, 0, 1}};
    assert_int_equal(count_left(&corner, 1), 5 + 4 + 3 + 2 + 1);
    ewa_scene *scene = NULL;
    WITH_DEFAULTS(ewa_scene_options, options);
    options.region_count = 1;
    options.regions[0] = corner;
    options.regions[0].box_axes_world[4] = NAN;
    assert_int_equal(ewa_scene_create(context, &options, &scene), EWA_ERROR_ARGUMENT);
}

/// The outline of [7.5, 12.5] x [5.5, 14.5] on the picture, at 2 pixels a unit, as a rectangle and with a notch.
TEST(test_outlines) {
    (void)state;
    static const double rectangle[8] = {35, 39, 45, 39, 45, 21, 35, 21}, triangle[6] = {0, 0, 80, 0, 40, 30};
    for (int flat = 0; flat < 2; flat++) {
        const ewa_camera camera = make_camera(flat);
        ewa_region region = {.kept = true};
        assert_int_equal(ewa_region_set_outline(&region, &camera, rectangle, 4), EWA_OK);
        assert_int_equal(count_left(&region, 1), 5 * 9);
        region.kept = false;
        assert_int_equal(count_left(&region, 1), POINTS - 5 * 9);
        region.kept = true;
        assert_int_equal(ewa_region_set_outline(&region, &camera, triangle, 3), EWA_OK);
        uint64_t wanted = 0; // above both sides, which end in the middle of the picture
        for (int i = 0; i < POINTS; i++) wanted += 2.0 * (i / SIDE - 10) > 0.75 * fabs(2.0 * (i % SIDE - 10));
        const uint64_t found = count_left(&region, 1);
        assert_true(found >= wanted && found <= wanted + SIDE); // on a side, either way
    }
    // What is behind the eye is in no outline.
    ewa_camera away = make_camera(false);
    for (int c = 8; c < 12; c++) away.world_to_camera[c] *= -1;
    ewa_region region = {.kept = true};
    assert_int_equal(ewa_region_set_outline(&region, &away, rectangle, 4), EWA_OK);
    assert_int_equal(count_left(&region, 1), 0);
    // A circle of 1,000 corners keeps its area.
    double circle[2000];
    for (int i = 0; i < 1000; i++) circle[2 * i] = 40 + 17.1 * cos(i * 0.0062831853), circle[2 * i + 1] = 30 + 17.1 * sin(i * 0.0062831853);
    const ewa_camera camera = make_camera(true);
    assert_int_equal(ewa_region_set_outline(&region, &camera, circle, 1000), EWA_OK);
    assert_int_equal(region.corner_count, EWA_REGION_CORNERS);
    uint64_t wanted = 0;
    for (int i = 0; i < POINTS; i++) wanted += hypot(i % SIDE - 10, i / SIDE - 10) < 8.55;
    const uint64_t found = count_left(&region, 1);
    assert_true(found + 8 >= wanted && found <= wanted + 4);
    assert_int_equal(ewa_region_set_outline(&region, &camera, circle, 2), EWA_ERROR_ARGUMENT);
}

static void draw(ewa_scene *scene, uint8_t *rgba8) {
    const ewa_camera camera = make_camera(false);
    OWNED(ewa_scene_renderer_destroy) ewa_scene_renderer *renderer = NULL;
    assert_int_equal(ewa_scene_renderer_create(context, EWA_BACKEND_CPU, NULL, &renderer), EWA_OK);
    assert_int_equal(ewa_scene_draw(scene, renderer, &camera, NULL, &(ewa_frame){.rgba8 = rgba8}, NULL), EWA_OK);
}

/// A picture of a scene of which points are hidden is that of the points that are left; shown again, that of all.
TEST(test_pictures) {
    (void)state;
    static uint8_t all[4 * WIDTH * HEIGHT], hidden[4 * WIDTH * HEIGHT], other[4 * WIDTH * HEIGHT];
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_grid(), *left = NULL;
    OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene(cloud);
    draw(scene, all);
    const ewa_region box = {.has_box = true, .box_world = {4, 4, -1, 12, 9, 1}};
    set_regions(scene, &box, 1);
    draw(scene, hidden);
    assert_memory_not_equal(all, hidden, sizeof all);
    assert_int_equal(ewa_scene_points(scene, &left), EWA_OK);
    assert_int_equal(ewa_cloud_attribute_count(left), ewa_cloud_attribute_count(cloud));
    OWNED(ewa_scene_destroy) ewa_scene *of_left = make_scene(left);
    draw(of_left, other);
    assert_memory_equal(hidden, other, sizeof hidden);
    // What is hidden is not picked.
    ewa_scene_renderer *renderer = NULL;
    const ewa_camera camera = make_camera(false);
    ewa_scene_hit hit;
    assert_int_equal(ewa_scene_renderer_create(context, EWA_BACKEND_CPU, NULL, &renderer), EWA_OK);
    assert_int_equal(ewa_scene_pick(scene, renderer, &camera, NULL, 36.5, 37.5, 0, 5, &hit), EWA_OK);
    assert_false(hit.hit);
    set_regions(scene, NULL, 0);
    assert_int_equal(ewa_scene_pick(scene, renderer, &camera, NULL, 36.5, 37.5, 0, 5, &hit), EWA_OK);
    assert_true(hit.hit && hit.has_point);
    ewa_scene_renderer_destroy(&renderer);
    draw(scene, other);
    assert_memory_equal(all, other, sizeof all);
    // All hidden: the background.
    const ewa_region nothing = {.kept = true};
    set_regions(scene, &nothing, 1);
    draw(scene, other);
    for (size_t i = 0; i < sizeof other; i++) assert_int_equal(other[i], 255);
}

/// Octrees hide the same points, and scene files keep regions to the bit.
TEST(test_files) {
    (void)state;
    ewa_cloud *cloud = make_grid(), *left = NULL;
    const double line[8] = {10, 10, 70, 12, 60, 50, 12, 44};
    const ewa_camera camera = make_camera(false);
    ewa_region regions[2] = {{.kept = true}, {.has_box = true, .box_world = {4, 4, -1, 12, 9, 1}, .has_classes = true}};
    regions[1].classes[0] = 1u << 1 | 1u << 4;
    assert_int_equal(ewa_region_set_outline(&regions[0], &camera, line, 4), EWA_OK);
    const uint64_t wanted = count_left(regions, 2);
    assert_true(wanted > 50 && wanted < POINTS - 50);
    assert_int_equal(ewa_cloud_save(cloud, "region.ply", NULL), EWA_OK);
    static const char *const path = "region.ply";
    assert_int_equal(ewa_lod_build(context, &path, 1, "region.copc.laz", NULL, NULL), EWA_OK);
    for (int k = 0; k < 2; k++) {
        ewa_asset *asset = NULL;
        WITH_DEFAULTS(ewa_asset_options, options);
        options.levels = EWA_OCTREE_ALWAYS;
        OWNED(ewa_scene_destroy) ewa_scene *scene = NULL, *again = NULL;
        assert_int_equal(ewa_scene_create(context, NULL, &scene), EWA_OK);
        assert_int_equal(ewa_asset_load(context, k ? "region.copc.laz" : path, &options, &asset), EWA_OK);
        assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
        ewa_asset_release(&asset);
        set_regions(scene, regions, 2);
        assert_int_equal(ewa_scene_points(scene, &left), EWA_OK);
        assert_int_equal(ewa_cloud_point_count(left), wanted);
        ewa_cloud_destroy(&left);
        assert_int_equal(ewa_scene_save(scene, NULL, "region.json"), EWA_OK);
        assert_int_equal(ewa_scene_create(context, NULL, &again), EWA_OK);
        assert_int_equal(ewa_scene_open(again, "region.json", NULL), EWA_OK);
        static ewa_scene_options read;
        ewa_scene_get_options(again, &read);
        assert_int_equal(read.region_count, 2);
        assert_memory_equal(read.regions, regions, sizeof regions);
        // What was there before and is counted no longer leaves no trace in what a file says.
        OWNED(ewa_scene_file_destroy) ewa_scene_file *saved = NULL;
        for (int i = 0; i < 2; i++) read.regions[i] = (ewa_region){.kept = true, .has_classes = true, .classes = {~0u}};
        read.region_count = 0;
        assert_int_equal(ewa_scene_file_load(context, "region.json", NULL, &saved), EWA_OK);
        ewa_scene_file_apply(saved, &read);
        assert_int_equal(read.region_count, 2);
        assert_memory_equal(read.regions, regions, sizeof regions);
    }
    static const char *const wrong[] = {"{\"keep\": 1}",           "{\"box\": [1, 2, 3]}",  "{\"classes\": [256]}",
                                        "{\"outline\": [1, 2, 3, 4]}", "{\"classes\": [0.5]}", "{\"volume\": 3}",
                                        "3",                       "{\"box\": \"here\"}", "{\"box\": [1, 0, 0, 0, 1, 1]}",
                                        "{\"box\": [0, 0, 0, 1, 1, 1e999]}"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        FILE *file = fopen("wrong.json", "w");
        fprintf(file, "{\"ewa_scene\": 1, \"options\": {\"regions\": [%s]}, \"items\": []}", wrong[i]);
        fclose(file);
        ewa_scene_file *made = NULL;
        assert_int_equal(ewa_scene_file_load(context, "wrong.json", NULL, &made), EWA_ERROR_FORMAT);
    }
    ewa_cloud_destroy(&cloud);
    static ewa_scene_options options;
    ewa_scene_options_init(&options, sizeof options);
    options.region_count = 1;
    options.regions[0] = (ewa_region){.has_box = true, .box_world = {0, 0, 2, 1, 1, 1}};
    ewa_scene *refused = NULL;
    assert_int_equal(ewa_scene_create(context, &options, &refused), EWA_ERROR_ARGUMENT);
}

/// A picture of a scene of one file, whose centres nearer than the camera's plane do not depend on what is left of it.
static void draw_file(ewa_scene *scene, uint8_t *rgba8) {
    static ewa_scene_options options;
    ewa_scene_get_options(scene, &options);
    options.gaussians.near_world = 0.01;
    options.volumes.minimum_transmittance = options.gaussians.minimum_transmittance = 0;
    assert_int_equal(ewa_scene_set_options(scene, &options), EWA_OK);
    draw(scene, rgba8);
}

static ewa_scene *open_file(const char *path, const char *transfer) {
    OWNED(ewa_asset_release) ewa_asset *asset = NULL;
    ewa_scene *scene = NULL;
    WITH_DEFAULTS(ewa_asset_options, options);
    options.transfer = transfer;
    assert_int_equal(ewa_asset_load(context, path, &options, &asset), EWA_OK);
    assert_int_equal(ewa_scene_create(context, NULL, &scene), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
    return scene;
}

/// Gaussians on a grid that regions hide are those whose centres they hold; what is left has the bytes of a file of it, drawn and
/// written, and so have levels.
TEST(test_gaussians) {
    (void)state;
    static uint8_t all[4 * WIDTH * HEIGHT], hidden[4 * WIDTH * HEIGHT], other[4 * WIDTH * HEIGHT];
    ewa_gaussians set, left;
    assert_int_equal(ewa_gaussians_create(context, POINTS, 1, &set), EWA_OK);
    for (uint32_t i = 0; i < POINTS; i++) {
        const float center[3] = {(float)(i % SIDE), (float)(i / SIDE), 0};
        memcpy(set.centers + 3 * (size_t)i, center, sizeof center);
        for (int c = 0; c < 3; c++) set.scales[3 * (size_t)i + (size_t)c] = 0.25f * (float)(c + 1);
        set.rotations[4 * (size_t)i] = 1;
        set.opacities[i] = 0.75f;
        for (int c = 0; c < 12; c++) set.harmonics[12 * (size_t)i + (size_t)c] = (float)((i + (uint32_t)c) % 7) / 8 - 0.25f;
    }
    assert_int_equal(ewa_gaussians_save(&set, "region_gaussians.ply", NULL), EWA_OK);
    ewa_gaussians_free(&set);
    ewa_scene *scene = open_file("region_gaussians.ply", NULL);
    draw_file(scene, all);
    const ewa_region box = {.has_box = true, .box_world = {4, 4, -1, 12, 9, 1}};
    set_regions(scene, &box, 1);
    draw_file(scene, hidden);
    assert_memory_not_equal(all, hidden, sizeof all);
    double up_world[3] = {1, 1, 1};
    assert_int_equal(ewa_scene_gaussians(scene, &left, up_world), EWA_OK);
    assert_int_equal(left.count, POINTS - 9 * 6);
    assert_true(up_world[0] == 0 && up_world[1] == 0 && up_world[2] == 0);
    assert_int_equal(ewa_gaussians_load(context, "region_gaussians.ply", &set, NULL), EWA_OK);
    for (uint32_t i = 0, k = 0; i < POINTS; i++) {
        const uint32_t x = i % SIDE, y = i / SIDE;
        if (x >= 4 && x <= 12 && y >= 4 && y <= 9) continue;
        assert_memory_equal(left.centers + 3 * (size_t)k, set.centers + 3 * (size_t)i, 3 * sizeof(float));
        assert_memory_equal(left.scales + 3 * (size_t)k, set.scales + 3 * (size_t)i, 3 * sizeof(float));
        assert_memory_equal(left.rotations + 4 * (size_t)k, set.rotations + 4 * (size_t)i, 4 * sizeof(float));
        assert_memory_equal(left.opacities + k, set.opacities + i, sizeof(float));
        assert_memory_equal(left.harmonics + 12 * (size_t)k, set.harmonics + 12 * (size_t)i, 12 * sizeof(float));
        k++;
    }
    ewa_gaussians_free(&set);
    assert_int_equal(ewa_gaussians_save(&left, "region_left.ply", NULL), EWA_OK);
    ewa_gaussians_free(&left);
    OWNED(ewa_scene_destroy) ewa_scene *of_left = open_file("region_left.ply", NULL), *copy = NULL;
    draw_file(of_left, other);
    assert_memory_equal(hidden, other, sizeof hidden);
    // A copy shares what is left, and outlives the scene that it was made of.
    assert_int_equal(ewa_scene_copy(scene, context, &copy), EWA_OK);
    ewa_scene_destroy(&scene);
    draw_file(copy, other);
    assert_memory_equal(hidden, other, sizeof hidden);
    ewa_cloud *centers = NULL;
    uint64_t count = 0;
    assert_int_equal(ewa_scene_centers(copy, 100, &centers, &count), EWA_OK);
    assert_int_equal(count, POINTS - 9 * 6);
    assert_int_equal(ewa_cloud_point_count(centers), (POINTS - 9 * 6 + 3) / 4);
    ewa_cloud_destroy(&centers);
    // Classes hold none of them, and all come back.
    ewa_region classes = {.has_classes = true, .classes = {~0u}};
    set_regions(copy, &classes, 1);
    draw_file(copy, other);
    assert_memory_equal(all, other, sizeof all);
    set_regions(copy, NULL, 0);
    draw_file(copy, other);
    assert_memory_equal(all, other, sizeof all);
    // Sections are part of what is written; where nothing is left, nothing is, and nothing is seen.
    static ewa_scene_options options;
    ewa_scene_get_options(copy, &options);
    options.render.section_count = 1;
    options.render.section_planes[0][0] = 1, options.render.section_planes[0][3] = -9.5;
    assert_int_equal(ewa_scene_set_options(copy, &options), EWA_OK);
    assert_int_equal(ewa_scene_gaussians(copy, &left, NULL), EWA_OK);
    assert_int_equal(left.count, (SIDE - 10) * SIDE);
    ewa_gaussians_free(&left);
    const ewa_region nothing = {.kept = true};
    set_regions(copy, &nothing, 1);
    draw_file(copy, other);
    for (size_t i = 0; i < sizeof other; i++) assert_int_equal(other[i], 255);
    assert_int_equal(ewa_scene_gaussians(copy, &left, NULL), EWA_OK);
    assert_int_equal(left.count, 0);
    ewa_gaussians_free(&left);
    ewa_volume volume;
    assert_int_equal(ewa_scene_volume(copy, &volume), EWA_ERROR_ARGUMENT);
}

/// Gaussians with classes are hidden by them, drawn, counted and written.
TEST(test_classes_of_gaussians) {
    (void)state;
    static uint8_t hidden[4 * WIDTH * HEIGHT], other[4 * WIDTH * HEIGHT];
    ewa_gaussians set, left;
    assert_int_equal(ewa_gaussians_create(context, POINTS, 0, &set), EWA_OK);
    assert_int_equal(ewa_gaussians_add_classes(&set), EWA_OK);
    for (uint32_t i = 0; i < POINTS; i++) {
        const float center[3] = {(float)(i % SIDE), (float)(i / SIDE), 0};
        memcpy(set.centers + 3 * (size_t)i, center, sizeof center);
        for (int c = 0; c < 3; c++) set.scales[3 * (size_t)i + (size_t)c] = 0.25f;
        set.rotations[4 * (size_t)i] = 1;
        set.opacities[i] = 0.75f;
        set.classes[i] = i / SIDE < 4 ? 2 : 40;
    }
    assert_int_equal(ewa_gaussians_save(&set, "region_classes.ply", NULL), EWA_OK);
    ewa_gaussians_free(&set);
    OWNED(ewa_scene_destroy) ewa_scene *scene = open_file("region_classes.ply", NULL), *of_left = NULL;
    const ewa_region classes = {.has_classes = true, .classes = {1u << 2}};
    set_regions(scene, &classes, 1);
    draw_file(scene, hidden);
    ewa_cloud *centers = NULL;
    uint64_t count = 0;
    assert_int_equal(ewa_scene_centers(scene, 10, &centers, &count), EWA_OK);
    ewa_cloud_destroy(&centers);
    assert_int_equal(count, POINTS - 4 * SIDE);
    assert_int_equal(ewa_scene_gaussians(scene, &left, NULL), EWA_OK);
    assert_int_equal(left.count, POINTS - 4 * SIDE);
    assert_int_equal(ewa_gaussians_save(&left, "region_classes_left.ply", NULL), EWA_OK);
    ewa_gaussians_free(&left);
    of_left = open_file("region_classes_left.ply", NULL);
    draw_file(of_left, other);
    assert_memory_equal(hidden, other, sizeof hidden);
}

/// A volume of 20 x 12 x 8 voxels: what is left is the grid around it, on its place, with every number; what is hidden within has one
/// that shows nothing, and the picture of the file is that of the scene.
TEST(test_volumes) {
    (void)state;
    static uint8_t all[4 * WIDTH * HEIGHT], hidden[4 * WIDTH * HEIGHT], other[4 * WIDTH * HEIGHT];
    static const char transfer[] = "region_transfer.json";
    FILE *file = fopen(transfer, "w");
    assert_non_null(file);
    fputs("{\"points\": [{\"value\": 20, \"color\": [1, 0, 0], \"extinction\": 0.5}, {\"value\": 90, \"color\": [0, 0, 1], "
          "\"extinction\": 0.5}], \"unit_length\": 1}", file);
    fclose(file);
    const uint32_t dims[3] = {20, 12, 8};
    for (int k = 0; k < 2; k++) {
        OWNED(ewa_volume_free) ewa_volume volume, left;
        assert_int_equal(ewa_volume_create(context, dims, k ? EWA_F32 : EWA_U8, &volume), EWA_OK);
        for (uint32_t i = 0; i < 20 * 12 * 8; i++) {
            const uint8_t value = (uint8_t)(20 + i % 70);
            if (k)
                ((float *)volume.voxels)[i] = value;
            else
                ((uint8_t *)volume.voxels)[i] = value;
        }
        for (int c = 0; c < 3; c++) volume.index_to_world[4 * c + 3] = 0;
        assert_int_equal(ewa_volume_save(&volume, "region_volume.nrrd", NULL), EWA_OK);
        OWNED(ewa_scene_destroy) ewa_scene *scene = open_file("region_volume.nrrd", transfer);
        static ewa_scene_options options;
        ewa_scene_get_options(scene, &options);
        options.shade_volumes = false; // by gradients, which what is beyond a border is part of
        assert_int_equal(ewa_scene_set_options(scene, &options), EWA_OK);
        draw_file(scene, all);
        const ewa_region regions[2] = {{.kept = true, .has_box = true, .box_world = {3, 2, 1, 9, 8, 5}},
                                       {.has_box = true, .box_world = {5, 4, -9, 6, 5, 9}}};
        set_regions(scene, regions, 2);
        draw_file(scene, hidden);
        assert_memory_not_equal(all, hidden, sizeof all);
        assert_int_equal(ewa_scene_volume(scene, &left), EWA_OK);
        assert_true(left.dims[0] == 7 && left.dims[1] == 7 && left.dims[2] == 5 && left.type == volume.type);
        const double *m = left.index_to_world;
        assert_true(m[0] == 1 && m[5] == 1 && m[10] == 1 && m[3] == 3 && m[7] == 2 && m[11] == 1);
        for (uint32_t i = 0; i < 7 * 7 * 5; i++) {
            const uint32_t x = 3 + i % 7, y = 2 + i / 7 % 7, z = 1 + i / 49, from = (z * 12 + y) * 20 + x;
            const bool is_hidden = x >= 5 && x <= 6 && y >= 4 && y <= 5;
            const double value = k ? (double)((float *)left.voxels)[i] : ((uint8_t *)left.voxels)[i];
            if (!is_hidden)
                assert_true(value == 20 + from % 70);
            else if (k)
                assert_true(isnan(value));
            else
                assert_true(value > 90);
        }
        assert_int_equal(ewa_volume_save(&left, "region_part.nrrd", NULL), EWA_OK);
        OWNED(ewa_scene_destroy) ewa_scene *of_left = open_file("region_part.nrrd", transfer);
        assert_int_equal(ewa_scene_set_options(of_left, &options), EWA_OK);
        draw_file(of_left, other);
        // Places are told from another voxel: what floats round differently is a step.
        for (size_t i = 0; i < sizeof hidden; i++) assert_true(abs(hidden[i] - other[i]) <= 1);
        ewa_cloud *centers = NULL;
        uint64_t count = 0;
        assert_int_equal(ewa_scene_centers(scene, UINT64_MAX, &centers, &count), EWA_OK);
        assert_int_equal(count, (7 * 7 - 4) * 5);
        ewa_cloud_destroy(&centers);
        const ewa_region nothing = {.kept = true};
        set_regions(scene, &nothing, 1);
        draw_file(scene, other);
        for (size_t i = 0; i < sizeof other; i++) assert_int_equal(other[i], 255);
        ewa_volume none;
        assert_int_equal(ewa_scene_volume(scene, &none), EWA_ERROR_ARGUMENT);
        set_regions(scene, NULL, 0);
        draw_file(scene, other);
        assert_memory_equal(all, other, sizeof all);
    }
}

int main(void) { return RUN_TESTS(enter, leave); }
