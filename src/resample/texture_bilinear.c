// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Backward mapping by bilinear interpolation at the pixels' centres, in linear light: what forward mapping is
// compared with.
#include "resample/texture.h"

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

void ewa_texture_bilinear(const ewa_texture_plan *plan, uint32_t x, uint32_t y, uint32_t width,
                          uint32_t height) {
    const double(*inverse)[3] = (const double(*)[3])plan->inverse;
    const bool inside = ewa_texture_covers(plan, x, y, width, height);
    for (uint32_t row = y; row < y + height; row++) {
        for (uint32_t column = x; column < x + width; column++) {
            double p[3];
            for (int c = 0; c < 3; c++)
                p[c] = (column + 0.5) * inverse[0][c] + (row + 0.5) * inverse[1][c] + inverse[2][c];
            float color[4] = {0};
            double coverage = inside ? 1 : ewa_texture_coverage(plan, column, row);
            if (coverage > 0 && p[2] > 0)
                interpolate(plan, p[0] / p[2], p[1] / p[2], color);
            else
                coverage = 0;
            ewa_texture_put(plan, column, row, color, (float)coverage);
        }
    }
}
