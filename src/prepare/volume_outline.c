// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where what can be seen of a volume is.
#include "base/base.h"
#include "ewa/prepare.h"
#include "image/volume.h"

#include <math.h>

enum { STEPS = 1024, ROW = 1024 };

/// Extinction per unit length from which all matter counts the same, and the share of that below which it is
/// taken for noise.
static const double ENOUGH = 0.02, FAINT = 0.25;

/// How much of the visible is at each index along each axis.
typedef struct marginals {
    double *sums[3];
    double all;
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

/// Adds a row to the sums.
static void add_row(const ewa_volume *volume, const weights *w, uint32_t j, uint32_t k, marginals *m) {
    float numbers[ROW];
    double sum = 0;
    const uint64_t first = ((uint64_t)k * volume->dims[1] + j) * volume->dims[0];
    for (uint32_t begin = 0; begin < volume->dims[0]; begin += ROW) {
        const uint32_t left = volume->dims[0] - begin, count = left < ROW ? left : ROW;
        ewa_volume_read(volume, first + begin, count, numbers);
        for (uint32_t i = 0; i < count; i++) {
            const double weight = (double)weight_of(w, numbers[i]);
            m->sums[0][begin + i] += weight;
            sum += weight;
        }
    }
    m->sums[1][j] += sum;
    m->sums[2][k] += sum;
    m->all += sum;
}

/// The first and the last index between which all but a share at either end lies.
static void find_range(const marginals *m, int axis, uint32_t count, double share, uint32_t range[2]) {
    const double *sums = m->sums[axis];
    double below = 0;
    range[0] = 0;
    range[1] = count - 1;
    while (range[0] < range[1] && (below += sums[range[0]]) <= share * m->all) range[0]++;
    below = 0;
    while (range[1] > range[0] && (below += sums[range[1]]) <= share * m->all) range[1]--;
}

/// The first and the last voxel of a row, inside of a range, that is more than `least`; false when none is.
static bool find_ends(const ewa_volume *volume, const weights *w, uint32_t j, uint32_t k,
                      const uint32_t range[2], float least, uint32_t ends[2]) {
    float numbers[ROW];
    bool found = false;
    const uint64_t first = ((uint64_t)k * volume->dims[1] + j) * volume->dims[0];
    for (uint32_t begin = range[0]; begin <= range[1]; begin += ROW) {
        const uint32_t left = range[1] + 1 - begin, count = left < ROW ? left : ROW;
        ewa_volume_read(volume, first + begin, count, numbers);
        for (uint32_t i = 0; i < count; i++) {
            if (!(weight_of(w, numbers[i]) > least)) continue;
            if (!found) ends[0] = begin + i;
            ends[1] = begin + i;
            found = true;
        }
    }
    return found;
}

static void place(const ewa_volume *volume, double i, double j, double k, double world[3]) {
    for (int c = 0; c < 3; c++) {
        const double *row = volume->index_to_world + 4 * c;
        world[c] = row[0] * i + row[1] * j + row[2] * k + row[3];
    }
}

/// Finds the ends of all rows of a box; writes two places for each that has any unless `places` is NULL.
/// Returns how many places there are.
static uint64_t find_places(const ewa_volume *volume, const weights *w, uint32_t box[3][2], float least,
                            double *places) {
    uint64_t count = 0;
    for (uint32_t k = box[2][0]; k <= box[2][1]; k++)
        for (uint32_t j = box[1][0]; j <= box[1][1]; j++) {
            uint32_t ends[2];
            if (!find_ends(volume, w, j, k, box[0], least, ends)) continue;
            if (places) {
                // The corners of the voxels, so that single ones and slices have a size as well.
                place(volume, ends[0] - 0.5, j - 0.5, k - 0.5, places + 3 * count);
                place(volume, ends[1] + 0.5, j + 0.5, k + 0.5, places + 3 * count + 3);
            }
            count += 2;
        }
    return count;
}

static ewa_status make_outline(const ewa_volume *volume, const weights *w, double share, marginals *m,
                               ewa_cloud **cloud) {
    const uint32_t *dims = volume->dims;
    float highest = 0;
    for (int i = 0; i <= STEPS; i++) highest = fmaxf(highest, w->table[i]);
    for (uint32_t k = 0; k < dims[2]; k++)
        for (uint32_t j = 0; j < dims[1]; j++) add_row(volume, w, j, k, m);
    uint32_t box[3][2];
    for (int axis = 0; axis < 3; axis++) find_range(m, axis, dims[axis], share, box[axis]);
    float least = (float)FAINT * highest;
    uint64_t count = m->all > 0 ? find_places(volume, w, box, least, NULL) : 0;
    if (m->all > 0 && count == 0) {
        // Nothing but faint matter.
        least = 0;
        count = find_places(volume, w, box, least, NULL);
    }
    ewa_status status = ewa_cloud_create(volume->context, count, cloud);
    void *places = NULL;
    if (status == EWA_OK) status = ewa_cloud_add(*cloud, EWA_POSITION, EWA_F64, 3, &places);
    if (status == EWA_OK && count) find_places(volume, w, box, least, places);
    if (status != EWA_OK) ewa_cloud_destroy(cloud);
    return status;
}

ewa_status ewa_volume_outline(const ewa_volume *volume, const ewa_transfer *transfer, double left_out_share,
                              ewa_cloud **cloud) {
    if (!volume || !volume->voxels || !transfer || !cloud || !(left_out_share >= 0 && left_out_share <= 0.4))
        return EWA_ERROR_ARGUMENT;
    *cloud = NULL;
    const ewa_status status = ewa_transfer_check(volume->context, "transfer function", transfer);
    if (status != EWA_OK) return status;
    weights w;
    make_weights(transfer, &w);
    const uint32_t *dims = volume->dims;
    const size_t room = (size_t)dims[0] + dims[1] + dims[2];
    double *sums = ewa_allocate_zeroed(volume->context, room, sizeof *sums);
    if (!sums) return EWA_ERROR_MEMORY;
    marginals m = {.sums = {sums, sums + dims[0], sums + dims[0] + dims[1]}};
    const ewa_status made = make_outline(volume, &w, left_out_share, &m, cloud);
    ewa_release(volume->context, sums, room, sizeof *sums);
    return made;
}
