// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How large the surfaces between lower and higher values of a volume are. The area of the surface at a value
// is the histogram of that value weighted by the length of the gradient (the coarea formula): here the number
// of neighbours that lie on either side. Noise has a large area for its volume, a clean boundary a small one.
//
// Based on: C. Bajaj, V. Pascucci, D. Schikore, "The Contour Spectrum", 1997 (the area as a function of the
// value); C. Scheidegger, J. Schreiner, B. Duffy, H. Carr, C. Silva, "Revisiting Histograms and Isosurface
// Statistics", 2008 (that histograms should be weighted by the gradient).
#include "image/volume_surfaces.h"
#include "image/volume.h"

#include <math.h>
#include <string.h>

enum { BINS = EWA_SURFACE_BINS, ROW = 1024, MAX_VOXELS = 1 << 20, MAX_ROUNDS = 16, NONE = -1 };

/// Share of the voxels that may lie beyond either end of the range; bins of a histogram that the range has to
/// cover, so that it need not be taken again.
static const double OUTSIDE_SHARE = 1e-4;
static const int ENOUGH_BINS = 64;

/// Which rows of a volume are looked at: every `step`-th, other ones in each slice.
typedef struct row_sample {
    const ewa_volume *volume;
    uint64_t step;
} row_sample;

static row_sample choose_rows(const ewa_volume *volume) {
    const uint64_t count = (uint64_t)volume->dims[0] * volume->dims[1] * volume->dims[2];
    return (row_sample){volume, 1 + count / MAX_VOXELS};
}

static bool is_sampled(const row_sample *rows, uint32_t j, uint32_t k) {
    return (j + (uint64_t)3 * k) % rows->step == 0;
}

static uint64_t row_first(const ewa_volume *volume, uint32_t j, uint32_t k) {
    return ((uint64_t)k * volume->dims[1] + j) * volume->dims[0];
}

/// A histogram of the sampled rows from `low` to `high`, what lies beyond in two more counts.
typedef struct range_counts {
    double counts[BINS], below, above;
} range_counts;

static void count_range(const row_sample *rows, double low, double high, range_counts *made) {
    const ewa_volume *volume = rows->volume;
    const double scale = (BINS - 1) / (high - low);
    *made = (range_counts){.below = 0};
    float numbers[ROW];
    for (uint32_t k = 0; k < volume->dims[2]; k++)
        for (uint32_t j = 0; j < volume->dims[1]; j++)
            for (uint32_t begin = 0; is_sampled(rows, j, k) && begin < volume->dims[0]; begin += ROW) {
                const uint32_t left = volume->dims[0] - begin, count = left < ROW ? left : ROW;
                ewa_volume_read(volume, row_first(volume, j, k) + begin, count, numbers);
                for (uint32_t i = 0; i < count; i++) {
                    const double number = (double)numbers[i];
                    if (!isfinite(number)) continue;
                    if (number < low)
                        made->below++;
                    else if (number > high)
                        made->above++;
                    else
                        made->counts[(int)((number - low) * scale + 0.5)]++;
                }
            }
}

/// Cuts off what few voxels have at either end, again and again until what is left fills its histogram.
static void find_range(const row_sample *rows, const ewa_volume_facts *facts, double *low, double *high) {
    *low = facts->low;
    *high = facts->high;
    range_counts range = {.below = 0};
    for (int i = 0; i < BINS; i++) range.counts[i] = (double)facts->histogram[i];
    for (int round = 0; round < MAX_ROUNDS; round++) {
        double all = range.below + range.above, under = range.below, over = range.above;
        for (int i = 0; i < BINS; i++) all += range.counts[i];
        int first = 0, last = BINS - 1;
        while (first < BINS - 1 && under + range.counts[first] <= OUTSIDE_SHARE * all)
            under += range.counts[first++];
        while (last > 0 && over + range.counts[last] <= OUTSIDE_SHARE * all) over += range.counts[last--];
        const double step = (*high - *low) / (BINS - 1), from = *low;
        const bool enough = last - first >= ENOUGH_BINS;
        *low = fmax(from + (first - (enough ? 0 : 0.5)) * step, facts->low);
        *high = fmin(from + (last + (enough ? 0 : 0.5)) * step, facts->high);
        if (enough) return;
        // One value and next to nothing else: that little is what there is to see.
        if (!(*high - *low > 1e-12 * fmax(fabs(*low), fabs(*high)))) break;
        count_range(rows, *low, *high, &range);
    }
    *low = facts->low;
    *high = facts->high;
}

/// The bins of a part of a row, NONE for what is no number.
static void bin_row(const ewa_volume_surfaces *s, const ewa_volume *volume, uint64_t first, uint32_t count,
                    int16_t *bins) {
    float numbers[ROW + 1];
    const double scale = (BINS - 1) / (s->high - s->low);
    ewa_volume_read(volume, first, count, numbers);
    for (uint32_t i = 0; i < count; i++) {
        const double number = (double)numbers[i], place = (number - s->low) * scale + 0.5;
        const double held = place < 0 ? 0 : place > BINS - 1 ? BINS - 1 : place;
        bins[i] = isfinite(number) ? (int16_t)held : NONE;
    }
}

/// Counts pairs at all thresholds between their bins: +1 where they begin, -1 behind their end.
static void add_pairs(const int16_t *a, const int16_t *b, uint32_t count, int64_t steps[BINS + 1]) {
    for (uint32_t i = 0; i < count; i++) {
        const int low = a[i] < b[i] ? a[i] : b[i], high = a[i] < b[i] ? b[i] : a[i];
        if (low == NONE) continue;
        steps[low + 1]++;
        steps[high + 1]--;
    }
}

/// Adds a sampled row: its voxels, and their pairs with the next ones along each axis.
static void add_row(const ewa_volume *volume, uint32_t j, uint32_t k, ewa_volume_surfaces *s,
                    int64_t steps[BINS + 1]) {
    const uint32_t *dims = volume->dims;
    const bool on_face =
        (dims[1] > 1 && (j == 0 || j + 1 == dims[1])) || (dims[2] > 1 && (k == 0 || k + 1 == dims[2]));
    const uint64_t first = row_first(volume, j, k);
    int16_t row[ROW + 1], next[ROW + 1];
    for (uint32_t begin = 0; begin < dims[0]; begin += ROW) {
        const uint32_t left = dims[0] - begin, count = left < ROW ? left : ROW;
        const uint32_t with_next = left > ROW ? ROW + 1 : count;
        bin_row(s, volume, first + begin, with_next, row);
        add_pairs(row, row + 1, with_next - 1, steps);
        if (j + 1 < dims[1]) {
            bin_row(s, volume, first + begin + dims[0], count, next);
            add_pairs(row, next, count, steps);
        }
        if (k + 1 < dims[2]) {
            bin_row(s, volume, first + begin + (uint64_t)dims[0] * dims[1], count, next);
            add_pairs(row, next, count, steps);
        }
        for (uint32_t i = 0; i < count; i++) {
            if (row[i] == NONE) continue;
            s->counts[row[i]]++;
            const uint32_t at = begin + i;
            if (on_face || (dims[0] > 1 && (at == 0 || at + 1 == dims[0]))) s->borders[row[i]]++;
        }
    }
}

void ewa_volume_surfaces_measure(const ewa_volume *volume, const ewa_volume_facts *facts,
                                 ewa_volume_surfaces *surfaces) {
    const row_sample rows = choose_rows(volume);
    *surfaces = (ewa_volume_surfaces){.low = 0};
    find_range(&rows, facts, &surfaces->low, &surfaces->high);
    int64_t steps[BINS + 1] = {0}, pairs = 0;
    for (uint32_t k = 0; k < volume->dims[2]; k++)
        for (uint32_t j = 0; j < volume->dims[1]; j++)
            if (is_sampled(&rows, j, k)) add_row(volume, j, k, surfaces, steps);
    for (int t = 1; t < BINS; t++) {
        pairs += steps[t];
        surfaces->area[t] = (double)pairs;
    }
    // From counts per bin to counts from each bin on.
    memcpy(surfaces->above, surfaces->counts, sizeof surfaces->above);
    for (int t = BINS - 2; t >= 0; t--) {
        surfaces->above[t] += surfaces->above[t + 1];
        surfaces->borders[t] += surfaces->borders[t + 1];
    }
    surfaces->count = surfaces->above[0];
    surfaces->border_count = surfaces->borders[0];
}

double ewa_surfaces_value(const ewa_volume_surfaces *surfaces, double threshold) {
    return surfaces->low + (surfaces->high - surfaces->low) * (threshold - 0.5) / (BINS - 1);
}
