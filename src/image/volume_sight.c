// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What of a volume stands in front of what, seen from the six sides of its box.
#include "base/base.h"
#include "image/volume.h"
#include "image/volume_surfaces.h"

/// Voxels of an obstacle that count as more than a blurred rim, and of a gap; voxels in a row that count as more than noise.
enum { THICK = 3, RUN = 2 };

/// Sums over lines of sight.
typedef struct sight_sums {
    double outer, inner; ///< what is looked for
    double hit, hidden, passed, separated;
} sight_sums;

static void look_along(void *user, const float *at, ptrdiff_t step, uint32_t count) {
    sight_sums *sums = user;
    uint32_t inner_run = 0, outer_run = 0, gap_run = 0, passed = 0;
    bool solid = false, gap = false;
    for (uint32_t i = 0; i < count; i++, at += step) {
        const double value = (double)*at;
        inner_run = value >= sums->inner ? inner_run + 1 : 0;
        if (inner_run == RUN) {
            const uint32_t before = passed - (RUN - 1); // the run's own first voxel was passed, too
            sums->hit++;
            sums->hidden += before >= THICK;
            sums->passed += before >= THICK ? before : 0;
            sums->separated += gap;
            return;
        }
        const bool is_outer = value >= sums->outer; // not for a NaN
        outer_run = is_outer ? outer_run + 1 : 0;
        passed += is_outer;
        solid |= outer_run >= RUN;
        gap_run = solid && !is_outer ? gap_run + 1 : 0;
        gap |= gap_run >= THICK;
    }
}

ewa_status ewa_volume_sight_measure(const ewa_volume *volume, double outer, double inner,
                                    ewa_volume_sight *sight) {
    *sight = (ewa_volume_sight){.hit = 0};
    sight_sums sums = {.outer = outer, .inner = inner};
    EWA_TRY(ewa_volume_look_through(volume, look_along, &sums));
    sight->hit = sums.hit;
    sight->hidden = sums.hit > 0 ? sums.hidden / sums.hit : 0;
    sight->passed = sums.hidden > 0 ? sums.passed / sums.hidden : 0;
    sight->separated = sums.hit > 0 ? sums.separated / sums.hit : 0;
    return EWA_OK;
}
