// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Levels of the resident form: the splats of a part are divided along the widest axis of their centres, into halves of as many groups
// of four as there are, until these are left. A group is one splat of level 1, four groups in a row one of level 2, and so on.
// Each stands for the splats themselves, not for those of the level before.
#include "volume/splat_levels.h"
#include "base/base.h"
#include "cloud/gaussian_merge.h"
#include "volume/splat_packets.h"

#include <math.h>

enum { LANES = EWA_SPLAT_LANES, PART_SPLATS = EWA_SPLAT_PART_PACKETS * LANES, GROUP = 4, MAX_MERGED = PART_SPLATS / GROUP };

typedef struct level_scratch {
    uint32_t members[PART_SPLATS];
    ewa_gaussian_mass masses[PART_SPLATS]; ///< theirs
    ewa_gaussians merged; ///< of one level
} level_scratch;

typedef struct level_job {
    ewa_splats *splats;
    const ewa_gaussians *set;
    const uint32_t *order;
    level_scratch *scratch; ///< one per worker
} level_job;

static float along(const ewa_gaussians *set, uint32_t member, uint32_t axis) { return set->centers[3 * (size_t)member + axis]; }

/// The order along an axis, of those at one place by their number.
static bool comes_before(const ewa_gaussians *set, uint32_t axis, uint32_t a, uint32_t b) {
    const float x = along(set, a, axis), y = along(set, b, axis);
    return x < y || (x == y && a < b);
}

/// Has the first `rank` members come before all others along an axis (Hoare's selection).
static void select_first(const ewa_gaussians *set, uint32_t axis, uint32_t *members, uint32_t count, uint32_t rank) {
    uint32_t low = 0, high = count - 1;
    while (low < high) {
        const uint32_t pivot = members[low + (high - low) / 2];
        uint32_t i = low, j = high;
        for (;;) {
            while (comes_before(set, axis, members[i], pivot)) i++;
            while (comes_before(set, axis, pivot, members[j])) j--;
            if (i >= j) break;
            const uint32_t swapped = members[i];
            members[i++] = members[j];
            members[j--] = swapped;
        }
        // [low, j] come before what is behind j.
        if (rank <= j)
            high = j;
        else
            low = j + 1;
    }
}

static uint32_t widest_axis(const ewa_gaussians *set, const uint32_t *members, uint32_t count) {
    uint32_t widest = 0;
    float maximum = -1;
    float low[3], high[3];
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t axis = 0; axis < 3; axis++) {
            const float at = along(set, members[i], axis);
            if (!i || at < low[axis]) low[axis] = at;
            if (!i || at > high[axis]) high[axis] = at;
        }
    for (uint32_t axis = 0; axis < 3; axis++)
        if (high[axis] - low[axis] > maximum) maximum = high[axis] - low[axis], widest = axis;
    return widest;
}

/// Orders members so that each four in a row are neighbours.
static void group_members(const ewa_gaussians *set, uint32_t *members, uint32_t count) {
    if (count <= GROUP) return;
    // The first half has whole groups, and whole groups of groups where there are enough.
    uint32_t step = GROUP;
    while (step * GROUP < count) step *= GROUP;
    uint32_t half = (count / 2 + step / 2) / step * step;
    if (half == 0 || half >= count) half = step;
    select_first(set, widest_axis(set, members, count), members, count, half);
    group_members(set, members, half);
    group_members(set, members + half, count - half);
}

/// Fills one level of a part; returns the RMS distance, world units.
static double make_level(const level_job *job, level_scratch *scratch, uint32_t part, uint32_t level, uint32_t count) {
    const uint32_t size = 1u << 2 * level, merged_count = (count - 1) / size + 1;
    double squares = 0, masses = 0;
    for (uint32_t m = 0; m < merged_count; m++) {
        const uint32_t first = m * size, members = count - first < size ? count - first : size;
        const double apart2 = ewa_gaussians_merge(job->set, scratch->members + first, scratch->masses + first, members, &scratch->merged, m);
        const float *scales = scratch->merged.scales + 3 * (size_t)m;
        const double mass = (double)scratch->merged.opacities[m] * (double)(scales[0] * scales[1] + scales[0] * scales[2] + scales[1] * scales[2]);
        squares += mass * apart2, masses += mass;
    }
    uint32_t packets;
    const size_t packet = ewa_splats_level(job->splats, part, level, &packets);
    for (uint32_t m = 0; m < merged_count; m++)
        ewa_splats_set(job->splats, &scratch->merged, m, packet + m / LANES, m % LANES);
    return masses > 0 ? sqrt(squares / masses) : 0;
}

static void make_part(void *data, uint32_t part, uint32_t worker) {
    const level_job *job = data;
    const ewa_gaussians *set = job->set;
    level_scratch *scratch = &job->scratch[worker];
    ewa_splat_part *made = &job->splats->parts[part];
    const double unit = job->splats->unit_world;
    const size_t begin = (size_t)part * PART_SPLATS, left = job->splats->info.splat_count - begin;
    const uint32_t count = left < PART_SPLATS ? (uint32_t)left : PART_SPLATS;
    double low[3], high[3], squares = 0;
    for (uint32_t i = 0; i < count; i++) {
        scratch->members[i] = job->order[begin + i];
        for (uint32_t k = 0; k < 3; k++) {
            const double at = (double)along(set, scratch->members[i], k);
            low[k] = i ? fmin(low[k], at) : at;
            high[k] = i ? fmax(high[k], at) : at;
        }
    }
    for (int k = 0; k < 3; k++) {
        made->center[k] = (float)((low[k] + high[k]) / 2 / unit);
        squares += (high[k] - low[k]) * (high[k] - low[k]);
    }
    made->radius = (float)(sqrt(squares) / 2 / unit * (1 + 1e-6));
    group_members(set, scratch->members, count);
    for (uint32_t i = 0; i < count; i++) ewa_gaussian_weigh(set, scratch->members[i], &scratch->masses[i]);
    for (uint32_t level = 1; level <= EWA_SPLAT_LEVELS; level++)
        made->apart[level - 1] = (float)(make_level(job, scratch, part, level, count) / unit);
}

ewa_status ewa_splats_make_levels(ewa_splats *splats, const ewa_gaussians *set, const uint32_t *order) {
    if (!splats->part_count) return EWA_OK;
    ewa_context *context = splats->context;
    const uint32_t workers = ewa_context_worker_count(context);
    level_job job = {splats, set, order, ewa_allocate_zeroed(context, workers, sizeof(level_scratch))};
    ewa_status status = job.scratch ? EWA_OK : EWA_ERROR_MEMORY;
    for (uint32_t w = 0; w < workers && status == EWA_OK; w++)
        status = ewa_gaussians_create(context, MAX_MERGED, set->sh_degree, &job.scratch[w].merged);
    if (status == EWA_OK) status = ewa_parallel_stoppable(context, "levels", make_part, &job, splats->part_count);
    for (uint32_t w = 0; w < workers && job.scratch; w++) ewa_gaussians_free(&job.scratch[w].merged);
    ewa_release(context, job.scratch, workers, sizeof(level_scratch));
    return status;
}
