// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Backward mapping by bilinear interpolation at the pixels' centres, in linear light: what forward mapping is
// compared with.
#include "texture/texture.h"

#include <math.h>

/// The texel at or beside `index`: wrapped, or the outermost one.
static uint32_t texel_index(double index, uint32_t count, bool repeat) {
    if (repeat) index -= floor(index / count) * count;
    const double last = (double)count - 1;
    return (uint32_t)(index > 0 ? (index < last ? index : last) : 0);
}

/// Interpolates at (u, v), in texels.
static void interpolate(const ewa_texture_plan *plan, double u, double v, float color[4]) {
    const ewa_texture_source *source = &plan->source;
    const bool repeat = plan->options.repeat;
    const double left = floor(u - 0.5), top = floor(v - 0.5);
    const float x = (float)(u - 0.5 - left), y = (float)(v - 0.5 - top);
    const uint32_t columns[2] = {texel_index(left, source->width_px, repeat),
                                 texel_index(left + 1, source->width_px, repeat)};
    const uint32_t rows[2] = {texel_index(top, source->height_px, repeat),
                              texel_index(top + 1, source->height_px, repeat)};
    float corners[2][2][4];
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) ewa_texel_read(source, columns[i], rows[j], corners[j][i]);
    for (int c = 0; c < 4; c++) {
        const float upper = corners[0][0][c] + x * (corners[0][1][c] - corners[0][0][c]);
        const float lower = corners[1][0][c] + x * (corners[1][1][c] - corners[1][0][c]);
        color[c] = upper + y * (lower - upper);
    }
}

bool ewa_texture_interpolate(const ewa_texture_plan *plan, uint32_t x, uint32_t y, float color[4]) {
    const double(*inverse)[3] = (const double(*)[3])plan->inverse;
    double p[3];
    for (int c = 0; c < 3; c++) p[c] = (x + 0.5) * inverse[0][c] + (y + 0.5) * inverse[1][c] + inverse[2][c];
    if (!(p[2] > 0)) return false;
    interpolate(plan, p[0] / p[2], p[1] / p[2], color);
    return true;
}
