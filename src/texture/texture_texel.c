// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One texel in double precision: how it is seen, its weight at a pixel, its colour.
//
// Based on: Yuan et al., "Hybrid Forward Resampling and Volume Rendering", 2003, section 3; Zwicker et al.,
// "Perspective Accurate Splatting", 2004, section 4 (docs/math.md sections 3, 4, 11).
#include "image/srgb.h"
#include "math/ellipse.h"
#include "texture/texture.h"

#include <math.h>

/// Tangents of the texel's disc after the map, sheared so that the texel's centre is on the axis: pixels
/// times w.
static void shear_tangents(const ewa_texture_plan *plan, const double center_px[2], double tangents[2][3]) {
    for (int i = 0; i < 2; i++) {
        const double *row = plan->map[i], sigma = plan->options.sigma_texels;
        tangents[i][0] = sigma * (row[0] - center_px[0] * row[2]);
        tangents[i][1] = sigma * (row[1] - center_px[1] * row[2]);
        tangents[i][2] = sigma * row[2];
    }
}

/// Homogeneous image of (u, v), divided but for w.
static double project(const ewa_texture_plan *plan, double u, double v, double center_px[2]) {
    double p[3];
    for (int c = 0; c < 3; c++) p[c] = u * plan->map[0][c] + v * plan->map[1][c] + plan->map[2][c];
    for (int c = 0; c < 2; c++) center_px[c] = p[c] / p[2];
    return p[2];
}

bool ewa_texel_place(const ewa_texture_plan *plan, double u, double v, bool as_point,
                     ewa_texel_kernel *kernel) {
    const double h2 = plan->options.prefilter_px * plan->options.prefilter_px, f = plan->options.cutoff;
    const double sigma2 = plan->options.sigma_texels * plan->options.sigma_texels;
    double center[2];
    const double w = project(plan, u, v, center);
    *kernel = (ewa_texel_kernel){.amplitude = 1, .half_px = {INFINITY, INFINITY}, .center_texels = {u, v}};
    if (as_point) {
        // The limit of the splat where its disc is small: a circular filter, scaled by the area of the disc.
        if (!(w > 0)) return false;
        for (int c = 0; c < 2; c++) {
            kernel->center_px[c] = center[c];
            kernel->half_px[c] = f * plan->options.prefilter_px;
        }
        kernel->conic[0] = kernel->conic[2] = 1 / h2;
        kernel->amplitude = sigma2 * plan->determinant / (w * w * w * h2);
        return isfinite(kernel->amplitude);
    }
    if (!(w > EWA_TEXTURE_NEAR * f * plan->tangent_w)) {
        kernel->along_rays = true;
        return w > -f * plan->tangent_w;
    }
    double t[2][3];
    shear_tangents(plan, center, t);
    static const int first[5] = {0, 0, 1, 0, 1}, second[5] = {0, 1, 1, 2, 2}; // xx, xy, yy, xw, yw
    double s[5], shift[2], variance[3];
    for (int i = 0; i < 5; i++) s[i] = t[0][first[i]] * t[0][second[i]] + t[1][first[i]] * t[1][second[i]];
    const double sum_ww = t[0][2] * t[0][2] + t[1][2] * t[1][2], k = 1 / (w * w - f * f * sum_ww);
    ewa_ellipse_project(s, k, f * f, variance, shift);
    const double xx = variance[0] + h2, xy = variance[1], yy = variance[2] + h2, filtered = xx * yy - xy * xy;
    for (int c = 0; c < 2; c++) kernel->center_px[c] = center[c] + shift[c];
    kernel->conic[0] = yy / filtered;
    kernel->conic[1] = -xy / filtered;
    kernel->conic[2] = xx / filtered;
    kernel->half_px[0] = f * sqrt(xx);
    kernel->half_px[1] = f * sqrt(yy);
    kernel->amplitude = sigma2 * plan->determinant * k * sqrt(k) / sqrt(filtered);
    return isfinite(kernel->amplitude);
}

bool ewa_texel_is_minified(const ewa_texture_plan *plan, double u, double v) {
    double center[2];
    const double w = project(plan, u, v, center), limit = plan->options.point_spacing_px * w;
    bool minified = w > EWA_TEXTURE_NEAR * plan->options.cutoff * plan->tangent_w;
    for (int i = 0; i < 2; i++) {
        const double *row = plan->map[i];
        const double x = row[0] - center[0] * row[2], y = row[1] - center[1] * row[2];
        minified = minified && x * x + y * y <= limit * limit;
    }
    return minified;
}

/// exp(-x) for x in [0, 64], to 1e-15, of exact operations only: halved until the series is short.
static double exp_minus(double x) {
    const double y = x * 0x1p-7;
    double series = 1;
    for (int n = 10; n > 0; n--) series = 1 - series * y / n;
    for (int i = 0; i < 7; i++) series *= series;
    return series;
}

double ewa_texel_weight(const ewa_texture_plan *plan, const ewa_texel_kernel *kernel, double x_px,
                        double y_px) {
    const double f = plan->options.cutoff;
    double r2;
    if (kernel->along_rays) {
        double p[3];
        for (int c = 0; c < 3; c++)
            p[c] = x_px * plan->inverse[0][c] + y_px * plan->inverse[1][c] + plan->inverse[2][c];
        if (!(p[2] > 0)) return 0;
        const double du = (p[0] / p[2] - kernel->center_texels[0]) / plan->options.sigma_texels;
        const double dv = (p[1] / p[2] - kernel->center_texels[1]) / plan->options.sigma_texels;
        r2 = du * du + dv * dv;
    } else {
        const double dx = x_px - kernel->center_px[0], dy = y_px - kernel->center_px[1];
        r2 = kernel->conic[0] * dx * dx + 2 * kernel->conic[1] * dx * dy + kernel->conic[2] * dy * dy;
    }
    return r2 < f * f ? kernel->amplitude * exp_minus(0.5 * r2) : 0;
}

void ewa_texel_read_row(const ewa_texture_source *source, uint32_t column, uint32_t row, uint32_t count,
                        float (*colors)[4]) {
    const uint32_t channels = source->channel_count;
    const char *line = (const char *)source->pixels + (size_t)row * source->stride_bytes;
    if (source->format == EWA_PIXEL_LINEAR) {
        const float *from = (const float *)(const void *)line + (size_t)column * channels;
        for (uint32_t i = 0; i < count; i++, from += channels) {
            colors[i][0] = from[0];
            colors[i][1] = from[channels > 1 ? 1 : 0];
            colors[i][2] = from[channels > 1 ? 2 : 0];
            colors[i][3] = channels == 4 ? from[3] : 1;
        }
        return;
    }
    const uint8_t *from = (const uint8_t *)line + (size_t)column * channels;
    if (channels == 1) {
        for (uint32_t i = 0; i < count; i++, from++) {
            for (int c = 0; c < 3; c++) colors[i][c] = ewa_srgb_decoded[from[0]];
            colors[i][3] = 1;
        }
        return;
    }
    for (uint32_t i = 0; i < count; i++, from += channels) {
        for (int c = 0; c < 3; c++) colors[i][c] = ewa_srgb_decoded[from[c]];
        colors[i][3] = 1;
        if (channels == 3 || from[3] == 255) continue;
        colors[i][3] = (float)from[3] / 255;
        for (int c = 0; c < 3; c++) colors[i][c] *= colors[i][3];
    }
}

void ewa_texel_read(const ewa_texture_source *source, uint32_t column, uint32_t row, float color[4]) {
    float texel[1][4];
    ewa_texel_read_row(source, column, row, 1, texel);
    for (int c = 0; c < 4; c++) color[c] = texel[0][c];
}
