// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Small depth images with known answers, and what their warps are drawn into.
#ifndef EWA_TESTS_WARP_PLANES_H
#define EWA_TESTS_WARP_PLANES_H

#include "check.h"

#include <math.h>
#include <string.h>

enum { PLANE_WIDTH = 96, PLANE_HEIGHT = 64, PLANE_PIXELS = PLANE_WIDTH * PLANE_HEIGHT };

/// A picture with depths in memory of its own.
typedef struct plane_image {
    float depth[PLANE_PIXELS];
    uint8_t rgb8[3 * PLANE_PIXELS];
    ewa_depth_image image;
} plane_image;

/// What is drawn.
typedef struct plane_frame {
    uint8_t rgba8[4 * PLANE_PIXELS], holes[PLANE_PIXELS];
    float rgba[4 * PLANE_PIXELS], depth[PLANE_PIXELS], normal[3 * PLANE_PIXELS], coverage[PLANE_PIXELS];
} plane_frame;

/// A camera at the origin that looks along +z, 80 pixels per unit of slope.
static inline ewa_camera plane_camera(void) {
    ewa_camera camera = check_camera(PLANE_WIDTH, PLANE_HEIGHT);
    camera.fx_px = camera.fy_px = 80;
    camera.cx_px = PLANE_WIDTH / 2;
    camera.cy_px = PLANE_HEIGHT / 2;
    return camera;
}

/// The same, moved.
static inline ewa_camera plane_camera_at(double x, double y, double z) {
    ewa_camera camera = plane_camera();
    camera.world_to_camera[3] = -x;
    camera.world_to_camera[7] = -y;
    camera.world_to_camera[11] = -z;
    return camera;
}

/// A plane at depth `z_world` with a smooth picture on it.
static inline void plane_set(plane_image *plane, double z_world) {
    ewa_depth_image_init(&plane->image);
    plane->image.camera = plane_camera();
    plane->image.depth = plane->depth;
    plane->image.depth_type = EWA_F32;
    plane->image.color = plane->rgb8;
    for (int i = 0; i < PLANE_PIXELS; i++) {
        const double x = i % PLANE_WIDTH, y = i / PLANE_WIDTH;
        plane->depth[i] = (float)z_world;
        plane->rgb8[3 * i] = (uint8_t)(128 + 60 * sin(0.2 * x) + 40 * cos(0.3 * y));
        plane->rgb8[3 * i + 1] = (uint8_t)(100 + 1.5 * x);
        plane->rgb8[3 * i + 2] = (uint8_t)(60 + 2 * y);
    }
}

static inline void plane_take(ewa_warp *warp, const plane_image *plane, ewa_warp_facts *facts) {
    assert_int_equal(ewa_warp_take(warp, &plane->image, 1, NULL, facts), EWA_OK);
}

/// Draws all planes, over black.
static inline void plane_draw(ewa_warp *warp, const ewa_camera *target, ewa_warp_method method,
                              plane_frame *drawn) {
    const ewa_frame frame = {.rgba8 = drawn->rgba8,
                             .rgba = drawn->rgba,
                             .depth = drawn->depth,
                             .normal = drawn->normal,
                             .coverage = drawn->coverage};
    assert_int_equal(ewa_warp_draw(warp, target, method, NULL, &frame, drawn->holes, NULL), EWA_OK);
}

static inline ewa_warp *plane_warp(ewa_context *context) {
    ewa_warp *warp = NULL;
    assert_int_equal(ewa_warp_create(context, &warp), EWA_OK);
    return warp;
}

#endif
