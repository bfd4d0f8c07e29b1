// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of gaussian_body.h: the splats of a block of 4x4 pixels in the order of every pixel, by the depth at
// which its ray passes the greatest density (docs/math.md section 12).
//
// A splat that some pixels show waits until the smallest depth of those to come is behind it in some of them.
// What can be composited then is sorted for all sixteen pixels at once, by a network of the minimum and the
// greater of two keys, Batcher's; a key is a depth and the splat's place, so that ties are as the splats came.
// Nothing is ever dropped.
//
// Two that come next to each other in depth change places by and by: while they are nearer to each other than either is to
// the next one, and their intervals of one standard deviation meet, each is partly in front of the other. So nothing
// changes at once where depths are equal, and light is neither lost nor won (docs/math.md section 12).
//
// Based on: K. E. Batcher, "Sorting Networks and Their Applications", 1968 (the merge exchange, for any count).
#ifndef EWA_SRC_VOLUME_GAUSSIAN_ORDER_H
#define EWA_SRC_VOLUME_GAUSSIAN_ORDER_H

#include "volume/gaussian_kernels.h"
#include "volume/kernels_over.h"

/// What is kept of a splat or layer until the next one is known.
enum { PENDING_Z, PENDING_ALPHA, PENDING_DEVIATION, PENDING_COLOR, PENDING_LAYER = PENDING_COLOR + 3, PENDING_NUMBERS };

/// Farther than all there is, and yet finite.
static const float BEYOND = 1e30f;

/// A block while it is drawn.
typedef struct block_state {
    _Alignas(64) float pixels[EWA_VOLUME_CHANNELS * 16];
    float surface[16];      ///< where pixels' rays end
    float enter[16];        ///< where section planes begin them
    float half[16];         ///< what is left of the light where depth is noted
    float linear[4 * 16];   ///< of volumes: premultiplied light and alpha, beside those of `pixels`
    float pending[2][PENDING_NUMBERS][16]; ///< the last two of each pixel, nearer one first
    float gap[16], lead[16];               ///< from the one before these in depth; what shows of the first
    uint32_t alive;         ///< pixels in which more would show
    uint32_t waiting_count; ///< splats that wait, in the order in which they came
    uint32_t free_count, made_count;
    uint32_t come, at_once; ///< splats since some were composited, and how many come before that
} block_state;

/// Keys of pixels that do not show a splat, or not yet: greater than all others, +infinity as a float.
static const int32_t NO_KEY = 0x7f800000;

/// How far apart the codes of depths that are sorted at once may lie.
static const int64_t CODE_SPAN = 0x7f800000 >> EWA_GAUSSIAN_SORT_BITS;

/// Integers that sort as depths do; +0 for both zeros.
static ALWAYS_INLINE wi flip_code(wi bits) {
    const wi flip = wi_and(wi_sar(bits, 31), wi_set(INT32_MAX));
    return wi_sub(wi_or(bits, flip), wi_and(bits, flip));
}

static ALWAYS_INLINE int64_t depth_code(float z) {
    int32_t bits;
    __builtin_memcpy(&bits, &z, sizeof bits);
    return bits ^ (bits >> 31 & INT32_MAX);
}

static ALWAYS_INLINE float depth_of_code(int64_t code) {
    const int32_t own = (int32_t)code, bits = own ^ (own >> 31 & INT32_MAX);
    float z;
    __builtin_memcpy(&z, &bits, sizeof z);
    return z;
}

/// Minimum of sixteen numbers.
static ALWAYS_INLINE float min_of(wf a) {
    typedef float four __attribute__((vector_size(16)));
    typedef int32_t mask __attribute__((vector_size(16)));
    float lanes[16];
    four part[4];
    wf_store(lanes, a);
    __builtin_memcpy(part, lanes, sizeof part);
    for (int half = 2; half; half /= 2)
        for (int i = 0; i < half; i++) {
            const mask less = part[i] < part[i + half];
            part[i] = (four)((less & (mask)part[i]) | (~less & (mask)part[i + half]));
        }
    const float low = part[0][0] < part[0][1] ? part[0][0] : part[0][1];
    const float high = part[0][2] < part[0][3] ? part[0][2] : part[0][3];
    return low < high ? low : high;
}

/// A place for a splat that comes; it counts once it is kept.
static ALWAYS_INLINE ewa_gaussian_hit *next_hit(const ewa_gaussian_tile *tile, const block_state *block) {
    return &tile->hit[block->free_count ? tile->free[block->free_count - 1] : block->made_count];
}

static ALWAYS_INLINE void keep_hit(ewa_gaussian_tile *tile, block_state *block) {
    tile->waiting[block->waiting_count++] =
        block->free_count ? tile->free[--block->free_count] : block->made_count++;
    block->come++;
}

/// Lists the first of those that wait and show in some pixel up to a depth, as many as are sorted at once;
/// returns how many there are in all. `minimum` gets the smallest of their depths.
static ALWAYS_INLINE uint32_t choose(const ewa_gaussian_tile *tile, const block_state *block, float top,
                                     float *minimum) {
    const wf bound = wf_set(top), infinite = wf_set(__builtin_inff());
    wf low = infinite;
    uint32_t count = 0;
    for (uint32_t i = 0; i < block->waiting_count; i++) {
        const uint32_t number = tile->waiting[i];
        const wf z = wf_load(tile->hit[number].z);
        const wm shows = wm_and(wm_of_bits(tile->hit[number].active & block->alive), wf_le(z, bound));
        low = wf_min(low, wf_select(shows, z, infinite));
        if (count < EWA_GAUSSIAN_SORTED) tile->sort_buffer->chosen[count] = number;
        count += wm_bits(shows) != 0;
    }
    *minimum = min_of(low);
    return count;
}

/// Lays out the keys of those chosen, in the pixels that show them up to a depth, where they wait no longer;
/// rows of none up to the next four.
static ALWAYS_INLINE void lay_out(ewa_gaussian_tile *tile, const block_state *block, uint32_t count,
                                  float top, int64_t low_code) {
    ewa_gaussian_sort_buffer *sort_buffer = tile->sort_buffer;
    const wf bound = wf_set(top);
    const wi low = wi_set((int32_t)low_code);
    for (uint32_t i = 0; i < count; i++) {
        ewa_gaussian_hit *hit = &tile->hit[sort_buffer->chosen[i]];
        const wf z = wf_load(hit->z);
        const wm shows = wm_and(wm_of_bits(hit->active & block->alive), wf_le(z, bound));
        const wi place = wi_sub(flip_code(wi_of_bits(z)), low);
        const wi key = wi_or(wi_shl(place, EWA_GAUSSIAN_SORT_BITS), wi_set((int32_t)i));
        wi_store(sort_buffer->keys[i],
                 wi_of_bits(wf_select(shows, wf_of_bits(key), wf_of_bits(wi_set(NO_KEY)))));
        wf_store(sort_buffer->alphas[i], wf_load(hit->alpha));
        wf_store(sort_buffer->deviations[i], wf_load(hit->deviation));
        if (tile->volume_count) sort_buffer->linear[i] = hit->layer != NULL;
        for (int c = 0; c < 3; c++)
            sort_buffer->colors[c][i] = hit->layer ? 0 : tile->records[hit->id][RECORD_COLOR + c];
        for (int c = 0; c < 3 && hit->layer; c++)
            wf_store(sort_buffer->layer_colors[c][i], wf_load(hit->layer->color[c]));
        hit->active &= ~wm_bits(shows);
    }
    for (uint32_t i = count; i & 3; i++) wi_store(sort_buffer->keys[i], wi_set(NO_KEY));
}

static ALWAYS_INLINE void exchange(wi *a, wi *b) {
    const wi low = wi_min(*a, *b);
    *b = wi_max(*a, *b);
    *a = low;
}

/// Sorts each four rows.
static ALWAYS_INLINE void sort_fours(int32_t keys[][16], uint32_t count) {
    for (uint32_t i = 0; i < count; i += 4) {
        wi a = wi_load(keys[i]), b = wi_load(keys[i + 1]), c = wi_load(keys[i + 2]), d = wi_load(keys[i + 3]);
        exchange(&a, &b), exchange(&c, &d), exchange(&a, &c), exchange(&b, &d), exchange(&b, &c);
        wi_store(keys[i], a), wi_store(keys[i + 1], b), wi_store(keys[i + 2], c), wi_store(keys[i + 3], d);
    }
}

/// The last two steps of a merge of the rows from `first` to `end`, two apart and neighbours.
static ALWAYS_INLINE void merge_last(int32_t keys[][16], uint32_t first, uint32_t end) {
    wi before = wi_load(keys[first + 1]);
    uint32_t i = first + 2;
    for (; i + 4 <= end; i += 4) {
        wi a = wi_load(keys[i]), b = wi_load(keys[i + 1]), c = wi_load(keys[i + 2]), d = wi_load(keys[i + 3]);
        exchange(&a, &c), exchange(&b, &d), exchange(&before, &a), exchange(&b, &c);
        wi_store(keys[i - 1], before), wi_store(keys[i], a), wi_store(keys[i + 1], b),
            wi_store(keys[i + 2], c);
        before = d;
    }
    wi a = wi_load(keys[i]);
    exchange(&before, &a);
    wi_store(keys[i - 1], before), wi_store(keys[i], a);
}

/// Sorts rows in every column; `count` is a multiple of four.
static ALWAYS_INLINE void sort_rows(int32_t keys[][16], uint32_t count) {
    sort_fours(keys, count);
    for (uint32_t half = 4; half < count; half *= 2) {
        for (uint32_t step = half; step > 2; step /= 2)
            for (uint32_t j = step & (half - 1); j + step < count; j += 2 * step) {
                if (((j + step) & (2 * half - 1)) == 0) continue;
                const uint32_t end = count - step < j + step ? count - step : j + step;
                for (uint32_t i = j; i < end; i++) {
                    wi a = wi_load(keys[i]), b = wi_load(keys[i + step]);
                    exchange(&a, &b);
                    wi_store(keys[i], a), wi_store(keys[i + step], b);
                }
            }
        for (uint32_t first = 0; first < count; first += 2 * half)
            merge_last(keys, first, first + 2 * half < count ? first + 2 * half : count);
    }
}

/// The pixels of a block between two rows.
typedef struct row_state {
    wf pending[2][PENDING_NUMBERS], gap, lead, through, depth, light[3], linear[4];
    wm alive;
} row_state;

static ALWAYS_INLINE void load_rows(const block_state *block, row_state *at) {
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < PENDING_NUMBERS; i++) at->pending[k][i] = wf_load(block->pending[k][i]);
    at->gap = wf_load(block->gap), at->lead = wf_load(block->lead);
    at->through = wf_load(block->pixels + 48), at->depth = wf_load(block->pixels + 64);
    for (int c = 0; c < 3; c++) at->light[c] = wf_load(block->pixels + 16 * c);
    for (int c = 0; c < 4; c++) at->linear[c] = wf_load(block->linear + 16 * c);
    at->alive = wm_of_bits(block->alive);
}

static ALWAYS_INLINE void store_rows(const row_state *at, block_state *block) {
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < PENDING_NUMBERS; i++) wf_store(block->pending[k][i], at->pending[k][i]);
    wf_store(block->gap, at->gap), wf_store(block->lead, at->lead);
    wf_store(block->pixels + 48, at->through), wf_store(block->pixels + 64, at->depth);
    for (int c = 0; c < 3; c++) wf_store(block->pixels + 16 * c, at->light[c]);
    for (int c = 0; c < 4; c++) wf_store(block->linear + 16 * c, at->linear[c]);
    block->alive = wm_bits(at->alive);
}

/// Nothing is pending yet.
static ALWAYS_INLINE void start_rows(block_state *block) {
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < PENDING_NUMBERS; i++)
            wf_store(block->pending[k][i], wf_set(i == PENDING_Z ? (k - 2) * BEYOND : 0));
    wf_store(block->gap, wf_set(BEYOND)), wf_store(block->lead, wf_set(1));
}

/// Composites the first of those that are pending, in the pixels that show the one that comes, `next`, which is pending
/// then.
static ALWAYS_INLINE void push_row(const ewa_gaussian_view *view, wm shows, const wf next[PENDING_NUMBERS], bool mixed,
                                   wf half, row_state *at) {
    const wf zero = wf_set(0), one = wf_set(1), *a = at->pending[0], *b = at->pending[1];
    // The share of the second that is in front of the first.
    const wf distance = wf_sub(b[PENDING_Z], a[PENDING_Z]), after = wf_sub(next[PENDING_Z], b[PENDING_Z]);
    const wf limit = wf_min(wf_min(at->gap, after), wf_add(a[PENDING_DEVIATION], b[PENDING_DEVIATION]));
    const wf nearness = wf_max(wf_sub(one, wf_div(distance, wf_max(limit, wf_set(1e-30f)))), zero);
    const wf share = wf_keep(wf_lt(zero, limit), wf_mul(wf_set(0.5f), nearness)); // of three at one depth none is
    const wf hidden = wf_mul(share, b[PENDING_ALPHA]), taken = wf_keep(shows, wf_mul(at->through, a[PENDING_ALPHA]));
    const wf full = wf_keep(shows, wf_mul(at->lead, a[PENDING_ALPHA])), weight = wf_fnma(full, hidden, full);
    const wf rest = wf_sub(at->through, taken);
    wf own = weight;
    if (mixed) {
        const wf layer = wf_mul(weight, a[PENDING_LAYER]);
        for (int c = 0; c < 3; c++) at->linear[c] = wf_fma(layer, a[PENDING_COLOR + c], at->linear[c]);
        at->linear[3] = wf_add(at->linear[3], layer);
        own = wf_sub(weight, layer);
    }
    for (int c = 0; c < 3; c++) at->light[c] = wf_fma(own, a[PENDING_COLOR + c], at->light[c]);
    if (view->with_depth)
        at->depth = view->expected ? wf_fma(weight, a[PENDING_Z], at->depth)
                                   : note_depth(at->depth, half, at->through, rest, a[PENDING_Z]);
    at->lead = wf_select(shows, wf_fma(taken, share, rest), at->lead);
    at->through = rest;
    at->gap = wf_select(shows, distance, at->gap);
    at->alive = wm_and(at->alive, wf_le(wf_set(view->minimum_transmittance), at->lead));
    for (int i = 0; i < PENDING_NUMBERS - !mixed; i++) {
        at->pending[0][i] = wf_select(shows, b[i], a[i]);
        at->pending[1][i] = wf_select(shows, next[i], b[i]);
    }
}

static ALWAYS_INLINE void composite_rows(const ewa_gaussian_view *view,
                                         const ewa_gaussian_sort_buffer *sort_buffer, uint32_t count,
                                         int64_t low_code, bool mixed, block_state *block) {
    static const int32_t lanes[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const wi lane = wi_load(lanes), low = wi_set((int32_t)low_code), all = wi_set(EWA_GAUSSIAN_SORTED - 1);
    const wf none = wf_of_bits(wi_set(NO_KEY)), half = wf_load(block->half);
    row_state rows;
    load_rows(block, &rows);
    for (uint32_t i = 0; i < count; i++) {
        const wi key = wi_load(sort_buffer->keys[i]), at = wi_and(key, all);
        const wm shows = wm_and(rows.alive, wf_lt(wf_of_bits(key), none));
        if (!wm_bits(shows)) break;
        const wi pixel = wi_or(wi_shl(at, 4), lane);
        wf next[PENDING_NUMBERS];
        next[PENDING_Z] = wf_of_bits(flip_code(wi_add(low, wi_sar(key, EWA_GAUSSIAN_SORT_BITS))));
        next[PENDING_ALPHA] = wf_gather(sort_buffer->alphas[0], pixel);
        next[PENDING_DEVIATION] = wf_gather(sort_buffer->deviations[0], pixel);
        next[PENDING_LAYER] = mixed ? wf_gather(sort_buffer->linear, at) : wf_set(0);
        for (int c = 0; c < 3; c++) {
            next[PENDING_COLOR + c] = wf_gather(sort_buffer->colors[c], at);
            if (mixed)
                next[PENDING_COLOR + c] =
                    wf_select(wf_lt(wf_set(0), next[PENDING_LAYER]),
                              wf_gather(sort_buffer->layer_colors[c][0], pixel), next[PENDING_COLOR + c]);
        }
        push_row(view, shows, next, mixed, half, &rows);
    }
    store_rows(&rows, block);
}

/// Composites what is still pending.
static ALWAYS_INLINE void end_rows(const ewa_gaussian_view *view, bool mixed, block_state *block) {
    row_state rows;
    wf next[PENDING_NUMBERS];
    for (int i = 0; i < PENDING_NUMBERS; i++) next[i] = wf_set(i == PENDING_Z ? BEYOND : 0);
    load_rows(block, &rows);
    for (int k = 0; k < 2; k++) push_row(view, rows.alive, next, mixed, wf_load(block->half), &rows);
    store_rows(&rows, block);
}

/// Composites what waits up to a depth, at which nothing to come can be in front of it.
static void advance(const ewa_gaussian_view *view, ewa_gaussian_tile *tile, float bound, block_state *block) {
    for (bool more = true; more && block->alive;) {
        float minimum, top = bound;
        uint32_t count = choose(tile, block, top, &minimum);
        if (!count) break;
        const int64_t low = depth_code(minimum);
        if (depth_code(top) >= low + CODE_SPAN) {
            top = depth_of_code(low + CODE_SPAN - 2); // not -0 for a span that ends at +0
            count = choose(tile, block, top, &minimum);
        }
        while (count > EWA_GAUSSIAN_SORTED && top > minimum) {
            top = depth_of_code(low + (depth_code(top) - low) / 2);
            count = choose(tile, block, top, &minimum);
        }
        more = top < bound || count > EWA_GAUSSIAN_SORTED; // these at one depth: as they came
        if (count > EWA_GAUSSIAN_SORTED) count = EWA_GAUSSIAN_SORTED;
        lay_out(tile, block, count, top, low);
        sort_rows(tile->sort_buffer->keys, (count + 3) & ~3u);
        if (tile->volume_count)
            composite_rows(view, tile->sort_buffer, count, low, true, block);
        else
            composite_rows(view, tile->sort_buffer, count, low, false, block);
        tile->sorted_count += count;
    }
    if (!block->alive) return;
    uint32_t left = 0;
    for (uint32_t i = 0; i < block->waiting_count; i++) {
        const uint32_t number = tile->waiting[i];
        const bool waits = tile->hit[number].active & block->alive;
        tile->waiting[left] = tile->free[block->free_count] = number; // no branches: they are anybody's guess
        left += waits;
        block->free_count += !waits;
    }
    block->waiting_count = left;
    // Where much waits, more comes before it is looked through again.
    block->come = 0;
    block->at_once = left / 2 < EWA_GAUSSIAN_AT_ONCE       ? EWA_GAUSSIAN_AT_ONCE
                     : left / 2 < EWA_GAUSSIAN_MAX_AT_ONCE ? left / 2
                                                           : EWA_GAUSSIAN_MAX_AT_ONCE;
}

#endif
