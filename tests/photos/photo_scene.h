// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A textured sphere of surfels, and photographs of the sphere itself: rays through 16 places of each pixel.
#ifndef EWA_TESTS_PHOTO_SCENE_H
#define EWA_TESTS_PHOTO_SCENE_H

#include "check.h"

enum { PHOTO_SCENE_MAX = 32 };

typedef struct photo_scene {
    uint32_t point_count, count;
    float *position, *normal, *radius;
    ewa_cloud *cloud;
    ewa_photo photos[PHOTO_SCENE_MAX];
    ewa_image images[PHOTO_SCENE_MAX];
    double gain[PHOTO_SCENE_MAX][3], offset[PHOTO_SCENE_MAX]; ///< of the photographs, mean of log gains of all: any
} photo_scene;

/// Linear colour of the sphere where it is; `wave_world`: the finest wave.
void photo_scene_texture(const double place_world[3], double wave_world, double color[3]);

/// Makes `point_count` points and `count` photographs of `side_px` pixels. `gain`: how much exposures differ, 0.2: by up
/// to 20 %; `offset`: likewise.
photo_scene *photo_scene_make(ewa_context *context, uint32_t point_count, uint32_t count, uint32_t side_px,
                              double gain, double offset);
void photo_scene_free(photo_scene **scene);

#endif
