// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One point per voxel.
#include "base/base.h"
#include "cloud/cloud.h"
#include "cloud/cubes.h"
#include "cloud/marks.h"

#include <math.h>

/// Steps of a voxel's edge in which means are taken: sums of 2^32 points stay in 64 bits, and whole numbers
/// add up to the same in any order.
static const double STEPS = 0x1p30;

typedef struct voxel_job {
    const ewa_cloud *cloud;
    const ewa_cubes *cubes;
    uint8_t *marks;
} voxel_job;

/// Gives a point's place in its voxel in whole steps.
static void find_steps(const ewa_cell_frame *frame, uint32_t point, double steps[3]) {
    double cell[3], at_cells[3];
    ewa_cell_of(frame, point, cell, at_cells);
    for (int c = 0; c < 3; c++) {
        const double share = at_cells[c] - cell[c]; // NaN so far out that the quotient overflows
        steps[c] = share > 0 ? floor(share * STEPS) : 0;
    }
}

/// Keeps the point nearest to the mean of some.
static void thin_voxel(const voxel_job *job, const uint32_t *points, uint32_t count) {
    const ewa_cell_frame *frame = &job->cubes->frame;
    uint64_t sums[3] = {0};
    double steps[3], mean[3], minimum = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        find_steps(frame, points[i], steps);
        for (int c = 0; c < 3; c++) sums[c] += (uint64_t)steps[c];
        job->marks[points[i]] = 0;
    }
    for (int c = 0; c < 3; c++) mean[c] = (double)sums[c] / count;
    uint32_t nearest = points[0];
    for (uint32_t i = 0; i < count; i++) {
        find_steps(frame, points[i], steps);
        double distance2 = 0;
        for (int c = 0; c < 3; c++) distance2 += (steps[c] - mean[c]) * (steps[c] - mean[c]);
        if (distance2 > minimum ||
            (distance2 == minimum && ewa_points_compare(job->cloud, points[i], nearest) >= 0))
            continue;
        minimum = distance2;
        nearest = points[i];
    }
    job->marks[nearest] = 1;
}

static void thin_bucket(void *data, uint32_t bucket, uint32_t worker) {
    (void)worker;
    const voxel_job *job = data;
    const uint32_t first = job->cubes->first_place[bucket];
    for (uint32_t g = 0; g < job->cubes->cube_count[bucket]; g++) {
        uint32_t count;
        const uint32_t *points = ewa_cubes_points(job->cubes, bucket, first + g, &count);
        if (count > 1) thin_voxel(job, points, count);
    }
}

ewa_status ewa_cloud_thin_voxels(const ewa_cloud *cloud, double size_world, uint8_t *marks) {
    if (!cloud || !marks) return EWA_ERROR_ARGUMENT;
    ewa_context *context = ewa_cloud_context(cloud);
    ewa_cell_frame frame = {
        .position = ewa_marks_position(cloud), .cell_world = size_world, .cubes_per_cell = 1};
    if (!frame.position) return EWA_ERROR_ARGUMENT;
    if (!(size_world > 0) || !isfinite(size_world))
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "voxels of size %g", size_world);
    ewa_cloud_origin(cloud, frame.origin_world);
    ewa_cubes cubes;
    ewa_status status = ewa_cubes_make(cloud, &frame, marks, &cubes);
    voxel_job job = {cloud, &cubes, marks};
    if (status == EWA_OK)
        status = ewa_parallel_stoppable(context, "thinning", thin_bucket, &job, cubes.bucket_count);
    ewa_cubes_free(&cubes);
    return status;
}
