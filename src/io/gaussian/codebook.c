// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A codebook for numbers has codes as dense as the cube root of the numbers' density, which gives the least mean of squares, and then
// a few rounds of Lloyd's, in which codes that few numbers share become these. More rounds take codes from what is rare, such as
// large Gaussians, to what is not. Palettes for vectors by binary splits: always of the cluster with the largest sum of squared distances to
// its mean, across its principal axis, at the mean. A palette is a mean.
//
// Based on: P. Panter, W. Dite, "Quantization distortion in pulse-count modulation with nonuniform spacing of levels", 1951;
// S. Lloyd, "Least squares quantization in PCM", 1982; M. Orchard, C. Bouman, "Color Quantization of Images", 1991.
#include "io/gaussian/codebook.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    SAMPLES = 1 << 19, ///< numbers at most that are sorted
    BINS = 4096,
    ROUNDS = 4,
    AXIS_SAMPLES = 256, ///< of a cluster, by which its principal axis is found
    AXIS_ROUNDS = 6,
};

static int compare(const void *a, const void *b) {
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/// The first of `count` ascending numbers that is at least `bound`.
static size_t find_from(const float *numbers, size_t count, double bound) {
    size_t first = 0;
    while (count) {
        const size_t half = count / 2;
        if ((double)numbers[first + half] < bound)
            first += half + 1, count -= half + 1;
        else
            count = half;
    }
    return first;
}

/// Bins of ascending numbers: of even width, and where they are dense of an even share of them, but for empty ones.
typedef struct bins {
    uint32_t count;
    double lows[2 * BINS + 1], highs[2 * BINS + 1], weights[2 * BINS + 1];
} bins;

static void make_bins(const float *numbers, size_t count, bins *made) {
    const double low = (double)numbers[0], wide = ((double)numbers[count - 1] - low) / BINS;
    const size_t share = (count - 1) / BINS + 1;
    made->count = 0;
    double before = low;
    for (size_t first = 0, end; first < count; first = end) {
        const double even = wide > 0 ? fmin(floor(((double)numbers[first] - low) / wide), BINS - 1) : 0;
        const size_t next = find_from(numbers + first, count - first, low + wide * (even + 1)) + first;
        end = next > first && next < first + share ? next : first + share < count ? first + share : count;
        double *high = &made->highs[made->count];
        made->lows[made->count] = fmax(before, low + wide * even);
        *high = fmax(end < count ? fmin((double)numbers[end], low + wide * (even + 1)) : (double)numbers[count - 1], made->lows[made->count]);
        // The density to the power of 1/3, for as wide as it is so.
        made->weights[made->count] = cbrt((double)(end - first)) * pow(*high - made->lows[made->count], 2.0 / 3);
        before = *high;
        made->count++;
    }
}

/// Puts codes as dense as gives the least mean of squares.
static void place_codes(const float *numbers, size_t count, bins *made, float codes[EWA_CODES]) {
    make_bins(numbers, count, made);
    double all = 0, passed = 0;
    for (uint32_t b = 0; b < made->count; b++) all += made->weights[b];
    for (uint32_t k = 0, b = 0; k < EWA_CODES; k++) {
        const double wanted = all * (k + 0.5) / EWA_CODES;
        while (b + 1 < made->count && passed + made->weights[b] < wanted) passed += made->weights[b++];
        const double share = made->weights[b] > 0 ? fmin((wanted - passed) / made->weights[b], 1) : 0;
        codes[k] = (float)(made->lows[b] + (made->highs[b] - made->lows[b]) * share);
    }
}

/// One round: every code moves to the mean of what is nearest to it, and stays where there is none. `sums[i]` is that of the
/// numbers before i.
static void improve(const float *numbers, const double *sums, size_t count, float codes[EWA_CODES]) {
    size_t first = 0;
    for (int k = 0; k < EWA_CODES; k++) {
        const double bound = k + 1 < EWA_CODES ? 0.5 * ((double)codes[k] + (double)codes[k + 1]) : (double)INFINITY;
        const size_t end = first + find_from(numbers + first, count - first, bound);
        if (end > first) codes[k] = (float)((sums[end] - sums[first]) / (double)(end - first));
        first = end;
    }
}

ewa_status ewa_codebook_make(ewa_context *context, ewa_number_take *take, const void *data, size_t count, float codes[EWA_CODES]) {
    const size_t step = (count - 1) / SAMPLES + 1, samples = (count - 1) / step + 1, room = samples + 2;
    float *numbers = ewa_allocate(context, room, sizeof *numbers);
    double *sums = ewa_allocate(context, room + 1, sizeof *sums);
    bins *made = ewa_allocate(context, 1, sizeof *made);
    const bool have = numbers && sums && made;
    if (have) {
        float low = take(data, 0), high = low;
        for (size_t i = 0; i < count; i++) {
            const float number = take(data, i);
            low = fminf(low, number), high = fmaxf(high, number);
            if (i % step == 0) numbers[i / step] = number;
        }
        // What is between two samples may be beyond all of them.
        numbers[samples] = low, numbers[samples + 1] = high;
        qsort(numbers, room, sizeof *numbers, compare);
        sums[0] = 0;
        for (size_t i = 0; i < room; i++) sums[i + 1] = sums[i] + (double)numbers[i];
        place_codes(numbers, room, made, codes);
        for (int round = 0; round < ROUNDS; round++) improve(numbers, sums, room, codes);
    }
    ewa_release(context, made, 1, sizeof *made);
    ewa_release(context, sums, room + 1, sizeof *sums);
    ewa_release(context, numbers, room, sizeof *numbers);
    return have ? EWA_OK : EWA_ERROR_MEMORY;
}

uint8_t ewa_codebook_find(const float codes[EWA_CODES], float number) {
    const size_t above = find_from(codes, EWA_CODES, (double)number);
    if (above == 0) return 0;
    if (above == EWA_CODES) return EWA_CODES - 1;
    return (uint8_t)((double)number - (double)codes[above - 1] <= (double)codes[above] - (double)number ? above - 1 : above);
}

/// Vectors [first, first + count) of the order.
typedef struct cluster {
    uint32_t first, count;
    double error; ///< sum of squared distances to the mean; 0: is not split
} cluster;

typedef struct splitting {
    const float *vectors;
    size_t stride;
    uint32_t size;
    uint32_t *order;
    cluster *heap; ///< the cluster of the largest error first
    uint32_t count;
} splitting;

static const float *vector_at(const splitting *s, uint32_t place) { return s->vectors + s->stride * s->order[place]; }

/// The mean of every `step`-th vector of a cluster and their squared distances to it.
static double measure(const splitting *s, uint32_t first, uint32_t count, uint32_t step, double mean[EWA_PALETTE_SIZE]) {
    double squares = 0, used = 0;
    for (uint32_t d = 0; d < s->size; d++) mean[d] = 0;
    for (uint32_t i = 0; i < count; i += step, used++) {
        const float *vector = vector_at(s, first + i);
        for (uint32_t d = 0; d < s->size; d++) mean[d] += (double)vector[d];
    }
    for (uint32_t d = 0; d < s->size; d++) mean[d] /= used;
    for (uint32_t i = 0; i < count; i += step) {
        const float *vector = vector_at(s, first + i);
        for (uint32_t d = 0; d < s->size; d++) squares += ((double)vector[d] - mean[d]) * ((double)vector[d] - mean[d]);
    }
    return squares;
}

static double project(const splitting *s, uint32_t place, const double mean[], const double axis[]) {
    const float *vector = vector_at(s, place);
    double along = 0;
    for (uint32_t d = 0; d < s->size; d++) along += axis[d] * ((double)vector[d] - mean[d]);
    return along;
}

/// The principal axis of samples of a cluster, from the coordinate along which they spread most, by the power method; of no length
/// where they are at one place.
static void find_axis(const splitting *s, const cluster *c, double axis[EWA_PALETTE_SIZE]) {
    const uint32_t step = (c->count - 1) / AXIS_SAMPLES + 1;
    double mean[EWA_PALETTE_SIZE], spread[EWA_PALETTE_SIZE] = {0};
    measure(s, c->first, c->count, step, mean);
    uint32_t widest = 0;
    for (uint32_t d = 0; d < s->size; d++) {
        for (uint32_t i = 0; i < c->count; i += step) {
            const double off = (double)vector_at(s, c->first + i)[d] - mean[d];
            spread[d] += off * off;
        }
        axis[d] = 0;
        if (spread[d] > spread[widest]) widest = d;
    }
    axis[widest] = 1;
    for (int round = 0; round < AXIS_ROUNDS; round++) {
        double next[EWA_PALETTE_SIZE] = {0}, length2 = 0;
        for (uint32_t i = 0; i < c->count; i += step) {
            const float *vector = vector_at(s, c->first + i);
            const double along = project(s, c->first + i, mean, axis);
            for (uint32_t d = 0; d < s->size; d++) next[d] += along * ((double)vector[d] - mean[d]);
        }
        for (uint32_t d = 0; d < s->size; d++) length2 += next[d] * next[d];
        if (!(length2 > 0)) return;
        for (uint32_t d = 0; d < s->size; d++) axis[d] = next[d] / sqrt(length2);
    }
}

/// Puts a cluster into the heap, at place `at` where it is the last or was changed.
static void settle_up(splitting *s, uint32_t at) {
    const cluster moved = s->heap[at];
    for (; at && s->heap[(at - 1) / 2].error < moved.error; at = (at - 1) / 2) s->heap[at] = s->heap[(at - 1) / 2];
    s->heap[at] = moved;
}
static void settle_down(splitting *s) {
    const cluster moved = s->heap[0];
    uint32_t at = 0;
    for (;;) {
        uint32_t child = 2 * at + 1;
        if (child + 1 < s->count && s->heap[child + 1].error > s->heap[child].error) child++;
        if (child >= s->count || s->heap[child].error <= moved.error) break;
        s->heap[at] = s->heap[child];
        at = child;
    }
    s->heap[at] = moved;
}

/// Splits the first cluster of the heap, or says that it is one.
static void split(splitting *s) {
    cluster *c = &s->heap[0], other;
    double mean[EWA_PALETTE_SIZE], axis[EWA_PALETTE_SIZE];
    find_axis(s, c, axis);
    measure(s, c->first, c->count, 1, mean);
    uint32_t from = c->first, end = c->first + c->count;
    while (from < end)
        if (project(s, from, mean, axis) < 0) {
            from++;
        } else {
            const uint32_t swapped = s->order[--end];
            s->order[end] = s->order[from];
            s->order[from] = swapped;
        }
    other = (cluster){.first = from, .count = c->first + c->count - from};
    c->count -= other.count;
    if (c->count && other.count) {
        c->error = measure(s, c->first, c->count, 1, mean);
        other.error = measure(s, other.first, other.count, 1, mean);
    } else {
        c->first = c->count ? c->first : other.first;
        c->count += other.count;
        c->error = other.error = 0;
        other.count = 0;
    }
    settle_down(s);
    if (!other.count) return;
    s->heap[s->count++] = other;
    settle_up(s, s->count - 1);
}

/// Palettes in the order of their vectors, so that neighbours in it are like each other.
static int compare_clusters(const void *a, const void *b) {
    const cluster *x = a, *y = b;
    return (x->first > y->first) - (x->first < y->first);
}

static void fill(splitting *s, ewa_palettes *palettes) {
    qsort(s->heap, s->count, sizeof *s->heap, compare_clusters);
    palettes->count = s->count;
    for (uint32_t k = 0; k < s->count; k++) {
        double mean[EWA_PALETTE_SIZE];
        measure(s, s->heap[k].first, s->heap[k].count, 1, mean);
        for (uint32_t d = 0; d < s->size; d++) palettes->numbers[(size_t)k * s->size + d] = (float)mean[d];
        for (uint32_t i = 0; i < s->heap[k].count; i++) palettes->labels[s->order[s->heap[k].first + i]] = (uint16_t)k;
    }
}

ewa_status ewa_palettes_make(ewa_context *context, const float *vectors, size_t stride, uint32_t vector_count, uint32_t size,
                             uint32_t room, ewa_palettes *palettes) {
    *palettes = (ewa_palettes){.size = size, .room = room, .vector_count = vector_count};
    palettes->numbers = ewa_allocate(context, room, size * sizeof(float));
    palettes->labels = ewa_allocate(context, vector_count, sizeof *palettes->labels);
    splitting s = {.vectors = vectors, .stride = stride, .size = size, .count = 1};
    s.order = ewa_allocate(context, vector_count, sizeof *s.order);
    s.heap = ewa_allocate(context, room, sizeof *s.heap);
    const bool have = palettes->numbers && palettes->labels && s.order && s.heap;
    if (have) {
        double mean[EWA_PALETTE_SIZE];
        for (uint32_t i = 0; i < vector_count; i++) s.order[i] = i;
        s.heap[0] = (cluster){.first = 0, .count = vector_count, .error = measure(&s, 0, vector_count, 1, mean)};
        while (s.count < room && s.heap[0].error > 0) split(&s);
        fill(&s, palettes);
    }
    ewa_release(context, s.heap, room, sizeof *s.heap);
    ewa_release(context, s.order, vector_count, sizeof *s.order);
    return have ? EWA_OK : EWA_ERROR_MEMORY;
}

void ewa_palettes_free(ewa_context *context, ewa_palettes *palettes) {
    ewa_release(context, palettes->labels, palettes->vector_count, sizeof *palettes->labels);
    ewa_release(context, palettes->numbers, palettes->room, palettes->size * sizeof(float));
    *palettes = (ewa_palettes){.size = 0};
}
