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

/// No depth of a splat is smaller.
static float begin_of(const ewa_reference_view *view, const ewa_reference_splat *splat) {
    double begin = splat->center.z - splat->half_range;
    if (!splat->by_rays) begin = view->orthographic ? -splat->key_high : 1 / splat->key_high;
    return nextafterf((float)begin, -INFINITY);
}

static ewa_adjoint_range range_of(const ewa_reference_splat *splat, uint32_t side_px) {
    if (!splat->drawn || splat->x_begin >= splat->x_end || splat->y_begin >= splat->y_end)
        return (ewa_adjoint_range){0, 0};
    const uint32_t x0 = (uint32_t)splat->x_begin / side_px, x1 = ((uint32_t)splat->x_end + side_px - 1) / side_px;
    const uint32_t y0 = (uint32_t)splat->y_begin / side_px, y1 = ((uint32_t)splat->y_end + side_px - 1) / side_px;
    return (ewa_adjoint_range){x0 | y0 << 16, x1 | y1 << 16};
}

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
        const ewa_adjoint_range range = job->ranges[i] = range_of(splat, job->tiles.side_px);
        if (range.end == 0) continue;
        job->begins[i] = begin_of(&job->frame.view, splat);
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

/// The sums of a point.
static void read_sums(const ewa_adjoint_job *job, uint64_t point, const double scales[EWA_MOMENT_COUNT],
                      double moments[EWA_MOMENT_COUNT]) {
    const int64_t *sums = job->sums + point * job->width;
    for (uint32_t m = 0; m < EWA_MOMENT_COUNT; m++)
        moments[m] = m < job->width ? (double)sums[m] / scales[m] : 0;
}

/// Whether a point is anywhere seen.
static bool has_sums(const ewa_adjoint_job *job, uint64_t point) {
    const int64_t *sums = job->sums + point * job->width;
    int64_t any = 0;
    for (uint32_t m = 0; m < job->width; m++) any |= sums[m];
    return any != 0;
}

static void pull_back_point(const ewa_adjoint_job *job, ewa_adjoint_scratch *s, uint64_t point) {
    ewa_reference_point_cotangent at;
    memset(&at, 0, sizeof at);
    if (has_sums(job, point)) {
        double scales[EWA_MOMENT_COUNT], moments[EWA_MOMENT_COUNT], camera[EWA_CAMERA_NUMBERS] = {0};
        ewa_surfel surfel;
        ewa_reference_splat splat;
        ewa_reference_surfel_cotangent of_surfel;
        ewa_reference_frame_project(&job->frame, point, 1, &surfel, &splat);
        ewa_adjoint_scales(job, &splat, scales);
        read_sums(job, point, scales, moments);
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
        read_sums(job, i, scales, moments);
        store_point(job->gradient.color, i, 3, moments + EWA_MOMENT_COLOR);
    }
}

/// Gives the workers what they need for the tiles.
static ewa_status reserve(ewa_adjoint_job *job) {
    ewa_context *context = job->frame.context;
    const uint32_t splats = (uint32_t)job->lists.largest, most = job->frame.resolve.layering.most;
    job->surface_count = splats < most ? (splats > 0 ? splats : 1) : most;
    const size_t pixels = (size_t)job->tiles.side_px * job->tiles.side_px, surfaces = job->surface_count;
    for (uint32_t i = 0; i < job->worker_count; i++) {
        ewa_adjoint_scratch *s = &job->scratch[i];
        s->splat_capacity = splats;
        s->plane_capacity = surfaces * ewa_adjoint_block_count(job) * EWA_PLANES * EWA_EIGHT_LANES;
        s->near_first = ewa_allocate(context, splats, sizeof *s->near_first);
        s->splats = ewa_allocate(context, splats, sizeof *s->splats);
        s->order = ewa_allocate(context, splats, sizeof *s->order);
        s->planes = ewa_allocate(context, s->plane_capacity, sizeof *s->planes);
        s->reached = ewa_allocate(context, surfaces, sizeof *s->reached);
        s->layers = ewa_allocate(context, surfaces, sizeof *s->layers);
        s->pixels = ewa_allocate(context, pixels, sizeof *s->pixels);
        if (!s->near_first || !s->splats || !s->order || !s->planes || !s->reached || !s->layers || !s->pixels)
            return EWA_ERROR_MEMORY;
    }
    return EWA_OK;
}

static void release(ewa_adjoint_job *job) {
    ewa_context *context = job->frame.context;
    const size_t pixels = (size_t)job->tiles.side_px * job->tiles.side_px;
    for (uint32_t i = 0; job->scratch && i < job->worker_count; i++) {
        ewa_adjoint_scratch *s = &job->scratch[i];
        ewa_release(context, s->near_first, s->splat_capacity, sizeof *s->near_first);
        ewa_release(context, s->splats, s->splat_capacity, sizeof *s->splats);
        ewa_release(context, s->order, s->splat_capacity, sizeof *s->order);
        ewa_release(context, s->planes, s->plane_capacity, sizeof *s->planes);
        ewa_release(context, s->reached, job->surface_count, sizeof *s->reached);
        ewa_release(context, s->layers, job->surface_count, sizeof *s->layers);
        ewa_release(context, s->pixels, pixels, sizeof *s->pixels);
        ewa_release(context, s->camera, EWA_CAMERA_NUMBERS, sizeof *s->camera);
    }
    const uint64_t points = job->frame.point_count;
    ewa_release(context, job->scratch, job->worker_count, sizeof *job->scratch);
    ewa_release(context, job->sums, points * job->width, sizeof *job->sums);
    ewa_release(context, job->begins, points, sizeof *job->begins);
    ewa_release(context, job->ranges, points, sizeof *job->ranges);
    ewa_bin_lists_free(context, &job->lists);
}

/// Makes what finding splats needs.
static ewa_status start(ewa_adjoint_job *job) {
    ewa_context *context = job->frame.context;
    job->worker_count = ewa_context_worker_count(context);
    job->kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_adjoint_kernels);
    job->ranges = ewa_allocate(context, job->frame.point_count, sizeof *job->ranges);
    job->begins = ewa_allocate(context, job->frame.point_count, sizeof *job->begins);
    if (job->width) job->sums = ewa_allocate_zeroed(context, job->frame.point_count * job->width, sizeof *job->sums);
    job->scratch = ewa_allocate_zeroed(context, job->worker_count, sizeof *job->scratch);
    if (!job->ranges || !job->begins || (job->width && !job->sums) || !job->scratch) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < job->worker_count && job->gradient.camera; i++) {
        job->scratch[i].camera = ewa_allocate_zeroed(context, EWA_CAMERA_NUMBERS, sizeof *job->scratch[i].camera);
        if (!job->scratch[i].camera) return EWA_ERROR_MEMORY;
    }
    return EWA_OK;
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
