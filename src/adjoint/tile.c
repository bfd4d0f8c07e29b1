// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One tile: which splats count at which of its pixels, what these show, and back to sums of its splats (docs/math.md
// section 15). Each term is rounded once to a whole number of units and added as such: neither the order of the
// splats nor how the picture is cut into tiles changes a byte.
#include "adjoint/tiles.h"
#include "base/base.h"

#include <string.h>

/// The power of two that is at most `size`, which is positive; 1 for what is not finite.
static double power_of(double size) { return size > 0 && isfinite(size) ? ldexp(1, ilogb(size)) : 1; }

void ewa_adjoint_scales(const ewa_adjoint_job *job, const ewa_reference_splat *splat, double scales[EWA_MOMENT_COUNT]) {
    const ewa_adjoint_units *units = &job->units;
    for (int m = 0; m < EWA_MOMENT_COUNT; m++) scales[m] = m < EWA_MOMENT_OPACITY ? units->color : units->other;
    if (splat->by_rays) return;
    // Places from the centre in the standard deviations of the filtered ellipse.
    const double *q = splat->inverse, determinant = q[0] * q[2] - q[1] * q[1];
    const double x = 1 / power_of(sqrt(q[2] / determinant)), y = 1 / power_of(sqrt(q[0] / determinant));
    scales[EWA_MOMENT_FIRST] *= x, scales[EWA_MOMENT_FIRST + 1] *= y;
    scales[EWA_MOMENT_SECOND] *= x * x;
    scales[EWA_MOMENT_SECOND + 1] *= x * y;
    scales[EWA_MOMENT_SECOND + 2] *= y * y;
    const double depth = units->depth / (job->frame.view.orthographic ? 1 : power_of(splat->center.z));
    scales[EWA_MOMENT_DEPTH] = depth * x, scales[EWA_MOMENT_DEPTH + 1] = depth * y;
    scales[EWA_MOMENT_DEPTH + 2] = depth;
}

/// A term in units; 0 of what is no number, which comes of colours that are not finite.
static inline int64_t whole_units(double term, double scale) {
    const double exact = term * scale, most = 0x1p52;
    if (!(exact > -most && exact < most)) return isnan(exact) ? 0 : exact < 0 ? -(INT64_C(1) << 52) : INT64_C(1) << 52;
    return (int64_t)(exact < 0 ? exact - 0.5 : exact + 0.5);
}

/// The cotangents of a pixel; depths per unit of the view.
static ewa_reference_values cotangent_of(const ewa_adjoint_job *job, size_t index) {
    const ewa_frame_cotangent *from = &job->cotangent;
    ewa_reference_values values = {.depth = 0};
    for (size_t c = 0; c < 4 && from->rgba; c++) values.rgba[c] = (double)from->rgba[4 * index + c];
    for (size_t c = 0; c < 3 && from->normal; c++) values.normal[c] = (double)from->normal[3 * index + c];
    if (from->depth) values.depth = (double)from->depth[index] * job->frame.view.placement.unit;
    if (from->coverage) values.coverage = (double)from->coverage[index];
    return values;
}

/// A worker of a job.
typedef struct pixel_work {
    const ewa_adjoint_job *job;
    ewa_adjoint_scratch *scratch;
} pixel_work;

/// Goes through one pixel; an ewa_reference_pixel.
static void draw_pixel(void *user, uint32_t x, uint32_t y, ewa_reference_fragment *fragments, uint32_t count) {
    const pixel_work *work = user;
    const ewa_adjoint_job *job = work->job;
    ewa_adjoint_scratch *s = work->scratch;
    const ewa_reference_resolve *to = &job->frame.resolve;
    const size_t index = (size_t)y * job->tiles.width_px + x;
    const double x_px = x + 0.5, y_px = y + 0.5;
    const uint32_t layer_count = ewa_reference_layers_find(to, x_px, y_px, fragments, count, s->rows.layers);
    if (job->gradient.rgba) {
        const ewa_reference_values shown = ewa_reference_layers_show(to, s->rows.layers, layer_count);
        memcpy(job->gradient.rgba + 4 * index, shown.rgba, sizeof shown.rgba);
    }
    if (layer_count == 0 || job->width == 0) return;
    const ewa_reference_values cotangent = cotangent_of(job, index);
    double camera[EWA_CAMERA_NUMBERS] = {0};
    ewa_reference_layers_pull_back(to, x_px, y_px, &cotangent, s->rows.layers, layer_count, camera);
    for (int i = 0; i < EWA_CAMERA_NUMBERS && s->camera; i++)
        if (camera[i] != 0) ewa_exact_add(&s->camera[i], camera[i]);
    for (uint32_t i = 0; i < count; i++) {
        const ewa_reference_fragment *from = &fragments[i];
        if (from->layer == EWA_NO_LAYER) continue;
        double terms[EWA_MOMENT_COUNT];
        ewa_reference_moments_at(to->view, from->splat, &from->sample, x_px, y_px, to->layering.transparent,
                                 &s->rows.layers[from->layer].cotangent, terms);
        int64_t *sums = s->moments[from->index];
        const double *scales = s->scales[from->index];
        for (uint32_t m = 0; m < job->width; m++) sums[m] += whole_units(terms[m], scales[m]);
    }
}

/// Where the sums of a splat in a tile go.
static int64_t *slot_of(const ewa_adjoint_job *job, uint32_t point, uint32_t tile) {
    const ewa_reference_tiles *range = &job->ranges[point];
    const uint32_t column = tile % job->tiles.columns - (range->first & 0xffff);
    const uint32_t row = tile / job->tiles.columns - (range->first >> 16);
    const uint32_t columns = (range->end & 0xffff) - (range->first & 0xffff);
    return job->slots + (job->first_slots[point] + (uint64_t)row * columns + column) * job->width;
}

void ewa_adjoint_tile(void *data, uint32_t index, uint32_t worker) {
    const ewa_adjoint_job *job = data;
    ewa_adjoint_scratch *s = &job->scratch[worker];
    const ewa_tile_rect place = ewa_tiles_rect(&job->tiles, index);
    const uint64_t first = job->lists.starts[index];
    const uint32_t count = (uint32_t)(job->lists.starts[index + 1] - first);
    const uint32_t *points = count ? job->lists.ids + first : NULL;
    ewa_reference_rows_fill(&job->frame, &s->rows, points, count);
    for (uint32_t k = 0; k < count; k++) ewa_adjoint_scales(job, &s->rows.splats[k], s->scales[k]);
    if (count) memset(s->moments, 0, count * sizeof *s->moments);
    pixel_work work = {job, s};
    for (uint32_t y = place.y_px; y < place.y_px + place.height_px && ewa_goes_on(job->frame.context, worker); y++)
        ewa_reference_rows_walk(&job->frame, &s->rows, count, place.x_px, place.width_px, y, draw_pixel, &work);
    for (uint32_t k = 0; k < count && job->width; k++)
        memcpy(slot_of(job, points[k], index), s->moments[k], job->width * sizeof(int64_t));
}
