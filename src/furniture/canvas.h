// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What all drawing on a canvas is made of: colours, coverage, blending.
#ifndef EWA_SRC_FURNITURE_CANVAS_H
#define EWA_SRC_FURNITURE_CANVAS_H

#include "ewa/furniture.h"
#include "image/srgb.h"

/// Coordinates beyond are not drawn: what is left is far within the range of int.
#define EWA_CANVAS_FARTHEST_PX 1e6

/// A colour ready for blending.
typedef struct ewa_paint {
    float linear[3], alpha;
} ewa_paint;

static inline ewa_paint ewa_paint_make(const uint8_t rgba[4]) {
    return (ewa_paint){{ewa_srgb_decoded[rgba[0]], ewa_srgb_decoded[rgba[1]], ewa_srgb_decoded[rgba[2]]},
                       (float)rgba[3] / 255};
}

/// Part of a pixel that a stripe of half width `radius` covers whose middle line passes its centre at `distance`,
/// parallel to two of its sides.
static inline double ewa_stripe_coverage(double distance, double radius) {
    const double high = distance + 0.5 < radius ? distance + 0.5 : radius;
    const double low = distance - 0.5 > -radius ? distance - 0.5 : -radius;
    return high > low ? high - low : 0;
}

/// Puts a colour over a part of a pixel.
static inline void ewa_paint_pixel(uint8_t pixel[4], const ewa_paint *paint, float coverage) {
    const float over = coverage * paint->alpha;
    if (!(over > 0)) return;
    const float under = (1 - over) * ((float)pixel[3] / 255), alpha = over + under;
    for (int c = 0; c < 3; c++)
        pixel[c] =
            ewa_srgb8_from_linear((over * paint->linear[c] + under * ewa_srgb_decoded[pixel[c]]) / alpha);
    pixel[3] = (uint8_t)(alpha * 255 + 0.5f);
}

/// Whether coordinates are near enough to be drawn; false for NaN.
static inline bool ewa_canvas_near(double x_px, double y_px) {
    return x_px >= -EWA_CANVAS_FARTHEST_PX && x_px <= EWA_CANVAS_FARTHEST_PX &&
           y_px >= -EWA_CANVAS_FARTHEST_PX && y_px <= EWA_CANVAS_FARTHEST_PX;
}

/// The first pixel at or after a coordinate, and the last one before it, within [0, size].
static inline int ewa_canvas_clip(double px, uint32_t size_px) {
    return px > 0 ? (px < size_px ? (int)px : (int)size_px) : 0;
}

#endif
