// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One frame by all ranks: the stages of src/surface/tile.c for the whole picture at a time, each with what the ranks have
// found put together before the next. Largest keys and sums of whole numbers have no order, so that the bytes are
// those of one process (docs/math.md section 6).
//
// Every rank resolves all tiles: that is little beside its splats, and each knows what is still open then.
#include "base/base.h"
#include "cluster/sources.h"
#include "surface/job.h"
#include "surface/tile_runs.h"
#include "wide/isa.h"

#include <math.h>
#include <string.h>

enum { LANES = EWA_BLOCK_LANES, ROWS = EWA_MAX_TILE_BLOCKS, BIAS_BITS = 0x4b400000, CARRY_SHIFT = 16 };

/// What a tile keeps from stage to stage beside its planes.
typedef struct joint_tile {
    uint32_t edge_rows[ROWS]; ///< blocks that had something behind, for the picture
    uint32_t open_rows[ROWS]; ///< blocks in which some pixel is still open
    uint32_t turned_rows[2][ROWS], cut_rows[2][ROWS], settled_rows[ROWS];
    bool open, layered;
} joint_tile;

typedef struct joint_state {
    ewa_context *context;
    ewa_exchange exchange;
    ewa_job_room room;
    ewa_joint_sources sources;
    ewa_tile_scratch *scratch; ///< [worker]
    uint32_t worker_count;
    ewa_buffer tiles, planes; ///< joint_tile; of each
    ewa_buffer keys, sums;    ///< what is exchanged
    // Of the frame:
    ewa_tile_job job;
    size_t tile_floats; ///< of all planes of a tile
    size_t pixel_lanes; ///< of one plane of a tile
    size_t tile_sums;   ///< numbers that a tile exchanges
    uint32_t surface;   ///< 0: the first, 1: one behind
    bool whole;         ///< all that is left is one surface
    uint32_t *order;    ///< the tiles that take part in an exchange
    uint32_t order_count;
    ewa_buffer order_buffer;
} joint_state;

static void destroy(ewa_context *context, void *state) {
    joint_state *old = state;
    for (uint32_t i = 0; old->scratch && i < old->worker_count; i++)
        ewa_tile_scratch_free(context, &old->scratch[i]);
    ewa_release(context, old->scratch, old->worker_count, sizeof *old->scratch);
    ewa_job_room_free(context, &old->room);
    ewa_joint_sources_free(context, &old->sources);
    ewa_buffer *const buffers[] = {&old->tiles, &old->planes, &old->keys, &old->sums, &old->order_buffer};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++) ewa_buffer_free(context, buffers[i]);
    ewa_release(context, old, 1, sizeof *old);
}

static ewa_status create(ewa_context *context, void **state) {
    joint_state *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->room.dome.kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_road_kernels);
    made->worker_count = ewa_context_worker_count(context);
    made->scratch = ewa_allocate_zeroed(context, made->worker_count, sizeof *made->scratch);
    if (!made->scratch) {
        destroy(context, made);
        return EWA_ERROR_MEMORY;
    }
    *state = made;
    return EWA_OK;
}

/// Points a worker at a tile's planes and brings what it keeps.
static joint_tile *take_tile(joint_state *joint, uint32_t index, uint32_t worker, ewa_tile *tile) {
    ewa_tile_scratch *s = &joint->scratch[worker];
    joint_tile *kept = (joint_tile *)joint->tiles.data + index;
    ewa_tile_planes_bind(&joint->job, s, (float *)joint->planes.data + index * joint->tile_floats);
    memcpy(s->edges.rows, kept->open_rows, sizeof kept->open_rows);
    memcpy(s->turned_rows, kept->turned_rows, sizeof kept->turned_rows);
    memcpy(s->cut_rows, kept->cut_rows, sizeof kept->cut_rows);
    memcpy(s->settled_rows, kept->settled_rows, sizeof kept->settled_rows);
    ewa_tile_place(&joint->job, s, index, tile);
    tile->pixels = NULL; // small splats have no sums of their own
    tile->only_small = false;
    tile->sums.careful = true;
    return kept;
}

static void leave_tile(const joint_state *joint, uint32_t worker, joint_tile *kept) {
    const ewa_tile_scratch *s = &joint->scratch[worker];
    memcpy(kept->open_rows, s->edges.rows, sizeof kept->open_rows);
    memcpy(kept->turned_rows, s->turned_rows, sizeof kept->turned_rows);
    memcpy(kept->cut_rows, s->cut_rows, sizeof kept->cut_rows);
    memcpy(kept->settled_rows, s->settled_rows, sizeof kept->settled_rows);
}

/// One pass over this rank's splats of a tile.
static void walk(const joint_state *joint, const ewa_tile *tile, ewa_tile_scratch *s, uint32_t index,
                 ewa_tile_pass what) {
    for (uint32_t i = 0; i < joint->job.source_count; i++) {
        const ewa_tile_source *source = &joint->job.sources[i];
        const uint64_t first = source->bins.lists.starts[index];
        const ewa_tile_packets all = {source, source->bins.lists.ids + first,
                                      source->bins.lists.starts[index + 1] - first};
        if (what >= EWA_PASS_EDGE_VISIBILITY)
            ewa_tile_draw_behind(&joint->job, tile, s, &all, what);
        else
            ewa_tile_walk_again(&joint->job, tile, s, &all, 0, ewa_run_count(&all), what);
    }
}

static float *keys_of(const joint_state *joint, uint32_t number) {
    return (float *)joint->keys.data + number * joint->pixel_lanes;
}

/// Finds the nearest of this rank's splats; an ewa_task.
static void find_nearest(void *data, uint32_t number, uint32_t worker) {
    joint_state *joint = data;
    ewa_tile_scratch *s = &joint->scratch[worker];
    const uint32_t index = joint->order[number];
    ewa_tile tile;
    joint_tile *kept = take_tile(joint, index, worker, &tile);
    if (joint->surface == 0) joint->job.kernels->clear_nearest(&tile);
    walk(joint, &tile, s, index, joint->surface ? EWA_PASS_EDGE_VISIBILITY : EWA_PASS_VISIBILITY);
    const uint32_t blocks = tile.blocks_per_row * tile.block_rows;
    float *keys = keys_of(joint, number);
    memcpy(keys, joint->surface ? s->edges.nearest : s->nearest, (size_t)blocks * LANES * sizeof *keys);
    for (size_t i = (size_t)blocks * LANES; i < joint->pixel_lanes; i++) keys[i] = -INFINITY;
    leave_tile(joint, worker, kept);
}

/// A set of sums of a tile, and how they are exchanged: blocks times channels, words after each other.
typedef struct sum_set {
    const ewa_sums *of;
    const uint32_t *within; ///< blocks that are being gathered; NULL: all
    uint32_t *rows;         ///< of those, blocks that have some; NULL: all
    uint32_t channels;
} sum_set;

/// The sets of the surface that is being gathered; returns how many.
static uint32_t sets_of(const joint_state *joint, ewa_tile_scratch *s, sum_set sets[3]) {
    const uint32_t channels = joint->job.channel_count;
    const ewa_apart *apart = joint->surface ? &s->edges.apart : &s->apart;
    const uint32_t *within = joint->surface ? s->edges.rows : NULL;
    uint32_t count = 0;
    sets[count++] = (sum_set){joint->surface ? &s->edges.sums : &s->sums, within, NULL, channels};
    sets[count++] = (sum_set){&apart->turned, within, apart->turned_rows, channels};
    if (apart->cut_rows) sets[count++] = (sum_set){&apart->cut, within, apart->cut_rows, EWA_CUT_CHANNELS};
    return count;
}

/// Numbers that a block of a set exchanges: a flag, then sums.
static size_t block_numbers(const sum_set *set) {
    return 1 + (size_t)set->channels * LANES * (set->of->fine ? 2 : 1);
}

/// Exchanges a plane of a block: its sum as one number, from and to low and high words (road_sums.h).
static void write_plane(const float *low, const float *high, bool has_high, int64_t *to) {
    int32_t bits[LANES], upper[LANES] = {0};
    memcpy(bits, low, sizeof bits);
    if (has_high) memcpy(upper, high, sizeof upper);
    for (int i = 0; i < LANES; i++) to[i] = (int64_t)upper[i] * (1 << CARRY_SHIFT) + (bits[i] - BIAS_BITS);
}

static void read_plane(const int64_t *from, float *low, float *high) {
    int32_t bits[LANES], upper[LANES];
    for (int i = 0; i < LANES; i++) {
        const int64_t lower = from[i] & ((1 << CARRY_SHIFT) - 1);
        upper[i] = (int32_t)((from[i] - lower) / (1 << CARRY_SHIFT));
        bits[i] = (int32_t)lower + BIAS_BITS;
    }
    memcpy(low, bits, sizeof bits);
    memcpy(high, upper, sizeof upper);
}

/// Where the planes of a block begin.
static size_t block_first(const sum_set *set, uint32_t block) {
    return (size_t)block * set->channels * LANES;
}

/// Writes what a tile has gathered.
static void write_sums(const sum_set *set, const ewa_tile *tile, int64_t *to) {
    const uint32_t columns = tile->blocks_per_row;
    for (uint32_t block = 0; block < columns * tile->block_rows; block++, to += block_numbers(set)) {
        const uint32_t row = block / columns, bit = 1u << block % columns;
        to[0] = (!set->within || (set->within[row] & bit)) && (!set->rows || (set->rows[row] & bit));
        memset(to + 1, 0, (block_numbers(set) - 1) * sizeof *to);
        if (!to[0]) continue;
        const bool has_high = set->of->high_rows[row] & bit;
        for (uint32_t c = 0; c < set->channels; c++) {
            const size_t at = block_first(set, block) + (size_t)c * LANES, fine = at + set->of->fine;
            write_plane(set->of->planes + at, set->of->high + at, has_high, to + 1 + (size_t)c * LANES);
            if (set->of->fine)
                write_plane(set->of->planes + fine, set->of->high + fine, has_high,
                            to + 1 + (size_t)(set->channels + c) * LANES);
        }
    }
}

/// Replaces what a tile has gathered by what all ranks have.
static void read_sums(const sum_set *set, const ewa_tile *tile, const int64_t *from) {
    const uint32_t columns = tile->blocks_per_row;
    for (uint32_t block = 0; block < columns * tile->block_rows; block++, from += block_numbers(set)) {
        const uint32_t row = block / columns, bit = 1u << block % columns;
        if (!from[0]) continue;
        if (set->rows) set->rows[row] |= bit;
        set->of->high_rows[row] |= bit;
        for (uint32_t c = 0; c < set->channels; c++) {
            const size_t at = block_first(set, block) + (size_t)c * LANES, fine = at + set->of->fine;
            read_plane(from + 1 + (size_t)c * LANES, set->of->planes + at, set->of->high + at);
            if (set->of->fine)
                read_plane(from + 1 + (size_t)(set->channels + c) * LANES, set->of->planes + fine,
                           set->of->high + fine);
        }
    }
}

static int64_t *sums_of(const joint_state *joint, uint32_t number) {
    return (int64_t *)joint->sums.data + number * joint->tile_sums;
}

/// Forgets what terms of the surface behind have been counted and carried: its planes begin at 0.
static void start_behind(ewa_tile_scratch *s) {
    memset(s->visits, 0, sizeof s->visits);
    memset(s->high_rows, 0, sizeof s->high_rows);
}

/// Sums this rank's splats that reach the nearest of all; an ewa_task.
static void gather_sums(void *data, uint32_t number, uint32_t worker) {
    joint_state *joint = data;
    ewa_tile_scratch *s = &joint->scratch[worker];
    const uint32_t index = joint->order[number];
    ewa_tile tile;
    joint_tile *kept = take_tile(joint, index, worker, &tile);
    const uint32_t blocks = tile.blocks_per_row * tile.block_rows;
    float *nearest = joint->surface ? s->edges.nearest : s->nearest;
    if (!joint->whole) memcpy(nearest, keys_of(joint, number), (size_t)blocks * LANES * sizeof *nearest);
    if (joint->surface == 0)
        joint->job.kernels->clear_sums(&tile);
    else if (joint->whole)
        joint->job.kernels->edge_take_all(&tile, &s->edges);
    start_behind(s);
    ewa_tile_close_pixels(nearest, blocks, -INFINITY, INFINITY);
    walk(joint, &tile, s, index, joint->surface ? EWA_PASS_EDGE_ACCUMULATE : EWA_PASS_ACCUMULATE);
    ewa_tile_close_pixels(nearest, blocks, INFINITY, -INFINITY);
    sum_set sets[3];
    int64_t *to = sums_of(joint, number);
    for (uint32_t i = 0, count = sets_of(joint, s, sets); i < count; i++) {
        write_sums(&sets[i], &tile, to);
        to += (size_t)blocks * block_numbers(&sets[i]);
    }
    memset(to, 0, (size_t)(sums_of(joint, number) + joint->tile_sums - to) * sizeof *to);
    leave_tile(joint, worker, kept);
}

/// Closes the blocks of a tile that are not marked.
static void close_unmarked(const ewa_tile *tile, ewa_tile_scratch *s) {
    for (uint32_t block = 0; block < tile->blocks_per_row * tile->block_rows; block++) {
        if (s->edges.rows[block / tile->blocks_per_row] >> block % tile->blocks_per_row & 1) continue;
        for (int i = 0; i < LANES; i++) s->edges.passed[(size_t)block * LANES + (size_t)i] = -INFINITY;
        for (int i = 0; i < LANES; i++) s->edges.nearest[(size_t)block * LANES + (size_t)i] = -INFINITY;
    }
}

/// Makes the surface of what all ranks have gathered; an ewa_task.
static void make_surface(void *data, uint32_t number, uint32_t worker) {
    joint_state *joint = data;
    const ewa_road_kernels *kernels = joint->job.kernels;
    ewa_tile_scratch *s = &joint->scratch[worker];
    const uint32_t index = joint->order[number];
    ewa_tile tile;
    joint_tile *kept = take_tile(joint, index, worker, &tile);
    const size_t blocks = (size_t)tile.blocks_per_row * tile.block_rows;
    start_behind(s);
    sum_set sets[3];
    const int64_t *from = sums_of(joint, number);
    for (uint32_t i = 0, count = sets_of(joint, s, sets); i < count; i++) {
        read_sums(&sets[i], &tile, from);
        from += blocks * block_numbers(&sets[i]);
    }
    uint32_t marked = 0;
    if (joint->surface == 0) {
        kernels->settle(&tile, &joint->job.resolve);
        if (joint->job.layers > 1) {
            memset(s->edges.rows, 0xff, sizeof s->edge_rows_left);
            marked = kernels->find_edges(&tile, &joint->job.resolve, &s->edges);
        }
        kept->layered = marked > 0;
        memcpy(kept->edge_rows, s->edges.rows, sizeof kept->edge_rows);
    } else {
        marked = kernels->edge_compose(&tile, &joint->job.resolve, &s->edges, joint->whole);
    }
    if (marked) close_unmarked(&tile, s);
    kept->open = marked > 0;
    leave_tile(joint, worker, kept);
}

/// Writes a tile's pixels; an ewa_task.
static void write_pixels(void *data, uint32_t index, uint32_t worker) {
    joint_state *joint = data;
    ewa_tile_scratch *s = &joint->scratch[worker];
    ewa_tile tile;
    const joint_tile *kept = take_tile(joint, index, worker, &tile);
    s->broken_pixel_count += joint->job.kernels->resolve(&tile, &joint->job.resolve,
                                                         kept->layered ? &s->edges : NULL, kept->edge_rows);
}

/// Lists the tiles that are open, or all of them.
static void order_tiles(joint_state *joint, bool all) {
    const joint_tile *tiles = joint->tiles.data;
    joint->order_count = 0;
    for (uint32_t i = 0; i < ewa_tiles_count(&joint->job.tiles); i++)
        if (all || tiles[i].open) joint->order[joint->order_count++] = i;
}

/// One surface: the stages, and what is exchanged between them.
static ewa_status draw_surface(joint_state *joint) {
    ewa_context *context = joint->context;
    const ewa_exchange *exchange = &joint->exchange;
    ewa_status status = EWA_OK;
    if (!joint->whole) {
        status = ewa_parallel_stoppable(context, "render", find_nearest, joint, joint->order_count);
        if (status != EWA_OK) return status;
        status =
            exchange->take_largest(exchange->user, joint->keys.data, joint->order_count * joint->pixel_lanes);
    }
    if (status == EWA_OK)
        status = ewa_parallel_stoppable(context, "render", gather_sums, joint, joint->order_count);
    if (status == EWA_OK)
        status = exchange->add(exchange->user, joint->sums.data, joint->order_count * joint->tile_sums);
    if (status == EWA_OK)
        status = ewa_parallel_stoppable(context, "render", make_surface, joint, joint->order_count);
    return status;
}

/// Makes room for the frame.
static ewa_status reserve(joint_state *joint) {
    ewa_context *context = joint->context;
    const ewa_tile_job *job = &joint->job;
    const size_t tiles = ewa_tiles_count(&job->tiles), side_px = job->tiles.side_px;
    joint->tile_floats = ewa_tile_plane_floats(job);
    joint->pixel_lanes = side_px * side_px;
    const size_t blocks = joint->pixel_lanes / LANES;
    const bool two_words = job->fine_sums || job->with_depth || job->with_clips;
    const size_t of_set = 1 + (size_t)job->channel_count * LANES * (two_words ? 2 : 1);
    joint->tile_sums = blocks * (2 * of_set + (job->with_clips ? 1 + EWA_CUT_CHANNELS * LANES : 0));
    const struct {
        ewa_buffer *buffer;
        size_t count, size_bytes;
    } needs[] = {{&joint->tiles, tiles, sizeof(joint_tile)},
                 {&joint->order_buffer, tiles, sizeof(uint32_t)},
                 {&joint->planes, tiles * joint->tile_floats, sizeof(float)},
                 {&joint->keys, tiles * joint->pixel_lanes, sizeof(float)},
                 {&joint->sums, tiles * joint->tile_sums, sizeof(int64_t)}};
    for (size_t i = 0; i < sizeof needs / sizeof needs[0]; i++) {
        const ewa_status status =
            ewa_buffer_reserve(context, needs[i].buffer, needs[i].count, needs[i].size_bytes);
        if (status != EWA_OK) return status;
    }
    joint->order = joint->order_buffer.data;
    memset(joint->tiles.data, 0, tiles * sizeof(joint_tile));
    for (uint32_t i = 0; i < joint->worker_count; i++) {
        const ewa_status status = ewa_tile_scratch_reserve(context, &joint->scratch[i], job);
        if (status != EWA_OK) return status;
    }
    return EWA_OK;
}

static ewa_status draw(void *state, const ewa_render_job *own, ewa_render_stats *stats) {
    enum { SIDE_PX = 64 };
    joint_state *joint = state;
    ewa_context *context = joint->context;
    const double start_s = ewa_now_s();
    if (own->first_row_px || own->end_row_px != own->camera.height_px)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED,
                        "render: a frame of several ranks is not drawn in bands");
    ewa_render_job frame;
    ewa_status status = ewa_joint_sources_gather(context, &joint->exchange, &joint->sources, own, &frame);
    if (status == EWA_OK) status = ewa_tile_job_make(context, &joint->room, &frame, SIDE_PX, &joint->job);
    if (status != EWA_OK) return status;
    joint->job.scratch = joint->scratch;
    joint->job.with_small = false;
    // A rank without sources exchanges what the others do.
    joint->job.with_clips |= own->options.section_count > 0 && own->options.point_size_px == 0;
    status = reserve(joint);
    for (uint32_t layer = 0; layer < joint->job.layers && status == EWA_OK; layer++) {
        joint->surface = layer > 0;
        joint->whole = layer > 0 && joint->job.merge_last && layer + 1 == joint->job.layers;
        order_tiles(joint, layer == 0);
        if (!joint->order_count) break;
        status = draw_surface(joint);
    }
    if (status == EWA_OK)
        status = ewa_parallel_stoppable(context, "render", write_pixels, joint,
                                        ewa_tiles_count(&joint->job.tiles));
    if (status != EWA_OK) return status;
    uint64_t broken = 0;
    *stats = (ewa_render_stats){.level = 0};
    for (uint32_t i = 0; i < joint->worker_count; i++) broken += joint->scratch[i].broken_pixel_count;
    ewa_job_finish(context, &joint->room, &frame, broken);
    ewa_job_count(&joint->job, stats);
    stats->total_s = ewa_now_s() - start_s;
    return EWA_OK;
}

static const ewa_backend joint_backend = {
    .name = "joint", .create = create, .destroy = destroy, .draw = draw};

ewa_status ewa_renderer_create_joint(ewa_context *context, const ewa_exchange *exchange,
                                     ewa_renderer **renderer) {
    if (!context || !exchange || !renderer) return EWA_ERROR_ARGUMENT;
    *renderer = NULL;
    if (!exchange->gather || !exchange->take_largest || !exchange->add || !exchange->rank_count ||
        exchange->rank >= exchange->rank_count)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "renderer: rank %u of %u, or an exchange without calls",
                        exchange->rank, exchange->rank_count);
    const ewa_status status = ewa_renderer_create_by(context, &joint_backend, renderer);
    if (status != EWA_OK) return status;
    void *state = NULL;
    ewa_renderer_backend(*renderer, &context, &state);
    ((joint_state *)state)->exchange = *exchange;
    return EWA_OK;
}
