// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Radii from what a place and its surroundings say; places that are far sparser than what is near.
#include "estimate/radii.h"
#include "base/base.h"

enum {
    GROUP_PLACES = 64, // along the curve, of which GROUP_SAMPLES are looked at
    GROUP_SAMPLES = 8,
    GROUP_WINDOW = 4, // groups before and after
    TASK_GROUPS = 256,
};

// A kernel has weight up to so many standard deviations: beyond them it has next to none, and the surface
// would look like a hole there.
static const double SOLID_SIGMAS = 2;
// The same where gaps are closed afterwards.
static const double COVERED_SIGMAS = 2.14;
// Share of the variance along the normal from which a neighbourhood is no surface at all. Edges of solids
// have 0.085, noise of half a spacing 0.09 of few neighbours and 0.03 of many, leaves of trees 0.1 to 0.2.
static const double SCATTERED_VARIATION = 0.16;
static const double STREWN_LOW = 0.085, STREWN_HIGH = 0.125;
// Spacings, in units of those around, between which a place ceases to be part of what is around it.
static const double NEAR_RATIO = 2, LONE_RATIO = 2.5;

static double larger(double a, double b) { return b > a ? b : a; }
static double smaller(double a, double b) { return b < a ? b : a; }

/// From 0 at low to 1 at high.
static double ramp(double x, double low, double high) {
    return larger(0, smaller(1, (x - low) / (high - low)));
}

double ewa_radius(const radius_place *place, double scale, double cutoff) {
    // What lies beyond a spacing counts twice: the kernels that meet in a wide gap are fewer than elsewhere,
    // and a pixel's alpha depends on their sum.
    const double wide = place->reach + larger(0, place->reach - place->spacing);
    const double closed = smaller(place->limit, wide * larger(1, cutoff / SOLID_SIGMAS));
    const double plain = scale * place->spacing;
    return plain + (1 - place->scatter) * larger(0, closed - plain);
}

local_sizing ewa_radius_sizing(double limit, double scale, double cutoff, bool gaps_later) {
    return (local_sizing){.scale = (float)scale,
                          .cover = (float)larger(1, cutoff / SOLID_SIGMAS),
                          .gaps_later = gaps_later,
                          .thin_cover = (float)larger(1, cutoff / COVERED_SIGMAS),
                          .limit = (float)limit,
                          .ratio_steps = RADIUS_NOTE_RATIO,
                          .max_steps = RADIUS_NOTE_MAX};
}

double ewa_radius_scatter(double variation) {
    return ramp(variation, LOCAL_SURFACE_VARIATION, SCATTERED_VARIATION);
}

double ewa_radius_strewn(double variation) { return ramp(variation, STREWN_LOW, STREWN_HIGH); }

double ewa_radius_lone(double spacing, double around) {
    return around > 0 ? ramp(spacing / around, NEAR_RATIO, LONE_RATIO) : 0;
}

typedef struct sparse_job {
    const float *spacing;
    uint32_t place_count, group_count;
    float limit; // over the steps of notes
    uint8_t *notes;
} sparse_job;

/// Inserts a value into ascending ones.
static void insert(float *sorted, uint32_t *count, float value) {
    uint32_t to = (*count)++;
    for (; to > 0 && sorted[to - 1] > value; to--) sorted[to] = sorted[to - 1];
    sorted[to] = value;
}

/// The lower median of some of a group's spacings.
static float group_spacing(const sparse_job *job, uint32_t group) {
    const uint32_t begin = group * GROUP_PLACES, left = job->place_count - begin;
    float sorted[GROUP_SAMPLES];
    uint32_t count = 0;
    for (uint32_t i = 0; i < GROUP_PLACES && i < left; i += GROUP_PLACES / GROUP_SAMPLES)
        insert(sorted, &count, job->spacing[begin + i]);
    return sorted[(count - 1) / 2];
}

static void sparse_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const sparse_job *job = data;
    const uint32_t first = task * TASK_GROUPS;
    const uint32_t end = job->group_count - first < TASK_GROUPS ? job->group_count : first + TASK_GROUPS;
    const uint32_t low = first > GROUP_WINDOW ? first - GROUP_WINDOW : 0;
    const uint32_t high = job->group_count - end > GROUP_WINDOW ? end + GROUP_WINDOW : job->group_count;
    float values[TASK_GROUPS + 2 * GROUP_WINDOW];
    for (uint32_t g = low; g < high; g++) values[g - low] = group_spacing(job, g);
    for (uint32_t g = first; g < end; g++) {
        float sorted[2 * GROUP_WINDOW + 1];
        uint32_t count = 0;
        for (uint32_t i = g > GROUP_WINDOW ? g - GROUP_WINDOW : 0; i <= g + GROUP_WINDOW && i < high; i++)
            insert(sorted, &count, values[i - low]);
        const float limit = job->limit * sorted[(count - 1) / 2];
        const uint32_t begin = g * GROUP_PLACES, left = job->place_count - begin;
        for (uint32_t i = begin; i - begin < GROUP_PLACES && i - begin < left; i++) {
            const uint32_t note = job->notes[i];
            const float radius_steps = job->spacing[i] * (float)(note >> RADIUS_NOTE_SHIFT);
            if (!(note & RADIUS_AGAIN) && radius_steps > limit) job->notes[i] = RADIUS_DOUBTFUL;
        }
    }
}

void ewa_radius_doubt_sparse(ewa_context *context, const float *spacing, uint32_t place_count, double limit,
                             uint8_t *notes) {
    const uint32_t groups = (uint32_t)(((uint64_t)place_count + GROUP_PLACES - 1) / GROUP_PLACES);
    sparse_job job = {spacing, place_count, groups, (float)(limit * RADIUS_NOTE_RATIO), notes};
    ewa_parallel(context, sparse_task, &job, (groups + TASK_GROUPS - 1) / TASK_GROUPS);
}
