// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which way is up in a volume whose file does not say: raw numbers, NRRD without a space, VTK. What a scanner's table carried,
// or what its first slice cut off, ends flat; what is above it ends in the air. Matter is what is denser than Otsu's
// threshold between air and all else.
//
// Based on: N. Otsu, "A Threshold Selection Method from Gray-Level Histograms", 1979; H. Fu et al., "Upright Orientation of
// Man-Made Objects", 2008 (what stands has a base).
#include "image/volume_upright.h"
#include "base/base.h"
#include "image/volume.h"
#include "math/angle.h"

#include <math.h>

enum { SIDE = 128, BINS = 1024, MAX_ROUNDS = 16, SHORTEST = 8, END_COUNT = 6 };

/// Share of the values beyond either end of the range that is looked at.
static const double OUTSIDE_SHARE = 5e-4;

/// Share of a section that matter has to have: less is noise. Where, of its length, an end's section is taken.
static const double NOISE_SHARE = 0.002, INSIDE_SHARE = 0.015;

/// A base: so many times as large as any other end, so much of the largest section along its axis, and of the ellipse around it.
static const double BASE_RATIO = 2, BASE_SHARE = 0.5, BASE_FILL = 0.7;

/// Slices: both ends of an axis are so much of the largest section, the others at most so much of theirs; the round end fills so
/// much of its ellipse, and so much more than the other.
static const double CUT_SHARE = 0.3, WHOLE_SHARE = 0.25, ROUND_FILL = 0.9, ROUNDER_BY = 0.15;

/// Evenly spread voxels.
typedef struct voxel_sample {
    ewa_context *context;
    uint32_t dims[3], steps[3];
    float *values; ///< x fastest
    size_t count;
} voxel_sample;

/// Where matter ends along an axis: at index 0 or at the last one.
typedef struct matter_end {
    double area_world, share, fill; ///< of the section; of the largest one along the axis; of the ellipse around it
} matter_end;

static ewa_status take_sample(const ewa_volume *volume, voxel_sample *sample) {
    *sample = (voxel_sample){.context = volume->context, .count = 1};
    for (int a = 0; a < 3; a++) {
        sample->steps[a] = 1 + (volume->dims[a] - 1) / SIDE;
        sample->dims[a] = 1 + (volume->dims[a] - 1) / sample->steps[a];
        sample->count *= sample->dims[a];
    }
    sample->values = ewa_allocate(volume->context, sample->count, sizeof *sample->values);
    float *row = ewa_allocate(volume->context, volume->dims[0], sizeof *row);
    float *next = sample->values;
    for (uint32_t k = 0; row && next && k < volume->dims[2]; k += sample->steps[2])
        for (uint32_t j = 0; j < volume->dims[1]; j += sample->steps[1]) {
            ewa_volume_read(volume, ((uint64_t)k * volume->dims[1] + j) * volume->dims[0], volume->dims[0], row);
            for (uint32_t i = 0; i < volume->dims[0]; i += sample->steps[0]) *next++ = row[i];
        }
    const bool taken = row && sample->values;
    ewa_release(volume->context, row, volume->dims[0], sizeof *row);
    return taken ? EWA_OK : EWA_ERROR_MEMORY;
}

/// Counts the values in equal steps of the range; what lies beyond it is in the outermost ones.
static double count_values(const voxel_sample *sample, double low, double high, double counts[BINS]) {
    const double scale = BINS / (high - low);
    double all = 0;
    for (int b = 0; b < BINS; b++) counts[b] = 0;
    for (size_t i = 0; i < sample->count; i++) {
        if (!isfinite(sample->values[i])) continue;
        const double bin = ((double)sample->values[i] - low) * scale;
        counts[bin < 0 ? 0 : bin >= BINS ? BINS - 1 : (int)bin]++;
        all++;
    }
    return all;
}

/// Narrows the range to what all but few values are in, again until it is most of what was looked at.
static void narrow_range(const voxel_sample *sample, double *low, double *high) {
    double counts[BINS];
    int first = 0, last = BINS - 1;
    for (int round = 0; round < MAX_ROUNDS && *high > *low; round++) {
        const double all = count_values(sample, *low, *high, counts), step = (*high - *low) / BINS, from = *low;
        double under = 0, over = 0;
        for (first = 0; first < BINS - 1 && (under += counts[first]) <= OUTSIDE_SHARE * all;) first++;
        for (last = BINS - 1; last > first && (over += counts[last]) <= OUTSIDE_SHARE * all;) last--;
        *low = from + first * step;
        *high = from + (last + 1) * step;
        if (last - first > BINS / 4) return;
    }
}

/// The value between air and matter; false where all are the same.
static bool find_threshold(const voxel_sample *sample, double *threshold) {
    double low = INFINITY, high = -INFINITY, counts[BINS];
    for (size_t i = 0; i < sample->count; i++) {
        const double value = (double)sample->values[i];
        if (!isfinite(value)) continue;
        low = fmin(low, value);
        high = fmax(high, value);
    }
    if (!(high > low) || !isfinite(high - low)) return false;
    narrow_range(sample, &low, &high);
    if (!(high > low)) return false; // one value, and next to nothing else
    const double all = count_values(sample, low, high, counts);
    double moment = 0, below = 0, below_moment = 0, best = -1;
    for (int b = 0; b < BINS; b++) moment += counts[b] * b;
    for (int b = 0; b + 1 < BINS; b++) {
        below += counts[b];
        below_moment += counts[b] * b;
        if (below == 0 || below == all) continue;
        const double difference = below_moment / below - (moment - below_moment) / (all - below);
        const double between = below * (all - below) * difference * difference;
        if (between > best) {
            best = between;
            *threshold = low + (b + 1) * (high - low) / BINS;
        }
    }
    return best > 0;
}

/// How many of the counts' places hold all but few.
static double width_of(const double counts[SIDE], uint32_t size) {
    double all = 0, sum = 0;
    uint32_t first = size, last = 0;
    for (uint32_t i = 0; i < size; i++) all += counts[i];
    for (uint32_t i = 0; i < size; i++) {
        sum += counts[i];
        if (first == size && sum > 0.005 * all) first = i;
        if (sum < 0.995 * all) last = i + 1;
    }
    return (double)last - first + 1;
}

/// Measures the ends along an axis; false where matter is too short.
static bool measure_ends(const voxel_sample *sample, int axis, double threshold, const double lengths_world[3], matter_end ends[2]) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const size_t strides[3] = {1, sample->dims[0], (size_t)sample->dims[0] * sample->dims[1]};
    const uint32_t size = sample->dims[axis];
    const double section = (double)sample->dims[u] * sample->dims[v];
    double profile[SIDE] = {0}, largest = 0;
    uint32_t first = size, last = 0;
    for (uint32_t k = 0; k < size; k++) {
        for (uint32_t b = 0; b < sample->dims[v]; b++)
            for (uint32_t a = 0; a < sample->dims[u]; a++)
                profile[k] += (double)sample->values[k * strides[axis] + a * strides[u] + b * strides[v]] > threshold;
        largest = fmax(largest, profile[k]);
        if (profile[k] <= NOISE_SHARE * section) continue;
        if (first == size) first = k;
        last = k;
    }
    if (first == size || last - first + 1 < SHORTEST) return false;
    const uint32_t inside = (uint32_t)fmax(1, round(INSIDE_SHARE * (last - first + 1)));
    for (int e = 0; e < 2; e++) {
        const uint32_t k = e ? last - inside : first + inside;
        double along_u[SIDE] = {0}, along_v[SIDE] = {0};
        for (uint32_t b = 0; b < sample->dims[v]; b++)
            for (uint32_t a = 0; a < sample->dims[u]; a++) {
                const double there = (double)sample->values[k * strides[axis] + a * strides[u] + b * strides[v]] > threshold;
                along_u[a] += there;
                along_v[b] += there;
            }
        const double ellipse = 0.25 * EWA_PI * width_of(along_u, sample->dims[u]) * width_of(along_v, sample->dims[v]);
        ends[e] = (matter_end){profile[k] * lengths_world[u] * lengths_world[v], profile[k] / largest, profile[k] / ellipse};
    }
    return true;
}

/// The end that is below: of axis e / 2, the last index for odd e; END_COUNT: nothing tells.
static int find_base(const matter_end ends[END_COUNT]) {
    int base = 0;
    double second = 0;
    for (int e = 1; e < END_COUNT; e++)
        if (ends[e].area_world > ends[base].area_world) base = e;
    for (int e = 0; e < END_COUNT; e++)
        if (e != base) second = fmax(second, ends[e].area_world);
    const bool solid = ends[base].share >= BASE_SHARE && ends[base].fill >= BASE_FILL;
    return solid && ends[base].area_world >= BASE_RATIO * second ? base : END_COUNT;
}

/// The same for slices that end within a head at both sides: a skull is round above, and has a face and a neck below.
static int find_lower_slice(const matter_end ends[END_COUNT]) {
    for (int axis = 0; axis < 3; axis++) {
        const matter_end *e = ends + 2 * axis;
        double others = 0;
        for (int i = 0; i < END_COUNT; i++)
            if (i / 2 != axis) others = fmax(others, ends[i].share);
        if (fmin(e[0].share, e[1].share) < CUT_SHARE || others > WHOLE_SHARE) continue;
        const double rounder = e[0].fill - e[1].fill;
        if (fmax(e[0].fill, e[1].fill) >= ROUND_FILL && fabs(rounder) >= ROUNDER_BY) return 2 * axis + (rounder > 0);
    }
    return END_COUNT;
}

ewa_status ewa_volume_find_up(const ewa_volume *volume, double up_world[3], const char **why) {
    voxel_sample sample;
    matter_end ends[END_COUNT];
    double threshold, lengths_world[3];
    ewa_status status = take_sample(volume, &sample);
    const double *m = volume->index_to_world;
    for (int a = 0; a < 3; a++) lengths_world[a] = sample.steps[a] * hypot(hypot(m[a], m[4 + a]), m[8 + a]);
    bool measured = status == EWA_OK && find_threshold(&sample, &threshold);
    for (int a = 0; measured && a < 3; a++) measured = measure_ends(&sample, a, threshold, lengths_world, ends + 2 * a);
    ewa_release(volume->context, sample.values, sample.count, sizeof *sample.values);
    if (!measured) return status;
    const int base = find_base(ends), slice = base < END_COUNT ? base : find_lower_slice(ends);
    const int axis = slice / 2;
    if (slice == END_COUNT || fabs(m[axis]) >= fmax(fabs(m[4 + axis]), fabs(m[8 + axis]))) return EWA_OK; // x is never up
    const double sign = slice % 2 ? -1 : 1;
    for (int c = 0; c < 3; c++) up_world[c] = sign * m[4 * c + axis] * sample.steps[axis] / lengths_world[axis];
    *why = base < END_COUNT ? "it ends flat below" : "its slices are round above";
    return EWA_OK;
}
