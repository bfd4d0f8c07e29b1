// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What kind of numbers a volume holds, from how neighbours differ.
//
// Based on: J. von Neumann, "Distribution of the Ratio of the Mean Square Successive Difference to the Variance",
// 1941 (the ratio is 2 for numbers that have nothing to do with each other).
#include "image/volume_kind.h"
#include "image/volume.h"

#include <math.h>

enum {
    ROW = 1024,
    CODE_RANGE = 1 << 16,
    WORD = 64,
    MIN_LABELS = 3,
    MANY_LABELS = 6,
    SMALL_CODE = 32,
    MIN_SIDE = 8
};

/// A code is a label's when this share of its neighbours have it too; share of the codes that have to be; share of
/// the borders between codes that have to skip others.
static const double EQUAL_SHARE = 0.5, LABEL_SHARE = 0.8, SKIP_SHARE = 0.1;

/// Half of von Neumann's ratio from which on a volume is noise: white noise has 1, a scan less than 0.4.
static const double WHITE = 0.8;

/// Sum of squared second differences over that of the first ones, below which a field is resolved by its grid:
/// sampled functions have 0.01 to 0.25, the borders of a scan 0.6, its noise 3.
static const double RESOLVED = 0.35;

/// The same along the other two axes: slices of a scan that was resampled smoothly in its plane have more.
static const double RESOLVED_ACROSS = 0.6;

/// The codes that occur.
typedef struct code_set {
    uint64_t bits[CODE_RANGE / WORD];
    double low; ///< the code of bit 0
    uint32_t count;
} code_set;

/// Adds whole numbers; false where a number is none, or where there are too many.
static bool add_codes(const float *numbers, size_t count, code_set *set) {
    for (size_t i = 0; i < count; i++) {
        const double place = (double)numbers[i] - set->low;
        if (!(place >= 0 && place < CODE_RANGE) || place != floor(place)) return false;
        const uint32_t at = (uint32_t)place;
        const uint64_t bit = UINT64_C(1) << at % WORD;
        if (set->bits[at / WORD] & bit) continue;
        set->bits[at / WORD] |= bit;
        if (++set->count > EWA_MAX_LABELS) return false;
    }
    return true;
}

static bool find_codes(const ewa_volume *volume, const ewa_volume_facts *facts, code_set *set) {
    *set = (code_set){.low = facts->low};
    if (facts->low != floor(facts->low)) return false;
    float numbers[ROW];
    for (uint64_t first = 0; first < facts->voxel_count; first += ROW) {
        const uint64_t left = facts->voxel_count - first;
        const size_t count = left < ROW ? (size_t)left : ROW;
        ewa_volume_read(volume, first, count, numbers);
        if (!add_codes(numbers, count, set)) return false;
    }
    return true;
}

uint32_t ewa_volume_label_index(const ewa_volume_labels *labels, float value) {
    uint32_t low = 0, high = labels->count;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (labels->codes[middle] < value)
            low = middle + 1;
        else
            high = middle;
    }
    return low < labels->count && labels->codes[low] == value ? low : labels->count;
}

/// What neighbours along x have in common.
typedef struct row_facts {
    double pairs, squares;         ///< pairs of numbers, their squared differences
    double bends;                  ///< squared second differences
    double count, sum, square_sum; ///< of the numbers
    double borders, skipping;      ///< pairs of different codes; those with other codes between them
    double adjacencies[EWA_MAX_LABELS], equal[EWA_MAX_LABELS]; ///< [code] pairs with it, and with it twice
} row_facts;

static void add_codes_of_row(const float *numbers, size_t count, const ewa_volume_labels *labels,
                             row_facts *facts) {
    uint32_t last = ewa_volume_label_index(labels, numbers[0]);
    for (size_t i = 1; i < count; i++) {
        const uint32_t here = ewa_volume_label_index(labels, numbers[i]);
        facts->adjacencies[here]++;
        if (here == last) {
            facts->equal[here]++;
        } else {
            facts->adjacencies[last]++;
            facts->borders++;
            facts->skipping += (here > last ? here - last : last - here) > 1;
        }
        last = here;
    }
}

/// Adds a row; numbers beyond the range of `surfaces` count as its ends.
static void add_row(const float *numbers, size_t count, const ewa_volume_surfaces *surfaces,
                    row_facts *facts) {
    const double low = surfaces->low, width = surfaces->high - low;
    double last = NAN, last_step = NAN;
    for (size_t i = 0; i < count; i++) {
        const double place = ((double)numbers[i] - low) / width;
        const double here = isfinite(place) ? fmin(fmax(place, 0), 1) : NAN, step = here - last;
        if (!isnan(here)) facts->count++, facts->sum += here, facts->square_sum += here * here;
        if (!isnan(step)) facts->pairs++, facts->squares += step * step;
        if (!isnan(step - last_step)) facts->bends += (step - last_step) * (step - last_step);
        last = here;
        last_step = step;
    }
}

static row_facts measure(const ewa_volume *volume, const ewa_volume_surfaces *surfaces,
                         const ewa_volume_labels *labels) {
    enum { MAX_VOXELS = 1 << 20 };
    const uint32_t *dims = volume->dims;
    const uint64_t rows = (uint64_t)dims[1] * dims[2], step = 1 + rows * dims[0] / MAX_VOXELS;
    row_facts facts = {.pairs = 0};
    float numbers[ROW];
    for (uint64_t row = 0; row < rows; row += step)
        for (uint32_t begin = 0; begin < dims[0]; begin += ROW) {
            const uint32_t left = dims[0] - begin, count = left < ROW ? left : ROW;
            ewa_volume_read(volume, row * dims[0] + begin, count, numbers);
            add_row(numbers, count, surfaces, &facts);
            if (labels->count) add_codes_of_row(numbers, count, labels, &facts);
        }
    return facts;
}

/// Sum of squared second differences over that of the first ones along y or z, of places within the range of `surfaces`.
static double bends_across(const ewa_volume *volume, const ewa_volume_surfaces *surfaces, int axis) {
    enum { MAX_VOXELS = 1 << 18 };
    const uint32_t *dims = volume->dims;
    const uint64_t rows = (uint64_t)dims[1] * dims[2], step = 1 + rows * dims[0] / MAX_VOXELS, stride = axis == 1 ? 1 : dims[1];
    const double low = surfaces->low, width = surfaces->high - low;
    double squares = 0, bends = 0;
    float numbers[3][ROW];
    for (uint64_t row = 0; row + 2 * stride < rows; row += step) {
        if (axis == 1 && row % dims[1] + 2 >= dims[1]) continue;
        for (uint32_t begin = 0; begin < dims[0]; begin += ROW) {
            const uint32_t left = dims[0] - begin, count = left < ROW ? left : ROW;
            for (uint64_t r = 0; r < 3; r++) ewa_volume_read(volume, (row + r * stride) * dims[0] + begin, count, numbers[r]);
            for (uint32_t i = 0; i < count; i++) {
                if (!isfinite(numbers[0][i]) || !isfinite(numbers[1][i]) || !isfinite(numbers[2][i])) continue;
                double place[3];
                for (int r = 0; r < 3; r++) place[r] = fmin(fmax(((double)numbers[r][i] - low) / width, 0), 1);
                const double first = place[1] - place[0], bend = place[2] - place[1] - first;
                squares += first * first;
                bends += bend * bend;
            }
        }
    }
    return squares > 0 ? bends / squares : 0;
}

/// Lists the codes; 0 surrounds, or the smallest.
static void list_codes(const code_set *set, ewa_volume_labels *labels) {
    for (uint32_t at = 0; at < CODE_RANGE; at++) {
        if (!(set->bits[at / WORD] >> at % WORD & 1)) continue;
        if (set->low + at == 0) labels->surrounding = labels->count;
        labels->codes[labels->count++] = (float)(set->low + at);
    }
}

/// Whether codes lie in pieces, and beside any others: steps of a quantity lie beside the next ones.
static bool are_labels(const ewa_volume_labels *labels, const row_facts *rows) {
    double present = 0, whole = 0;
    for (uint32_t i = 0; i < labels->count; i++) {
        present += rows->adjacencies[i] > 0;
        whole += rows->equal[i] > EQUAL_SHARE * rows->adjacencies[i];
    }
    return present >= MIN_LABELS && whole >= LABEL_SHARE * present && rows->skipping >= SKIP_SHARE * rows->borders;
}

ewa_volume_kind ewa_volume_find_kind(const ewa_volume *volume, const ewa_volume_facts *facts,
                                     const ewa_volume_surfaces *surfaces, ewa_volume_labels *labels) {
    const uint32_t *dims = volume->dims;
    *labels = (ewa_volume_labels){.count = 0};
    code_set set;
    if (find_codes(volume, facts, &set) && set.count >= MIN_LABELS &&
        (set.count >= MANY_LABELS || facts->high <= SMALL_CODE))
        list_codes(&set, labels);
    const row_facts rows = measure(volume, surfaces, labels);
    if (labels->count && are_labels(labels, &rows)) return EWA_KIND_LABELS;
    labels->count = 0;
    if ((dims[0] == 1) + (dims[1] == 1) + (dims[2] == 1) == 1) return EWA_KIND_PICTURE;
    const double mean = rows.sum / rows.count, variance = rows.square_sum / rows.count - mean * mean;
    if (dims[0] < MIN_SIDE || dims[1] < MIN_SIDE || dims[2] < MIN_SIDE || !(rows.squares > 0))
        return EWA_KIND_SCAN;
    if (rows.squares >= 2 * WHITE * variance * rows.pairs) return EWA_KIND_NOISE;
    const bool resolved = rows.bends <= RESOLVED * rows.squares && bends_across(volume, surfaces, 1) <= RESOLVED_ACROSS &&
                          bends_across(volume, surfaces, 2) <= RESOLVED_ACROSS;
    return resolved ? EWA_KIND_FIELD : EWA_KIND_SCAN;
}
