// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Furniture drawn over canvases, for tests.
#ifndef EWA_TESTS_DRAWING_H
#define EWA_TESTS_DRAWING_H

#include "painting.h"
static const uint8_t black[4] = {0, 0, 0, 255}, white[4] = {255, 255, 255, 255},
                     grey[4] = {128, 128, 128, 255};

/// Options of which nothing is asked for yet.
static inline ewa_furniture_options no_furniture(void) {
    WITH_DEFAULTS(ewa_furniture_options, options);
    return options;
}

/// An orthographic camera of the canvas's size with so many pixels per unit, its axes those of the world.
static inline ewa_camera map_camera(const ewa_canvas *canvas, double scale_px) {
    ewa_camera camera;
    ewa_camera_init(&camera);
    camera.projection = EWA_ORTHOGRAPHIC;
    camera.width_px = canvas->width_px;
    camera.height_px = canvas->height_px;
    camera.fx_px = camera.fy_px = scale_px;
    return camera;
}

static inline void draw(const ewa_canvas *canvas, const ewa_camera *camera, const ewa_furniture_options *options) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    assert_int_equal(ewa_furniture_draw(context, camera, options, canvas), EWA_OK);
}

static inline bool is_dark(const uint8_t *pixel) { return pixel[0] < 40 && pixel[1] < 40 && pixel[2] < 40; }

#endif
