// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: what lies behind antialiased edges. The surfaces behind the first one are gathered
// in the few blocks that hold a partly covered pixel, one surface after another (docs/math.md section 8;
// semantics.h, layers).
#ifndef EWA_SRC_SURFACE_PIPELINE_EDGES_H
#define EWA_SRC_SURFACE_PIPELINE_EDGES_H

#include "surface/pipeline_gather.h"

static size_t block_at(const ewa_tile *tile, uint32_t row, uint32_t column) {
    return (size_t)row * tile->blocks_per_row + column;
}

/// Starts a surface in a block: where `open`, splats beyond the key `done` are wanted, elsewhere none.
static void start_surface(const ewa_tile *tile, const ewa_edges *edges, uint32_t row, uint32_t column,
                          wm open, wf done) {
    const size_t block = block_at(tile, row, column);
    const wf never = wf_set(-__builtin_inff()), passed = wf_select(open, done, never);
    wf_store(edges->passed + block * EWA_BLOCK_LANES, passed);
    edges->reach[block] = largest_lane(passed);
    wf_store(edges->nearest + block * EWA_BLOCK_LANES, never);
    clear_block(tile, &edges->sums, row, column, tile->channel_count);
    const uint32_t others = ~(1u << column);
    edges->side.back_facing_rows[row] &= others;
    if (edges->side.cut_rows) edges->side.cut_rows[row] &= others;
}

/// The tile as the surface that is being gathered behind its edges sees it.
static ewa_tile tile_behind(const ewa_tile *tile, const ewa_edges *edges) {
    ewa_tile behind = *tile;
    behind.nearest = edges->nearest, behind.sums = edges->sums, behind.side = edges->side;
    behind.with_depth = false;
    return behind;
}

static uint32_t find_edges(const ewa_tile *tile, const ewa_resolve *to, const ewa_edges *edges) {
    enum { LANES = EWA_BLOCK_LANES };
    uint32_t count = 0;
    const wf one = wf_set(1), zero = wf_set(0), never = wf_set(-__builtin_inff());
    for (uint32_t row = 0; row < tile->block_rows; row++) {
        const uint32_t candidates = edges->rows[row];
        edges->rows[row] = 0;
        for (uint32_t column = 0; column < tile->blocks_per_row; column++) {
            const size_t block = block_at(tile, row, column);
            edges->reach[block] = -__builtin_inff();
            if (!(candidates >> column & 1)) continue;
            const block_sums sums = tile_block(tile, row, column);
            const wf alpha = surface_alpha(tile, to, &sums, cut_cover(tile, row, column));
            // What is in front may be too small for its weight to be told from none.
            const wm open = wm_and(wf_lt(never, wf_load(tile->nearest + block * LANES)), wf_lt(alpha, one));
            if (!wm_bits(open)) continue;
            edges->rows[row] |= 1u << column;
            count++;
            start_surface(tile, edges, row, column, open, wf_load(tile->nearest + block * LANES));
            for (int c = 0; c < 4; c++) wf_store(edges->behind + (block * 4 + (size_t)c) * LANES, zero);
        }
    }
    return count;
}

/// Lane i: the largest lane of v[i].
static ALWAYS_INLINE wi largest_of_each(const wi v[EWA_BLOCK_LANES]) {
    wf f[EWA_BLOCK_LANES];
    for (int i = 0; i < EWA_BLOCK_LANES; i++) f[i] = wf_of_bits(v[i]);
    w_transpose(f);
    wi largest = wi_of_bits(f[0]);
    for (int i = 1; i < EWA_BLOCK_LANES; i++) largest = wi_max(largest, wi_of_bits(f[i]));
    return largest;
}

/// Fills sixteen boxes from `at` on, of which `count` are there, from the records' words.
static ALWAYS_INLINE void set_boxes(uint32_t at, uint32_t count, ewa_edge_boxes *boxes) {
    const wm there = wm_of_bits(count < EWA_BLOCK_LANES ? (1u << count) - 1 : 0xffff);
    const wi some = wi_set(boxes->first[at]);
    const wi box = wi_of_bits(wf_select(there, wf_of_bits(wi_load(boxes->first + at)), wf_of_bits(some)));
    enum { FLAGS = EWA_BACK_FACING_BIT | EWA_STEEP_BIT | EWA_CONCAVE_BIT | EWA_CLIP_BIT };
    const wi first = wi_and(box, wi_set(0xffff & ~FLAGS));
    const wm concave = wf_lt(wf_set(0), wf_from_i(wi_and(box, wi_set(EWA_CONCAVE_BIT))));
    const wi size = wi_and(wi_sar(box, 16), wi_set(0x3f3f));
    wi_store(boxes->first + at, first);
    wi_store(boxes->last + at, wi_add(wi_add(first, size), wi_set(EWA_BOX_GUARD - 0x0101)));
    wf_store(boxes->key_low + at, wf_select(wm_and(there, wm_not(concave)), wf_load(boxes->key_low + at),
                                            wf_set(__builtin_inff())));
}

/// What boxes span, by extremes that only grow: columns and rows, those of the first counted from 127 down,
/// and keys. Zero but for the keys: nothing.
typedef struct box_spans {
    wi left[EWA_BLOCK_LANES], above[EWA_BLOCK_LANES], right[EWA_BLOCK_LANES], below[EWA_BLOCK_LANES];
    wf nearer[EWA_BLOCK_LANES];
} box_spans;

/// Sets spans `i` to those of sixteen-lane rows [at, end) of `boxes`.
static ALWAYS_INLINE void span_boxes(const ewa_edge_boxes *boxes, uint32_t at, uint32_t end, box_spans *spans,
                                     uint32_t i) {
    const wi byte = wi_set(0x7f);
    wi left = wi_set(0), above = left, right = left, below = left;
    wf nearer = wf_set(-__builtin_inff());
    for (; at < end; at += EWA_BLOCK_LANES) {
        const wi first = wi_load(boxes->first + at), last = wi_load(boxes->last + at);
        left = wi_max(left, wi_sub(byte, wi_and(first, byte)));
        above = wi_max(above, wi_sub(byte, wi_sar(first, 8)));
        right = wi_max(right, wi_and(last, byte));
        below = wi_max(below, wi_and(wi_sar(last, 8), byte));
        nearer = wf_max(nearer, wf_negate(wf_load(boxes->key_low + at)));
    }
    spans->left[i] = left, spans->above[i] = above, spans->right[i] = right, spans->below[i] = below;
    spans->nearer[i] = nearer;
}

/// Makes a level of boxes from the one below, `each` of its entries to a box, sixteen boxes at a time; what
/// is too many in the last vector holds nothing.
static ALWAYS_INLINE void set_level(const ewa_edge_boxes *from, uint32_t each, ewa_edge_boxes *level) {
    const wi byte = wi_set(0x7f);
    level->count = (from->count + each - 1) / each;
    for (uint32_t g = 0; g < level->count; g += EWA_BLOCK_LANES) {
        box_spans spans;
        for (uint32_t i = 0; i < EWA_BLOCK_LANES; i++) {
            const uint32_t first = (g + i) * each, end = first + each;
            span_boxes(from, first, end < from->count ? end : from->count, &spans, i);
        }
        const wi left = wi_sub(byte, largest_of_each(spans.left)),
                 above = wi_sub(byte, largest_of_each(spans.above)), right = largest_of_each(spans.right),
                 below = largest_of_each(spans.below);
        wi_store(level->first + g, wi_or(left, wi_shl(above, 8)));
        wi_store(level->last + g, wi_or(wi_or(right, wi_shl(below, 8)), wi_set(EWA_BOX_GUARD)));
        w_transpose(spans.nearer);
        wf nearest = spans.nearer[0];
        for (int i = 1; i < EWA_BLOCK_LANES; i++) nearest = wf_max(nearest, spans.nearer[i]);
        wf_store(level->key_low + g, wf_negate(nearest));
    }
}

static void edge_boxes(ewa_edge_boxes levels[EWA_BOX_LEVELS]) {
    const uint32_t count = levels[0].count;
    for (uint32_t i = 0; i < count; i += EWA_BLOCK_LANES) set_boxes(i, count - i, &levels[0]);
    set_level(&levels[0], EWA_GROUP_RECORDS, &levels[1]);
    set_level(&levels[1], EWA_BLOCK_LANES, &levels[2]);
}

/// The boxes [at, at + 16) that hold the block and whose splats may be beyond `reach`.
static ALWAYS_INLINE wm holds_block(const ewa_edge_boxes *boxes, uint32_t at, wi block, wf reach) {
    const wi guard = wi_set(EWA_BOX_GUARD);
    const wi after_first = wi_sub(wi_or(block, guard), wi_load(boxes->first + at));
    const wi before_last = wi_sub(wi_load(boxes->last + at), block);
    const wf both = wf_from_i(wi_and(wi_and(after_first, before_last), guard));
    return wm_and(wf_le(wf_set(EWA_BOX_GUARD), both), wf_lt(wf_load(boxes->key_low + at), reach));
}

static uint32_t edge_list(const ewa_edge_boxes levels[EWA_BOX_LEVELS], uint32_t row, uint32_t column,
                          float reach, uint32_t *indices) {
    static const int32_t lane_numbers[EWA_BLOCK_LANES] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                          8, 9, 10, 11, 12, 13, 14, 15};
    const ewa_edge_boxes *boxes = &levels[0], *groups = &levels[1], *clusters = &levels[2];
    const wi block = wi_set((int32_t)(column | row << 8)), lanes = wi_load(lane_numbers);
    const wf beyond = wf_set(reach);
    uint32_t listed = 0;
    for (uint32_t c = 0; c < clusters->count; c += EWA_BLOCK_LANES)
        for (uint32_t near = wm_bits(holds_block(clusters, c, block, beyond)); near; near &= near - 1) {
            const uint32_t g = (c + (uint32_t)__builtin_ctz(near)) * EWA_BLOCK_LANES;
            for (uint32_t bits = wm_bits(holds_block(groups, g, block, beyond)); bits; bits &= bits - 1) {
                const uint32_t first = (g + (uint32_t)__builtin_ctz(bits)) * EWA_GROUP_RECORDS;
                const uint32_t end =
                    first + EWA_GROUP_RECORDS < boxes->count ? first + EWA_GROUP_RECORDS : boxes->count;
                for (uint32_t i = first; i < end; i += EWA_BLOCK_LANES) {
                    const wm hits = holds_block(boxes, i, block, beyond);
                    wi_pack((int32_t *)(void *)(indices + listed), hits, wi_add(lanes, wi_set((int32_t)i)));
                    listed += (uint32_t)__builtin_popcount(wm_bits(hits));
                }
            }
        }
    return listed;
}

/// Sixteen splats at one block: what its columns and rows of pixels share, a splat per lane.
typedef struct splat_lanes {
    wf quadratic[EWA_BLOCK_PX], cross[EWA_BLOCK_PX], key_x[EWA_BLOCK_PX],
        bound_x[EWA_BLOCK_PX]; ///< by column
    wf dy[EWA_BLOCK_PX];       ///< by row
    wf yy, key_y, bound_y;
    wm steep, clipped;
    wide_line line[EWA_CLIP_LINES];
    uint32_t line_count;                             ///< maximum count of one of them
    wf either;                                       ///< of clipped ones
    wf key_low, key_high, bound_scale, bound_offset; ///< of steep ones
} splat_lanes;

/// The clip lines of the lanes in `clipped_bits`; lines that keep everything for the others.
static void load_lines(const ewa_clip *clips, const uint32_t *indices, uint32_t count, uint32_t clipped_bits,
                       splat_lanes *s) {
    enum { NUMBERS = sizeof(ewa_clip_line) / sizeof(float) };
    static const ewa_clip_line keep_all = {.offset = 1};
    float numbers[EWA_CLIP_LINES][NUMBERS][EWA_BLOCK_LANES], either[EWA_BLOCK_LANES];
    s->line_count = 2;
    for (uint32_t i = 0; i < count && i < EWA_BLOCK_LANES; i++)
        if ((clipped_bits >> i & 1) && clips[indices[i]].count > s->line_count)
            s->line_count = clips[indices[i]].count;
    for (uint32_t i = 0; i < EWA_BLOCK_LANES; i++) {
        const bool clipped = clipped_bits >> i & 1;
        const ewa_clip *clip = clipped ? &clips[indices[i < count ? i : count - 1]] : NULL;
        for (uint32_t k = 0; k < s->line_count; k++) {
            float line[NUMBERS];
            memcpy(line, clip && k < clip->count ? &clip->line[k] : &keep_all, sizeof line);
            for (int c = 0; c < NUMBERS; c++) numbers[k][c][i] = line[c];
        }
        either[i] = clip && clip->either;
    }
    for (uint32_t k = 0; k < s->line_count; k++)
        s->line[k] = (wide_line){wf_load(numbers[k][0]), wf_load(numbers[k][1]), wf_load(numbers[k][2]),
                                 wf_load(numbers[k][3]), wf_load(numbers[k][4]), wf_load(numbers[k][5]),
                                 wf_load(numbers[k][6])};
    s->either = wf_load(either);
}

/// The shares of sixteen splats at one pixel.
static ALWAYS_INLINE wf lane_shares(const splat_lanes *s, float x, float y) {
    const wf x_px = wf_set(x), y_px = wf_set(y);
    wf own[2];
    for (int i = 0; i < 2; i++) own[i] = half_plane_share(&s->line[i], x_px, y_px);
    wf share = wf_select(wf_lt(wf_set(0), s->either), wf_max(own[0], own[1]), wf_min(own[0], own[1]));
    for (uint32_t i = 2; i < s->line_count; i++)
        share = wf_min(share, half_plane_share(&s->line[i], x_px, y_px));
    return share;
}

/// The same numbers as column_terms and the passes over whole boxes get.
static ALWAYS_INLINE splat_lanes load_splats(const ewa_record *records, const ewa_clip *clips,
                                             const uint32_t *indices, uint32_t count, uint32_t row,
                                             uint32_t column) {
    wf f[EWA_BLOCK_LANES];
    for (uint32_t i = 0; i < EWA_BLOCK_LANES; i++)
        f[i] = wf_load(&records[indices[i < count ? i : count - 1]].offset_x);
    w_transpose(f);
    splat_lanes s = {.bound_scale = f[8], .bound_offset = f[9], .key_high = f[10], .key_low = f[11]};
    const wi box = wi_of_bits(f[15]);
    s.steep = wf_lt(wf_set(0), wf_from_i(wi_and(box, wi_set(EWA_STEEP_BIT))));
    s.clipped = wf_lt(wf_set(0), wf_from_i(wi_and(box, wi_set(EWA_CLIP_BIT))));
    if (wm_bits(s.clipped)) load_lines(clips, indices, count, wm_bits(s.clipped), &s);
    const wi columns = wi_sub(wi_set((int32_t)column), wi_and(box, wi_set(0x3f)));
    const wf rows = wf_from_i(wi_sub(wi_set((int32_t)row), wi_and(wi_sar(box, 8), wi_set(0x3f))));
    const wf side = wf_set(EWA_BLOCK_PX), first_px = wf_add(f[0], wf_mul(side, wf_from_i(columns)));
    for (int i = 0; i < EWA_BLOCK_PX; i++) {
        const wf dx = wf_add(first_px, wf_set((float)i + 0.5f));
        s.quadratic[i] = wf_mul(wf_mul(f[2], dx), dx);
        s.cross[i] = wf_mul(f[3], dx);
        s.key_x[i] = wf_fma(f[6], dx, f[5]);
        s.bound_x[i] = wf_fma(f[9], dx, f[8]);
        s.dy[i] = wf_add(f[1], wf_set((float)i + 0.5f));
    }
    for (int steps = 0;; steps++) {
        const wm more = wf_lt(wf_set((float)steps), rows);
        if (!wm_bits(more)) break;
        for (int i = 0; i < EWA_BLOCK_PX; i++) s.dy[i] = wf_select(more, wf_add(s.dy[i], side), s.dy[i]);
    }
    s.yy = f[4], s.key_y = f[7], s.bound_y = f[10];
    return s;
}

/// First pass: sixteen splats at a time, pixel by pixel, for few are open. Keeps in the list only what counts
/// somewhere.
static void edge_raise(const ewa_view *view, const ewa_tile *tile, const ewa_edges *edges, uint32_t row,
                       uint32_t column, ewa_edge_splats *splats) {
    const wf end = wf_set(view->exponent_end), never = wf_set(-__builtin_inff()), zero = wf_set(0);
    const size_t at = block_at(tile, row, column) * EWA_BLOCK_LANES;
    const float *passed = edges->passed + at;
    const uint32_t open = wm_bits(wf_lt(never, wf_load(passed)));
    wf nearest[EWA_BLOCK_LANES];
    for (int i = 0; i < EWA_BLOCK_LANES; i++) nearest[i] = never;
    uint32_t kept = 0;
    for (uint32_t first = 0; first < splats->count; first += EWA_BLOCK_LANES) {
        const uint32_t count = splats->count - first;
        uint32_t *indices = splats->indices + first;
        const splat_lanes s = load_splats(splats->records, splats->clips, indices, count, row, column);
        const bool any_steep = wm_bits(s.steep) != 0, any_clipped = wm_bits(s.clipped) != 0;
        const wm is_exact = wm_and(s.steep, wf_le(s.bound_scale, zero));
        const bool any_exact = wm_bits(is_exact) != 0;
        wf largest_key = never;
        for (uint32_t left = open; left; left &= left - 1) {
            const uint32_t pixel = (uint32_t)__builtin_ctz(left), x = pixel % EWA_BLOCK_PX,
                           y = pixel / EWA_BLOCK_PX;
            const wf exponent = wf_fma(s.dy[y], wf_fma(s.yy, s.dy[y], s.cross[x]), s.quadratic[x]);
            wf key = wf_fma(s.key_y, s.dy[y], s.key_x[x]);
            wf bound = wf_fma(s.bound_y, s.dy[y], s.bound_x[x]);
            if (any_steep) {
                key = wf_select(s.steep, wf_min(wf_max(key, s.key_low), s.key_high), key);
                bound = wf_select(s.steep, wf_fma(s.bound_scale, key, s.bound_offset), bound);
            }
            wm beyond = wm_and(wf_lt(exponent, end), wf_lt(key, wf_set(passed[pixel])));
            if (any_clipped) {
                const float x_px = column_px(tile, column) + (float)x + 0.5f;
                const float y_px = row_px(tile, row) + (float)y + 0.5f;
                beyond = wm_and(beyond, wf_lt(zero, lane_shares(&s, x_px, y_px)));
            }
            if (any_exact) {
                const wf exact = wf_mul(key, wf_reciprocal(wf_fma(s.bound_offset, key, wf_set(1))));
                bound = wf_select(is_exact, exact, bound);
            }
            nearest[pixel] = wf_select(beyond, wf_max(bound, nearest[pixel]), nearest[pixel]);
            largest_key = wf_select(beyond, wf_max(key, largest_key), largest_key);
        }
        const uint32_t there = count < EWA_BLOCK_LANES ? (1u << count) - 1 : 0xffff;
        const wm keep = wm_and(wf_lt(never, largest_key), wm_of_bits(there));
        wi_pack((int32_t *)(void *)(splats->indices + kept), keep,
                wi_load((const int32_t *)(const void *)indices));
        wf_pack(splats->largest_keys + kept, keep, largest_key);
        kept += (uint32_t)__builtin_popcount(wm_bits(keep));
    }
    splats->count = kept;
    for (uint32_t left = open; left; left &= left - 1) {
        const uint32_t pixel = (uint32_t)__builtin_ctz(left);
        edges->nearest[at + pixel] = largest_lane(wf_max(nearest[pixel], wf_set(edges->nearest[at + pixel])));
    }
}

static ALWAYS_INLINE void edge_sum(const ewa_view *view, const ewa_tile *tile, const ewa_edges *edges,
                                   uint32_t row, uint32_t column, const ewa_edge_splats *splats, int what) {
    const size_t block = block_at(tile, row, column), at = block * EWA_BLOCK_LANES;
    const wf passed = wf_load(edges->passed + at), nearest = wf_load(edges->nearest + at);
    const wf end = wf_set(view->exponent_end), never = wf_set(-__builtin_inff());
    const wf behind_all = wf_set(__builtin_inff());
    // Splats that are nowhere as near as what counts.
    const float min_key =
        -largest_lane(wf_sub(wf_set(0), wf_select(wf_lt(never, nearest), nearest, behind_all)));
    const ewa_tile behind = tile_behind(tile, edges);
    float *sums = edges->sums.planes + block * tile->channel_count * EWA_BLOCK_LANES;
    uint32_t *visits = edges->sums.visits + block;
    for (uint32_t first = 0; first < splats->count; first += EWA_BLOCK_LANES) {
        const uint32_t left = splats->count - first;
        uint32_t near_enough = wm_bits(wf_le(wf_set(min_key), wf_load(splats->largest_keys + first)));
        if (left < EWA_BLOCK_LANES) near_enough &= (1u << left) - 1;
        for (; near_enough; near_enough &= near_enough - 1) {
            const uint32_t index = splats->indices[first + (uint32_t)__builtin_ctz(near_enough)];
            const ewa_record *r = &splats->records[index];
            const block_sample sample = sample_block(r, row, column);
            const wm beyond = wm_and(wf_lt(sample.exponent, end), wf_lt(sample.key, passed));
            wm counts = wm_and(beyond, wf_le(nearest, sample.key));
            const ewa_clip *clip = clip_of(splats->clips, index);
            clip_sample kept;
            if (box_clipped(r->box)) {
                kept = clip_block(tile, clip, row, column);
                counts = wm_and(counts, wf_lt(wf_set(0), kept.share));
            }
            if (!wm_bits(counts)) continue;
            const payload add = payload_load(view, r, &splats->loads[index], splats->opacities,
                                             splats->materials, index, what);
            const wf weight = wf_keep(counts, exponential(sample.exponent, view->doublings));
            if (box_clipped(r->box) || box_back_facing(r->box)) {
                add_splat(&behind, r, clip, &kept, row, column, weight, &add, wf_set(0), what);
                continue;
            }
            if (*visits == edges->sums.max_visits)
                carry_block(tile, &edges->sums, row, column, tile->channel_count);
            ++*visits;
            add_channels(sums, &edges->sums, tile->channel_count, weight, &add, wf_set(0), what);
        }
    }
}

/// edge_raise() for raycast splats.
static void ray_edge_raise(const ewa_view *view, const ewa_tile *tile, const ewa_edges *edges, uint32_t row,
                           uint32_t column, ewa_edge_splats *splats) {
    const size_t at = block_at(tile, row, column) * EWA_BLOCK_LANES;
    const wf end = wf_set(view->exponent_end), never = wf_set(-__builtin_inff());
    const wf passed = wf_load(edges->passed + at);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < splats->count; i++) {
        const uint32_t index = splats->indices[i];
        const ewa_record *r = &splats->records[index];
        const ray_splat ray = ray_start(view, r, splats->loads[index].peak);
        clip_sample left;
        const ray_sample sample =
            ray_block(view, tile, r, &ray, clip_of(splats->clips, index), row, column, &left);
        const wm beyond = wm_and(wf_lt(sample.exponent, end), wf_lt(sample.key, passed));
        if (!wm_bits(beyond)) continue;
        ray_raise(r, &sample, beyond, edges->nearest + at);
        splats->indices[kept] = index;
        splats->largest_keys[kept++] = largest_lane(wf_select(beyond, sample.key, never));
    }
    splats->count = kept;
}

static void ray_edge_sum(const ewa_view *view, const ewa_tile *tile, const ewa_edges *edges, uint32_t row,
                         uint32_t column, const ewa_edge_splats *splats) {
    const size_t block = block_at(tile, row, column), at = block * EWA_BLOCK_LANES;
    const wf passed = wf_load(edges->passed + at), nearest = wf_load(edges->nearest + at);
    const int what = channels_of(tile);
    const ewa_tile behind = tile_behind(tile, edges);
    for (uint32_t i = 0; i < splats->count; i++) {
        const uint32_t index = splats->indices[i];
        const ewa_record *r = &splats->records[index];
        const ewa_load *load = &splats->loads[index];
        const ray_splat ray = ray_start(view, r, load->peak);
        const ewa_clip *clip = clip_of(splats->clips, index);
        clip_sample left;
        const ray_sample sample = ray_block(view, tile, r, &ray, clip, row, column, &left);
        const wm counts = wm_and(wf_lt(sample.exponent, wf_set(view->exponent_end)),
                                 wm_and(wf_lt(sample.key, passed), wf_le(nearest, sample.key)));
        if (!wm_bits(counts)) continue;
        const payload add = payload_load(view, r, load, splats->opacities, splats->materials, index, what);
        const payload gained = payload_times(&add, wf_keep(counts, sample.gain), what);
        const wf bell = exponential(wf_keep(counts, sample.exponent), view->doublings);
        add_splat(&behind, r, clip, &left, row, column, wf_keep(counts, bell), &gained, wf_set(0), what);
    }
}

static void edge_pass(const ewa_view *view, const ewa_tile *tile, const ewa_edges *edges, uint32_t row,
                      uint32_t column, ewa_edge_splats *splats, bool second_pass) {
    if (view->raycast && second_pass)
        ray_edge_sum(view, tile, edges, row, column, splats);
    else if (view->raycast)
        ray_edge_raise(view, tile, edges, row, column, splats);
    else if (!second_pass)
        edge_raise(view, tile, edges, row, column, splats);
    else if (tile->with_fine)
        edge_sum(view, tile, edges, row, column, splats, channels_of(tile));
    else if (tile->with_materials && tile->with_opacity)
        edge_sum(view, tile, edges, row, column, splats, ADD_NORMAL | ADD_MATERIAL | ADD_OPACITY);
    else if (tile->with_materials)
        edge_sum(view, tile, edges, row, column, splats, ADD_NORMAL | ADD_MATERIAL);
    else if (tile->with_opacity)
        edge_sum(view, tile, edges, row, column, splats, ADD_NORMAL | ADD_OPACITY);
    else if (tile->with_normals)
        edge_sum(view, tile, edges, row, column, splats, ADD_NORMAL);
    else
        edge_sum(view, tile, edges, row, column, splats, 0);
}

static void edge_near_pass(const ewa_view *view, const ewa_tile *tile, const ewa_edges *edges,
                           const ewa_near_record *records, uint32_t count, bool second_pass) {
    const ewa_tile behind = tile_behind(tile, edges);
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t row = 0; row < tile->block_rows; row++) {
            for (uint32_t marked = edges->rows[row]; marked; marked &= marked - 1) {
                const uint32_t column = (uint32_t)__builtin_ctz(marked);
                const size_t block = block_at(tile, row, column);
                const near_sample sample = near_block(view, tile, &records[i], row, column);
                const wf key = key_of_depth(view, sample.z);
                float *nearest = edges->nearest + block * EWA_BLOCK_LANES;
                wm counts =
                    wm_and(sample.counts, wf_lt(key, wf_load(edges->passed + block * EWA_BLOCK_LANES)));
                if (!second_pass) {
                    near_raise(view, &records[i], &sample, counts, nearest);
                    continue;
                }
                counts = wm_and(counts, wf_le(wf_load(nearest), key));
                near_add(view, &behind, &records[i], &sample, counts, key, wf_load(nearest), row, column,
                         false);
            }
        }
    }
}

static void edge_take_all(const ewa_tile *tile, const ewa_edges *edges) {
    const wf all = wf_set(-3e38f); // below every key, but unlike -infinity something that counts
    for (uint32_t row = 0; row < tile->block_rows; row++)
        for (uint32_t marked = edges->rows[row]; marked; marked &= marked - 1) {
            const size_t block = block_at(tile, row, (uint32_t)__builtin_ctz(marked));
            wf_store(edges->nearest + block * EWA_BLOCK_LANES, all);
        }
}

/// Alpha of a layer that is all that is left, from that of one surface and the coverage (semantics.h,
/// layers).
static ALWAYS_INLINE wf merged_alpha(wf alpha, wf coverage) {
    const wf zero = wf_set(0), one = wf_set(1);
    wf through = wf_sub(one, alpha);
    for (int i = 1; i < EWA_MERGED_SURFACES; i++) {
        const wf share = wf_min(wf_max(wf_fma(coverage, wf_set(4), wf_set((float)(-4 * i - 2))), zero), one);
        if (!wm_bits(wf_lt(zero, share))) break;
        through = wf_mul(through, wf_sub(one, wf_mul(alpha, share)));
    }
    return wf_sub(one, through);
}

/// What a surface behind a first one of alpha `first` covers of the part that this leaves open, if both are
/// cut by clip lines (planes of cut_cover()): semantics.h, layers. `whole`: what it would cover without them.
static wf cover_behind_cut(wf first, const float *first_cut, wf whole, const float *cut) {
    enum { LANES = EWA_BLOCK_LANES };
    const wf zero = wf_set(0), one = wf_set(1), open = wf_sub(one, first), over = wf_load(cut);
    const wf x = wf_mul(wf_load(first_cut + CUT_X * LANES), wf_load(cut + CUT_X * LANES));
    const wf along = wf_fma(wf_load(first_cut + CUT_Y * LANES), wf_load(cut + CUT_Y * LANES), x);
    const wf beside = wf_max(wf_sub(over, first), zero);
    const wf behind = wf_div(beside, wf_select(wf_lt(zero, open), open, one));
    const wf related = wf_min(wf_mul(wf_abs(along), wf_set(2)), one);
    return wf_fma(related, wf_sub(wf_select(wf_lt(zero, along), behind, whole), over), over);
}

/// Composites one block's gathered surface under what is in front of it, and sets the planes of the way back; returns the
/// pixels that stay open.
static wm compose_block(const ewa_tile *tile, const ewa_resolve *to, const ewa_edges *edges, bool merged,
                        uint32_t row, uint32_t column) {
    enum { LANES = EWA_BLOCK_LANES };
    const size_t block = block_at(tile, row, column);
    const ewa_tile gathered = tile_behind(tile, edges);
    const bool finalizes = rows_to_finalize(&gathered, row) >> column & 1;
    if (finalizes) finalize_block(&gathered, to, row, column, merged);
    const block_sums sums = {edges->sums.planes + first_number(tile, row, column, tile->channel_count),
                             finalizes ? 0 : BIAS};
    float shade[EWA_SHADE_FLOATS];
    shade_block(tile, to, &sums, (uint32_t)tile->x_px + column * EWA_BLOCK_PX,
                (uint32_t)tile->y_px + row * EWA_BLOCK_PX, shade);
    const float *cut = merged ? NULL : cut_cover(&gathered, row, column);
    const float *first_cut = cut_cover(tile, row, column);
    surface found = gathered_surface(tile, to, &sums, shade, cut);
    if (cut && first_cut && !to->transparent) {
        const block_sums in_front = tile_block(tile, row, column);
        const wf first = surface_alpha(tile, to, &in_front, first_cut);
        const wf whole = surface_alpha(&gathered, to, &sums, NULL);
        found.alpha = cover_behind_cut(first, first_cut, whole, cut);
    }
    if (merged)
        found.alpha = merged_alpha(found.alpha, wf_mul(sum_of(&sums, 0), wf_set(to->unit_coverage_inverse)));
    float *behind = edges->behind + block * 4 * LANES;
    const wf covered = wf_load(behind + 3 * LANES);
    const wf share = wf_mul(wf_sub(wf_set(1), covered), found.alpha);
    for (int c = 0; c < 3; c++)
        wf_store(behind + c * LANES, wf_fma(found.color[c], share, wf_load(behind + c * LANES)));
    const wf total = wf_add(covered, share);
    wf_store(behind + 3 * LANES, total);
    if (tile->gather) {
        const block_sums in_front = tile_block(tile, row, column);
        const wf through = wf_sub(wf_set(1), surface_alpha(tile, to, &in_front, first_cut));
        set_gather_block(&gathered, to, &edges->side, &sums, wf_mul(share, through), merged, row, column,
                         wf_load(edges->nearest + block * LANES), wf_load(edges->passed + block * LANES));
    }
    const wm found_some = wf_lt(wf_set(-__builtin_inff()), wf_load(edges->nearest + block * LANES));
    return wm_and(found_some, wf_lt(total, wf_set(1)));
}

static uint32_t edge_compose(const ewa_tile *tile, const ewa_resolve *to, const ewa_edges *edges,
                             bool merged) {
    uint32_t count = 0;
    for (uint32_t row = 0; row < tile->block_rows; row++) {
        if (tile->gather) tile->gather->rows[row] = 0;
        for (uint32_t marked = edges->rows[row]; marked; marked &= marked - 1) {
            const uint32_t column = (uint32_t)__builtin_ctz(marked);
            const size_t block = block_at(tile, row, column);
            const wm open = compose_block(tile, to, edges, merged, row, column);
            if (wm_bits(open)) {
                start_surface(tile, edges, row, column, open,
                              wf_load(edges->nearest + block * EWA_BLOCK_LANES));
                count++;
            } else {
                edges->rows[row] &= ~(1u << column);
                edges->reach[block] = -__builtin_inff();
            }
        }
    }
    return count;
}

#endif
