// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Statistical outlier removal.
//
// Based on R. B. Rusu, Z. C. Marton, N. Blodow, M. Dolha, M. Beetz, "Towards 3D point cloud based object maps
// for household environments", 2008, section 5.1. Duplicates count as one neighbour.
#include "estimate/outliers.h"
#include "base/base.h"
#include "base/options.h"
#include "cloud/cloud.h"
#include "estimate/local.h"
#include "ewa/select.h"

#include <math.h>
#include <string.h>

typedef struct distance_job {
    const local_kernels *kernels;
    float *mean_distance; // [place_count]
} distance_job;

static void visit(void *user, const ewa_block *block, uint32_t worker) {
    (void)worker;
    const distance_job *job = user;
    local_surface s;
    job->kernels->measure_distance(block, &s);
    for (uint32_t lane = 0; lane < block->lane_count; lane++)
        job->mean_distance[block->first_place + lane] =
            (float)((double)s.mean_distance[lane] * block->unit_world);
}

/// Clears the marks of all but those that are near enough.
static void clear_marks(const ewa_neighbours *neighbours, const float *mean_distance, double factor, uint64_t point_count,
                        uint8_t *keep, uint8_t *marks) {
    const uint32_t place_count = ewa_neighbours_place_count(neighbours);
    double sum = 0, sum2 = 0;
    for (uint32_t place = 0; place < place_count; place++) sum += (double)mean_distance[place];
    const double mean = sum / place_count;
    for (uint32_t place = 0; place < place_count; place++) {
        const double d = (double)mean_distance[place] - mean;
        sum2 += d * d;
    }
    const double limit = mean + factor * sqrt(sum2 / place_count);
    for (uint32_t place = 0; place < place_count; place++) {
        if ((double)mean_distance[place] > limit) continue;
        uint32_t count;
        const uint32_t *points = ewa_neighbours_points(neighbours, place, &count);
        for (uint32_t i = 0; i < count; i++) keep[points[i]] = 1;
    }
    for (uint64_t i = 0; i < point_count; i++) marks[i] = marks[i] && keep[i];
}

static ewa_status mark(const ewa_cloud *cloud, const ewa_estimate_options *options, uint8_t *marks) {
    ewa_context *context = ewa_cloud_context(cloud);
    const uint64_t point_count = ewa_cloud_point_count(cloud);
    ewa_neighbours *neighbours = NULL;
    EWA_TRY(ewa_neighbours_create(context, ewa_cloud_find(cloud, EWA_POSITION), (uint32_t)point_count, &neighbours));
    const size_t place_count = ewa_neighbours_place_count(neighbours);
    distance_job job = {.kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_local_kernels)};
    job.mean_distance = ewa_allocate(context, place_count, sizeof *job.mean_distance);
    uint8_t *keep = ewa_allocate_zeroed(context, point_count, sizeof *keep);
    ewa_status status = EWA_ERROR_MEMORY;
    if (job.mean_distance && keep) {
        const ewa_visit_choice choice = {options->neighbour_count, 1, NULL, "outliers", 0, NULL};
        status = ewa_neighbours_visit(neighbours, &choice, visit, &job);
        if (status == EWA_OK) clear_marks(neighbours, job.mean_distance, options->outlier_factor, point_count, keep, marks);
    }
    ewa_release(context, keep, point_count, sizeof *keep);
    ewa_release(context, job.mean_distance, place_count, sizeof *job.mean_distance);
    ewa_neighbours_destroy(&neighbours);
    return status;
}

/// Whether a cloud can be asked for its neighbours.
static ewa_status check(const ewa_cloud *cloud) {
    ewa_context *context = ewa_cloud_context(cloud);
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    if (!position || position->component_count != 3)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "outliers: the cloud has no positions of three components");
    if (ewa_cloud_point_count(cloud) >= UINT32_MAX)
        return ewa_fail(context, EWA_ERROR_LIMIT, "outliers: %llu points are over the limit of 2^32 - 2",
                        (unsigned long long)ewa_cloud_point_count(cloud));
    return EWA_OK;
}

ewa_status ewa_cloud_mark_outliers(const ewa_cloud *cloud, const ewa_estimate_options *given, uint8_t *marks) {
    if (!cloud || !given || !marks) return EWA_ERROR_ARGUMENT;
    ewa_context *context = ewa_cloud_context(cloud);
    ewa_estimate_options options;
    ewa_estimate_options_init(&options, sizeof options);
    EWA_TRY(ewa_options_take(context, &ewa_estimate_options_table, given, &options));
    if (!(options.outlier_factor > 0)) return ewa_fail(context, EWA_ERROR_ARGUMENT, "outliers: outlier_factor is 0, not above it");
    EWA_TRY(check(cloud));
    return mark(cloud, &options, marks);
}

ewa_status ewa_remove_outliers(ewa_cloud **cloud, const ewa_estimate_options *options) {
    ewa_context *context = ewa_cloud_context(*cloud);
    const uint64_t point_count = ewa_cloud_point_count(*cloud);
    uint8_t *marks = ewa_allocate(context, point_count, sizeof *marks);
    if (!marks) return EWA_ERROR_MEMORY;
    memset(marks, 1, point_count);
    ewa_cloud *copy = NULL;
    ewa_status status = mark(*cloud, options, marks);
    if (status == EWA_OK && memchr(marks, 0, point_count)) status = ewa_cloud_keep(*cloud, marks, &copy);
    ewa_release(context, marks, point_count, sizeof *marks);
    if (copy) {
        ewa_report(context, EWA_SEVERITY_INFO, "%llu of %llu points removed as outliers",
                   (unsigned long long)(point_count - ewa_cloud_point_count(copy)), (unsigned long long)point_count);
        ewa_cloud_destroy(cloud);
        *cloud = copy;
    }
    return status;
}
