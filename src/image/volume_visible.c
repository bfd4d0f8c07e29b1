// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where what can be seen of a volume is.
#include "base/base.h"
#include "image/volume.h"

#include <math.h>

enum { STEPS = 1024, ROW = 1024 };

/// Extinction per unit length from which all matter counts the same.
static const double ENOUGH = 0.02;

/// How much of the visible is at each index along each axis.
typedef struct marginals {
    double *sums[3];
    uint64_t visible_count;
} marginals;

/// What a value counts, tabled over the range of the transfer function.
typedef struct weights {
    double low, scale;
    float table[STEPS + 1];
} weights;

static void make_weights(const ewa_transfer *transfer, weights *made) {
    const ewa_transfer_point *points = transfer->points;
    const uint32_t last = transfer->point_count - 1;
    const double low = points[0].value, high = points[last].value;
    made->low = low;
    made->scale = high > low ? STEPS / (high - low) : 0;
    uint32_t at = 0;
    for (int i = 0; i <= STEPS; i++) {
        const double value = low + (high - low) * i / STEPS;
        while (at + 1 < last && points[at + 1].value <= value) at++;
        const double width = points[at + 1].value - points[at].value;
        const double t = width > 0 ? fmin((value - points[at].value) / width, 1) : 1;
        const double extinction =
            (1 - t) * (double)points[at].extinction + t * (double)points[at + 1].extinction;
        made->table[i] = (float)fmin(extinction, ENOUGH);
    }
}

static float weight_of(const weights *w, float value) {
    const double place = ((double)value - w->low) * w->scale;
    return place >= 0 && place <= STEPS ? w->table[(int)(place + 0.5)] : 0;
}

static void add_row(const ewa_volume *volume, const weights *w, uint32_t j, uint32_t k, marginals *m) {
    float numbers[ROW];
    double sum = 0;
    const uint64_t first = ((uint64_t)k * volume->dims[1] + j) * volume->dims[0];
    for (uint32_t begin = 0; begin < volume->dims[0]; begin += ROW) {
        const uint32_t left = volume->dims[0] - begin, count = left < ROW ? left : ROW;
        ewa_volume_read(volume, first + begin, count, numbers);
        for (uint32_t i = 0; i < count; i++) {
            const double weight = (double)weight_of(w, numbers[i]);
            if (!(weight > 0)) continue;
            m->visible_count++;
            m->sums[0][begin + i] += weight;
            sum += weight;
        }
    }
    m->sums[1][j] += sum;
    m->sums[2][k] += sum;
}

/// The range of indices between which all but a share at either end lies, half a voxel wider.
static void find_range(const double *sums, uint32_t count, double share, double range[2]) {
    double all = 0, below = 0;
    for (uint32_t i = 0; i < count; i++) all += sums[i];
    uint32_t low = 0, high = count - 1;
    while (low < high && (below += sums[low]) <= share * all) low++;
    below = 0;
    while (high > low && (below += sums[high]) <= share * all) high--;
    range[0] = low - 0.5;
    range[1] = high + 0.5;
}

static void make_bounds(const ewa_volume *volume, double ranges[3][2], ewa_bounds *bounds) {
    for (int k = 0; k < 3; k++) {
        const double *row = volume->index_to_world + 4 * k;
        bounds->low_world[k] = bounds->high_world[k] = row[3];
        for (int axis = 0; axis < 3; axis++) {
            const bool ahead = row[axis] > 0;
            bounds->low_world[k] += row[axis] * ranges[axis][!ahead];
            bounds->high_world[k] += row[axis] * ranges[axis][ahead];
        }
    }
}

ewa_status ewa_volume_measure_visible(const ewa_volume *volume, const ewa_transfer *transfer,
                                      double left_out_share, ewa_bounds *bounds) {
    if (!volume || !volume->voxels || !transfer || !bounds || !(left_out_share >= 0 && left_out_share <= 0.4))
        return EWA_ERROR_ARGUMENT;
    *bounds = (ewa_bounds){.finite_count = 0};
    const ewa_status status = ewa_transfer_check(volume->context, "transfer function", transfer);
    if (status != EWA_OK) return status;
    weights w;
    make_weights(transfer, &w);
    const uint32_t *dims = volume->dims;
    const size_t room = (size_t)dims[0] + dims[1] + dims[2];
    double *sums = ewa_allocate_zeroed(volume->context, room, sizeof *sums);
    if (!sums) return EWA_ERROR_MEMORY;
    marginals m = {.sums = {sums, sums + dims[0], sums + dims[0] + dims[1]}};
    for (uint32_t k = 0; k < dims[2]; k++)
        for (uint32_t j = 0; j < dims[1]; j++) add_row(volume, &w, j, k, &m);
    bounds->finite_count = m.visible_count;
    if (m.visible_count) {
        double ranges[3][2];
        for (int axis = 0; axis < 3; axis++)
            find_range(m.sums[axis], dims[axis], left_out_share, ranges[axis]);
        make_bounds(volume, ranges, bounds);
    }
    ewa_release(volume->context, sums, room, sizeof *sums);
    return EWA_OK;
}
