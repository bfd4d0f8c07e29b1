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
#include "cloud/cells.h"
#include "cloud/cloud.h"

#include <math.h>
#include <string.h>

enum {
    CODE_BITS = 64,         // 63 of the three axes; the top one marks points that are not finite
    LEVELS_PER_GRID = 64,   // split levels of one grid
    LARGE_POINTS = 1 << 15, // ranges above are sorted by all threads together: 1 MB of items and spare
    FIRST_DIGIT_BITS = 13,  // four levels of cells and the bit for points that are not finite
    LARGE_DIGIT_BITS = 11,
    SMALL_DIGIT_BITS = 8,
    MAX_SMALL_DIGITS = 4,
    INSERTION_POINTS = 24,
    PART_POINTS = 1 << 13,
    MAX_PARTS = 64,
};

typedef struct item {
    uint64_t code;
    uint32_t index;
} item;

/// What a worker needs to sort a small range.
typedef struct small_scratch {
    uint32_t histogram[MAX_SMALL_DIGITS][1 << SMALL_DIGIT_BITS];
    uint64_t keys[2][LARGE_POINTS];
    item items[LARGE_POINTS];
} small_scratch;

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
    uint64_t *codes; // of the input
    ewa_code_cells *code_cells;
    item *items, *spare; // `spare` is NULL while no range is large
    // one parallel step over `now`
    range now;
    ewa_grid grid;
    uint32_t parts;
    uint32_t digit_bits; // of the step
    uint32_t *histogram; // [parts][1 << digit_bits], then their places
    ewa_bounds partial[MAX_PARTS];
    small_scratch *scratch; // [worker_count]
    range *small;           // [1 << FIRST_DIGIT_BITS]
} sorter;

/// Returns false when the box is a single point.
static bool make_grid(const ewa_bounds *box, ewa_grid *made) {
    double half_extent = 0;
    for (int c = 0; c < 3; c++) {
        made->half_low[c] = 0.5 * box->low_world[c];
        half_extent = fmax(half_extent, 0.5 * box->high_world[c] - made->half_low[c]);
    }
    made->cells_per_half_unit = (1 << EWA_GRID_AXIS_BITS) / half_extent;
    return half_extent > 0 && isfinite(made->cells_per_half_unit);
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

static void encode_items(const sorter *s, const ewa_grid *g, item *items, uint32_t count) {
    double points[3 * EWA_CELL_BLOCK];
    uint64_t codes[EWA_CELL_BLOCK];
    for (uint32_t done = 0; done < count; done += EWA_CELL_BLOCK) {
        const uint32_t size = count - done < EWA_CELL_BLOCK ? count - done : EWA_CELL_BLOCK;
        for (uint32_t i = 0; i < size; i++)
            ewa_attribute_read_f64(s->position, items[done + i].index, 1, &points[3 * i]);
        s->code_cells(g, points, size, codes);
        for (uint32_t i = 0; i < size; i++) items[done + i].code = codes[i];
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
    if (items->code == EWA_NOT_FINITE) return false;
    ewa_grid finer;
    const ewa_bounds box = measure_items(s, items, count);
    if (!make_grid(&box, &finer)) return false;
    encode_items(s, &finer, items, count);
    return true;
}

/// Sorts by the bits from `shift` down, as many as tell apart most points of a surface, from the bottom digit
/// up; what is moved are those bits and the place of their item. Returns the lowest bit sorted by and leaves
/// the items in `sorted`.
static uint32_t sort_digits(const item *items, item *sorted, uint32_t count, uint32_t shift,
                            small_scratch *scratch) {
    const uint32_t wanted_bits = 3 * (32 - (uint32_t)__builtin_clz(count)) / 2 + SMALL_DIGIT_BITS / 2;
    uint32_t digits = (wanted_bits < shift ? wanted_bits : shift) / SMALL_DIGIT_BITS + 1;
    if (digits > MAX_SMALL_DIGITS) digits = MAX_SMALL_DIGITS;
    const uint32_t low = shift > digits * SMALL_DIGIT_BITS ? shift - digits * SMALL_DIGIT_BITS : 0;
    const uint32_t mask = (1u << SMALL_DIGIT_BITS) - 1;
    memset(scratch->histogram, 0, digits * sizeof scratch->histogram[0]);
    uint64_t *keys = scratch->keys[0], *spare = scratch->keys[1];
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t bits = (uint32_t)(items[i].code >> low);
        for (uint32_t d = 0; d < digits; d++) scratch->histogram[d][bits >> d * SMALL_DIGIT_BITS & mask]++;
        keys[i] = (uint64_t)bits << 32 | i;
    }
    for (uint32_t d = 0; d < digits; d++) {
        uint32_t *place = scratch->histogram[d], sum = 0;
        for (uint32_t b = 0; b <= mask; b++) {
            const uint32_t size = place[b];
            place[b] = sum;
            sum += size;
        }
        const uint32_t digit_shift = 32 + d * SMALL_DIGIT_BITS;
        for (uint32_t i = 0; i < count; i++) spare[place[keys[i] >> digit_shift & mask]++] = keys[i];
        uint64_t *swapped = keys;
        keys = spare;
        spare = swapped;
    }
    for (uint32_t i = 0; i < count; i++) sorted[i] = items[(uint32_t)keys[i]];
    return low;
}

/// Sorts items whose codes differ below `shift` at most, on one thread. `first` is the place of items[0].
static void sort_small(const sorter *s, item *items, item *spare, uint32_t first, uint32_t count,
                       uint32_t shift, uint32_t depth, small_scratch *scratch) {
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
    uint32_t low = 0;
    if (shift) {
        low = sort_digits(items, spare, count, shift, scratch);
        item *swapped = items;
        items = spare;
        spare = swapped;
    }
    for (uint32_t begin = 0, end; begin < count; begin = end) {
        for (end = begin + 1; end < count && (items[begin].code ^ items[end].code) >> low == 0;) end++;
        if (begin) set_level(s, first + begin, depth, items[begin].code ^ items[begin - 1].code);
        if (end - begin == 1)
            s->order[first + begin] = items[begin].index;
        else
            sort_small(s, items + begin, spare + begin, first + begin, end - begin, low, depth, scratch);
    }
}

static void sort_small_task(void *data, uint32_t task, uint32_t worker) {
    const sorter *s = data;
    const range *r = &s->small[task];
    item *items = (r->in_spare ? s->spare : s->items) + r->begin;
    sort_small(s, items, s->scratch[worker].items, r->begin, r->end - r->begin, r->shift, r->depth,
               &s->scratch[worker]);
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

/// Codes a part of the input and counts the first digits.
static void first_histogram_task(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    sorter *s = data;
    uint32_t *histogram = s->histogram + ((size_t)part << FIRST_DIGIT_BITS);
    memset(histogram, 0, sizeof *histogram << FIRST_DIGIT_BITS);
    double points[3 * EWA_CELL_BLOCK];
    const uint64_t end = ewa_split(s->now.end, s->parts, part + 1);
    for (uint64_t first = ewa_split(s->now.end, s->parts, part), count; first < end; first += count) {
        count = end - first < EWA_CELL_BLOCK ? end - first : EWA_CELL_BLOCK;
        ewa_attribute_read_f64(s->position, first, count, points);
        uint64_t *codes = s->codes + first;
        s->code_cells(&s->grid, points, (uint32_t)count, codes);
        for (uint64_t i = 0; i < count; i++) histogram[codes[i] >> (CODE_BITS - FIRST_DIGIT_BITS)]++;
    }
}

/// Puts the items of a part of the input to the places of their first digits.
static void first_scatter_task(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const sorter *s = data;
    uint32_t *place = s->histogram + ((size_t)part << FIRST_DIGIT_BITS);
    const uint64_t end = ewa_split(s->now.end, s->parts, part + 1);
    for (uint64_t i = ewa_split(s->now.end, s->parts, part); i < end; i++)
        s->items[place[s->codes[i] >> (CODE_BITS - FIRST_DIGIT_BITS)]++] = (item){s->codes[i], (uint32_t)i};
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

static uint32_t max_parts(ewa_context *context) {
    const uint32_t useful = 4 * ewa_context_worker_count(context);
    return useful < MAX_PARTS ? useful : MAX_PARTS;
}

static void set_now(ewa_context *context, sorter *s, const range *r) {
    s->now = *r;
    const uint32_t wanted = (r->end - r->begin) / PART_POINTS + 1, maximum = max_parts(context);
    s->parts = wanted < maximum ? wanted : maximum;
}

/// Lays a finer grid over the range at work, whose codes are all equal. Returns false when it is one place.
static bool refine(ewa_context *context, sorter *s) {
    const item *items = (s->now.in_spare ? s->spare : s->items) + s->now.begin;
    if (items->code == EWA_NOT_FINITE) return false;
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

/// Turns the counts of a step's digits into places and its buckets into ranges below bit `low`: small ones
/// to finish, large ones pushed. Returns the number of small ones; `*moved` tells whether there is more than
/// one bucket.
static uint32_t place_buckets(sorter *s, uint32_t low, bool to_spare, range *large, uint32_t *large_count,
                              bool *moved) {
    const uint32_t size = s->now.end - s->now.begin;
    uint32_t place = s->now.begin, small_count = 0, previous_bucket = 0;
    *moved = true;
    for (uint32_t b = 0; b < 1u << s->digit_bits; b++) {
        const uint32_t begin = place;
        for (uint32_t part = 0; part < s->parts; part++) {
            uint32_t *entry = &s->histogram[((size_t)part << s->digit_bits) + b];
            const uint32_t count = *entry;
            *entry = place;
            place += count;
        }
        if (place == begin) continue;
        *moved = place - begin < size;
        const range bucket = {begin, place, low, s->now.depth, *moved ? to_spare : s->now.in_spare};
        if (begin > s->now.begin) set_level(s, begin, s->now.depth, (uint64_t)(b ^ previous_bucket) << low);
        previous_bucket = b;
        if (place - begin > LARGE_POINTS)
            large[(*large_count)++] = bucket;
        else
            s->small[small_count++] = bucket;
    }
    return small_count;
}

/// Splits the range at work by its next digit.
static ewa_status split_large(ewa_context *context, sorter *s, range *large, uint32_t *large_count) {
    s->digit_bits = LARGE_DIGIT_BITS;
    EWA_TRY(ewa_parallel_stoppable(context, "order", histogram_task, s, s->parts));
    bool moved;
    const uint32_t small_count =
        place_buckets(s, large_low(&s->now), !s->now.in_spare, large, large_count, &moved);
    if (moved) EWA_TRY(ewa_parallel_stoppable(context, "order", scatter_task, s, s->parts));
    return ewa_parallel_stoppable(context, "order", sort_small_task, s, small_count);
}

static ewa_status sort_all(ewa_context *context, sorter *s, uint32_t count, range *large) {
    const range all = {0, count, CODE_BITS, 0, false};
    set_now(context, s, &all);
    s->digit_bits = FIRST_DIGIT_BITS;
    uint32_t large_count = 0;
    bool moved;
    EWA_TRY(ewa_parallel_stoppable(context, "order", first_histogram_task, s, s->parts));
    const uint32_t small_count =
        place_buckets(s, CODE_BITS - FIRST_DIGIT_BITS, false, large, &large_count, &moved);
    EWA_TRY(ewa_parallel_stoppable(context, "order", first_scatter_task, s, s->parts));
    EWA_TRY(ewa_parallel_stoppable(context, "order", sort_small_task, s, small_count));
    if (large_count == 0) return EWA_OK;
    s->spare = ewa_allocate(context, count, sizeof *s->spare);
    if (!s->spare) return EWA_ERROR_MEMORY;
    ewa_status status = EWA_OK;
    while (large_count && status == EWA_OK) {
        set_now(context, s, &large[--large_count]);
        if (s->now.shift > 0 || refine(context, s))
            status = split_large(context, s, large, &large_count);
        else
            status = ewa_parallel_stoppable(context, "order", emit_same_task, s, s->parts);
    }
    ewa_release(context, s->spare, count, sizeof *s->spare);
    return status;
}

/// Orders the points within a grid over `box`; `items` has room for all of them and their codes.
static ewa_status order_in_box(ewa_context *context, const ewa_attribute *position, uint32_t count,
                               const ewa_bounds *box, item *items, uint32_t *order, uint16_t *split_level) {
    const size_t large_capacity = count / LARGE_POINTS + 1, histogram_size = (size_t)max_parts(context)
                                                                             << FIRST_DIGIT_BITS;
    const size_t small_capacity = (size_t)1 << FIRST_DIGIT_BITS;
    const uint32_t worker_count = ewa_context_worker_count(context);
    sorter *s = ewa_allocate(context, 1, sizeof *s);
    uint32_t *histogram = ewa_allocate(context, histogram_size, sizeof *histogram);
    range *small = ewa_allocate(context, small_capacity, sizeof *small);
    small_scratch *scratch = ewa_allocate(context, worker_count, sizeof *scratch);
    range *large = ewa_allocate(context, large_capacity, sizeof *large);
    ewa_status status = EWA_ERROR_MEMORY;
    if (s && histogram && small && scratch && large) {
        *s = (sorter){.position = position,
                      .order = order,
                      .split_level = split_level,
                      .items = items,
                      .codes = (uint64_t *)(items + count),
                      .code_cells = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_code_cells),
                      .histogram = histogram,
                      .scratch = scratch,
                      .small = small};
        if (!make_grid(box, &s->grid)) s->grid = (ewa_grid){.cells_per_half_unit = 0};
        status = count ? sort_all(context, s, count, large) : EWA_OK;
        if (count && split_level) split_level[0] = 0;
    }
    ewa_release(context, large, large_capacity, sizeof *large);
    ewa_release(context, scratch, worker_count, sizeof *scratch);
    ewa_release(context, small, small_capacity, sizeof *small);
    ewa_release(context, histogram, histogram_size, sizeof *histogram);
    ewa_release(context, s, 1, sizeof *s);
    return status;
}

void ewa_morton_codes(ewa_context *context, const ewa_bounds *box, const float *places, uint32_t count, uint64_t *codes) {
    ewa_code_cells *const code_cells = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_code_cells);
    ewa_grid grid;
    if (!make_grid(box, &grid)) grid = (ewa_grid){.cells_per_half_unit = 0};
    for (uint32_t done = 0; done < count; done += EWA_CELL_BLOCK) {
        const uint32_t size = count - done < EWA_CELL_BLOCK ? count - done : EWA_CELL_BLOCK;
        double points[3 * EWA_CELL_BLOCK];
        for (uint32_t i = 0; i < 3 * size; i++) points[i] = (double)places[3 * (size_t)done + i];
        code_cells(&grid, points, size, codes + done);
    }
}

size_t ewa_morton_room_bytes(uint32_t count) { return count * (sizeof(item) + sizeof(uint64_t)); }

ewa_status ewa_morton_order_in(ewa_context *context, const ewa_attribute *position, uint32_t count,
                               const ewa_bounds *box, void *room, uint32_t *order, uint16_t *split_level) {
    if (room) return order_in_box(context, position, count, box, room, order, split_level);
    item *items = ewa_allocate(context, 1, ewa_morton_room_bytes(count));
    if (!items) return EWA_ERROR_MEMORY;
    const ewa_status status = order_in_box(context, position, count, box, items, order, split_level);
    ewa_release(context, items, 1, ewa_morton_room_bytes(count));
    return status;
}

ewa_status ewa_morton_order(ewa_context *context, const ewa_attribute *position, uint32_t count,
                            uint32_t *order, uint16_t *split_level, uint32_t *finite_count) {
    ewa_bounds box;
    ewa_position_measure(context, position, count, &box);
    if (finite_count) *finite_count = (uint32_t)box.finite_count;
    return ewa_morton_order_in(context, position, count, &box, NULL, order, split_level);
}
