// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The back end of threads and vectors: an object whose memory survives, and the order of a frame's stages.
// Reference: src/reference/surface.c.
#include "base/base.h"
#include "surface/backend.h"
#include "surface/job.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Large tiles share fewer packets; small ones spread a small picture over the threads, and keep the records
/// of dense ones in the cache.
static uint32_t tile_side_px(const ewa_camera *camera, uint64_t splat_count) {
    enum { LARGE_PX = 1 << 20, MANY_SURFELS = 12000000 };
    return (uint64_t)camera->width_px * camera->height_px >= LARGE_PX && splat_count <= MANY_SURFELS ? 128
                                                                                                     : 64;
}

/// Whether a fair share of what is drawn lies in tiles that are too full for their splats to be kept from pass to pass.
static bool is_crowded(const ewa_tile_job *job) {
    enum { SHARE = 8 };
    uint64_t all = 0, crowded = 0;
    for (uint32_t tile = 0; tile < ewa_tiles_count(&job->tiles); tile++) {
        uint64_t packets = 0;
        for (uint32_t i = 0; i < job->source_count; i++) {
            const uint64_t *first = &job->sources[i].bins.lists.starts[tile];
            packets += first[1] - first[0];
        }
        all += packets;
        if (packets * EWA_PACKET_LANES > EWA_KEPT_RECORDS) crowded += packets;
    }
    return SHARE * crowded > all;
}

typedef struct cpu_state {
    ewa_context *context;
    ewa_job_room room;
    uint32_t worker_count;
    ewa_tile_scratch *scratch; ///< one per worker
} cpu_state;

static void destroy(ewa_context *context, void *state) {
    cpu_state *old = state;
    for (uint32_t i = 0; old->scratch && i < old->worker_count; i++)
        ewa_tile_scratch_free(context, &old->scratch[i]);
    ewa_release(context, old->scratch, old->worker_count, sizeof *old->scratch);
    ewa_job_room_free(context, &old->room);
    ewa_release(context, old, 1, sizeof *old);
}

static ewa_status create(ewa_context *context, void **state) {
    const uint32_t worker_count = ewa_context_worker_count(context);
    cpu_state *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->room.eye_dome.kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_pipeline_kernels);
    made->worker_count = worker_count;
    made->scratch = ewa_allocate_zeroed(context, worker_count, sizeof *made->scratch);
    if (!made->scratch) {
        destroy(context, made);
        return EWA_ERROR_MEMORY;
    }
    *state = made;
    return EWA_OK;
}

/// Draws the tiles of the frame's band.
static ewa_status draw_tiles(cpu_state *cpu, ewa_tile_job *job, const ewa_render_job *frame) {
    const uint32_t side_px = job->tiles.side_px, first_row = frame->first_row_px / side_px,
                   end_row = (frame->end_row_px + side_px - 1) / side_px;
    job->first_tile = first_row * job->tiles.columns;
    for (uint32_t i = 0; i < cpu->worker_count; i++)
        EWA_TRY(ewa_tile_scratch_reserve(cpu->context, &cpu->scratch[i], job));
    return ewa_parallel_stoppable(cpu->context, "render", ewa_tile_draw, job,
                                  (end_row - first_row) * job->tiles.columns);
}

static ewa_status draw(void *state, const ewa_render_job *frame, ewa_render_stats *stats) {
    cpu_state *cpu = state;
    ewa_context *context = cpu->context;
    const double start_s = ewa_now_s();
    uint64_t splat_count = 0;
    for (uint32_t i = 0; i < frame->source_count; i++) splat_count += frame->sources[i].surfels->count;
    uint32_t side_px = frame->tile_px ? frame->tile_px : tile_side_px(&frame->camera, splat_count);
    ewa_tile_job job;
    for (;; side_px /= 2) {
        EWA_TRY(ewa_tile_job_make(context, &cpu->room, frame, side_px, &job));
        EWA_TRY(ewa_tile_job_bin(context, &cpu->room, &job));
        if (frame->tile_px || side_px <= EWA_DENSE_TILE_PX || !is_crowded(&job)) break;
    }
    job.scratch = cpu->scratch;
    job.blank = frame->blank, job.first_row_px = frame->first_row_px;
    const double binned_s = ewa_now_s();
    EWA_TRY(draw_tiles(cpu, &job, frame));
    uint64_t broken = 0;
    for (uint32_t i = 0; i < cpu->worker_count; i++) broken += cpu->scratch[i].broken_pixel_count;
    ewa_job_finish(context, &cpu->room, frame, broken);
    *stats = (ewa_render_stats){.bin_s = (binned_s - start_s) * cpu->worker_count};
    ewa_job_count(&job, cpu->worker_count, stats);
    stats->total_s = ewa_now_s() - start_s;
    return EWA_OK;
}

const ewa_backend ewa_backend_cpu = {.name = "cpu", .create = create, .destroy = destroy, .draw = draw};
