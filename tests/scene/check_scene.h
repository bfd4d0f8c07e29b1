// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scenes of generated objects for tests, and all planes of their pictures.
#ifndef EWA_TESTS_SCENE_CHECK_SCENE_H
#define EWA_TESTS_SCENE_CHECK_SCENE_H

#include "check.h"
#include "tests/prepare/check_generated.h"

enum { WIDTH = 96, HEIGHT = 72, PIXELS = WIDTH * HEIGHT, POINTS = 6000 };

/// All planes of a picture.
typedef struct planes {
    uint8_t rgba8[4 * PIXELS];
    float rgba[4 * PIXELS], depth[PIXELS], normal[3 * PIXELS], coverage[PIXELS];
} planes;

static inline ewa_cloud *make_object(ewa_context *context, ewa_object object, double shift_world) {
    ewa_cloud *cloud = check_object(context, object, POINTS);
    const double to_world[16] = {1, 0, 0, shift_world, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    assert_int_equal(ewa_cloud_transform(cloud, to_world), EWA_OK);
    return cloud;
}

static inline void add_cloud(ewa_context *context, ewa_scene *scene, const ewa_cloud *cloud,
                      const ewa_instance *instance) {
    ewa_asset *asset = NULL;
    assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.cloud = cloud}, NULL, &asset), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, instance), EWA_OK);
    ewa_asset_release(&asset);
}

static inline void draw(ewa_context *context, ewa_scene *scene, const ewa_camera *camera, planes *to) {
    OWNED(ewa_scene_renderer_destroy) ewa_scene_renderer *renderer = NULL;
    assert_int_equal(ewa_scene_renderer_create(context, EWA_BACKEND_CPU, NULL, &renderer), EWA_OK);
    const ewa_frame frame = {to->rgba8, to->rgba, to->depth, to->normal, to->coverage};
    assert_int_equal(ewa_scene_draw(scene, renderer, camera, NULL, &frame, NULL), EWA_OK);
}

static inline ewa_scene *make_scene(ewa_context *context) {
    ewa_scene *scene = NULL;
    assert_int_equal(ewa_scene_create(context, NULL, &scene), EWA_OK);
    return scene;
}

/// A scene of one object, and the object's cloud.
static inline ewa_scene *make_scene_of(ewa_context *context, ewa_object object, ewa_cloud **cloud) {
    ewa_scene *scene = make_scene(context);
    *cloud = make_object(context, object, 0);
    add_cloud(context, scene, *cloud, NULL);
    return scene;
}

static inline ewa_camera place(ewa_scene *scene) {
    WITH_DEFAULTS(ewa_view_options, options);
    options.width_px = WIDTH;
    options.height_px = HEIGHT;
    ewa_camera camera;
    assert_int_equal(ewa_scene_place_camera(scene, &options, &camera, NULL), EWA_OK);
    return camera;
}

#endif
