// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A frame on its way back: lists of each tile's splats, the tiles, and from each splat's sums to its point and the
// camera.
#include "adjoint/tiles.h"
#include "base/base.h"

#include <string.h>

enum {
    CHAIN_POINTS = 1024, ///< points per piece of parallel work
    BLOCK_POINTS = 32,   ///< that are read together
    UNIT_BITS = 36,      ///< units per bound of a term
};

static uint32_t find_splats(const void *data, uint32_t worker, uint32_t first, uint32_t count,
                            const ewa_bin_items *items) {
    const ewa_adjoint_job *job = data;
    ewa_adjoint_scratch *s = &job->scratch[worker];
    uint32_t next = first;
    ewa_surfel surfels[BLOCK_POINTS];
    ewa_reference_splat splats[BLOCK_POINTS];
    for (uint32_t i = first; i < first + count; i++) {
        const uint32_t in_block = (i - first) % BLOCK_POINTS, left = first + count - i;
        if (in_block == 0)
            ewa_reference_frame_project(&job->frame, i, left < BLOCK_POINTS ? left : BLOCK_POINTS, surfels, splats);
        const ewa_reference_splat *splat = &splats[in_block];
        const ewa_reference_tiles range = job->ranges[i] = ewa_reference_tiles_of(splat, job->tiles.side_px);
        if (range.end == 0) continue;
        items->ids[next] = (int32_t)i, items->first[next] = (int32_t)range.first, items->end[next] = (int32_t)range.end;
        next++;
        const double color = fmax(fabs(splat->color.x), fmax(fabs(splat->color.y), fabs(splat->color.z)));
        s->largest_color = fmax(s->largest_color, color);
        s->largest_depth = fmax(s->largest_depth, fabs(splat->center.z) + splat->half_range);
    }
    return next - first;
}

static double largest_of(const float *plane, size_t count) {
    float largest = 0;
    for (size_t i = 0; i < count && plane; i++) largest = fmaxf(fabsf(plane[i]), largest);
    return (double)largest;
}

/// What terms are rounded to: 2^-36 of what none is much larger than.
static void set_units(ewa_adjoint_job *job) {
    const size_t pixels = (size_t)job->tiles.width_px * job->tiles.height_px;
    const ewa_shading_setup *shading = &job->frame.shading;
    double color = 0, depth = 0, light = 1;
    for (uint32_t i = 0; i < job->worker_count; i++) {
        color = fmax(color, job->scratch[i].largest_color);
        depth = fmax(depth, job->scratch[i].largest_depth);
    }
    for (uint32_t i = 0; i < shading->light_count && shading->lit; i++)
        light += fmax(shading->lights[i].color[0], fmax(shading->lights[i].color[1], shading->lights[i].color[2]));
    const double by_color = largest_of(job->cotangent.rgba, 4 * pixels) * light;
    const double by_depth = largest_of(job->cotangent.depth, pixels) * job->frame.view.placement.unit * depth;
    const double others = by_color * (1 + color) + by_depth + largest_of(job->cotangent.normal, 3 * pixels) +
                          largest_of(job->cotangent.coverage, pixels) / job->frame.resolve.unit_coverage;
    const double bounds[3] = {by_color, others, by_depth};
    double *const units[3] = {&job->units.color, &job->units.other, &job->units.depth};
    for (int i = 0; i < 3; i++) *units[i] = bounds[i] > 0 ? ldexp(1, UNIT_BITS - ilogb(bounds[i])) : 1;
}

/// Points at a part of a stream where it is wanted.
static void store_point(double *stream, uint64_t point, int components, const double *values) {
    if (stream) memcpy(stream + point * (uint64_t)components, values, (size_t)components * sizeof *values);
}

/// The sums of a splat over all of its tiles.
static void add_slots(const ewa_adjoint_job *job, uint64_t point, const double scales[EWA_MOMENT_COUNT],
                      double moments[EWA_MOMENT_COUNT]) {
    int64_t sums[EWA_MOMENT_COUNT] = {0};
    for (uint64_t slot = job->first_slots[point]; slot < job->first_slots[point + 1]; slot++)
        for (uint32_t m = 0; m < job->width; m++) sums[m] += job->slots[slot * job->width + m];
    for (int m = 0; m < EWA_MOMENT_COUNT; m++) moments[m] = (double)sums[m] / scales[m];
}

static void pull_back_point(const ewa_adjoint_job *job, ewa_adjoint_scratch *s, uint64_t point) {
    ewa_reference_point_cotangent at;
    memset(&at, 0, sizeof at);
    if (job->ranges[point].end != 0) {
        double scales[EWA_MOMENT_COUNT], moments[EWA_MOMENT_COUNT], camera[EWA_CAMERA_NUMBERS] = {0};
        ewa_surfel surfel;
        ewa_reference_splat splat;
        ewa_reference_surfel_cotangent of_surfel;
        ewa_reference_frame_project(&job->frame, point, 1, &surfel, &splat);
        ewa_adjoint_scales(job, &splat, scales);
        add_slots(job, point, scales, moments);
        ewa_reference_moments_pull_back(&job->frame.view, &splat, &surfel, moments, &of_surfel, camera);
        ewa_reference_surfel_pull_back(&job->frame.reader, point, &surfel, &of_surfel, &at);
        for (int i = 0; i < EWA_CAMERA_NUMBERS && s->camera; i++) ewa_exact_add(&s->camera[i], camera[i]);
    }
    const ewa_gradient *to = &job->gradient;
    store_point(to->color, point, 3, at.color);
    store_point(to->opacity, point, 1, &at.opacity);
    store_point(to->position, point, 3, at.position);
    store_point(to->normal, point, 3, at.normal);
    store_point(to->radius, point, 1, &at.radius);
    store_point(to->tangent_u, point, 3, at.tangent_u);
    store_point(to->tangent_v, point, 3, at.tangent_v);
}

static void pull_back_piece(void *data, uint32_t index, uint32_t worker) {
    const ewa_adjoint_job *job = data;
    const uint64_t count = job->frame.point_count, begin = (uint64_t)index * CHAIN_POINTS;
    for (uint64_t i = begin; i < begin + CHAIN_POINTS && i < count; i++) {
        if (job->width > EWA_MOMENT_OPACITY) {
            pull_back_point(job, &job->scratch[worker], i);
            continue;
        }
        double moments[EWA_MOMENT_COUNT], scales[EWA_MOMENT_COUNT];
        for (int m = 0; m < EWA_MOMENT_COUNT; m++) scales[m] = job->units.color;
        add_slots(job, i, scales, moments);
        store_point(job->gradient.color, i, 3, moments + EWA_MOMENT_COLOR);
    }
}

/// Gives the workers what they need for the tiles.
static ewa_status reserve(ewa_adjoint_job *job) {
    ewa_context *context = job->frame.context;
    const uint64_t splats = job->lists.largest;
    for (uint32_t i = 0; i < job->worker_count; i++) {
        ewa_adjoint_scratch *s = &job->scratch[i];
        EWA_TRY(ewa_reference_rows_reserve(context, &s->rows, (uint32_t)splats, job->frame.resolve.layering.most,
                                          job->tiles.side_px));
        s->moments = ewa_allocate(context, splats, sizeof *s->moments);
        s->scales = ewa_allocate(context, splats, sizeof *s->scales);
        if (!s->moments || !s->scales) return EWA_ERROR_MEMORY;
    }
    return EWA_OK;
}

static void release(ewa_adjoint_job *job) {
    ewa_context *context = job->frame.context;
    for (uint32_t i = 0; job->scratch && i < job->worker_count; i++) {
        ewa_adjoint_scratch *s = &job->scratch[i];
        const size_t splats = s->rows.capacity;
        ewa_reference_rows_free(context, &s->rows);
        ewa_release(context, s->moments, splats, sizeof *s->moments);
        ewa_release(context, s->scales, splats, sizeof *s->scales);
        ewa_release(context, s->camera, EWA_CAMERA_NUMBERS, sizeof *s->camera);
    }
    const uint64_t points = job->frame.point_count;
    if (job->slots) ewa_release(context, job->slots, job->first_slots[points] * job->width, sizeof *job->slots);
    ewa_release(context, job->scratch, job->worker_count, sizeof *job->scratch);
    ewa_release(context, job->first_slots, points + 1, sizeof *job->first_slots);
    ewa_release(context, job->ranges, points, sizeof *job->ranges);
    ewa_bin_lists_free(context, &job->lists);
}

/// Makes what finding splats needs.
static ewa_status start(ewa_adjoint_job *job) {
    ewa_context *context = job->frame.context;
    job->worker_count = ewa_context_worker_count(context);
    job->ranges = ewa_allocate(context, job->frame.point_count, sizeof *job->ranges);
    job->first_slots = ewa_allocate(context, job->frame.point_count + 1, sizeof *job->first_slots);
    job->scratch = ewa_allocate_zeroed(context, job->worker_count, sizeof *job->scratch);
    if (!job->ranges || !job->first_slots || !job->scratch) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < job->worker_count && job->gradient.camera; i++) {
        job->scratch[i].camera = ewa_allocate_zeroed(context, EWA_CAMERA_NUMBERS, sizeof *job->scratch[i].camera);
        if (!job->scratch[i].camera) return EWA_ERROR_MEMORY;
    }
    return EWA_OK;
}

/// Gives each splat as many slots as it has tiles.
static ewa_status place_slots(ewa_adjoint_job *job) {
    uint64_t sum = 0;
    for (uint64_t i = 0; i < job->frame.point_count; i++) {
        const ewa_reference_tiles *range = &job->ranges[i];
        job->first_slots[i] = sum;
        const uint32_t columns = (range->end & 0xffff) - (range->first & 0xffff);
        sum += (uint64_t)columns * ((range->end >> 16) - (range->first >> 16));
    }
    job->first_slots[job->frame.point_count] = sum;
    job->slots = ewa_allocate(job->frame.context, sum * job->width, sizeof *job->slots);
    return job->slots ? EWA_OK : EWA_ERROR_MEMORY;
}

/// The camera's numbers, each the exact sum of all.
static void store_camera(const ewa_adjoint_job *job) {
    ewa_camera_cotangent *to = job->gradient.camera;
    if (!to) return;
    double *const members[EWA_CAMERA_NUMBERS] = {
        &to->rotation[0],    &to->rotation[1],    &to->rotation[2], &to->translation[0], &to->translation[1],
        &to->translation[2], &to->focal_px[0],    &to->focal_px[1], &to->principal_px[0], &to->principal_px[1]};
    for (int i = 0; i < EWA_CAMERA_NUMBERS; i++) {
        ewa_exact_sum sum = {.not_finite = false};
        for (uint32_t worker = 0; worker < job->worker_count; worker++)
            ewa_exact_join(&sum, &job->scratch[worker].camera[i]);
        *members[i] = ewa_exact_value(&sum);
    }
}

void ewa_adjoint_warn_unseen(ewa_context *context, uint64_t point_count, uint32_t width_px, uint32_t height_px) {
    ewa_report(context, EWA_SEVERITY_WARNING, "gradients: none of %llu surfels is in the picture of %u x %u pixels",
               (unsigned long long)point_count, width_px, height_px);
}

static ewa_status run(ewa_adjoint_job *job) {
    ewa_context *context = job->frame.context;
    EWA_TRY(start(job));
    EWA_TRY(ewa_bin_lists_fill(context, &job->lists, job->tiles.columns, job->tiles.rows,
                               (uint32_t)job->frame.point_count, find_splats, job));
    if (job->lists.item_count == 0)
        ewa_adjoint_warn_unseen(context, job->frame.point_count, job->tiles.width_px, job->tiles.height_px);
    set_units(job);
    EWA_TRY(place_slots(job));
    EWA_TRY(reserve(job));
    EWA_TRY(ewa_parallel_within(context, "gradients", 0.1, 0.9, ewa_adjoint_tile, job, ewa_tiles_count(&job->tiles)));
    if (job->width)
        EWA_TRY(ewa_parallel_within(context, "gradients", 0.9, 1, pull_back_piece, job,
                                    (uint32_t)((job->frame.point_count + CHAIN_POINTS - 1) / CHAIN_POINTS)));
    store_camera(job);
    return EWA_OK;
}

ewa_status ewa_adjoint_run(ewa_adjoint_job *job) {
    const ewa_status status = run(job);
    release(job);
    return status;
}
