// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A picture on irregular points of a plane, seen from the front, with its exact truth: figure 6 of "Surface
// Splatting".
#ifndef EWA_TESTS_QUALITY_ACQUIRE_SCENE_H
#define EWA_TESTS_QUALITY_ACQUIRE_SCENE_H

#include "defaults.h"
#include "owned.h"
#include "ewa/ewa.h"

enum { ACQUIRE_ROW = 512, ACQUIRE_SIDE = 256 };

/// A plane of ACQUIRE_ROW^2 surfels, one in each cell of a grid. The unit of length is a cell.
typedef struct acquire_scene {
    ewa_context *context;
    ewa_image texture;
    double radius_scale, jitter;
    double view_px_per_cell;
    double pixel_sigma_px; ///< of the texture's pixels, in acquisition and truth
} acquire_scene;

/// Makes a checkerboard of `size_px` pixels in squares of `check_px`.
ewa_status acquire_checker(ewa_context *context, uint32_t size_px, uint32_t check_px, ewa_image *image);

/// The picture that a view should be, ACQUIRE_SIDE wide and high, 3 channels: the texture's continuous
/// function under the renderer's pixel filter, 1,024 samples along each axis of each pixel.
ewa_status acquire_truth(const acquire_scene *scene, ewa_image *picture);

/// Makes the points with their coordinates on the picture; the caller destroys them.
ewa_status acquire_points(const acquire_scene *scene, ewa_cloud **cloud);

/// Draws points that have colours.
ewa_status acquire_draw(const acquire_scene *scene, const ewa_cloud *cloud, ewa_image *picture);

/// RMS difference of two pictures of a view, over pixels whose filter sees the plane only.
double acquire_rms(const acquire_scene *scene, const ewa_image *a, const ewa_image *b);

#endif
