// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One frame by all ranks. A tile in which one rank alone has splats is drawn as any tile is (surface/tile.c). Of the others,
// the stages of that are gone through for all at a time, each with what the ranks have found put together
// before the next: largest keys and sums of whole numbers have no order, so that the bytes are those of one
// process (docs/math.md section 6).
#include "cluster/joint.h"
#include "cluster/pack.h"
#include "wide/isa.h"

#include <string.h>

static void destroy(ewa_context *context, void *state) {
    ewa_joint *old = state;
    for (uint32_t i = 0; old->scratch && i < old->worker_count; i++)
        ewa_tile_scratch_free(context, &old->scratch[i]);
    ewa_release(context, old->scratch, old->worker_count, sizeof *old->scratch);
    ewa_joint_tile_cache *tile_caches = old->tile_caches.data;
    for (uint32_t i = 0; i < old->tile_cache_capacity; i++)
        ewa_tile_scratch_free(context, &tile_caches[i].scratch);
    ewa_job_room_free(context, &old->room);
    ewa_joint_sources_free(context, &old->sources);
    ewa_joint_tiles_free(context, &old->tiles);
    ewa_messages_free(context, &old->messages);
    ewa_buffer *const buffers[] = {&old->rows,   &old->passed, &old->given_keys, &old->taken_keys,
                                   &old->places, &old->kept,   &old->planes,     &old->totals,
                                   &old->packed, &old->wave,   &old->pixels,     &old->tile_caches};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++) ewa_buffer_free(context, buffers[i]);
    ewa_release(context, old, 1, sizeof *old);
}

static ewa_status create(ewa_context *context, void **state) {
    ewa_joint *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->tile_cache_bytes = EWA_JOINT_TILE_CACHE_BYTES;
    made->room.eye_dome.kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_pipeline_kernels);
    made->worker_count = ewa_context_worker_count(context);
    made->scratch = ewa_allocate_zeroed(context, made->worker_count, sizeof *made->scratch);
    if (!made->scratch) {
        destroy(context, made);
        return EWA_ERROR_MEMORY;
    }
    *state = made;
    return EWA_OK;
}

/// Gives the first contributions tile caches, as many as there is memory for.
static ewa_status reserve_tile_caches(ewa_joint *joint) {
    enum { SPLAT_BYTES = 224 }; // records, what they carry, lists of them
    const ewa_joint_tiles *tiles = &joint->tiles;
    size_t bytes = 0;
    for (joint->tile_cache_count = 0; joint->tile_cache_count < tiles->contribution_count;
         joint->tile_cache_count++) {
        const uint32_t tile = tiles->contributions[joint->tile_cache_count].tile;
        ewa_tile_job own = joint->job;
        own.largest_bin = 0;
        for (uint32_t i = 0; i < own.source_count; i++) {
            const uint64_t *starts = own.sources[i].bins.lists.starts;
            own.largest_bin += starts[tile + 1] - starts[tile];
        }
        bytes += own.largest_bin * EWA_PACKET_LANES * SPLAT_BYTES + joint->tile_floats * sizeof(float);
        if (bytes > joint->tile_cache_bytes) break;
        ewa_joint_tile_cache *tile_caches = joint->tile_caches.data;
        if (joint->tile_cache_count == joint->tile_cache_capacity) {
            EWA_TRY(ewa_buffer_grow(joint->context, &joint->tile_caches, joint->tile_cache_capacity,
                                    (size_t)joint->tile_cache_capacity + 1, sizeof *tile_caches));
            tile_caches = joint->tile_caches.data;
            memset(&tile_caches[joint->tile_cache_capacity++], 0, sizeof *tile_caches);
        }
        ewa_joint_tile_cache *cache = &tile_caches[joint->tile_cache_count];
        cache->kept = cache->behind = false;
        EWA_TRY(ewa_tile_scratch_reserve(joint->context, &cache->scratch, &own));
    }
    return EWA_OK;
}

/// Makes room for the frame.
static ewa_status reserve(ewa_joint *joint) {
    ewa_context *context = joint->context;
    const ewa_tile_job *job = &joint->job;
    const ewa_joint_tiles *tiles = &joint->tiles;
    const size_t side_px = job->tiles.side_px, contributions = tiles->contribution_count,
                 incoming = tiles->incoming_count;
    joint->tile_floats = ewa_tile_plane_floats(job);
    joint->pixel_lanes = side_px * side_px;
    const struct {
        ewa_buffer *buffer;
        size_t count, size_bytes;
    } needs[] = {
        {&joint->rows, contributions, sizeof *joint->contribution_rows},
        {&joint->passed, job->layers > 1 ? contributions * joint->pixel_lanes : 0, sizeof(float)},
        {&joint->places, 2 * incoming + 2 * contributions + 2, sizeof(size_t)},
        {&joint->kept, tiles->reduction_count, sizeof(ewa_joint_kept)},
        {&joint->planes, tiles->reduction_count * joint->tile_floats, sizeof(float)},
        {&joint->totals, joint->worker_count * ewa_joint_total_numbers(job), sizeof(int64_t)},
    };
    for (size_t i = 0; i < sizeof needs / sizeof needs[0]; i++) {
        EWA_TRY(ewa_buffer_reserve(context, needs[i].buffer, needs[i].count, needs[i].size_bytes));
    }
    joint->contribution_rows = joint->rows.data;
    joint->contribution_places = joint->places.data;
    joint->incoming_places = joint->contribution_places + contributions + 1;
    joint->incoming_sums = (const void **)(void *)(joint->incoming_places + incoming + 1);
    joint->active = (uint32_t *)(void *)(joint->incoming_sums + incoming);
    if (tiles->reduction_count) memset(joint->kept.data, 0, tiles->reduction_count * sizeof(ewa_joint_kept));
    for (uint32_t i = 0; i < joint->worker_count; i++) {
        EWA_TRY(ewa_tile_scratch_reserve(context, &joint->scratch[i], job));
    }
    return reserve_tile_caches(joint);
}

static ewa_status add(void *state, int64_t *numbers, uint32_t count) {
    ewa_joint *joint = state;
    return ewa_exchange_add(joint->context, &joint->exchange, numbers, count);
}

/// Adds up a number of all ranks.
static ewa_status add_up(ewa_joint *joint, uint64_t mine, uint64_t *sum) {
    int64_t value = (int64_t)mine;
    const ewa_status status = ewa_exchange_add(joint->context, &joint->exchange, &value, 1);
    *sum = (uint64_t)value;
    return status;
}

/// Makes the counts those of all ranks.
static ewa_status count_all(ewa_joint *joint, uint64_t *broken, ewa_render_stats *stats) {
    uint64_t *const counts[] = {broken,
                                &stats->splat_count,
                                &stats->culled_count,
                                &stats->hidden_count,
                                &stats->drawn_count,
                                &stats->fragment_count};
    enum { COUNTS = sizeof counts / sizeof counts[0] };
    int64_t values[COUNTS];
    for (int i = 0; i < COUNTS; i++) values[i] = (int64_t)*counts[i];
    const ewa_status status = ewa_exchange_add(joint->context, &joint->exchange, values, COUNTS);
    for (int i = 0; i < COUNTS; i++) *counts[i] = (uint64_t)values[i];
    return status;
}

/// Draws the surfaces of shared tiles, one behind the other, until nothing is open on any rank.
static ewa_status draw_shared(ewa_joint *joint) {
    const ewa_tile_job *job = &joint->job;
    uint64_t open = 0;
    for (uint32_t layer = 0; layer < job->layers; layer++) {
        uint64_t mine = 0;
        for (uint32_t m = 0; m < joint->tiles.reduction_count; m++) mine += joint->tiles.reductions[m].open;
        EWA_TRY(add_up(joint, mine, &open));
        if (!open) break;
        joint->surface = layer > 0;
        joint->whole = layer > 0 && job->merge_last && layer + 1 == job->layers;
        EWA_TRY(ewa_joint_find_nearest(joint));
        EWA_TRY(ewa_joint_gather(joint));
        EWA_TRY(ewa_joint_finalize(joint));
    }
    return EWA_OK;
}

/// The side of the tiles, the same on all ranks.
static uint32_t tile_side_px(const ewa_joint *joint) {
    return joint->sources.splat_count > EWA_DENSE_SURFELS ? EWA_DENSE_TILE_PX : 64;
}

static ewa_status draw(void *state, const ewa_render_job *own, ewa_render_stats *stats) {
    ewa_joint *joint = state;
    ewa_context *context = joint->context;
    const double start_s = ewa_now_s();
    if (own->first_row_px || own->end_row_px != own->camera.height_px)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED,
                        "render: a frame of several ranks is not drawn in bands");
    ewa_render_job frame;
    EWA_TRY(ewa_joint_sources_gather(context, &joint->exchange, &joint->sources, own, &frame));
    EWA_TRY(ewa_tile_job_make(context, &joint->room, &frame, tile_side_px(joint), &joint->job));
    EWA_TRY(ewa_tile_job_bin(context, &joint->room, &joint->job));
    joint->job.scratch = joint->scratch;
    // A rank without sources exchanges what the others do.
    joint->job.with_clips |= own->options.section_count > 0 && own->options.point_size_px == 0;
    ewa_status status = ewa_messages_open(context, &joint->exchange, &joint->messages);
    if (status == EWA_OK)
        status = ewa_joint_tiles_assign(context, &joint->exchange, &joint->job, &joint->tiles);
    if (status == EWA_OK) status = reserve(joint);
    *stats = (ewa_render_stats){.bin_s = (ewa_now_s() - start_s) * joint->worker_count};
    if (status == EWA_OK) status = ewa_joint_draw_alone(joint);
    if (status == EWA_OK) status = draw_shared(joint);
    if (status == EWA_OK) status = ewa_joint_resolve(joint);
    if (status == EWA_OK) status = ewa_joint_collect(joint);
    uint64_t broken = 0;
    for (uint32_t i = 0; i < joint->worker_count; i++) broken += joint->scratch[i].broken_pixel_count;
    const ewa_joint_tile_cache *tile_caches = joint->tile_caches.data;
    for (uint32_t i = 0; i < joint->tile_cache_count; i++) {
        joint->scratch->drawn_count += tile_caches[i].scratch.drawn_count;
        joint->scratch->fragment_count += tile_caches[i].scratch.fragment_count;
        joint->scratch->hidden_splat_count += tile_caches[i].scratch.hidden_splat_count;
    }
    ewa_job_count(&joint->job, joint->worker_count, stats);
    if (status == EWA_OK) status = count_all(joint, &broken, stats);
    EWA_TRY(status);
    const uint32_t to = joint->exchange.picture_rank;
    if (to == EWA_ALL_RANKS || to == joint->exchange.rank)
        ewa_job_finish(context, &joint->room, &frame, broken);
    stats->total_s = ewa_now_s() - start_s;
    return EWA_OK;
}

static const ewa_backend joint_backend = {
    .name = "joint", .create = create, .destroy = destroy, .draw = draw, .add = add};

ewa_status ewa_renderer_create_joint(ewa_context *context, const ewa_exchange *exchange,
                                     ewa_renderer **renderer) {
    if (!context || !exchange || !renderer) return EWA_ERROR_ARGUMENT;
    *renderer = NULL;
    EWA_TRY(ewa_exchange_check(context, exchange));
    EWA_TRY(ewa_renderer_create_by(context, &joint_backend, renderer));
    void *state = NULL;
    ewa_renderer_backend(*renderer, &context, &state);
    ((ewa_joint *)state)->exchange = *exchange;
    return EWA_OK;
}
