// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the numbers of a "color" mean.
#ifndef EWA_SRC_CLOUD_COLOR_H
#define EWA_SRC_CLOUD_COLOR_H

#include "ewa/cloud.h"
#include "image/srgb.h"

#include <math.h>

/// Linear colour of points that have none.
#define EWA_DEFAULT_GREY 0.6

/// Largest magnitude of a linear colour.
#define EWA_COLOR_LIMIT 1e15

/// Linear light of the 256 sRGB codes in double precision.
typedef struct ewa_color_table {
    double linear_from_u8[256];
} ewa_color_table;

static inline void ewa_color_table_make(ewa_color_table *table) {
    for (int i = 0; i < 256; i++) table->linear_from_u8[i] = ewa_srgb_decode(i / 255.0);
}

static inline double ewa_color_clamp01(double value) { return value < 0 ? 0 : value > 1 ? 1 : value; }

/// Full scale of a type of colours, 0 for floats.
static inline double ewa_color_full_scale(ewa_type type) {
    static const double full_scale[] = {0, 0, 127, 255, 32767, 65535, 2147483647.0, 4294967295.0};
    return full_scale[type];
}

static inline bool ewa_color_is_finite(const ewa_attribute *color, const double *value) {
    bool finite = true;
    for (uint32_t c = 0; c < color->component_count; c++) finite = finite && isfinite(value[c]);
    return finite;
}

/// Straight alpha, [0, 1]; 1 where there is none or a number is not finite.
static inline double ewa_color_alpha(const ewa_attribute *color, const double *value) {
    const double scale = ewa_color_full_scale(color->type);
    if (color->component_count < 4 || !ewa_color_is_finite(color, value)) return 1;
    return ewa_color_clamp01(scale > 0 ? value[3] / scale : value[3]);
}

/// Turns the 3 or 4 numbers of a point into linear light: unsigned integers are sRGB over their whole range,
/// signed ones over their non-negative half, floats are linear, of any sign. False, with EWA_DEFAULT_GREY,
/// where a number is not finite.
static inline bool ewa_color_decode(const ewa_color_table *table, const ewa_attribute *color,
                                    const double *value, double linear[3]) {
    const double scale = ewa_color_full_scale(color->type);
    const bool finite = ewa_color_is_finite(color, value);
    for (int c = 0; c < 3; c++) {
        if (!finite)
            linear[c] = EWA_DEFAULT_GREY;
        else if (color->type == EWA_U8)
            linear[c] = table->linear_from_u8[(int)value[c]];
        else if (scale > 0)
            linear[c] = ewa_srgb_decode(ewa_color_clamp01(value[c] / scale));
        else
            linear[c] = fmin(fmax(value[c], -EWA_COLOR_LIMIT), EWA_COLOR_LIMIT);
    }
    return finite;
}

#endif
