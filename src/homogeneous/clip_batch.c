// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Batch clipping: which kernel, on which threads.
#include "homogeneous/clip_batch.h"

#include <stdatomic.h>

#include "base/base.h"

/// Segments of one task: large enough that handing it out costs nothing, small enough that inputs and outputs
/// (up to 113 bytes per segment) stay in the second-level cache.
enum { TASK_SEGMENTS = 8192 };

typedef struct job {
    const ewa_segment_batch *segments;
    const ewa_segment_clips *clips;
    clip_segments_kernel *kernel;
    _Atomic uint64_t invalid_count;
} job;

static void run_task(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    job *j = data;
    uint64_t first = (uint64_t)index * TASK_SEGMENTS, left = j->segments->count - first;
    uint64_t count = left < TASK_SEGMENTS ? left : TASK_SEGMENTS, invalid = 0;
    j->kernel(j->segments, j->clips, first, count);
    for (uint64_t i = 0; i < count; i++) invalid += j->clips->visible[first + i] == EWA_VISIBLE_INVALID;
    if (invalid) atomic_fetch_add(&j->invalid_count, invalid);
}

static bool arrays_are_there(const ewa_segment_batch *segments, const ewa_segment_clips *clips) {
    bool wants_ends = clips->end[0][0][0] != NULL;
    if (!clips->visible) return false;
    for (int i = 0; i < 2; i++)
        for (int e = 0; e < 2; e++) {
            if (!clips->alpha[i][e]) return false;
            for (int c = 0; c < 4; c++)
                if (!segments->end[e][c] || (clips->end[i][e][c] != NULL) != wants_ends) return false;
        }
    return true;
}

ewa_status ewa_clip_segments(ewa_context *context, const ewa_segment_batch *segments,
                             const ewa_segment_clips *clips) {
    if (!context || !segments || !clips) return EWA_ERROR_ARGUMENT;
    if (segments->count == 0) return EWA_OK;
    if (!arrays_are_there(segments, clips))
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "ewa_clip_segments: an array is NULL that must not be");
    uint64_t task_count = (segments->count - 1) / TASK_SEGMENTS + 1;
    if (task_count > UINT32_MAX)
        return ewa_fail(context, EWA_ERROR_ARGUMENT,
                        "ewa_clip_segments: %llu segments are too many for one batch",
                        (unsigned long long)segments->count);
    job j = {segments, clips, EWA_CHOOSE(ewa_context_cpu_features(context), ewa_clip_segments), 0};
    ewa_parallel(context, run_task, &j, (uint32_t)task_count);
    if (j.invalid_count == 0) return EWA_OK;
    uint64_t first = 0;
    while (clips->visible[first] != EWA_VISIBLE_INVALID) first++;
    return ewa_fail(
        context, EWA_ERROR_NUMERIC,
        "ewa_clip_segments: %llu of %llu segments have an end that is no point, the first is number %llu",
        (unsigned long long)j.invalid_count, (unsigned long long)segments->count, (unsigned long long)first);
}
