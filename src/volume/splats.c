// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From a set of Gaussians to its resident form: their order, and what is measured of them.
#include "volume/splats.h"
#include "base/base.h"
#include "cloud/morton.h"
#include "volume/splat_levels.h"
#include "volume/splat_packets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LANES = EWA_SPLAT_LANES, CORE_BINS = 1 << 14 };

/// Of a core's diagonal: what may be left out before the eye.
static const double NEAR_SHARE = 0.02;

/// What lies outside of a core, at either end.
static const double OUTSIDE_CORE = 0.02;

/// Where the numbers of Gaussian `number` begin.
typedef struct gaussian_parts {
    const float *parts[5];
    size_t counts[5];
} gaussian_parts;

static gaussian_parts parts_of(const ewa_gaussians *set, size_t number) {
    const size_t harmonics = 3 * (size_t)(set->sh_degree + 1) * (set->sh_degree + 1);
    return (gaussian_parts){{set->centers + 3 * number, set->scales + 3 * number, set->rotations + 4 * number,
                             set->opacities + number, set->harmonics + harmonics * number},
                            {3, 3, 4, 1, harmonics}};
}

static bool drawable(const ewa_gaussians *set, size_t number) {
    const gaussian_parts at = parts_of(set, number);
    for (int p = 0; p < 5; p++)
        for (size_t i = 0; i < at.counts[p]; i++)
            if (!isfinite(at.parts[p][i])) return false;
    return set->opacities[number] > 0 && (at.parts[1][0] > 0 || at.parts[1][1] > 0 || at.parts[1][2] > 0);
}

/// A Gaussian among others that the Morton curve does not tell apart.
typedef struct tied_gaussian {
    const ewa_gaussians *set;
    uint32_t number;
} tied_gaussian;

static int compare_tied(const void *a, const void *b) {
    const tied_gaussian *s = a, *t = b;
    const gaussian_parts x = parts_of(s->set, s->number), y = parts_of(t->set, t->number);
    for (int p = 0; p < 5; p++)
        for (size_t i = 0; i < x.counts[p]; i++)
            if (x.parts[p][i] != y.parts[p][i]) return x.parts[p][i] < y.parts[p][i] ? -1 : 1;
    return s->set->classes ? (int)s->set->classes[s->number] - (int)t->set->classes[t->number] : 0;
}

static ewa_status order_ties(const ewa_gaussians *set, const uint16_t *split_level, uint32_t count,
                             uint32_t *order) {
    for (uint32_t first = 0, end; first < count; first = end) {
        end = first + 1;
        while (end < count && split_level[end] == EWA_MORTON_SAME) end++;
        if (end - first < 2) continue;
        tied_gaussian *tied = ewa_allocate(set->context, end - first, sizeof *tied);
        if (!tied) return EWA_ERROR_MEMORY;
        for (uint32_t i = first; i < end; i++) tied[i - first] = (tied_gaussian){set, order[i]};
        qsort(tied, end - first, sizeof *tied, compare_tied);
        for (uint32_t i = first; i < end; i++) order[i] = tied[i - first].number;
        ewa_release(set->context, tied, end - first, sizeof *tied);
    }
    return EWA_OK;
}

/// Fills `order` with the drawable Gaussians, neighbours together, whatever their order in the set.
static ewa_status order_all(const ewa_gaussians *set, uint32_t *order, uint32_t *count) {
    uint16_t *split_level = ewa_allocate(set->context, set->count, sizeof *split_level);
    if (!split_level) return EWA_ERROR_MEMORY;
    const ewa_attribute position = {
        .data = set->centers, .type = EWA_F32, .component_count = 3, .stride_bytes = 3 * sizeof(float)};
    uint32_t finite_count = 0;
    ewa_status status =
        ewa_morton_order(set->context, &position, set->count, order, split_level, &finite_count);
    if (status == EWA_OK) status = order_ties(set, split_level, finite_count, order);
    ewa_release(set->context, split_level, set->count, sizeof *split_level);
    *count = 0;
    for (uint32_t i = 0; i < finite_count && status == EWA_OK; i++)
        if (drawable(set, order[i])) order[(*count)++] = order[i];
    return status;
}

typedef struct build_job {
    const ewa_gaussians *set;
    const uint32_t *order;
    ewa_splats *splats;
} build_job;

enum { PACKETS_PER_TASK = 256 };

static void build(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const build_job *job = data;
    const uint32_t count = job->splats->info.splat_count;
    for (uint64_t i = (uint64_t)index * PACKETS_PER_TASK * LANES;
         i < (index + (uint64_t)1) * PACKETS_PER_TASK * LANES && i < count; i++)
        ewa_splats_set(job->splats, job->set, job->order[i], i / LANES, i % LANES);
}

static double place_of(const ewa_splats *splats, uint32_t i, int axis) {
    return (double)splats->packets[i / LANES][EWA_SPLAT_PLACE + axis][i % LANES];
}

/// The place below which lies `share` of the opacities along an axis, looked for in ever smaller bins: the
/// end of the last one that is the outer one.
static double quantile(const ewa_splats *splats, int axis, double low, double high, double share,
                       double *bins) {
    for (int round = 0; round < 3 && high > low; round++) {
        double before = 0, all = 0;
        memset(bins, 0, CORE_BINS * sizeof *bins);
        for (uint32_t i = 0; i < splats->info.splat_count; i++) {
            const double at = (place_of(splats, i, axis) - low) / (high - low) * CORE_BINS;
            const double weight = (double)splats->packets[i / LANES][EWA_SPLAT_OPACITY][i % LANES];
            all += weight;
            if (at < 0)
                before += weight;
            else if (at <= CORE_BINS)
                bins[at < CORE_BINS ? (int)at : CORE_BINS - 1] += weight;
        }
        int bin = 0;
        for (; bin < CORE_BINS - 1 && before + bins[bin] < share * all; bin++) before += bins[bin];
        const double step = (high - low) / CORE_BINS;
        low += bin * step;
        if (bin < CORE_BINS - 1) high = low + step;
    }
    return share < 0.5 ? low : high;
}

static ewa_status measure(ewa_splats *splats) {
    ewa_splats_info *info = &splats->info;
    double *bins = ewa_allocate(splats->context, CORE_BINS, sizeof *bins);
    if (!bins) return EWA_ERROR_MEMORY;
    double squares = 0; // of the core's sides
    info->bounds.finite_count = info->core.finite_count = info->splat_count;
    for (int axis = 0; axis < 3 && info->splat_count; axis++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = 0; i < info->splat_count; i++) {
            low = fmin(low, place_of(splats, i, axis));
            high = fmax(high, place_of(splats, i, axis));
        }
        const double first = quantile(splats, axis, low, high, OUTSIDE_CORE, bins);
        const double last = quantile(splats, axis, low, high, 1 - OUTSIDE_CORE, bins);
        const double unit = splats->unit_world, origin = splats->origin_world[axis];
        info->bounds.low_world[axis] = origin + unit * low,
        info->bounds.high_world[axis] = origin + unit * high;
        info->core.low_world[axis] = origin + unit * first,
        info->core.high_world[axis] = origin + unit * last;
        squares += unit * unit * (last - first) * (last - first);
    }
    const double near = NEAR_SHARE * sqrt(squares);
    info->near_world = near > 0 ? fmin(EWA_GAUSSIAN_NEAR_WORLD, near) : EWA_GAUSSIAN_NEAR_WORLD;
    ewa_release(splats->context, bins, CORE_BINS, sizeof *bins);
    return EWA_OK;
}

/// The power of two from the largest coordinate or scale up, so that squares stay within floats.
static double choose_unit(const ewa_gaussians *set, const uint32_t *order, uint32_t count) {
    float largest = 0;
    for (uint32_t i = 0; i < count; i++)
        for (int part = 0; part < 2; part++)
            for (int axis = 0; axis < 3; axis++)
                largest = fmaxf(
                    largest, fabsf((part ? set->scales : set->centers)[3 * (size_t)order[i] + (size_t)axis]));
    int exponent = 0;
    if (largest > 0) frexp((double)largest, &exponent);
    return ldexp(1, exponent);
}

static ewa_status fill(ewa_splats *splats, const ewa_gaussians *set, const uint32_t *order) {
    ewa_context *context = splats->context;
    const size_t packets = splats->packet_count, all = ewa_splats_all_packets(splats);
    splats->packets = ewa_allocate_zeroed(context, all, sizeof *splats->packets);
    splats->harmonics = ewa_allocate_zeroed(context, all * splats->harmonic_count, sizeof *splats->harmonics);
    splats->parts = ewa_allocate_zeroed(context, splats->part_count, sizeof *splats->parts);
    if (set->classes) splats->classes = ewa_allocate_zeroed(context, all, sizeof *splats->classes);
    if (!splats->packets || !splats->harmonics || !splats->parts || (set->classes && !splats->classes)) return EWA_ERROR_MEMORY;
    splats->unit_world = choose_unit(set, order, splats->info.splat_count);
    memcpy(splats->origin_world, set->origin, sizeof splats->origin_world);
    build_job job = {set, order, splats};
    EWA_TRY(ewa_parallel_stoppable(context, "splats", build, &job,
                                   (uint32_t)((packets + PACKETS_PER_TASK - 1) / PACKETS_PER_TASK)));
    EWA_TRY(ewa_splats_make_levels(splats, set, order));
    return measure(splats);
}

ewa_status ewa_splats_create(const ewa_gaussians *gaussians, bool levels, ewa_splats **splats) {
    if (!gaussians || !gaussians->context || !splats || gaussians->sh_degree > EWA_MAX_SH_DEGREE)
        return EWA_ERROR_ARGUMENT;
    *splats = NULL;
    ewa_context *context = gaussians->context;
    const uint32_t count = gaussians->count;
    if (count > EWA_SPLATS_MAX)
        return ewa_fail(context, EWA_ERROR_LIMIT, "splats: %u Gaussians, more than %d", count,
                        EWA_SPLATS_MAX);
    uint32_t *order = ewa_allocate(context, count, sizeof *order);
    ewa_splats *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    ewa_status status = order && made ? EWA_OK : EWA_ERROR_MEMORY;
    if (made) made->context = context;
    if (status == EWA_OK) {
        made->serial = ewa_serial_next(context);
        made->harmonic_count = 3 * ((gaussians->sh_degree + 1) * (gaussians->sh_degree + 1) - 1);
        made->flat = gaussians->flat;
        made->info.sh_degree = gaussians->sh_degree;
        made->info.antialiased = gaussians->antialiased;
        status = order_all(gaussians, order, &made->info.splat_count);
    }
    if (status == EWA_OK) {
        made->packet_count = (made->info.splat_count + LANES - 1) / LANES;
        if (levels && made->info.splat_count >= EWA_SPLAT_LEVELS_FROM && !made->flat)
            made->part_count = (made->packet_count - 1) / EWA_SPLAT_PART_PACKETS + 1;
        made->info.has_levels = made->part_count > 0;
        made->info.has_classes = gaussians->classes;
        made->info.resident_bytes =
            sizeof *made + made->part_count * sizeof *made->parts +
            ewa_splats_all_packets(made) * (sizeof *made->packets + made->harmonic_count * sizeof *made->harmonics +
                                         (gaussians->classes ? sizeof *made->classes : 0));
        status = fill(made, gaussians, order);
    }
    ewa_release(context, order, count, sizeof *order);
    if (status != EWA_OK)
        ewa_splats_destroy(&made);
    else
        *splats = made;
    return status;
}

void ewa_splats_destroy(ewa_splats **splats) {
    if (!splats || !*splats) return;
    ewa_splats *old = *splats;
    const size_t all = ewa_splats_all_packets(old);
    if (old->shown_lanes) {
        ewa_release(old->context, old->shown_lanes, all, sizeof *old->shown_lanes);
    } else {
        ewa_release(old->context, old->packets, all, sizeof *old->packets);
        ewa_release(old->context, old->harmonics, all * old->harmonic_count, sizeof *old->harmonics);
        ewa_release(old->context, old->parts, old->part_count, sizeof *old->parts);
        ewa_release(old->context, old->classes, all, sizeof *old->classes);
    }
    ewa_release(old->context, old, 1, sizeof *old);
    *splats = NULL;
}

void ewa_splats_describe(const ewa_splats *splats, ewa_splats_info *info) {
    if (splats && info) *info = splats->info;
}
