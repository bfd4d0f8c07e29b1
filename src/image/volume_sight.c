// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What of a volume stands in front of what, seen from the six sides of its box.
#include "base/base.h"
#include "image/volume.h"
#include "image/volume_surfaces.h"

/// Columns along an axis and across it; voxels of an obstacle that count as more than a blurred rim, and of a
/// gap; voxels in a row that count as more than noise.
enum { COLUMNS = 48, THICK = 3, RUN = 2 };

/// Sums over lines of sight.
typedef struct sight_sums {
    double hit, hidden, passed, apart;
} sight_sums;

/// One line of sight, from `at` on in steps of `step`.
static void look_along(const float *at, ptrdiff_t step, uint32_t count, double outer, double inner,
                       sight_sums *sums) {
    uint32_t inner_run = 0, outer_run = 0, gap_run = 0, passed = 0;
    bool solid = false, gap = false;
    for (uint32_t i = 0; i < count; i++, at += step) {
        const double value = (double)*at;
        inner_run = value >= inner ? inner_run + 1 : 0;
        if (inner_run == RUN) {
            const uint32_t before = passed - (RUN - 1); // the run's own first voxel was passed, too
            sums->hit++;
            sums->hidden += before >= THICK;
            sums->passed += before >= THICK ? before : 0;
            sums->apart += gap;
            return;
        }
        const bool is_outer = value >= outer; // not for a NaN
        outer_run = is_outer ? outer_run + 1 : 0;
        passed += is_outer;
        solid |= outer_run >= RUN;
        gap_run = solid && !is_outer ? gap_run + 1 : 0;
        gap |= gap_run >= THICK;
    }
}

ewa_status ewa_volume_sight_measure(const ewa_volume *volume, double outer, double inner,
                                    ewa_volume_sight *sight) {
    const uint32_t *dims = volume->dims;
    const uint64_t strides[3] = {1, dims[0], (uint64_t)dims[0] * dims[1]};
    uint32_t longest = dims[0];
    for (int axis = 1; axis < 3; axis++) longest = dims[axis] > longest ? dims[axis] : longest;
    *sight = (ewa_volume_sight){.hit = 0};
    float *numbers = ewa_allocate(volume->context, longest, sizeof *numbers);
    if (!numbers) return EWA_ERROR_MEMORY;
    sight_sums sums = {.hit = 0};
    for (int axis = 0; axis < 3; axis++) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const uint32_t u_step = 1 + dims[u] / COLUMNS, v_step = 1 + dims[v] / COLUMNS;
        for (uint32_t b = v_step / 2; b < dims[v]; b += v_step)
            for (uint32_t a = u_step / 2; a < dims[u]; a += u_step) {
                ewa_volume_read_column(volume, a * strides[u] + b * strides[v], strides[axis], dims[axis],
                                       numbers);
                look_along(numbers, 1, dims[axis], outer, inner, &sums);
                look_along(numbers + dims[axis] - 1, -1, dims[axis], outer, inner, &sums);
            }
    }
    ewa_release(volume->context, numbers, longest, sizeof *numbers);
    sight->hit = sums.hit;
    sight->hidden = sums.hit > 0 ? sums.hidden / sums.hit : 0;
    sight->passed = sums.hidden > 0 ? sums.passed / sums.hidden : 0;
    sight->apart = sums.hit > 0 ? sums.apart / sums.hit : 0;
    return EWA_OK;
}
