// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Float images, sRGB, colour maps.
#ifndef EWA_IMAGE_H
#define EWA_IMAGE_H

#include "ewa/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/// A float image: rows from the top down, pixels interleaved, tightly packed. Colour is linear light.
typedef struct ewa_image {
    ewa_context *context;
    uint32_t width_px, height_px;
    uint32_t channel_count; ///< 1 to 16; colour images: 3 (RGB) or 4 (RGBA, premultiplied)
    float *pixels;          ///< height * width * channel_count numbers
} ewa_image;

/// Makes a black (all zero) image; the caller frees it with ewa_image_free().
/// Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_LIMIT (side over ewa_limits.max_image_side), EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_image_create(ewa_context *context, uint32_t width_px, uint32_t height_px,
                                    uint32_t channel_count, ewa_image *image);

/// Frees the pixels and zeroes the struct; accepts NULL and a zeroed struct.
EWA_API void ewa_image_free(ewa_image *image);

/// Linear light to sRGB and back, the exact piecewise curve of IEC 61966-2-1; input is clamped to [0, 1].
EWA_API float ewa_srgb_from_linear(float linear);
EWA_API float ewa_linear_from_srgb(float srgb);

/// How the colours of points are made from a texture.
typedef enum ewa_texture_filter {
    EWA_TEXTURE_NEAREST = 0, ///< the pixel that the centre is in: sharp and noisy
    EWA_TEXTURE_EWA = 1,     ///< mean of the texture under the surfel's kernel (SS section 5)
    EWA_TEXTURE_OPTIMAL = 2, ///< what makes the drawn surface differ least from the texture (SS appendix A)
} ewa_texture_filter;

/// What lies beyond the edge of a picture.
typedef enum ewa_texture_wrap {
    EWA_TEXTURE_REPEAT = 0, ///< the picture again
    EWA_TEXTURE_CLAMP = 1,  ///< its outermost pixels
} ewa_texture_wrap;

typedef enum ewa_colormap {
    EWA_COLORMAP_VIRIDIS = 0,  ///< dark blue to yellow, even in lightness
    EWA_COLORMAP_TURBO = 1,    ///< rainbow, even in hue
    EWA_COLORMAP_GRAY = 2,     ///< black to white, even in sRGB
    EWA_COLORMAP_PLASMA = 3,   ///< blue over magenta to yellow, even in lightness
    EWA_COLORMAP_INFERNO = 4,  ///< black over red to pale yellow, even in lightness
    EWA_COLORMAP_MAGMA = 5,    ///< black over magenta to cream, even in lightness
    EWA_COLORMAP_CIVIDIS = 6,  ///< blue to yellow, the same without colour vision
    EWA_COLORMAP_COOLWARM = 7, ///< blue over light grey to red, for numbers about a middle
} ewa_colormap;

/// Gives the 8-bit sRGB colour of a number, which is clamped to [0, 1]; NaN counts as 0. Any thread.
EWA_API void ewa_colormap_color(ewa_colormap colormap, double number, uint8_t srgb[3]);

/// Gives the 8-bit sRGB colour of a class of points: codes 0 to 18 are those of ASPRS LAS 1.4 (ground brown, vegetation
/// green, buildings red, water blue), others follow a fixed sequence of colours that are far from each other. Any
/// thread.
EWA_API void ewa_class_color(uint32_t code, uint8_t srgb[3]);

enum { EWA_CLASS_NAME_BYTES = 32 };

/// Writes the name of a class: "ground", of codes above 18 "class 37". Any thread.
EWA_API void ewa_class_name(uint32_t code, char name[EWA_CLASS_NAME_BYTES]);

/// Finds the class that ewa_class_name() calls so, in any case, with '_' or '-' for a blank; false when there is none.
/// Any thread.
EWA_API bool ewa_class_find(const char *name, uint32_t *code);

#ifdef __cplusplus
}
#endif
#endif
