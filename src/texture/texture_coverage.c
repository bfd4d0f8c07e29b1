// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Forward texture mapping: how much of a pixel the texture covers, and writing pixels
// (docs/math.md section 11).
#include "image/srgb.h"
#include "texture/texture.h"

#include <math.h>

static double line_value(const ewa_texture_line *line, double x, double y) {
    return line->a * x + line->b * y + line->c;
}

/// Cuts off what a line has on its negative side; returns the number of corners that are left.
static uint32_t clip(const ewa_texture_line *line, double (*corners)[2], uint32_t count,
                     double (*clipped)[2]) {
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        const double *p = corners[i], *q = corners[(i + 1) % count];
        const double at_p = line_value(line, p[0], p[1]), at_q = line_value(line, q[0], q[1]);
        if (at_p >= 0) {
            clipped[kept][0] = p[0];
            clipped[kept++][1] = p[1];
        }
        if ((at_p >= 0) == (at_q >= 0)) continue;
        const double t = at_p / (at_p - at_q);
        clipped[kept][0] = p[0] + t * (q[0] - p[0]);
        clipped[kept++][1] = p[1] + t * (q[1] - p[1]);
    }
    return kept;
}

bool ewa_texture_covers(const ewa_texture_plan *plan, uint32_t x, uint32_t y, uint32_t width,
                        uint32_t height) {
    for (uint32_t i = 0; i < plan->edge_count; i++) {
        const ewa_texture_line *edge = &plan->edges[i];
        const double far_x = edge->a < 0 ? (double)x + width : x,
                     far_y = edge->b < 0 ? (double)y + height : y;
        if (!(line_value(edge, far_x, far_y) >= 0)) return false;
    }
    return true;
}

double ewa_texture_coverage(const ewa_texture_plan *plan, uint32_t x, uint32_t y) {
    bool whole = true;
    for (uint32_t i = 0; i < plan->edge_count; i++) {
        const ewa_texture_line *edge = &plan->edges[i];
        const double middle = line_value(edge, x + 0.5, y + 0.5),
                     reach = 0.5 * (fabs(edge->a) + fabs(edge->b));
        if (middle < -reach) return 0;
        whole = whole && middle >= reach;
    }
    if (whole) return 1;
    // Relative to the pixel, so that areas keep their digits.
    double polygons[2][8][2] = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    uint32_t count = 4;
    for (uint32_t i = 0; i < plan->edge_count && count; i++) {
        ewa_texture_line edge = plan->edges[i];
        edge.c += edge.a * x + edge.b * y;
        count = clip(&edge, polygons[i % 2], count, polygons[(i + 1) % 2]);
    }
    double twice = 0;
    const double(*corners)[2] = (const double(*)[2])polygons[plan->edge_count % 2];
    for (uint32_t i = 0; i < count; i++) {
        const double *p = corners[i], *q = corners[(i + 1) % count];
        twice += p[0] * q[1] - q[0] * p[1];
    }
    return fmin(fmax(0.5 * twice, 0), 1);
}

void ewa_texture_put(const ewa_texture_plan *plan, uint32_t x, uint32_t y, const float color[4],
                     float coverage) {
    const ewa_texture_target *target = &plan->target;
    const float *background = plan->options.background;
    float out[4];
    const float alpha = color[3] * coverage, behind = (1 - alpha) * background[3];
    for (int c = 0; c < 3; c++) out[c] = color[c] * coverage + behind * background[c];
    out[3] = alpha + behind;
    char *row = (char *)target->pixels + (size_t)y * target->stride_bytes;
    if (target->format == EWA_PIXEL_LINEAR) {
        float *pixel = (float *)(void *)row + (size_t)x * target->channel_count;
        for (uint32_t c = 0; c < target->channel_count; c++) pixel[c] = out[c];
        return;
    }
    uint8_t *pixel = (uint8_t *)row + (size_t)x * target->channel_count;
    if (target->channel_count == 4) {
        const float straight = out[3] > 0 && out[3] < 1 ? 1 / out[3] : 1;
        pixel[3] = (uint8_t)(255 * fminf(fmaxf(out[3], 0), 1) + 0.5f);
        for (int c = 0; c < 3; c++) pixel[c] = pixel[3] ? ewa_srgb8_from_linear(out[c] * straight) : 0;
    } else {
        for (uint32_t c = 0; c < target->channel_count; c++) pixel[c] = ewa_srgb8_from_linear(out[c]);
    }
}
