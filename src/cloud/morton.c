// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Z-order by a radix sort from the top digit: wide digits in parallel while a range is large, then every
// small range on its own inside a core's cache, where a few points end in an insertion sort. Every step is
// stable, so the result is the one stable order whatever the number of threads. Unlike a sort from the bottom
// digit it stops as soon as cells hold few points, and it can lay a finer grid over a cell that still holds
// many.
//
// Based on G. M. Morton, "A computer oriented geodetic data base and a new technique in file sequencing",
// 1966.
#include "cloud/morton.h"
#include "base/base.h"
#include "cloud/cloud.h"

#include <math.h>

enum {
    AXIS_BITS = 21,
    CODE_BITS = 64,         // 63 of the three axes; the top one marks points that are not finite
    LEVELS_PER_GRID = 64,   // split levels of one grid
    LARGE_POINTS = 1 << 15, // ranges above are sorted by all threads together: 1 MB of items and spare
    LARGE_DIGIT_BITS = 11,  // more buckets than this thrash the TLB
    SMALL_DIGIT_BITS = 8,
    MAX_SMALL_DIGITS = 4,
    INSERTION_POINTS = 24,
    PART_POINTS = 1 << 13,
    MAX_PARTS = 64,
};

static const uint64_t NOT_FINITE = UINT64_MAX;

typedef struct item {
    uint64_t code;
    uint32_t index;
} item;

/// A grid of cubic cells; works on half coordinates, so that no difference overflows.
typedef struct grid {
    double half_low[3];
    double cells_per_half_unit;
} grid;

typedef uint32_t small_histogram[MAX_SMALL_DIGITS][1 << SMALL_DIGIT_BITS];

/// Items whose code bits from `shift` up are equal.
typedef struct range {
    uint32_t begin, end;
    uint32_t shift;
    uint32_t depth; // number of grids laid over each other before this one
    bool in_spare;  // the items are in `spare`, else in `items`
} range;

typedef struct sorter {
    const ewa_attribute *position;
    uint32_t *order;
    uint16_t *split_level;
    item *items, *spare;
    // one parallel step over `now`
    range now;
    grid grid;
    uint32_t parts;
    uint32_t *histogram; // [MAX_PARTS][1 << LARGE_DIGIT_BITS], then their places
    ewa_bounds partial[MAX_PARTS];
    small_histogram *small_histogram; // [worker_count]
    range *small;                     // [1 << LARGE_DIGIT_BITS]
} sorter;

/// Puts two zero bits before each of the low 21 bits.
static uint64_t spread_bits(uint64_t v) {
    v = (v | v << 32) & 0x001f00000000ffffu;
    v = (v | v << 16) & 0x001f0000ff0000ffu;
    v = (v | v << 8) & 0x100f00f00f00f00fu;
    v = (v | v << 4) & 0x10c30c30c30c30c3u;
    v = (v | v << 2) & 0x1249249249249249u;
    return v;
}

/// Returns false when the box is a single point.
static bool make_grid(const ewa_bounds *box, grid *made) {
    double half_extent = 0;
    for (int c = 0; c < 3; c++) {
        made->half_low[c] = 0.5 * box->low_world[c];
        half_extent = fmax(half_extent, 0.5 * box->high_world[c] - made->half_low[c]);
    }
    made->cells_per_half_unit = (1 << AXIS_BITS) / half_extent;
    return half_extent > 0 && isfinite(made->cells_per_half_unit);
}

static uint64_t encode(const grid *g, const double p[3]) {
    uint64_t code = 0;
    for (int c = 0; c < 3; c++) {
        const double cell = (0.5 * p[c] - g->half_low[c]) * g->cells_per_half_unit;
        const double last = (1 << AXIS_BITS) - 1;
        code |= spread_bits((uint64_t)(int64_t)(cell < last ? cell : last)) << c;
    }
    return code;
}

static void grow(ewa_bounds *box, const double p[3]) {
    for (int c = 0; c < 3; c++) {
        box->low_world[c] = p[c] < box->low_world[c] ? p[c] : box->low_world[c];
        box->high_world[c] = p[c] > box->high_world[c] ? p[c] : box->high_world[c];
    }
}

static const ewa_bounds EMPTY_BOX = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 0};

static ewa_bounds measure_items(const sorter *s, const item *items, uint32_t count) {
    ewa_bounds box = EMPTY_BOX;
    for (uint32_t i = 0; i < count; i++) {
        double p[3];
        ewa_attribute_read_f64(s->position, items[i].index, 1, p);
        grow(&box, p);
    }
    return box;
}

static void encode_items(const sorter *s, const grid *g, item *items, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        double p[3];
        ewa_attribute_read_f64(s->position, items[i].index, 1, p);
        items[i].code = encode(g, p);
    }
}

static void set_level(const sorter *s, uint32_t place, uint32_t depth, uint64_t difference) {
    if (!s->split_level) return;
    const uint32_t level = depth * LEVELS_PER_GRID + (uint32_t)__builtin_clzll(difference | 1);
    s->split_level[place] = difference ? (uint16_t)level : EWA_MORTON_SAME;
}

/// Writes the order of items that no grid tells apart.
static void emit_same(const sorter *s, const item *items, uint32_t first, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        s->order[first + i] = items[i].index;
        if (i && s->split_level) s->split_level[first + i] = EWA_MORTON_SAME;
    }
}

/// Sorts a few items and writes their order.
static void emit_few(const sorter *s, item *items, uint32_t first, uint32_t count, uint32_t depth) {
    for (uint32_t i = 1; i < count; i++) {
        const item moved = items[i];
        uint32_t j = i;
        for (; j > 0 && items[j - 1].code > moved.code; j--) items[j] = items[j - 1];
        items[j] = moved;
    }
    for (uint32_t i = 0; i < count; i++) {
        s->order[first + i] = items[i].index;
        if (i) set_level(s, first + i, depth, items[i].code ^ items[i - 1].code);
    }
}

/// Lays a finer grid over items of equal codes. Returns false when they are at one place or not finite.
static bool refine_small(const sorter *s, item *items, uint32_t count) {
    if (items->code == NOT_FINITE) return false;
    grid finer;
    const ewa_bounds box = measure_items(s, items, count);
    if (!make_grid(&box, &finer)) return false;
    encode_items(s, &finer, items, count);
    return true;
}

/// Sorts by the bits from `shift` down, as many as tell apart most points of a surface, from the bottom digit
/// up. Returns the lowest bit sorted by and leaves the items in `*items`.
static uint32_t sort_digits(item **items, item **spare, uint32_t count, uint32_t shift,
                            small_histogram *histogram) {
    const uint32_t wanted_bits = 3 * (32 - (uint32_t)__builtin_clz(count)) / 2 + SMALL_DIGIT_BITS / 2;
    uint32_t digits = (wanted_bits < shift ? wanted_bits : shift) / SMALL_DIGIT_BITS + 1;
    if (digits > MAX_SMALL_DIGITS) digits = MAX_SMALL_DIGITS;
    const uint32_t low = shift > digits * SMALL_DIGIT_BITS ? shift - digits * SMALL_DIGIT_BITS : 0;
    const uint32_t mask = (1u << SMALL_DIGIT_BITS) - 1;
    for (uint32_t d = 0; d < digits; d++)
        for (uint32_t b = 0; b <= mask; b++) (*histogram)[d][b] = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint64_t bits = (*items)[i].code >> low;
        for (uint32_t d = 0; d < digits; d++) (*histogram)[d][bits >> d * SMALL_DIGIT_BITS & mask]++;
    }
    for (uint32_t d = 0; d < digits; d++) {
        uint32_t *place = (*histogram)[d], sum = 0;
        for (uint32_t b = 0; b <= mask; b++) {
            const uint32_t size = place[b];
            place[b] = sum;
            sum += size;
        }
        const uint32_t digit_shift = low + d * SMALL_DIGIT_BITS;
        for (uint32_t i = 0; i < count; i++)
            (*spare)[place[(*items)[i].code >> digit_shift & mask]++] = (*items)[i];
        item *swapped = *items;
        *items = *spare;
        *spare = swapped;
    }
    return low;
}

/// Sorts items whose codes differ below `shift` at most, on one thread. `first` is the place of items[0].
static void sort_small(const sorter *s, item *items, item *spare, uint32_t first, uint32_t count,
                       uint32_t shift, uint32_t depth, small_histogram *histogram) {
    if (count <= INSERTION_POINTS) {
        emit_few(s, items, first, count, depth);
        return;
    }
    if (shift == 0) {
        if (!refine_small(s, items, count)) {
            emit_same(s, items, first, count);
            return;
        }
        shift = CODE_BITS;
        depth++;
    }
    uint64_t differing = 0;
    for (uint32_t i = 1; i < count; i++) differing |= items[i].code ^ items[0].code;
    shift = differing ? CODE_BITS - (uint32_t)__builtin_clzll(differing) : 0;
    const uint32_t low = shift ? sort_digits(&items, &spare, count, shift, histogram) : 0;
    for (uint32_t begin = 0, end; begin < count; begin = end) {
        for (end = begin + 1; end < count && (items[begin].code ^ items[end].code) >> low == 0;) end++;
        if (begin) set_level(s, first + begin, depth, items[begin].code ^ items[begin - 1].code);
        sort_small(s, items + begin, spare + begin, first + begin, end - begin, low, depth, histogram);
    }
}

static void sort_small_task(void *data, uint32_t task, uint32_t worker) {
    const sorter *s = data;
    const range *r = &s->small[task];
    item *here = (r->in_spare ? s->spare : s->items) + r->begin,
         *other = (r->in_spare ? s->items : s->spare) + r->begin;
    sort_small(s, here, other, r->begin, r->end - r->begin, r->shift, r->depth, &s->small_histogram[worker]);
}

/// The items of part `part` of the range at work.
static item *part_items(const sorter *s, uint32_t part, uint32_t *count) {
    const uint64_t size = s->now.end - s->now.begin;
    const uint64_t begin = ewa_split(size, s->parts, part);
    *count = (uint32_t)(ewa_split(size, s->parts, part + 1) - begin);
    return (s->now.in_spare ? s->spare : s->items) + s->now.begin + begin;
}

static void measure_task(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    sorter *s = data;
    uint32_t count;
    const item *items = part_items(s, part, &count);
    s->partial[part] = measure_items(s, items, count);
}

static void encode_task(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const sorter *s = data;
    uint32_t count;
    item *items = part_items(s, part, &count);
    encode_items(s, &s->grid, items, count);
}

/// The first codes, from positions in the order of the input.
static void encode_first_task(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const sorter *s = data;
    uint32_t count;
    item *items = part_items(s, part, &count);
    uint32_t index = (uint32_t)(items - s->items);
    double block[3 * 256];
    for (uint32_t done = 0; done < count;) {
        const uint32_t size = count - done < 256 ? count - done : 256;
        ewa_attribute_read_f64(s->position, index, size, block);
        for (uint32_t i = 0; i < size; i++, index++) {
            const double *p = &block[3 * i];
            const bool finite = isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
            items[done + i] = (item){finite ? encode(&s->grid, p) : NOT_FINITE, index};
        }
        done += size;
    }
}

static uint32_t large_low(const range *r) {
    return r->shift > LARGE_DIGIT_BITS ? r->shift - LARGE_DIGIT_BITS : 0;
}

static void histogram_task(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    sorter *s = data;
    uint32_t count;
    const item *items = part_items(s, part, &count);
    const uint32_t low = large_low(&s->now), mask = (1u << LARGE_DIGIT_BITS) - 1;
    uint32_t *histogram = s->histogram + ((size_t)part << LARGE_DIGIT_BITS);
    for (uint32_t b = 0; b <= mask; b++) histogram[b] = 0;
    for (uint32_t i = 0; i < count; i++) histogram[items[i].code >> low & mask]++;
}

static void scatter_task(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    sorter *s = data;
    uint32_t count;
    const item *items = part_items(s, part, &count);
    const uint32_t low = large_low(&s->now), mask = (1u << LARGE_DIGIT_BITS) - 1;
    uint32_t *place = s->histogram + ((size_t)part << LARGE_DIGIT_BITS);
    item *to = s->now.in_spare ? s->items : s->spare;
    for (uint32_t i = 0; i < count; i++) to[place[items[i].code >> low & mask]++] = items[i];
}

static void emit_same_task(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const sorter *s = data;
    uint32_t count;
    const item *items = part_items(s, part, &count);
    const uint32_t first = (uint32_t)(items - (s->now.in_spare ? s->spare : s->items));
    emit_same(s, items, first, count);
    if (first > s->now.begin && s->split_level) s->split_level[first] = EWA_MORTON_SAME;
}

static void set_now(ewa_context *context, sorter *s, const range *r) {
    s->now = *r;
    const uint32_t wanted = (r->end - r->begin) / PART_POINTS + 1,
                   useful = 4 * ewa_context_worker_count(context);
    s->parts = wanted < useful ? wanted : useful;
    if (s->parts > MAX_PARTS) s->parts = MAX_PARTS;
}

/// Lays a finer grid over the range at work, whose codes are all equal. Returns false when it is one place.
static bool refine(ewa_context *context, sorter *s) {
    const item *items = (s->now.in_spare ? s->spare : s->items) + s->now.begin;
    if (items->code == NOT_FINITE) return false;
    ewa_parallel(context, measure_task, s, s->parts);
    ewa_bounds box = EMPTY_BOX;
    for (uint32_t part = 0; part < s->parts; part++) {
        grow(&box, s->partial[part].low_world);
        grow(&box, s->partial[part].high_world);
    }
    if (!make_grid(&box, &s->grid)) return false;
    ewa_parallel(context, encode_task, s, s->parts);
    s->now.shift = CODE_BITS;
    s->now.depth++;
    return true;
}

/// Splits the range at work by its next digit: small buckets are finished, large ones pushed.
static void split_large(ewa_context *context, sorter *s, range *large, uint32_t *large_count) {
    const uint32_t low = large_low(&s->now), buckets = 1u << LARGE_DIGIT_BITS;
    const uint32_t size = s->now.end - s->now.begin;
    ewa_parallel(context, histogram_task, s, s->parts);
    uint32_t place = s->now.begin, small_count = 0, previous_bucket = 0;
    bool moved = true;
    for (uint32_t b = 0; b < buckets; b++) {
        const uint32_t begin = place;
        for (uint32_t part = 0; part < s->parts; part++) {
            uint32_t *entry = &s->histogram[((size_t)part << LARGE_DIGIT_BITS) + b];
            const uint32_t count = *entry;
            *entry = place;
            place += count;
        }
        if (place == begin) continue;
        moved = place - begin < size;
        const range bucket = {begin, place, low, s->now.depth, s->now.in_spare == !moved};
        if (begin > s->now.begin) set_level(s, begin, s->now.depth, (uint64_t)(b ^ previous_bucket) << low);
        previous_bucket = b;
        if (place - begin > LARGE_POINTS)
            large[(*large_count)++] = bucket;
        else
            s->small[small_count++] = bucket;
    }
    if (moved) ewa_parallel(context, scatter_task, s, s->parts);
    ewa_parallel(context, sort_small_task, s, small_count);
}

static void sort_all(ewa_context *context, sorter *s, uint32_t count, range *large) {
    const range all = {0, count, CODE_BITS, 0, false};
    set_now(context, s, &all);
    ewa_parallel(context, encode_first_task, s, s->parts);
    uint32_t large_count = 0;
    if (count > LARGE_POINTS)
        large[large_count++] = all;
    else
        sort_small(s, s->items, s->spare, 0, count, CODE_BITS, 0, s->small_histogram);
    while (large_count) {
        set_now(context, s, &large[--large_count]);
        if (s->now.shift > 0 || refine(context, s))
            split_large(context, s, large, &large_count);
        else
            ewa_parallel(context, emit_same_task, s, s->parts);
    }
}

ewa_status ewa_morton_order(ewa_context *context, const ewa_attribute *position, uint32_t count,
                            uint32_t *order, uint16_t *split_level, uint32_t *finite_count) {
    const size_t large_capacity = count / LARGE_POINTS + 1,
                 histogram_size = (size_t)MAX_PARTS << LARGE_DIGIT_BITS;
    const size_t small_capacity = (size_t)1 << LARGE_DIGIT_BITS;
    sorter *s = ewa_allocate(context, 1, sizeof *s);
    item *items = ewa_allocate(context, count, 2 * sizeof *items);
    uint32_t *histogram = ewa_allocate(context, histogram_size, sizeof *histogram);
    range *small = ewa_allocate(context, small_capacity, sizeof *small);
    const uint32_t worker_count = ewa_context_worker_count(context);
    small_histogram *small_histograms = ewa_allocate(context, worker_count, sizeof *small_histograms);
    range *large = ewa_allocate(context, large_capacity, sizeof *large);
    ewa_status status = EWA_ERROR_MEMORY;
    if (s && items && histogram && small && small_histograms && large) {
        *s = (sorter){.position = position,
                      .order = order,
                      .split_level = split_level,
                      .items = items,
                      .spare = items + count,
                      .histogram = histogram,
                      .small_histogram = small_histograms,
                      .small = small};
        ewa_bounds box;
        ewa_position_measure(context, position, count, &box);
        if (finite_count) *finite_count = (uint32_t)box.finite_count;
        if (!make_grid(&box, &s->grid)) s->grid = (grid){.cells_per_half_unit = 0};
        if (count) sort_all(context, s, count, large);
        if (count && split_level) split_level[0] = 0;
        status = EWA_OK;
    }
    ewa_release(context, large, large_capacity, sizeof *large);
    ewa_release(context, small_histograms, worker_count, sizeof *small_histograms);
    ewa_release(context, small, small_capacity, sizeof *small);
    ewa_release(context, histogram, histogram_size, sizeof *histogram);
    ewa_release(context, items, count, 2 * sizeof *items);
    ewa_release(context, s, 1, sizeof *s);
    return status;
}
