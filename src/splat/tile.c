// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One tile from its packets to its pixels: runs of packets are set up, sorted and raise the depth bound; then
// all records that reach the bound are summed, and the sums resolved (docs/math.md sections 6 and 7).
//
// Records are kept from the first pass to the second. A tile that would need more than EWA_KEPT_RECORDS sets
// its runs up again for the second pass instead: the same records in the same order, so the same bytes.
#include "splat/tile.h"

#include <math.h>
#include <string.h>

enum { NEAR_CHUNK = 64 };

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

/// Orders a run's splats by class, stably.
static void sort_run(const ewa_run *run, uint16_t *order, ewa_sorted_run *sorted) {
    uint16_t next[EWA_CLASS_COUNT] = {0};
    for (uint32_t i = 0; i < run->count; i++) next[run->classes[i]]++;
    uint16_t sum = 0;
    for (int c = 0; c < EWA_CLASS_COUNT; c++) {
        sorted->class_first[c] = sum;
        sum = (uint16_t)(sum + next[c]);
        next[c] = sorted->class_first[c];
    }
    sorted->class_first[EWA_CLASS_COUNT] = sum;
    for (uint32_t i = 0; i < run->count; i++) order[next[run->classes[i]]++] = (uint16_t)i;
    sorted->records = run->records;
    sorted->loads = run->loads;
    sorted->opacities = run->opacities;
    sorted->materials = run->materials;
    sorted->order = order;
}

void ewa_tile_draw_near(const ewa_tile_job *job, const ewa_tile *tile, const ewa_edges *edges,
                        const uint32_t *surfels, uint32_t count, ewa_tile_pass what) {
    const ewa_road_kernels *kernels = job->kernels;
    ewa_near_record records[NEAR_CHUNK];
    for (uint32_t done = 0; done < count;) {
        uint32_t filled = 0;
        for (; done < count && filled < NEAR_CHUNK; done++)
            filled += ewa_near_record_set(&records[filled], job->surfels, surfels[done], &job->view, tile);
        if (what == EWA_PASS_VISIBILITY)
            kernels->near_visibility(&job->view, tile, records, filled);
        else if (what == EWA_PASS_ACCUMULATE)
            kernels->near_accumulate(&job->view, tile, records, filled);
        else
            kernels->edge_near_pass(&job->view, tile, edges, records, filled,
                                    what == EWA_PASS_EDGE_ACCUMULATE);
    }
}

static void count_splats(const ewa_tile_job *job, ewa_tile_scratch *s, const ewa_sorted_run *run) {
    s->drawn_count += s->run.count + s->run.near_count;
    if (!job->count_fragments) return;
    uint32_t blocks = 0;
    for (uint32_t c = 0; c < EWA_CLASS_COUNT; c++) {
        const uint32_t columns = c % EWA_STEEP_CLASS / EWA_ROW_CLASSES + 1, rows = c % EWA_ROW_CLASSES + 1;
        if (c < EWA_WIDE_CLASS && rows < EWA_ROW_CLASSES) {
            blocks += columns * rows * (uint32_t)(run->class_first[c + 1] - run->class_first[c]);
            continue;
        }
        for (uint32_t i = run->class_first[c]; i < run->class_first[c + 1]; i++) {
            const uint32_t box = run->records[run->order[i]].box;
            blocks += (box >> 16 & 0xff) * (box >> 24);
        }
    }
    s->fragment_count += blocks;
}

/// Sets up and sorts run `index`; its splats go to place `at` of the scratch.
static void prepare_run(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s,
                        const ewa_tile_packets *packets, uint64_t index, uint32_t at,
                        ewa_sorted_run *sorted) {
    const uint64_t first = index * EWA_RUN_PACKETS, left = packets->count - first;
    s->run.records = s->records + at;
    s->run.loads = s->loads + at;
    s->run.opacities = s->opacities ? s->opacities + at : NULL;
    s->run.materials = s->materials ? s->materials + at : NULL;
    const uint32_t announced = left < 2 * EWA_RUN_PACKETS ? (uint32_t)left : 2 * EWA_RUN_PACKETS;
    job->kernels->setup(&job->view, &job->source, packets->ids + first,
                        announced < EWA_RUN_PACKETS ? announced : EWA_RUN_PACKETS, announced, tile, &s->run);
    s->least_key = fminf(s->least_key, s->run.least_key);
    s->has_near |= s->run.near_count > 0;
    sort_run(&s->run, s->order + at, sorted);
    sorted->clips = s->clips ? s->clips + at : NULL;
    for (uint32_t i = 0; i < s->run.clipped_count; i++)
        ewa_clip_set(&s->clips[at + s->run.clipped[i].record], job->surfels, s->run.clipped[i].surfel,
                     &job->view, tile);
}

static void visit_run(const ewa_tile_job *job, const ewa_tile *tile, const ewa_sorted_run *run,
                      ewa_tile_pass what) {
    if (what == EWA_PASS_VISIBILITY)
        job->kernels->visibility(&job->view, tile, run);
    else
        job->kernels->accumulate(&job->view, tile, run);
}

/// Second pass over the runs that the first pass has kept.
static void walk_kept(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s) {
    for (uint32_t i = 0; i < s->kept_count; i++) {
        const ewa_kept_run *kept = &s->kept[i];
        visit_run(job, tile, &kept->sorted, EWA_PASS_ACCUMULATE);
        ewa_tile_draw_near(job, tile, NULL, s->near_surfels + kept->near_first, kept->near_count,
                           EWA_PASS_ACCUMULATE);
    }
}

/// One pass over runs [first, end), set up for it and forgotten.
static void walk_again(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s,
                       const ewa_tile_packets *packets, uint64_t first, uint64_t end, ewa_tile_pass what) {
    for (uint64_t i = first; i < end; i++) {
        ewa_sorted_run sorted;
        const double before = ewa_now_s();
        prepare_run(job, tile, s, packets, i, 0, &sorted);
        const double middle = ewa_now_s();
        s->setup_s += middle - before;
        visit_run(job, tile, &sorted, what);
        ewa_tile_draw_near(job, tile, NULL, s->run.near_surfels, s->run.near_count, what);
        if (what == EWA_PASS_VISIBILITY) count_splats(job, s, &sorted);
        *(what == EWA_PASS_VISIBILITY ? &s->visibility_s : &s->accumulate_s) += ewa_now_s() - middle;
    }
}

void ewa_tile_drop_runs(ewa_tile_scratch *s) { s->kept_count = s->near_count = s->boxes[0].count = 0; }

uint64_t ewa_tile_keep_runs(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s,
                            const ewa_tile_packets *packets, uint64_t first, uint64_t end, bool draw) {
    double before = ewa_now_s();
    uint64_t i = first;
    for (; i < end; i++) {
        const uint64_t packets_left = packets->count - i * EWA_RUN_PACKETS;
        const uint64_t lanes =
            EWA_PACKET_LANES * (packets_left < EWA_RUN_PACKETS ? packets_left : EWA_RUN_PACKETS);
        if (s->boxes[0].count + s->near_count + lanes > s->record_capacity) break;
        if (s->kept_count >= s->kept_capacity) break;
        ewa_kept_run *kept = &s->kept[s->kept_count++];
        prepare_run(job, tile, s, packets, i, s->boxes[0].count, &kept->sorted);
        kept->near_first = s->near_count;
        kept->near_count = s->run.near_count;
        for (uint32_t k = 0; k < kept->near_count; k++)
            s->near_surfels[s->near_count + k] = s->run.near_surfels[k];
        s->boxes[0].count += s->run.count;
        s->near_count += kept->near_count;
        const double middle = ewa_now_s();
        s->setup_s += middle - before;
        before = middle;
        if (!draw) continue;
        visit_run(job, tile, &kept->sorted, EWA_PASS_VISIBILITY);
        ewa_tile_draw_near(job, tile, NULL, s->run.near_surfels, kept->near_count, EWA_PASS_VISIBILITY);
        count_splats(job, s, &kept->sorted);
        before = ewa_now_s();
        s->visibility_s += before - middle;
    }
    return i;
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
            walk_again(job, tile, s, &packets, drawn_runs, end, EWA_PASS_VISIBILITY);
        drawn_runs = end;
    }
    s->hidden_splat_count += s->hidden_count * EWA_PACKET_LANES;
}

void ewa_tile_draw(void *data, uint32_t index, uint32_t worker) {
    const ewa_tile_job *job = data;
    ewa_tile_scratch *s = &job->scratch[worker];
    const ewa_tile_rect place = ewa_tiles_rect(&job->bins->tiles, index);
    ewa_tile tile = {.x_px = (int32_t)place.x_px,
                     .y_px = (int32_t)place.y_px,
                     .width_px = (int32_t)place.width_px,
                     .height_px = (int32_t)place.height_px,
                     .nearest = s->nearest,
                     .sums = s->sums,
                     .apart = s->apart,
                     .channel_count = job->channel_count,
                     .with_normals = job->with_normals,
                     .with_depth = job->with_depth,
                     .with_opacity = job->with_opacity,
                     .with_materials = job->with_materials};
    tile.blocks_per_row = ((uint32_t)tile.width_px + EWA_BLOCK_PX - 1) / EWA_BLOCK_PX;
    tile.block_rows = ((uint32_t)tile.height_px + EWA_BLOCK_PX - 1) / EWA_BLOCK_PX;
    job->kernels->clear(&tile);
    const uint64_t first = job->bins->lists.starts[index], count = job->bins->lists.starts[index + 1] - first;
    const bool kept = count * EWA_PACKET_LANES <= s->record_capacity;
    const uint32_t *ids = job->bins->lists.ids + first;
    draw_visible(job, &tile, s, job->resolve.transparent ? ids : front_to_back(job, s, ids, count), count,
                 kept);
    const ewa_tile_packets shown = {s->shown, s->shown_count};
    const double accumulating = ewa_now_s();
    if (kept)
        walk_kept(job, &tile, s);
    else
        walk_again(job, &tile, s, &shown, 0, ewa_run_count(&shown), EWA_PASS_ACCUMULATE);
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
