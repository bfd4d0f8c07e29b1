// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The sampling of a whole cloud in a few numbers.
#include "base/base.h"
#include "cloud/cloud.h"
#include "estimate/local.h"
#include "ewa/prepare.h"

#include <math.h>
#include <string.h>

enum { SPACING_NEIGHBOURS = 16, DIGIT_BITS = 16 };

typedef struct spacing_job {
    const local_kernels *kernels;
    local_batch *batches; // per worker
    float *spacing;       // [place_count]; negative where not measured
} spacing_job;

static void visit(void *user, const ewa_block *block, uint32_t worker) {
    const spacing_job *job = user;
    local_surface s;
    job->kernels->measure(block, 0, &job->batches[worker], &s);
    for (uint32_t lane = 0; lane < block->lane_count; lane++)
        job->spacing[block->first_place + lane] = (float)((double)s.spacing[lane] * block->unit_world);
}

static uint32_t bits_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/// Returns the value of a rank (0: the smallest) among non-negative numbers, whose bits order like they do:
/// the upper half of the bits by one count, then the lower half. `histogram` has 2^16 entries.
static float value_of_rank(const float *values, uint32_t count, uint32_t rank, uint32_t *histogram) {
    uint32_t upper = 0;
    for (int pass = 0; pass < 2; pass++) {
        memset(histogram, 0, sizeof *histogram << DIGIT_BITS);
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t bits = bits_of(values[i]);
            if (pass == 0)
                histogram[bits >> DIGIT_BITS]++;
            else if (bits >> DIGIT_BITS == upper)
                histogram[bits & ((1u << DIGIT_BITS) - 1)]++;
        }
        uint32_t digit = 0;
        while (rank >= histogram[digit]) rank -= histogram[digit++];
        upper = pass == 0 ? digit : upper << DIGIT_BITS | digit;
    }
    float value;
    memcpy(&value, &upper, sizeof value);
    return value;
}

/// Moves what was measured to the front, at most `limit` numbers; returns how many.
static uint32_t compact(float *values, uint32_t count, uint64_t limit) {
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count && kept < limit; i++)
        if (values[i] >= 0 && isfinite(values[i])) values[kept++] = values[i];
    return kept;
}

static void summarise(const float *values, uint32_t count, uint32_t *histogram, ewa_spacing *spacing) {
    double sum = 0;
    for (uint32_t i = 0; i < count; i++) sum += (double)values[i];
    spacing->mean_world = sum / count;
    const uint32_t last = count - 1;
    spacing->median_world = (double)value_of_rank(values, count, last / 2, histogram);
    spacing->low_world = (double)value_of_rank(values, count, (uint32_t)(0.05 * last), histogram);
    spacing->high_world = (double)value_of_rank(values, count, (uint32_t)(0.95 * last), histogram);
}

static ewa_status measure(ewa_context *context, const ewa_neighbours *neighbours, uint64_t sample_count,
                          ewa_spacing *spacing) {
    const uint32_t places = ewa_neighbours_place_count(neighbours);
    for (uint32_t place = 0; place < places; place++) {
        uint32_t count;
        ewa_neighbours_points(neighbours, place, &count);
        if (count > 1) spacing->duplicate_count += count;
    }
    if (places < 2) return EWA_OK;
    const uint64_t wanted = sample_count && sample_count < places ? sample_count : places;
    const size_t entries = (size_t)1 << DIGIT_BITS;
    spacing_job job = {.kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_local_kernels)};
    const uint32_t workers = ewa_context_worker_count(context);
    job.batches = ewa_allocate(context, workers, sizeof *job.batches);
    job.spacing = ewa_allocate(context, places, sizeof *job.spacing);
    uint32_t *histogram = ewa_allocate(context, entries, sizeof *histogram);
    ewa_status status = EWA_ERROR_MEMORY;
    if (job.batches && job.spacing && histogram) {
        for (uint32_t place = 0; place < places; place++) job.spacing[place] = -1;
        const ewa_visit_choice choice = {
            SPACING_NEIGHBOURS, (uint32_t)(places / wanted), NULL, "spacing", 0, NULL};
        status = ewa_neighbours_visit(neighbours, &choice, visit, &job);
        const uint32_t measured = status == EWA_OK ? compact(job.spacing, places, wanted) : 0;
        if (measured) summarise(job.spacing, measured, histogram, spacing);
    }
    ewa_release(context, histogram, entries, sizeof *histogram);
    ewa_release(context, job.spacing, places, sizeof *job.spacing);
    ewa_release(context, job.batches, workers, sizeof *job.batches);
    return status;
}

ewa_status ewa_cloud_measure_spacing(const ewa_cloud *cloud, uint64_t sample_count, ewa_spacing *spacing) {
    if (!cloud || !spacing) return EWA_ERROR_ARGUMENT;
    *spacing = (ewa_spacing){0};
    ewa_context *context = ewa_cloud_context(cloud);
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    if (!position || position->component_count != 3)
        return ewa_fail(context, EWA_ERROR_ARGUMENT,
                        "spacing: the cloud has no positions of three components");
    const uint64_t point_count = ewa_cloud_point_count(cloud);
    if (point_count >= UINT32_MAX)
        return ewa_fail(context, EWA_ERROR_LIMIT, "spacing: %llu points are over the limit of 2^32 - 2",
                        (unsigned long long)point_count);
    ewa_neighbours *neighbours = NULL;
    ewa_status status = ewa_neighbours_create(context, position, (uint32_t)point_count, &neighbours);
    if (status == EWA_OK) status = measure(context, neighbours, sample_count, spacing);
    ewa_neighbours_destroy(&neighbours);
    return status;
}
