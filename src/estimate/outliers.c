// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Statistical outlier removal.
//
// Based on R. B. Rusu, Z. C. Marton, N. Blodow, M. Dolha, M. Beetz, "Towards 3D point cloud based object maps
// for household environments", 2008, section 5.1. Duplicates count as one neighbour.
#include "estimate/outliers.h"
#include "base/base.h"
#include "cloud/cloud.h"
#include "estimate/local.h"
#include "ewa/select.h"

#include <math.h>

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

/// Marks the points to keep; returns how many they are.
static uint64_t mark(const ewa_neighbours *neighbours, const float *mean_distance, double factor,
                     uint8_t *keep) {
    const uint32_t place_count = ewa_neighbours_place_count(neighbours);
    double sum = 0, sum2 = 0;
    for (uint32_t place = 0; place < place_count; place++) sum += (double)mean_distance[place];
    const double mean = sum / place_count;
    for (uint32_t place = 0; place < place_count; place++) {
        const double d = (double)mean_distance[place] - mean;
        sum2 += d * d;
    }
    const double limit = mean + factor * sqrt(sum2 / place_count);
    uint64_t kept = 0;
    for (uint32_t place = 0; place < place_count; place++) {
        if ((double)mean_distance[place] > limit) continue;
        uint32_t count;
        const uint32_t *points = ewa_neighbours_points(neighbours, place, &count);
        for (uint32_t i = 0; i < count; i++) keep[points[i]] = 1;
        kept += count;
    }
    return kept;
}

ewa_status ewa_remove_outliers(ewa_cloud **cloud, uint32_t neighbour_count, double factor) {
    ewa_context *context = ewa_cloud_context(*cloud);
    const uint64_t point_count = ewa_cloud_point_count(*cloud);
    ewa_neighbours *neighbours = NULL;
    EWA_TRY(ewa_neighbours_create(context, ewa_cloud_find(*cloud, EWA_POSITION), (uint32_t)point_count,
                                  &neighbours));
    const size_t place_count = ewa_neighbours_place_count(neighbours);
    distance_job job = {.kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_local_kernels)};
    job.mean_distance = ewa_allocate(context, place_count, sizeof *job.mean_distance);
    uint8_t *keep = ewa_allocate_zeroed(context, point_count, sizeof *keep);
    ewa_status status = EWA_ERROR_MEMORY;
    if (job.mean_distance && keep) {
        const ewa_visit_choice choice = {neighbour_count, 1, NULL, "outliers", 0, NULL};
        status = ewa_neighbours_visit(neighbours, &choice, visit, &job);
        const uint64_t kept =
            status == EWA_OK ? mark(neighbours, job.mean_distance, factor, keep) : point_count;
        ewa_cloud *copy = NULL;
        if (kept < point_count) status = ewa_cloud_keep(*cloud, keep, &copy);
        if (copy) {
            ewa_report(context, EWA_SEVERITY_INFO, "%llu of %llu points removed as outliers",
                       (unsigned long long)(point_count - kept), (unsigned long long)point_count);
            ewa_cloud_destroy(cloud);
            *cloud = copy;
        }
    }
    ewa_release(context, keep, point_count, sizeof *keep);
    ewa_release(context, job.mean_distance, place_count, sizeof *job.mean_distance);
    ewa_neighbours_destroy(&neighbours);
    return status;
}
