// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The surfaces behind a tile's antialiased edges (semantics.h, edge layers). Few blocks have edges, and few
// splats lie behind them: these are listed block by block, so that a block's sums are gathered in one go.
#include "splat/tile.h"

#include <string.h>

enum {
    INDEX_BITS = 18, ///< of a pair: the splat's; the rest is the block's
    MAX_BLOCKS = EWA_MAX_TILE_BLOCKS * EWA_MAX_TILE_BLOCKS,
};

_Static_assert(EWA_KEPT_RECORDS <= 1 << INDEX_BITS, "a pair holds the index of a kept splat");

static uint32_t largest_run_pairs(const ewa_view *view) {
    const uint32_t side = view->tile_px / EWA_BLOCK_PX;
    return EWA_RUN_RECORDS * side * side;
}

uint32_t ewa_edge_pair_capacity(const ewa_view *view) { return 2 * largest_run_pairs(view); }

/// The kept runs whose splats are listed: from `kept_first` on; they are runs `first` to `end` of the tile.
typedef struct batch {
    uint64_t first, end, kept_first;
    uint32_t block_first[MAX_BLOCKS], block_end[MAX_BLOCKS]; ///< in scratch->listed
} batch;

/// [n - 1][row]: the marked blocks of n rows from `row` on, united.
typedef uint32_t united_rows[EWA_ROW_CLASSES - 1][EWA_MAX_TILE_BLOCKS];

static void unite_rows(const ewa_tile *tile, const uint32_t *rows, united_rows united) {
    for (uint32_t row = 0; row < tile->block_rows; row++) {
        uint32_t all = 0;
        for (uint32_t n = 0; n < EWA_ROW_CLASSES - 1; n++) {
            if (row + n < tile->block_rows) all |= rows[row + n];
            united[n][row] = all;
        }
    }
}

/// Writes those of a class' splats to `hits` whose box holds a marked block; returns how many.
static uint32_t find_hits(const ewa_sorted_run *run, uint32_t class, united_rows united, uint16_t *hits) {
    const uint32_t rows = class % EWA_ROW_CLASSES;
    const bool any = class == EWA_WIDE_CLASS || rows == EWA_ROW_CLASSES - 1; // large: take all
    uint32_t count = 0;
    for (uint32_t i = run->class_first[class]; i < run->class_first[class + 1]; i++) {
        const uint16_t splat = run->order[i];
        const uint32_t box = run->records[splat].box;
        hits[count] = splat;
        if (any) {
            count++;
        } else {
            const uint32_t columns = ((1u << (box >> 16 & 0xff)) - 1) << (box & 0xff);
            count += (united[rows][box >> 8 & 0xff] & columns) != 0;
        }
    }
    return count;
}

/// Lists the marked blocks that a splat may lie behind.
static uint32_t list_splat(const ewa_tile *tile, const float *reach, const ewa_record *r, uint32_t index,
                           uint32_t *pairs) {
    const uint32_t columns = r->box >> 16 & 0xff, rows = r->box >> 24;
    uint32_t block = (r->box >> 8 & 0xff) * tile->blocks_per_row + (r->box & 0xff), count = 0;
    for (uint32_t row = 0; row < rows; row++, block += tile->blocks_per_row) {
        for (uint32_t column = 0; column < columns; column++) {
            pairs[count] = (block + column) << INDEX_BITS | index;
            count += r->key_low < reach[block + column];
        }
    }
    return count;
}

static uint32_t list_run(const ewa_tile *tile, const ewa_edges *edges, const ewa_kept_run *kept,
                         united_rows united, uint32_t *pairs) {
    uint16_t hits[EWA_RUN_RECORDS + 1];
    uint32_t count = 0;
    for (uint32_t class = 0; class < EWA_CLASS_COUNT; class ++) {
        const uint32_t hit_count = find_hits(&kept->sorted, class, united, hits);
        for (uint32_t i = 0; i < hit_count; i++)
            count += list_splat(tile, edges->reach, &kept->sorted.records[hits[i]],
                                kept->record_first + hits[i], pairs + count);
    }
    return count;
}

/// Orders the pairs by block, stably, to scratch->listed.
static void sort_pairs(const ewa_tile *tile, ewa_tile_scratch *s, uint32_t pair_count, batch *made) {
    const uint32_t block_count = tile->blocks_per_row * tile->block_rows;
    uint32_t *next = made->block_end, sum = 0;
    memset(next, 0, block_count * sizeof *next);
    for (uint32_t i = 0; i < pair_count; i++) next[s->pairs[i] >> INDEX_BITS]++;
    for (uint32_t b = 0; b < block_count; b++) {
        const uint32_t count = next[b];
        made->block_first[b] = next[b] = sum;
        sum += count;
    }
    for (uint32_t i = 0; i < pair_count; i++)
        s->listed[next[s->pairs[i] >> INDEX_BITS]++] = s->pairs[i] & ((1u << INDEX_BITS) - 1);
}

/// Lists as many runs from `first` on as there is room for.
static void fill_batch(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s,
                       const ewa_tile_packets *packets, bool kept, uint64_t first, batch *made) {
    const uint32_t largest = largest_run_pairs(&job->view);
    united_rows united;
    unite_rows(tile, s->edges.rows, united);
    made->first = first;
    made->kept_first = kept ? first : 0;
    const uint64_t end = kept ? packets->run_count : ewa_tile_keep_runs(job, tile, s, packets, first, false);
    uint32_t pair_count = 0;
    for (made->end = first; made->end < end && pair_count <= largest; made->end++)
        pair_count += list_run(tile, &s->edges, &s->kept[made->kept_first + made->end - first], united,
                               s->pairs + pair_count);
    sort_pairs(tile, s, pair_count, made);
}

static void draw_batch(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s, batch *from,
                       ewa_tile_pass what) {
    for (uint32_t row = 0; row < tile->block_rows; row++) {
        for (uint32_t marked = s->edges.rows[row]; marked; marked &= marked - 1) {
            const uint32_t column = (uint32_t)__builtin_ctz(marked);
            const uint32_t block = row * tile->blocks_per_row + column, first = from->block_first[block];
            ewa_edge_splats splats = {s->records, s->loads, s->listed + first,
                                      from->block_end[block] - first};
            if (!splats.count) continue;
            job->kernels->edge_pass(&job->view, tile, &s->edges, row, column, &splats,
                                    what == EWA_PASS_EDGE_ACCUMULATE);
            from->block_end[block] = first + splats.count;
        }
    }
    for (uint64_t i = 0; i < from->end - from->first; i++) {
        const ewa_kept_run *kept = &s->kept[from->kept_first + i];
        ewa_tile_draw_near(job, tile, &s->edges, s->near_surfels + kept->near_first, kept->near_count, what);
    }
}

bool ewa_tile_draw_edges(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s,
                         const ewa_tile_packets *packets, bool kept) {
    if (job->edge_layers < 2 || !job->kernels->find_edges(tile, &job->resolve, &s->edges)) return false;
    memcpy(s->edge_rows, s->edges.rows, sizeof s->edge_rows);
    batch listed;
    listed.first = listed.end = 0;
    for (uint32_t layer = 1; layer < job->edge_layers; layer++) {
        for (ewa_tile_pass what = EWA_PASS_EDGE_VISIBILITY; what <= EWA_PASS_EDGE_ACCUMULATE; what++) {
            for (uint64_t first = 0; first < packets->run_count; first = listed.end) {
                // What lies behind a layer lies behind those before it: a list of all runs serves to the end.
                const bool all = listed.first == 0 && listed.end == packets->run_count;
                if (!all) fill_batch(job, tile, s, packets, kept, first, &listed);
                draw_batch(job, tile, s, &listed, what);
            }
        }
        if (!job->kernels->edge_compose(tile, &job->resolve, &s->edges)) break;
    }
    return true;
}
