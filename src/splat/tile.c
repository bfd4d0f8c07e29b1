// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One tile from its packets to its pixels: runs of packets are set up, sorted and raise the depth bound; then
// all records that reach the bound are summed, and the sums resolved (docs/math.md sections 6 and 7).
//
// Records are kept from the first pass to the second. A tile that would need more than EWA_KEPT_RECORDS sets
// its runs up again for the second pass instead: the same records in the same order, so the same bytes.
#include "splat/tile.h"
#include "splat/tile_runs.h"

#include <math.h>
#include <string.h>

ewa_status ewa_tile_scratch_reserve(ewa_context *context, ewa_tile_scratch *s, const ewa_tile_job *job,
                                    uint64_t largest_bin) {
    uint64_t records = largest_bin * EWA_PACKET_LANES;
    if (records > EWA_KEPT_RECORDS) records = EWA_KEPT_RECORDS;
    if (records < EWA_RUN_RECORDS) records = EWA_RUN_RECORDS;
    // Per pixel: nearest and sums twice, the edges' `passed`, and four channels of what lies behind; sums of
    // turned splats, and twice what is noted of clip lines; per block `reach`.
    const size_t tile_floats = (size_t)job->view.tile_px * job->view.tile_px;
    const size_t cut_floats = job->source.clip_masks ? tile_floats * EWA_CUT_CHANNELS : 0;
    const size_t pixel_floats = tile_floats * (2 * (1 + EWA_MAX_CHANNELS) + 1 + 4 + EWA_MAX_CHANNELS) +
                                2 * cut_floats + tile_floats / EWA_BLOCK_LANES;
    const uint64_t packet_count = largest_bin + EWA_PACKET_LANES;
    const size_t box_counts[EWA_BOX_LEVELS] = {
        records + EWA_BLOCK_LANES, records / EWA_GROUP_RECORDS + EWA_BLOCK_LANES,
        records / EWA_GROUP_RECORDS / EWA_BLOCK_LANES + EWA_BLOCK_LANES};
    size_t box_count = 0;
    for (int i = 0; i < EWA_BOX_LEVELS; i++) box_count += box_counts[i];
    const struct {
        ewa_buffer *buffer;
        size_t count, size_bytes;
    } needs[] = {
        {&s->record_buffer, records + EWA_PACKET_LANES, sizeof *s->records},
        {&s->load_buffer, records + EWA_PACKET_LANES, sizeof *s->loads},
        {&s->order_buffer, records, sizeof *s->order},
        {&s->list_buffer, 2 * (EWA_LISTS * records + EWA_BLOCK_LANES), sizeof *s->listed},
        {&s->box_buffer, 3 * box_count, sizeof(float)},
        {&s->near_buffer, records, sizeof *s->near_surfels},
        {&s->clip_buffer, job->source.clip_masks ? records : 0, sizeof *s->clips},
        {&s->opacity_buffer, job->with_opacity ? records + EWA_PACKET_LANES : 0, sizeof *s->opacities},
        {&s->material_buffer, job->with_materials ? records + EWA_PACKET_LANES : 0, sizeof *s->materials},
        {&s->kept_buffer, records / EWA_RUN_RECORDS + 2, sizeof *s->kept},
        {&s->pixel_buffer, pixel_floats, sizeof(float)},
        {&s->packet_buffer, 4 * packet_count, sizeof *s->shown},
    };
    for (size_t i = 0; i < sizeof needs / sizeof needs[0]; i++) {
        const ewa_status status =
            ewa_buffer_reserve(context, needs[i].buffer, needs[i].count, needs[i].size_bytes);
        if (status != EWA_OK) return status;
    }
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
    s->clips = job->source.clip_masks ? s->clip_buffer.data : NULL;
    s->opacities = job->with_opacity ? s->opacity_buffer.data : NULL;
    s->materials = job->with_materials ? s->material_buffer.data : NULL;
    s->kept = s->kept_buffer.data;
    s->nearest = s->pixel_buffer.data;
    s->sums = s->nearest + tile_floats;
    s->edges.rows = s->edge_rows_left;
    s->edges.nearest = s->sums + tile_floats * EWA_MAX_CHANNELS;
    s->edges.sums = s->edges.nearest + tile_floats;
    s->edges.passed = s->edges.sums + tile_floats * EWA_MAX_CHANNELS;
    s->edges.behind = s->edges.passed + tile_floats;
    s->edges.reach = s->edges.behind + 4 * tile_floats;
    s->apart.turned = s->edges.reach + tile_floats / EWA_BLOCK_LANES;
    s->edges.apart = s->apart;
    s->apart.cut = s->apart.turned + tile_floats * EWA_MAX_CHANNELS;
    s->edges.apart.cut = s->apart.cut + cut_floats;
    s->apart.turned_rows = s->turned_rows[0], s->edges.apart.turned_rows = s->turned_rows[1];
    s->apart.cut_rows = cut_floats ? s->cut_rows[0] : NULL;
    s->edges.apart.cut_rows = cut_floats ? s->cut_rows[1] : NULL;
    s->record_capacity = records;
    s->kept_capacity = records / EWA_RUN_RECORDS + 2;
    s->shown = s->packet_buffer.data;
    s->hidden = s->shown + packet_count;
    s->ordered = s->hidden + packet_count;
    s->depths_world = (float *)(s->ordered + packet_count);
    s->drawn_count = s->fragment_count = s->hidden_splat_count = s->broken_pixel_count = 0;
    s->setup_s = s->visibility_s = s->accumulate_s = s->edge_s = s->resolve_s = 0;
    return EWA_OK;
}

void ewa_tile_scratch_free(ewa_context *context, ewa_tile_scratch *s) {
    ewa_buffer *const buffers[] = {&s->record_buffer,  &s->load_buffer,  &s->order_buffer,
                                   &s->list_buffer,    &s->box_buffer,   &s->near_buffer,
                                   &s->kept_buffer,    &s->pixel_buffer, &s->packet_buffer,
                                   &s->opacity_buffer, &s->clip_buffer,  &s->material_buffer};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++) ewa_buffer_free(context, buffers[i]);
}

enum { DEPTH_BUCKETS = 64 };

/// The first or the last bucket for depths beyond the range of floats, of which differences say nothing.
static int depth_bucket(float depth, float nearest, float per_depth) {
    const float place = (depth - nearest) * per_depth;
    return place > 0 ? (place < DEPTH_BUCKETS - 1 ? (int)place : DEPTH_BUCKETS - 1) : 0;
}

/// The tile's packets with nearer runs first: what lies behind them need not be set up. By a counting sort,
/// which leaves runs of about one depth in their order along the curve.
static const uint32_t *front_to_back(const ewa_tile_job *job, ewa_tile_scratch *s, const uint32_t *ids,
                                     uint64_t count) {
    const uint64_t run_count = count / EWA_RUN_PACKETS; // the rest stays at the end
    float *depths = s->depths_world, nearest = INFINITY, farthest = -INFINITY;
    job->kernels->depths(&job->view, &job->surfels->bounds, &job->source.places, ids, (uint32_t)count,
                         depths);
    for (uint64_t run = 0; run < run_count; run++) {
        float begin = INFINITY;
        for (uint32_t i = 0; i < EWA_RUN_PACKETS; i++)
            begin = fminf(begin, depths[run * EWA_RUN_PACKETS + i]);
        depths[run] = begin;
        nearest = fminf(nearest, begin), farthest = fmaxf(farthest, begin);
    }
    if (!(nearest < farthest)) return ids;
    const float per_depth = (DEPTH_BUCKETS - 1) / (farthest - nearest);
    uint64_t next[DEPTH_BUCKETS + 1] = {0};
    for (uint64_t run = 0; run < run_count; run++) next[depth_bucket(depths[run], nearest, per_depth) + 1]++;
    for (int i = 0; i < DEPTH_BUCKETS; i++) next[i + 1] += next[i];
    for (uint64_t run = 0; run < run_count; run++) {
        const uint64_t at = next[depth_bucket(depths[run], nearest, per_depth)]++;
        memcpy(s->ordered + at * EWA_RUN_PACKETS, ids + run * EWA_RUN_PACKETS, EWA_RUN_PACKETS * sizeof *ids);
    }
    const uint64_t done = run_count * EWA_RUN_PACKETS;
    memcpy(s->ordered + done, ids + done, (count - done) * sizeof *ids);
    return s->ordered;
}

/// First pass, some packets at a time: those that lie behind what is drawn by then are put aside. Where
/// nothing is hidden, fewer and fewer packets are asked.
static void draw_visible(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s,
                         const uint32_t *ids, uint64_t count, bool kept) {
    enum { CHUNK_PACKETS = 4 * EWA_RUN_PACKETS, MOST_PASSED = 6 };
    s->shown_count = s->hidden_count = 0;
    s->least_key = INFINITY;
    s->has_near = false;
    ewa_tile_drop_runs(s);
    uint64_t drawn_runs = 0;
    uint32_t passed = 0; // chunks since the last that was asked, and until the next
    uint32_t to_pass = job->resolve.transparent ? UINT32_MAX : 1;
    for (uint64_t first = 0; first < count; first += CHUNK_PACKETS) {
        const uint32_t here = count - first < CHUNK_PACKETS ? (uint32_t)(count - first) : CHUNK_PACKETS;
        const double before = ewa_now_s();
        if (passed < to_pass) {
            memcpy(s->shown + s->shown_count, ids + first, here * sizeof *ids);
            s->shown_count += here;
            passed++;
        } else {
            job->kernels->set_cells(tile, s->cells);
            const uint32_t shown =
                job->kernels->hide(&job->view, &job->surfels->bounds, &job->source.places, tile, s->cells,
                                   ids + first, here, s->shown + s->shown_count, s->hidden + s->hidden_count);
            s->shown_count += shown;
            s->hidden_count += here - shown;
            to_pass = shown < here ? 0 : to_pass < MOST_PASSED ? to_pass + 1 : MOST_PASSED;
            passed = 0;
        }
        s->setup_s += ewa_now_s() - before;
        const ewa_tile_packets packets = {s->shown, s->shown_count};
        const uint64_t end =
            first + here == count ? ewa_run_count(&packets) : s->shown_count / EWA_RUN_PACKETS;
        if (kept)
            ewa_tile_keep_runs(job, tile, s, &packets, drawn_runs, end, true);
        else
            ewa_tile_walk_again(job, tile, s, &packets, drawn_runs, end, EWA_PASS_VISIBILITY);
        drawn_runs = end;
    }
    s->hidden_splat_count += s->hidden_count * EWA_PACKET_LANES;
}

void ewa_tile_draw(void *data, uint32_t index, uint32_t worker) {
    const ewa_tile_job *job = data;
    ewa_tile_scratch *s = job->scratch[worker];
    const ewa_view *view = &job->view;
    ewa_tile tile = {.x_px = (int32_t)(index % job->bins->tiles_x * view->tile_px),
                     .y_px = (int32_t)(index / job->bins->tiles_x * view->tile_px),
                     .nearest = s->nearest,
                     .sums = s->sums,
                     .apart = s->apart,
                     .channel_count = job->channel_count,
                     .with_normals = job->with_normals,
                     .with_depth = job->with_depth,
                     .with_opacity = job->with_opacity,
                     .with_materials = job->with_materials};
    const int32_t side = (int32_t)view->tile_px;
    tile.width_px = (int32_t)view->width_px - tile.x_px < side ? (int32_t)view->width_px - tile.x_px : side;
    tile.height_px =
        (int32_t)view->height_px - tile.y_px < side ? (int32_t)view->height_px - tile.y_px : side;
    tile.blocks_per_row = ((uint32_t)tile.width_px + EWA_BLOCK_PX - 1) / EWA_BLOCK_PX;
    tile.block_rows = ((uint32_t)tile.height_px + EWA_BLOCK_PX - 1) / EWA_BLOCK_PX;
    job->kernels->clear(&tile);
    const uint64_t first = job->bins->tile_first[index], count = job->bins->tile_first[index + 1] - first;
    const bool kept = count * EWA_PACKET_LANES <= s->record_capacity;
    const uint32_t *ids = job->bins->entries + first;
    draw_visible(job, &tile, s, job->resolve.transparent ? ids : front_to_back(job, s, ids, count), count,
                 kept);
    const ewa_tile_packets shown = {s->shown, s->shown_count};
    const double accumulating = ewa_now_s();
    if (kept)
        ewa_tile_walk_kept(job, &tile, s);
    else
        ewa_tile_walk_again(job, &tile, s, &shown, 0, ewa_run_count(&shown), EWA_PASS_ACCUMULATE);
    job->kernels->settle(&tile, &job->resolve);
    const double accumulated = ewa_now_s();
    if (kept) s->accumulate_s += accumulated - accumulating;
    const bool edges = ewa_tile_draw_edges(job, &tile, s, kept);
    const double before = ewa_now_s();
    s->edge_s += before - accumulated;
    s->broken_pixel_count +=
        job->kernels->resolve(&tile, &job->resolve, edges ? &s->edges : NULL, s->edge_rows);
    s->resolve_s += ewa_now_s() - before;
}
