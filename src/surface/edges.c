// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The surfaces behind a tile's antialiased edges (docs/math.md section 8; semantics.h, layers). Few blocks
// have edges, and few splats lie behind them: these are listed block by block, so that a block's sums are
// gathered in one go.
#include "surface/tile_runs.h"

#include <math.h>
#include <string.h>

enum { NOT_LISTED = UINT32_MAX };

static void start_lists(const ewa_tile_job *job, ewa_tile_scratch *s, bool whole, ewa_edge_lists *made) {
    made->whole = whole;
    made->begun = true;
    made->used = 0;
    memset(made->count, 0xff, sizeof made->count); // NOT_LISTED
    job->kernels->edge_boxes(s->boxes);
}

static void draw_block(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s,
                       ewa_edge_lists *from, uint32_t row, uint32_t column, ewa_tile_pass what) {
    const uint32_t block = row * tile->blocks_per_row + column;
    const bool listed = from->count[block] != NOT_LISTED;
    ewa_edge_splats splats = {s->records, s->loads,  s->opacities,   s->materials,
                              s->clips,   s->listed, s->listed_keys, 0};
    const uint32_t first = listed ? from->first[block] : from->used;
    splats.indices += first;
    splats.largest_keys += first;
    if (listed) {
        splats.count = from->count[block];
    } else {
        splats.count = job->kernels->edge_list(s->boxes, row, column, s->edges.reach[block], splats.indices);
        for (uint32_t i = 0; i < splats.count && what == EWA_PASS_EDGE_ACCUMULATE; i++)
            splats.largest_keys[i] = INFINITY;
    }
    if (splats.count)
        job->kernels->edge_pass(&job->sources[0].view, tile, &s->edges, row, column, &splats,
                                what == EWA_PASS_EDGE_ACCUMULATE);
    // What lies behind a layer lies behind those before it: a list serves to the end. There must be room for
    // another that holds all splats. Lists are shortened by whole vectors.
    const uint32_t taken = (splats.count + EWA_BLOCK_LANES - 1) / EWA_BLOCK_LANES * EWA_BLOCK_LANES;
    const size_t room = EWA_LISTS * s->record_capacity - from->used;
    if (listed || (from->whole && taken + s->record_capacity <= room)) {
        from->count[block] = splats.count;
        if (listed) return;
        from->first[block] = first;
        from->used += taken;
    }
}

/// One pass over the kept runs where most blocks are marked: as for the first surface, but beyond what has
/// passed.
static void draw_runs(const ewa_tile_job *job, const ewa_tile *tile, const ewa_tile_scratch *s,
                      ewa_tile_pass what) {
    ewa_tile behind = *tile;
    behind.nearest = s->edges.nearest, behind.sums = s->edges.sums, behind.passed = s->edges.passed;
    behind.side = s->edges.side;
    for (uint32_t i = 0; i < s->kept_count && ewa_tile_goes_on(job, s); i++) {
        if (!ewa_takes_part(s->kept[i].source, what)) continue;
        const ewa_view *view = &s->kept[i].source->view;
        if (what == EWA_PASS_EDGE_VISIBILITY)
            job->kernels->visibility(view, &behind, &s->kept[i].sorted);
        else
            job->kernels->accumulate(view, &behind, &s->kept[i].sorted);
    }
}

/// One pass over the splats that are kept.
static void draw_batch(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s,
                       ewa_edge_lists *from, ewa_tile_pass what, bool dense) {
    if (dense)
        draw_runs(job, tile, s, what);
    else
        for (uint32_t row = 0; row < tile->block_rows && ewa_tile_goes_on(job, s); row++)
            for (uint32_t marked = s->edges.rows[row]; marked; marked &= marked - 1)
                draw_block(job, tile, s, from, row, (uint32_t)__builtin_ctz(marked), what);
    for (uint32_t i = 0; i < s->kept_count && ewa_tile_goes_on(job, s); i++) {
        const ewa_kept_run *kept = &s->kept[i];
        ewa_tile_draw_near(job, kept->source, tile, &s->edges, s->near_surfels + kept->near_first,
                           kept->near_count, what);
    }
}

/// Whether so many blocks are marked that all splats are best drawn in all of them, or, of several sources,
/// must be, since pixel rays take views of the sources' own; then closes the others.
static bool close_others(const ewa_tile_job *job, const ewa_tile *tile, const ewa_tile_scratch *s,
                         uint32_t marked) {
    enum { MIN_SHARE = 4 };
    const bool one_view = job->source_count == 1 || !job->view.raycast;
    if (one_view && MIN_SHARE * marked < tile->blocks_per_row * tile->block_rows) return false;
    for (uint32_t row = 0; row < tile->block_rows; row++)
        for (uint32_t column = 0; column < tile->blocks_per_row; column++) {
            float *passed = s->edges.passed + (size_t)(row * tile->blocks_per_row + column) * EWA_BLOCK_LANES;
            for (int i = 0; i < EWA_BLOCK_LANES && !(s->edges.rows[row] >> column & 1); i++)
                passed[i] = -INFINITY;
        }
    return true;
}

/// Marks the cells with marked blocks, for kernels->hide: there everything shows, elsewhere nothing.
static void mark_cells(const ewa_tile *tile, ewa_tile_scratch *s) {
    for (int i = 0; i < EWA_TILE_CELLS * EWA_TILE_CELLS; i++) s->cells[i] = INFINITY;
    for (uint32_t row = 0; row < tile->block_rows; row++)
        for (uint32_t marked = s->edges.rows[row]; marked; marked &= marked - 1) {
            const uint32_t column = (uint32_t)__builtin_ctz(marked);
            s->cells[row / EWA_CELL_BLOCKS * EWA_TILE_CELLS + column / EWA_CELL_BLOCKS] = -INFINITY;
        }
}

/// A source's hidden packets that may reach marked blocks go behind those that are shown; returns how many.
static uint32_t show_behind_edges(const ewa_tile_job *job, const ewa_tile_source *source,
                                  const ewa_tile *tile, ewa_tile_scratch *s, const ewa_tile_split *split) {
    if (!split->hidden_count) return 0;
    mark_cells(tile, s);
    return job->kernels->hide(&source->view, &source->surfels->bounds, &source->packets.places, tile,
                              s->cells, split->hidden, (uint32_t)split->hidden_count,
                              split->shown + split->shown_count, split->hidden);
}

/// Replaces the depth `from` by `to` in the marked blocks: ewa_tile_close_pixels().
static void close_pixels(const ewa_tile_job *job, const ewa_tile *tile, const ewa_tile_scratch *s, float from,
                         float to) {
    for (uint32_t row = 0; row < tile->block_rows && !job->all_hide; row++)
        for (uint32_t marked = s->edges.rows[row]; marked; marked &= marked - 1) {
            const uint32_t block = row * tile->blocks_per_row + (uint32_t)__builtin_ctz(marked);
            ewa_tile_close_pixels(s->edges.nearest + (size_t)block * EWA_BLOCK_LANES, 1, from, to);
        }
}

/// Whether anything may lie behind a marked block.
static bool something_behind(const ewa_tile_job *job, const ewa_tile *tile, const ewa_tile_scratch *s) {
    for (uint32_t i = 0; i < job->source_count; i++)
        if (s->split[i].hidden_count) return true;
    if (s->has_near) return true;
    float reach = -INFINITY;
    for (uint32_t block = 0; block < tile->blocks_per_row * tile->block_rows; block++)
        reach = s->edges.reach[block] > reach ? s->edges.reach[block] : reach;
    return s->min_key < reach;
}

/// One pass over a source's splats, as many at a time as there is room for.
static void draw_some(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s,
                      const ewa_tile_packets *packets, ewa_edge_lists *current, ewa_tile_pass what,
                      bool dense) {
    for (uint64_t run = 0, end = ewa_run_count(packets); run < end && ewa_tile_goes_on(job, s);) {
        ewa_tile_drop_runs(s);
        run = ewa_tile_keep_runs(job, tile, s, packets, run, end, false);
        if (!dense) start_lists(job, s, false, current);
        draw_batch(job, tile, s, current, what, dense);
    }
}

/// Sets how far splats may be for marked blocks, and that nothing is wanted in others; returns how many are marked.
static uint32_t find_reach(const ewa_tile *tile, ewa_tile_scratch *s) {
    uint32_t count = 0;
    for (uint32_t block = 0; block < tile->blocks_per_row * tile->block_rows; block++) {
        const bool marked = s->edges.rows[block / tile->blocks_per_row] >> block % tile->blocks_per_row & 1;
        const float *passed = s->edges.passed + (size_t)block * EWA_BLOCK_LANES;
        float reach = -INFINITY;
        for (int i = 0; i < EWA_BLOCK_LANES && marked; i++) reach = passed[i] > reach ? passed[i] : reach;
        s->edges.reach[block] = reach;
        count += marked;
    }
    return count;
}

void ewa_tile_keep_behind(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s,
                          ewa_edge_lists *lists) {
    *lists = (ewa_edge_lists){.whole = true};
    for (uint32_t i = 0; i < job->source_count; i++) {
        ewa_tile_split *split = &s->split[i];
        const uint32_t behind = show_behind_edges(job, &job->sources[i], tile, s, split);
        const ewa_tile_packets more = {&job->sources[i], split->shown + split->shown_count, behind};
        const uint64_t end = ewa_run_count(&more);
        lists->whole = lists->whole && ewa_tile_keep_runs(job, tile, s, &more, 0, end, false) == end;
        split->shown_count += behind;
    }
}

void ewa_tile_draw_behind(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s, uint32_t index,
                          ewa_edge_lists *lists, ewa_tile_pass what) {
    const bool dense = close_others(job, tile, s, find_reach(tile, s));
    if (lists->whole) {
        if (!dense && !lists->begun) start_lists(job, s, true, lists);
        draw_batch(job, tile, s, lists, what, dense);
        return;
    }
    mark_cells(tile, s);
    for (uint32_t i = 0; i < job->source_count; i++) {
        const ewa_tile_source *source = &job->sources[i];
        const uint64_t first = source->bins.lists.starts[index],
                       count = source->bins.lists.starts[index + 1] - first;
        ewa_tile_packets shown = {source, s->packets, 0};
        shown.count = job->kernels->hide(&source->view, &source->surfels->bounds, &source->packets.places,
                                         tile, s->cells, source->bins.lists.ids + first, (uint32_t)count,
                                         s->packets, s->packets + count + 1);
        draw_some(job, tile, s, &shown, lists, what, dense);
    }
}

static void draw_again(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s, uint32_t source,
                       ewa_edge_lists *current, ewa_tile_pass what, bool dense) {
    const ewa_tile_packets all = {&job->sources[source], s->split[source].shown,
                                  s->split[source].shown_count};
    draw_some(job, tile, s, &all, current, what, dense);
}

/// Unmarks the blocks that no splat reaches behind the first surface; returns how many stay marked.
static uint32_t keep_beyond(const ewa_tile *tile, ewa_tile_scratch *s) {
    uint32_t marked = 0;
    for (uint32_t row = 0; row < tile->block_rows; row++) {
        for (uint32_t left = s->edges.rows[row] & ~s->beyond_rows[row]; left; left &= left - 1)
            s->edges.reach[row * tile->blocks_per_row + (uint32_t)__builtin_ctz(left)] = -INFINITY;
        s->edges.rows[row] &= s->beyond_rows[row];
        marked += (uint32_t)__builtin_popcount(s->edges.rows[row]);
    }
    memcpy(s->edge_rows, s->edges.rows, sizeof s->edge_rows);
    return marked;
}

/// Marks the blocks where something may lie behind the first surface: where splats were seen to, unless there
/// are others that were not looked at.
static void mark_beyond(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s) {
    bool others = s->has_near;
    for (uint32_t i = 0; i < job->source_count; i++) others |= s->split[i].hidden_count > 0;
    for (uint32_t row = 0; row < tile->block_rows; row++)
        s->edges.rows[row] = others ? UINT32_MAX : s->beyond_rows[row];
}

bool ewa_tile_draw_edges(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s, bool kept) {
    if (job->layers < 2) return false;
    mark_beyond(job, tile, s);
    uint32_t marked = job->kernels->find_edges(tile, &job->resolve, &s->edges);
    if (!marked || !something_behind(job, tile, s)) return false;
    for (uint32_t i = 0; i < job->source_count; i++) {
        ewa_tile_split *split = &s->split[i];
        const uint32_t behind = show_behind_edges(job, &job->sources[i], tile, s, split);
        const ewa_tile_packets more = {&job->sources[i], split->shown + split->shown_count, behind};
        const uint32_t records = s->boxes[0].count, near = s->near_count;
        if (kept) ewa_tile_keep_runs(job, tile, s, &more, 0, ewa_run_count(&more), false);
        for (uint32_t k = records; k < s->boxes[0].count; k++)
            ewa_mark_box(s->beyond_rows, s->records[k].box);
        if (s->near_count > near || (behind && !kept)) memset(s->beyond_rows, 0xff, sizeof s->beyond_rows);
        split->shown_count += behind;
    }
    marked = keep_beyond(tile, s);
    if (!marked) return false;
    ewa_edge_lists current;
    bool listed = false; // `current` holds what is kept
    for (uint32_t layer = 1; layer < job->layers && marked && ewa_tile_goes_on(job, s); layer++) {
        const bool dense = close_others(job, tile, s, marked),
                   last = job->merge_last && layer + 1 == job->layers;
        if (last) job->kernels->edge_take_all(tile, &s->edges);
        for (ewa_tile_pass what = last && dense ? EWA_PASS_EDGE_ACCUMULATE : EWA_PASS_EDGE_VISIBILITY;
             what <= EWA_PASS_EDGE_ACCUMULATE; what++) {
            if (kept) {
                if (!dense && !listed) start_lists(job, s, listed = true, &current);
                draw_batch(job, tile, s, &current, what, dense);
            }
            for (uint32_t i = 0; i < job->source_count && !kept; i++)
                draw_again(job, tile, s, i, &current, what, dense);
            if (last) job->kernels->edge_take_all(tile, &s->edges);
            if (what == EWA_PASS_EDGE_VISIBILITY) close_pixels(job, tile, s, -INFINITY, INFINITY);
        }
        close_pixels(job, tile, s, INFINITY, -INFINITY);
        marked = job->kernels->edge_compose(tile, &job->resolve, &s->edges, last);
        if (!tile->gather) continue;
        s->gather.beyond = true;
        ewa_tile_walk_shown(job, tile, s, kept, EWA_PASS_GATHER);
    }
    return true;
}
