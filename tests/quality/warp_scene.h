// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A room to warp pictures of: a textured floor and wall, spheres and a board in front of them, ray-cast
// exactly.
#ifndef EWA_TESTS_WARP_SCENE_H
#define EWA_TESTS_WARP_SCENE_H

#include "ewa/ewa.h"

/// What a ray meets: the object (-1: nothing), the depth z in the camera and the linear colour.
typedef struct warp_hit {
    int object;
    double z, point_world[3], color[3];
} warp_hit;

/// The ray through (x, y) in pixels.
warp_hit warp_scene_hit(const ewa_camera *camera, double x, double y);

/// A camera of the room, `shift` from the usual place.
ewa_camera warp_scene_camera(uint32_t width_px, uint32_t height_px, double shift_x, double shift_y,
                             double shift_z);

/// The picture, 4 x 4 rays a pixel, as 8-bit sRGB (3 per pixel); depths of the pixels' centres (may be NULL).
void warp_scene_picture(const ewa_camera *camera, uint8_t *rgb8, float *depth);

/// Marks with 255 the pixels of `target` whose surface another camera sees.
void warp_scene_seen(const ewa_camera *target, const ewa_camera *from, uint8_t *seen);

/// Peak signal to noise ratio and mean structural similarity of 8-bit RGB pictures where `counts` is not 0
/// (NULL: everywhere). SSIM: of luma, windows of 8 x 8 of which all pixels count.
/// Based on: Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error Visibility to Structural
/// Similarity", 2004, equation 13.
typedef struct picture_likeness {
    double psnr_db, ssim;
    uint64_t pixel_count;
} picture_likeness;

picture_likeness picture_compare(uint32_t width_px, uint32_t height_px, const uint8_t *rgb8_a,
                                 const uint8_t *rgb8_b, const uint8_t *counts);

#endif
