// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One tile from its packets to its pixels: runs of packets are set up, sorted and raise the depth bound; then
// all records that reach the bound are summed, and the sums resolved (docs/math.md sections 6 and 7).
//
// Records are kept from the first pass to the second. A tile that would need more than EWA_KEPT_RECORDS sets
// its runs up again for the second pass instead: the same records in the same order, so the same bytes.
#include "surface/tile.h"
#include "surface/render.h"
#include "surface/tile_runs.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/// Floats of the parts of a tile's planes.
typedef struct plane_sizes {
    size_t tile, sums, cuts; ///< of a plane, of all sums of one kind, of what is noted of clip lines
    bool two_words;
} plane_sizes;

static plane_sizes sizes_of(const ewa_tile_job *job) {
    plane_sizes sizes = {.tile = (size_t)job->tiles.side_px * job->tiles.side_px};
    sizes.two_words = job->fine_sums || job->with_depth || job->with_clips;
    sizes.sums = sizes.tile * job->channel_count * (sizes.two_words ? 2 : 1);
    sizes.cuts = job->with_clips ? sizes.tile * EWA_CUT_CHANNELS : 0;
    return sizes;
}

size_t ewa_tile_plane_floats(const ewa_tile_job *job) {
    // Per pixel: `nearest` twice, the edges' `passed`, and four channels of what lies behind; per block
    // `reach`; sums of both surfaces and of back-facing splats, and what is noted of clip lines by both, each
    // in two words.
    const plane_sizes n = sizes_of(job);
    return n.tile * (2 + 1 + 4) + n.tile / EWA_BLOCK_LANES + 2 * (3 * n.sums + 2 * n.cuts);
}

void ewa_tile_planes_bind(const ewa_tile_job *job, ewa_tile_scratch *s, float *planes) {
    const plane_sizes n = sizes_of(job);
    const size_t tile_floats = n.tile, sum_floats = n.sums, cut_floats = n.cuts;
    const bool two_words = n.two_words;
    s->nearest = planes;
    s->edges.rows = s->edge_rows_left;
    s->edges.nearest = s->nearest + tile_floats;
    s->edges.passed = s->edges.nearest + tile_floats;
    s->edges.behind = s->edges.passed + tile_floats;
    s->edges.reach = s->edges.behind + 4 * tile_floats;
    ewa_sums *const sums[5] = {&s->sums, &s->edges.sums, &s->side.is_back, &s->side.cut, &s->edges.side.cut};
    float *next = s->edges.reach + tile_floats / EWA_BLOCK_LANES;
    for (int i = 0; i < 5; i++) {
        const size_t floats = i < 3 ? sum_floats : cut_floats;
        *sums[i] = (ewa_sums){.planes = next,
                              .high = next + floats,
                              .fine = i < 3 && two_words ? floats / 2 : 0,
                              .careful = i > 0,
                              .max_visits = job->terms_per_carry,
                              .visits = s->visits[i],
                              .high_rows = s->high_rows[i]};
        next += 2 * floats;
    }
    s->edges.side.is_back = s->side.is_back;
    s->side.back_facing_rows = s->back_facing_rows[0],
    s->edges.side.back_facing_rows = s->back_facing_rows[1];
    s->side.cut_rows = cut_floats ? s->cut_rows[0] : NULL;
    s->edges.side.cut_rows = cut_floats ? s->cut_rows[1] : NULL;
}

static size_t all_boxes(const size_t counts[EWA_BOX_LEVELS]) {
    size_t sum = 0;
    for (int i = 0; i < EWA_BOX_LEVELS; i++) sum += counts[i];
    return sum;
}

/// Has a tile's memory, of so many records, packets, runs and boxes, point into its buffers.
static void bind(const ewa_tile_job *job, ewa_tile_scratch *s, uint64_t records, uint64_t packet_count, uint64_t run_count,
                 const size_t box_counts[EWA_BOX_LEVELS]) {
    const size_t box_count = all_boxes(box_counts);
    s->records = s->record_buffer.data;
    s->loads = s->load_buffer.data;
    s->order = s->order_buffer.data;
    s->listed = s->list_buffer.data;
    s->listed_keys = (float *)(s->listed + EWA_LISTS * records + EWA_BLOCK_LANES);
    int32_t *box_numbers = s->box_buffer.data;
    for (int i = 0; i < EWA_BOX_LEVELS; i++, box_numbers += box_counts[i - 1]) {
        s->boxes[i].first = box_numbers;
        s->boxes[i].last = box_numbers + box_count;
        s->boxes[i].key_low = (float *)(box_numbers + 2 * box_count);
    }
    s->near_surfels = s->near_buffer.data;
    s->clips = job->with_clips ? s->clip_buffer.data : NULL;
    s->opacities = job->with_opacity ? s->opacity_buffer.data : NULL;
    s->materials = job->with_materials ? s->material_buffer.data : NULL;
    s->surfels = job->gather ? s->surfel_buffer.data : NULL;
    if (job->gather) s->gather = *job->gather;
    s->gather.planes = s->gather_buffer.data;
    s->kept = s->kept_buffer.data;
    s->pixels = job->with_small ? s->pixel_buffer.data : NULL;
    ewa_tile_planes_bind(job, s, s->plane_buffer.data);
    s->record_capacity = records;
    s->kept_capacity = run_count;
    s->split = s->split_buffer.data;
    s->ordered = s->packet_buffer.data;
    s->depths = (float *)(s->ordered + packet_count);
    s->packets = s->ordered + 2 * packet_count;
}

ewa_status ewa_tile_scratch_reserve(ewa_context *context, ewa_tile_scratch *s, const ewa_tile_job *job) {
    uint64_t records = job->largest_bin * EWA_PACKET_LANES;
    if (records > EWA_KEPT_RECORDS) records = EWA_KEPT_RECORDS;
    if (records < EWA_RUN_RECORDS) records = EWA_RUN_RECORDS;
    const size_t tile_floats = (size_t)job->tiles.side_px * job->tiles.side_px;
    const uint64_t packet_count = job->largest_bin + (uint64_t)EWA_PACKET_LANES * (job->source_count + 1),
                   run_count = records / EWA_RUN_RECORDS + 2 * ((uint64_t)job->source_count + 1);
    const size_t box_counts[EWA_BOX_LEVELS] = {
        records + EWA_BLOCK_LANES, records / EWA_GROUP_RECORDS + EWA_BLOCK_LANES,
        records / EWA_GROUP_RECORDS / EWA_BLOCK_LANES + EWA_BLOCK_LANES};
    const size_t box_count = all_boxes(box_counts);
    const struct {
        ewa_buffer *buffer;
        size_t count, size_bytes;
    } needs[] = {
        {&s->record_buffer, records + EWA_PACKET_LANES, sizeof *s->records},
        {&s->load_buffer, records + EWA_PACKET_LANES, sizeof *s->loads},
        {&s->order_buffer, records + EWA_BLOCK_LANES, sizeof *s->order},
        {&s->list_buffer, 2 * (EWA_LISTS * records + EWA_BLOCK_LANES), sizeof *s->listed},
        {&s->box_buffer, 3 * box_count, sizeof(float)},
        {&s->near_buffer, records, sizeof *s->near_surfels},
        {&s->clip_buffer, job->with_clips ? records : 0, sizeof *s->clips},
        {&s->opacity_buffer, job->with_opacity ? records + EWA_PACKET_LANES : 0, sizeof *s->opacities},
        {&s->surfel_buffer, job->gather ? records + EWA_PACKET_LANES : 0, sizeof *s->surfels},
        {&s->gather_buffer, job->gather ? EWA_GATHER_PLANES * tile_floats : 0, sizeof(float)},
        {&s->material_buffer, job->with_materials ? records + EWA_PACKET_LANES : 0, sizeof *s->materials},
        {&s->kept_buffer, run_count, sizeof *s->kept},
        {&s->plane_buffer, ewa_tile_plane_floats(job), sizeof(float)},
        {&s->pixel_buffer, job->with_small ? tile_floats * EWA_PIXEL_FLOATS + EWA_BLOCK_LANES : 0,
         sizeof(float)},
        {&s->packet_buffer, 4 * packet_count, sizeof *s->ordered},
        {&s->split_buffer, job->source_count, sizeof *s->split},
    };
    for (size_t i = 0; i < sizeof needs / sizeof needs[0]; i++) {
        EWA_TRY(ewa_buffer_reserve(context, needs[i].buffer, needs[i].count, needs[i].size_bytes));
    }
    bind(job, s, records, packet_count, run_count, box_counts);
    s->drawn_count = s->fragment_count = s->hidden_splat_count = s->broken_pixel_count = 0;
    s->setup_s = s->visibility_s = s->accumulate_s = s->edge_s = s->resolve_s = 0;
    return EWA_OK;
}

void ewa_tile_scratch_free(ewa_context *context, ewa_tile_scratch *s) {
    ewa_buffer *const buffers[] = {
        &s->record_buffer,  &s->load_buffer, &s->order_buffer,    &s->list_buffer,  &s->box_buffer,
        &s->near_buffer,    &s->kept_buffer, &s->plane_buffer,    &s->pixel_buffer, &s->packet_buffer,
        &s->opacity_buffer, &s->clip_buffer, &s->material_buffer, &s->split_buffer,
        &s->surfel_buffer,  &s->gather_buffer};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++) ewa_buffer_free(context, buffers[i]);
}

enum { DEPTH_BUCKETS = 64 };

static float lesser(float a, float b) { return a < b ? a : b; }

/// The first or the last bucket for depths beyond the range of floats, of which differences say nothing.
static int depth_bucket(float depth, float nearest, float per_depth) {
    const float place = (depth - nearest) * per_depth;
    return place > 0 ? (place < DEPTH_BUCKETS - 1 ? (int)place : DEPTH_BUCKETS - 1) : 0;
}

/// The tile's packets with nearer groups first: what lies behind them need not be set up. By a counting sort,
/// which leaves groups of about one depth in their order along the curve. Groups are as many packets as the
/// kernels look at in one step.
static const uint32_t *front_to_back(const ewa_tile_job *job, const ewa_tile_source *source,
                                     ewa_tile_scratch *s, const uint32_t *ids, uint64_t count) {
    enum { GROUP = EWA_PACKET_LANES };
    const uint64_t group_count = count / GROUP; // the rest stays at the end
    float *depths = s->depths, nearest = INFINITY, farthest = -INFINITY;
    job->kernels->depths(&source->view, &source->surfels->bounds, &source->packets.places, ids,
                         (uint32_t)count, depths);
    for (uint64_t group = 0; group < group_count; group++) {
        float begin = INFINITY;
        for (uint32_t i = 0; i < GROUP; i++) begin = lesser(depths[group * GROUP + i], begin);
        depths[group] = begin;
        nearest = lesser(begin, nearest), farthest = begin > farthest ? begin : farthest;
    }
    if (!(nearest < farthest)) return ids;
    const float per_depth = (DEPTH_BUCKETS - 1) / (farthest - nearest);
    uint64_t next[DEPTH_BUCKETS + 1] = {0};
    for (uint64_t group = 0; group < group_count; group++)
        next[depth_bucket(depths[group], nearest, per_depth) + 1]++;
    for (int i = 0; i < DEPTH_BUCKETS; i++) next[i + 1] += next[i];
    for (uint64_t group = 0; group < group_count; group++) {
        const uint64_t at = next[depth_bucket(depths[group], nearest, per_depth)]++;
        memcpy(s->ordered + at * GROUP, ids + group * GROUP, GROUP * sizeof *ids);
    }
    const uint64_t done = group_count * GROUP;
    memcpy(s->ordered + done, ids + done, (count - done) * sizeof *ids);
    return s->ordered;
}

/// First pass over one source, some packets at a time: those that lie behind what is drawn by then are kept
/// for later. Where nothing is hidden, fewer and fewer packets are asked.
static void draw_visible(const ewa_tile_job *job, const ewa_tile_source *source, const ewa_tile *tile,
                         ewa_tile_scratch *s, ewa_tile_split *split, const uint32_t *ids, uint64_t count,
                         bool kept) {
    enum { CHUNK_PACKETS = 4 * EWA_RUN_PACKETS, MAX_PASSED = 6 };
    split->shown_count = split->hidden_count = 0;
    uint64_t drawn_runs = 0;
    uint32_t passed = 0; // chunks since the last that was asked, and until the next
    uint32_t to_pass = job->resolve.transparent ? UINT32_MAX : 1;
    for (uint64_t first = 0; first < count && ewa_tile_goes_on(job, s); first += CHUNK_PACKETS) {
        const uint32_t here = count - first < CHUNK_PACKETS ? (uint32_t)(count - first) : CHUNK_PACKETS;
        const double before = ewa_now_s();
        if (passed < to_pass) {
            memcpy(split->shown + split->shown_count, ids + first, here * sizeof *ids);
            split->shown_count += here;
            passed++;
        } else {
            job->kernels->set_cells(tile, s->cells);
            const uint32_t shown = job->kernels->hide(
                &source->view, &source->surfels->bounds, &source->packets.places, tile, s->cells, ids + first,
                here, split->shown + split->shown_count, split->hidden + split->hidden_count);
            split->shown_count += shown;
            split->hidden_count += here - shown;
            to_pass = shown < here ? 0 : to_pass < MAX_PASSED ? to_pass + 1 : MAX_PASSED;
            passed = 0;
        }
        s->setup_s += ewa_now_s() - before;
        const ewa_tile_packets packets = {source, split->shown, split->shown_count};
        const uint64_t end =
            first + here == count ? ewa_run_count(&packets) : split->shown_count / EWA_RUN_PACKETS;
        if (kept)
            ewa_tile_keep_runs(job, tile, s, &packets, drawn_runs, end, true);
        else
            ewa_tile_walk_again(job, tile, s, &packets, drawn_runs, end, EWA_PASS_VISIBILITY);
        drawn_runs = end;
    }
    s->hidden_splat_count += split->hidden_count * EWA_PACKET_LANES;
}

/// First pass over all sources; returns whether their runs are kept.
static bool draw_sources(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s, uint32_t index) {
    uint64_t all = 0;
    for (uint32_t i = 0; i < job->source_count; i++) {
        const uint64_t *first = &job->sources[i].bins.lists.starts[index];
        all += first[1] - first[0];
    }
    const bool kept = all * EWA_PACKET_LANES <= s->record_capacity;
    s->min_key = INFINITY;
    s->has_near = false;
    s->record_count = s->small_count = 0;
    ewa_tile_drop_runs(s);
    uint32_t *packets = s->packets;
    for (uint32_t i = 0; i < job->source_count; i++) {
        const ewa_tile_source *source = &job->sources[i];
        const uint64_t first = source->bins.lists.starts[index],
                       count = source->bins.lists.starts[index + 1] - first;
        const uint32_t *ids = count ? source->bins.lists.ids + first : NULL;
        s->split[i] = (ewa_tile_split){.shown = packets, .hidden = packets + count + 1};
        packets += 2 * (count + 1);
        if (!job->resolve.transparent) ids = front_to_back(job, source, s, ids, count);
        draw_visible(job, source, tile, s, &s->split[i], ids, count, kept);
    }
    return kept;
}

bool ewa_tile_find_nearest(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s,
                           uint32_t index) {
    return draw_sources(job, tile, s, index);
}

void ewa_tile_sum_nearest(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s, uint32_t index,
                          bool kept) {
    const uint32_t block_count = tile->blocks_per_row * tile->block_rows;
    job->kernels->set_cells(tile, s->cells);
    ewa_tile_close_pixels(tile->nearest, block_count, -INFINITY, INFINITY);
    if (kept) ewa_tile_walk_kept(job, tile, s, EWA_PASS_ACCUMULATE);
    for (uint32_t i = 0; i < job->source_count && !kept; i++) {
        const ewa_tile_source *source = &job->sources[i];
        const uint64_t first = source->bins.lists.starts[index],
                       count = source->bins.lists.starts[index + 1] - first;
        const uint32_t *ids = count ? source->bins.lists.ids + first : NULL;
        ewa_tile_packets shown = {source, s->packets, 0};
        shown.count =
            job->kernels->hide(&source->view, &source->surfels->bounds, &source->packets.places, tile,
                               s->cells, ids, (uint32_t)count, s->packets, s->packets + count + 1);
        ewa_tile_walk_again(job, tile, s, &shown, 0, ewa_run_count(&shown), EWA_PASS_ACCUMULATE);
    }
    ewa_tile_close_pixels(tile->nearest, block_count, INFINITY, -INFINITY);
}

void ewa_tile_place(const ewa_tile_job *job, ewa_tile_scratch *s, uint32_t index, ewa_tile *tile) {
    const ewa_tile_rect place = ewa_tiles_rect(&job->tiles, index);
    *tile = (ewa_tile){.x_px = (int32_t)place.x_px,
                       .y_px = (int32_t)place.y_px,
                       .width_px = (int32_t)place.width_px,
                       .height_px = (int32_t)place.height_px,
                       .nearest = s->nearest,
                       .sums = s->sums,
                       .side = s->side,
                       .channel_count = job->channel_count,
                       .with_normals = job->with_normals,
                       .with_depth = job->with_depth,
                       .with_opacity = job->with_opacity,
                       .with_materials = job->with_materials,
                       .with_fine = job->fine_sums,
                       .pixels = s->pixels,
                       .beyond_rows = s->beyond_rows,
                       .finalized_rows = s->finalized_rows};
    static_assert(EWA_FIELD_PX == EWA_MAX_TILE_BLOCKS * EWA_BLOCK_PX, "no tile is in two fields");
    tile->field_x_px = (float)(tile->x_px % EWA_FIELD_PX - EWA_FIELD_PX / 2);
    tile->field_y_px = (float)(tile->y_px % EWA_FIELD_PX - EWA_FIELD_PX / 2);
    tile->blocks_per_row = ((uint32_t)tile->width_px + EWA_BLOCK_PX - 1) / EWA_BLOCK_PX;
    tile->block_rows = ((uint32_t)tile->height_px + EWA_BLOCK_PX - 1) / EWA_BLOCK_PX;
}

/// The way back from a tile's first surfaces to their splats, and from those behind.
static void gather_back(const ewa_tile_job *job, ewa_tile *tile, ewa_tile_scratch *s, bool kept) {
    tile->gather = &s->gather;
    s->gather.rows = s->gather_rows;
    s->gather.beyond = false;
    job->kernels->set_gather(tile, &job->resolve);
    if (job->gather->colors) {
        ewa_tile_walk_shown(job, tile, s, kept, EWA_PASS_SPREAD);
        job->kernels->turn_gather(tile, &job->resolve);
    }
    if (job->gather->sums) ewa_tile_walk_shown(job, tile, s, kept, EWA_PASS_GATHER);
    if (!job->gather->filled) ewa_tile_draw_edges(job, tile, s, kept);
}

static bool is_blank(const ewa_tile_job *job, uint32_t index) {
    for (uint32_t i = 0; i < job->source_count; i++) {
        const uint64_t *first = &job->sources[i].bins.lists.starts[index];
        if (first[1] > first[0]) return false;
    }
    return true;
}

/// Notes a tile as blank, in squares; tiles are no smaller than these.
static void note_blank(const ewa_tile_job *job, uint32_t index) {
    const ewa_tile_rect place = ewa_tiles_rect(&job->tiles, index);
    const uint32_t columns = (job->tiles.width_px + EWA_BLANK_PX - 1) / EWA_BLANK_PX;
    const uint32_t first = place.y_px - job->first_row_px, end = first + place.height_px;
    for (uint32_t y = first / EWA_BLANK_PX; y * EWA_BLANK_PX < end; y++)
        for (uint32_t x = place.x_px / EWA_BLANK_PX; x * EWA_BLANK_PX < place.x_px + place.width_px; x++)
            job->blank[(size_t)y * columns + x] = 1;
}

void ewa_tile_draw(void *data, uint32_t number, uint32_t worker) {
    const ewa_tile_job *job = data;
    const uint32_t index = job->first_tile + number;
    if (job->blank && is_blank(job, index)) {
        note_blank(job, index);
        return;
    }
    ewa_tile_scratch *s = &job->scratch[worker];
    ewa_tile tile;
    ewa_tile_place(job, s, index, &tile);
    if (!s->mostly_small || job->gather) tile.pixels = NULL; // what is spread has one order of its terms
    job->kernels->clear_nearest(&tile);
    const bool kept = draw_sources(job, &tile, s, index);
    tile.only_small = tile.pixels && s->small_count == s->record_count && !s->has_near;
    if (s->record_count) s->mostly_small = 16 * s->small_count >= 15 * s->record_count;
    const double accumulating = ewa_now_s();
    const uint32_t block_count = tile.blocks_per_row * tile.block_rows;
    if (!job->all_hide) ewa_tile_close_pixels(tile.nearest, block_count, -INFINITY, INFINITY);
    for (bool finalized = false; !finalized; tile.sums.careful = true) {
        job->kernels->clear_sums(&tile);
        ewa_tile_walk_shown(job, &tile, s, kept, EWA_PASS_ACCUMULATE);
        finalized = job->kernels->finalize(&tile, &job->resolve);
    }
    if (!job->all_hide) ewa_tile_close_pixels(tile.nearest, block_count, INFINITY, -INFINITY);
    if (job->gather) {
        gather_back(job, &tile, s, kept);
        return;
    }
    const double accumulated = ewa_now_s();
    if (kept) s->accumulate_s += accumulated - accumulating;
    const bool edges = ewa_tile_draw_edges(job, &tile, s, kept);
    const double before = ewa_now_s();
    s->edge_s += before - accumulated;
    s->broken_pixel_count +=
        job->kernels->resolve(&tile, &job->resolve, edges ? &s->edges : NULL, s->edge_rows);
    s->resolve_s += ewa_now_s() - before;
}
