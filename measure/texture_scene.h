// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Textured floors with supersampled truth, for measuring what texture mapping blurs and what it aliases.
//
// The truth is cast from an image with twice the resolution of the texture along each axis, by 32 x 32 rays
// per pixel (1,024), averaged in linear light. The floor is eight copies of the image, one behind the other:
// texels are three pixels wide at the lower edge of the picture, and a pixel holds hundreds of them at the
// far end.
#ifndef EWA_TESTS_QUALITY_TEXTURE_SCENE_H
#define EWA_TESTS_QUALITY_TEXTURE_SCENE_H

#include "ewa/ewa.h"

enum { TEXTURE_SIDE = 512, TEXTURE_BANDS = 3, TEXTURE_COPIES = 8, TEXTURE_RAYS = 32 };

/// A floor, its texture and the true picture.
typedef struct texture_scene {
    ewa_image fine;    ///< 3 channels
    ewa_image texture; ///< 3 channels, averages of 2 x 2
    ewa_mat3 map;      ///< of the texture
    ewa_image truth;   ///< 3 channels, TEXTURE_SIDE square
    /// 0 (near): under one texel per pixel, 1 (middle): under 16, 2 (horizon); -1: not wholly covered.
    int8_t band[TEXTURE_SIDE][TEXTURE_SIDE];
} texture_scene;

/// PSNR in dB of sRGB numbers, by bands.
typedef struct texture_errors {
    double psnr_db[TEXTURE_BANDS], all_db;
} texture_errors;

/// Makes the scene of an image file, or, when `path` is NULL, of a checkerboard of 24 x 16 squares, 16 texels
/// wide. Errors are those of the library; free in any case.
ewa_status texture_scene_make(ewa_context *context, const char *path, texture_scene *scene);
void texture_scene_free(texture_scene *scene);

/// Draws the scene, linear floats with 3 channels.
ewa_status texture_scene_draw(ewa_context *context, const texture_scene *scene,
                              const ewa_texture_options *options, ewa_image *picture,
                              ewa_texture_stats *stats);

/// Compares a picture of 3 or 4 channels with the truth.
texture_errors texture_scene_compare(const texture_scene *scene, const ewa_image *picture);

/// PSNR in dB of the sRGB numbers of two pictures of 3 channels over one band; over all bands when it is
/// negative.
double texture_psnr_db(const texture_scene *scene, const ewa_image *a, const ewa_image *b, int band);

/// What a source or target of floats is to the library.
ewa_texture_source texture_source_of(const ewa_image *image);
ewa_texture_target texture_target_of(const ewa_image *image);

#endif
