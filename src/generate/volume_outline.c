// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where what can be seen of a volume is.
#include "base/base.h"
#include "ewa/prepare.h"
#include "homogeneous/vec.h"
#include "image/transfer.h"
#include "image/volume.h"
#include <string.h>

enum { STEPS = 1024, ROW = 1024, GROUPS = 64, CORNERS = 8, SLICES = 5, FEW = 3 };

/// Opacity that nobody sees: half a step of 8 bits.
static const double UNSEEN = 0.5 / 255;

/// Which values can be seen, tabled over the range of the transfer function.
typedef struct visibility {
    double low, scale;
    bool table[STEPS + 1];
} visibility;

/// Indices between which something of a group of rows was found.
typedef struct row_group {
    uint32_t low[3], high[3];
    bool any;
} row_group;

typedef struct outline {
    const ewa_volume *volume;
    visibility seen;
    uint8_t *masks;                   ///< [SLICES][j][i] of the slices k % SLICES: voxels that can be seen
    bool with_specks;                 ///< voxels count that have next to nothing around them
    row_group groups[GROUPS][GROUPS]; ///< [k][j]
    uint64_t group_count;
} outline;

/// Matter counts when a line of sight through all of the volume would show it, if it were of nothing else.
static void make_visibility(const ewa_volume *volume, const ewa_transfer *transfer, visibility *made) {
    const double *m = volume->index_to_world;
    double longest = 0, shortest = INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        const double step = vec3_length_scaled(vec3_make(m[axis], m[4 + axis], m[8 + axis]));
        longest += step * volume->dims[axis];
        shortest = fmin(shortest, step);
    }
    const double unit = transfer->unit_length_world > 0 ? transfer->unit_length_world : shortest;
    const double minimum = UNSEEN / (longest / unit);
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
        made->table[i] =
            (1 - t) * (double)points[at].extinction + t * (double)points[at + 1].extinction > minimum;
    }
}

static bool is_visible(const visibility *seen, float value) {
    const double place = ((double)value - seen->low) * seen->scale;
    return place >= 0 && place <= STEPS && seen->table[(int)(place + 0.5)];
}

static uint8_t *mask_row(const outline *o, uint32_t j, uint32_t k) {
    return o->masks + ((size_t)(k % SLICES) * o->volume->dims[1] + j) * o->volume->dims[0];
}

static void mask_slice(outline *o, uint32_t k) {
    const uint32_t *dims = o->volume->dims;
    float numbers[ROW];
    for (uint32_t j = 0; j < dims[1]; j++) {
        uint8_t *row = mask_row(o, j, k);
        const uint64_t first = ((uint64_t)k * dims[1] + j) * dims[0];
        for (uint32_t begin = 0; begin < dims[0]; begin += ROW) {
            const uint32_t left = dims[0] - begin, count = left < ROW ? left : ROW;
            ewa_volume_read(o->volume, first + begin, count, numbers);
            for (uint32_t i = 0; i < count; i++) row[begin + i] = is_visible(&o->seen, numbers[i]);
        }
    }
}

/// Counts what can be seen of a voxel and those around it, up to FEW; `beside` becomes one of these.
static int count_around(const outline *o, const uint32_t at[3], uint32_t beside[3]) {
    const uint32_t *dims = o->volume->dims;
    uint32_t low[3], high[3];
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = at[axis] ? at[axis] - 1 : 0;
        high[axis] = at[axis] + 1 < dims[axis] ? at[axis] + 1 : at[axis];
    }
    int found = 0;
    for (uint32_t k = low[2]; k <= high[2]; k++)
        for (uint32_t j = low[1]; j <= high[1]; j++) {
            const uint8_t *row = mask_row(o, j, k);
            for (uint32_t i = low[0]; i <= high[0]; i++) {
                if (!row[i]) continue;
                if (++found == FEW) return found;
                if (i != at[0] || j != at[1] || k != at[2]) beside[0] = i, beside[1] = j, beside[2] = k;
            }
        }
    return found;
}

/// Whether three voxels that touch can be seen, this one among them: noise is alone or in pairs.
static bool is_matter(const outline *o, uint32_t i, uint32_t j, uint32_t k) {
    if (o->with_specks) return true;
    const uint32_t at[3] = {i, j, k};
    uint32_t beside[3] = {i, j, k}, other[3];
    const int found = count_around(o, at, beside);
    // The end of a thin thing has one neighbour, which has another.
    return found == FEW || (found == FEW - 1 && count_around(o, beside, other) == FEW);
}

static void widen(row_group *group, const uint32_t at[3]) {
    for (int axis = 0; axis < 3; axis++) {
        if (!group->any || at[axis] < group->low[axis]) group->low[axis] = at[axis];
        if (!group->any || at[axis] > group->high[axis]) group->high[axis] = at[axis];
    }
    group->any = true;
}

/// Adds the ends of the rows of a slice, of which two slices to either side are masked, to their groups.
static void add_slice(outline *o, uint32_t k) {
    const uint32_t *dims = o->volume->dims;
    for (uint32_t j = 0; j < dims[1]; j++) {
        const uint8_t *row = mask_row(o, j, k);
        row_group *group = &o->groups[(uint64_t)k * GROUPS / dims[2]][(uint64_t)j * GROUPS / dims[1]];
        uint32_t first = 0, last = dims[0];
        while (first < dims[0] && !(row[first] && is_matter(o, first, j, k))) first++;
        if (first == dims[0]) continue;
        while (!(row[last - 1] && is_matter(o, last - 1, j, k))) last--;
        widen(group, (const uint32_t[3]){first, j, k});
        widen(group, (const uint32_t[3]){last - 1, j, k});
    }
}

static void find_groups(outline *o) {
    const uint32_t slices = o->volume->dims[2];
    memset(o->groups, 0, sizeof o->groups);
    o->group_count = 0;
    for (uint32_t k = 0; k < slices; k++) {
        mask_slice(o, k);
        if (k >= 2) add_slice(o, k - 2);
    }
    for (uint32_t k = slices > 2 ? slices - 2 : 0; k < slices; k++) add_slice(o, k);
    for (int n = 0; n < GROUPS * GROUPS; n++) o->group_count += o->groups[n / GROUPS][n % GROUPS].any;
}

static void write_corners(const outline *o, double reach_steps, double *to) {
    const double *m = o->volume->index_to_world;
    for (int n = 0; n < GROUPS * GROUPS; n++) {
        const row_group *group = &o->groups[n / GROUPS][n % GROUPS];
        for (int corner = 0; corner < CORNERS && group->any; corner++, to += 3) {
            double at[3];
            for (int axis = 0; axis < 3; axis++)
                at[axis] =
                    corner >> axis & 1 ? group->high[axis] + reach_steps : group->low[axis] - reach_steps;
            for (int c = 0; c < 3; c++)
                to[c] = m[4 * c] * at[0] + m[4 * c + 1] * at[1] + m[4 * c + 2] * at[2] + m[4 * c + 3];
        }
    }
}

ewa_status ewa_volume_outline(const ewa_volume *volume, const ewa_transfer *transfer, double reach_steps,
                              ewa_cloud **cloud) {
    if (!volume || !volume->voxels || !transfer || !cloud || !(reach_steps >= 0 && reach_steps <= 1000))
        return EWA_ERROR_ARGUMENT;
    *cloud = NULL;
    ewa_context *context = volume->context;
    EWA_TRY(ewa_transfer_check(context, "transfer function", transfer));
    const size_t slice = (size_t)volume->dims[0] * volume->dims[1];
    outline *o = ewa_allocate_zeroed(context, 1, sizeof *o);
    if (!o) return EWA_ERROR_MEMORY;
    o->volume = volume;
    o->masks = ewa_allocate(context, slice, SLICES);
    void *places = NULL;
    ewa_status status = o->masks ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) {
        make_visibility(volume, transfer, &o->seen);
        find_groups(o);
        o->with_specks = o->group_count == 0;
        if (o->with_specks) find_groups(o);
        status = ewa_cloud_create(context, CORNERS * o->group_count, cloud);
    }
    if (status == EWA_OK) status = ewa_cloud_add(*cloud, EWA_POSITION, EWA_F64, 3, &places);
    if (status == EWA_OK && o->group_count) write_corners(o, reach_steps, places);
    if (status != EWA_OK) ewa_cloud_destroy(cloud);
    ewa_release(context, o->masks, slice, SLICES);
    ewa_release(context, o, 1, sizeof *o);
    return status;
}
