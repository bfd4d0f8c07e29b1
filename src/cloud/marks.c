// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Marks of points, block by block, and the cloud of what is marked.
#include "cloud/marks.h"
#include "base/base.h"
#include "cloud/cloud.h"

enum { PART_POINTS = 1 << 16 };

typedef struct mark_job {
    ewa_mark_block *look;
    const void *data;
    uint64_t point_count;
    uint8_t *marks;
} mark_job;

static uint32_t part_count(uint64_t point_count) { return (uint32_t)(point_count / PART_POINTS + 1); }

static void mark_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const mark_job *job = data;
    const uint32_t parts = part_count(job->point_count);
    const uint64_t end = ewa_split(job->point_count, parts, part + 1);
    for (uint64_t first = ewa_split(job->point_count, parts, part); first < end; first += EWA_MARK_BLOCK) {
        const uint64_t left = end - first;
        job->look(job->data, first, left < EWA_MARK_BLOCK ? (uint32_t)left : EWA_MARK_BLOCK,
                  job->marks + first);
    }
}

void ewa_mark_blocks(const ewa_cloud *cloud, ewa_mark_block *look, const void *data, uint8_t *marks) {
    mark_job job = {look, data, ewa_cloud_point_count(cloud), marks};
    ewa_parallel(ewa_cloud_context(cloud), mark_part, &job, part_count(job.point_count));
}

const ewa_attribute *ewa_marks_position(const ewa_cloud *cloud) {
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    if (position && position->component_count == 3) return position;
    ewa_fail(ewa_cloud_context(cloud), EWA_ERROR_ARGUMENT, "the cloud has no positions of three components");
    return NULL;
}

ewa_status ewa_cloud_keep(const ewa_cloud *cloud, const uint8_t *marks, ewa_cloud **selected) {
    if (!cloud || !marks || !selected) return EWA_ERROR_ARGUMENT;
    *selected = NULL;
    ewa_context *context = ewa_cloud_context(cloud);
    const uint64_t point_count = ewa_cloud_point_count(cloud);
    uint64_t kept = 0;
    for (uint64_t i = 0; i < point_count; i++) kept += marks[i] != 0;
    uint64_t *indices = ewa_allocate(context, kept, sizeof *indices);
    if (!indices) return EWA_ERROR_MEMORY;
    uint64_t to = 0;
    for (uint64_t i = 0; i < point_count; i++)
        if (marks[i]) indices[to++] = i;
    const ewa_status status = ewa_cloud_select(cloud, indices, kept, selected);
    ewa_release(context, indices, kept, sizeof *indices);
    return status;
}
