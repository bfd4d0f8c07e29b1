// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Means of a picture under Gaussians of any size and shape.
#ifndef EWA_SRC_IMAGE_TEXTURE_H
#define EWA_SRC_IMAGE_TEXTURE_H

#include "ewa/image.h"

enum { EWA_TEXTURE_LEVELS = 17 };

/// The picture, or a copy of it, a box mean of the one before.
typedef struct ewa_texture_level {
    const float *pixels;    ///< premultiplied
    uint32_t channel_count; ///< 1, 3 or 4, as an image has them; 4 of copies
    uint32_t width_px, height_px;
    double scale[2]; ///< pixels of this level per pixel of the picture, across and down
    double blur[2];  ///< variance of the boxes, in pixels^2 of the picture
} ewa_texture_level;

typedef struct ewa_texture {
    ewa_context *context;
    ewa_texture_level levels[EWA_TEXTURE_LEVELS]; ///< the last has one pixel
    uint32_t level_count;                         ///< 0: no picture
    bool repeats[2];                              ///< across, down
    bool opaque, owns_first; ///< owns_first: the first level is a copy
} ewa_texture;

/// Makes the smaller copies of a picture of 1, 3 or 4 channels, whose pixels it borrows; where some are no numbers, it takes a
/// copy with zeros there. Progress stage: "texture", 0. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_MEMORY, EWA_CANCELLED; the texture
/// is then zeroed.
ewa_status ewa_texture_make(const ewa_image *image, ewa_texture_wrap wrap_s, ewa_texture_wrap wrap_t,
                            ewa_texture *texture);
void ewa_texture_free(ewa_texture *texture);

/// A Gaussian on the picture: centre and covariance in pixels of the picture, y down.
typedef struct ewa_texture_gauss {
    double x_px, y_px;
    double xx_px2, xy_px2, yy_px2;
} ewa_texture_gauss;

/// Makes a Gaussian at most 16 times as long as wide, by making it wider.
void ewa_texture_round(ewa_texture_gauss *gauss);

/// The smallest copy on which the Gaussian's minor standard deviation is still a pixel.
uint32_t ewa_texture_level_of(const ewa_texture *texture, const ewa_texture_gauss *gauss);

/// Mean of a level under a Gaussian that is not longer than ewa_texture_round() makes it. The level's own
/// blur is taken off. Any thread.
void ewa_texture_mean(const ewa_texture *texture, uint32_t level, const ewa_texture_gauss *gauss,
                      double color[4]);

/// The pixel of the picture at a place.
void ewa_texture_nearest(const ewa_texture *texture, double x_px, double y_px, double color[4]);

#endif
