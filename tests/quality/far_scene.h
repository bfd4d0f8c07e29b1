// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What is far against its truth: a picture whose pixels hold many surfels beside its own picture at FAR_FINER times the
// resolution, averaged over the pixels. Averages are of linear light, premultiplied.
#ifndef EWA_TESTS_QUALITY_FAR_SCENE_H
#define EWA_TESTS_QUALITY_FAR_SCENE_H

#include "defaults.h"
#include "ewa/ewa.h"

enum { FAR_FINER = 8 };

/// Scenes that are generated, and one read from a file.
typedef enum far_kind {
    FAR_TOWN,    ///< boxes and trees
    FAR_SPHERE,  ///< a sphere of noise
    FAR_TERRAIN, ///< hills of marble
    FAR_KINDS,
} far_kind;

extern const char *const far_names[FAR_KINDS];

/// Makes a generated scene. The caller destroys `*cloud`. Errors are those of the library.
ewa_status far_make(ewa_context *context, far_kind kind, uint64_t point_count, ewa_cloud **cloud);

/// A square picture of `side_px` that sees a box from above at an angle, from `times` the distance at which it fills the
/// picture; `finer` times as many pixels along each side.
ewa_camera far_camera(const ewa_bounds *bounds, double times, uint32_t side_px, uint32_t finer);

/// Averages a picture of `finer` times `side_px` pixels along each side: linear, premultiplied, 4 floats a pixel.
void far_average(const float *fine, uint32_t side_px, uint32_t finer, float *rgba);

/// How a picture differs from the truth.
typedef struct far_errors {
    double linear_db;       ///< PSNR of premultiplied linear colours where one of both shows something, peak 1
    double screen_db;       ///< the same of sRGB over white
    uint64_t inner_count;   ///< pixels that the truth covers with all their eight neighbours
    uint64_t open_count;    ///< of these, alpha below 0.99: the background shows
    double fat_px;          ///< how far outlines lie outside of the truth's: difference of alpha over their length
    double lighter_percent; ///< mean light of the inner pixels over the truth's
} far_errors;

/// Compares pictures of `side_px` squared: linear, premultiplied, 4 floats a pixel, over nothing.
void far_compare(const float *truth, const float *other, uint32_t side_px, far_errors *errors);

#endif
