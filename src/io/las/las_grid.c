// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scale and offset of the coordinates that are written: those the cloud has, so that its numbers stay what
// they are, else decimal ones that are fine enough and fit 32 bits.
#include "base/base.h"
#include "io/crs.h"
#include "io/las/las_write.h"

#include <math.h>
#include <string.h>

/// Whether all places between `low` and `high` have whole numbers of 32 bits.
static bool fits(double low, double high, double scale, double offset) {
    return nearbyint((low - offset) / scale) >= INT32_MIN && nearbyint((high - offset) / scale) <= INT32_MAX;
}

/// Offset of new coordinates: a whole number at the centre, of a finer decimal place where the scale is so
/// fine that whole numbers are too far away.
static double new_offset(double low, double high, double scale) {
    double unit = 1;
    while (unit / scale > 1e9) unit /= 10;
    return floor((low / 2 + high / 2) / unit) * unit;
}

/// The finest of some decimal steps with which the box fits; 0 when none does. `finest` and `coarsest` are
/// powers of ten.
static double new_scale(double low, double high, int finest, int coarsest) {
    for (int power = finest; power <= coarsest; power++) {
        // Quotients are nearer to the decimal number than products.
        const double scale = power < 0 ? 1 / pow(10, -power) : pow(10, power);
        if (fits(low, high, scale, new_offset(low, high, scale))) return scale;
    }
    return 0;
}

static ewa_status fail_range(const ewa_cloud_target *target, int axis, double scale) {
    return ewa_fail(
        target->context, EWA_ERROR_LIMIT,
        "%s: %c from %.17g to %.17g in steps of %g does not fit the 32 bits of LAS; set a coarser "
        "step",
        target->name, "xyz"[axis], target -> bounds -> low_world[axis], target -> bounds -> high_world[axis],
        scale);
}

ewa_status ewa_las_grid_choose(const ewa_cloud_target *target, ewa_las_plan *plan) {
    enum { FINEST = -4, COARSEST = -2, FINEST_DEGREES = -8, COARSEST_DEGREES = -6, MINIMUM = -12 };
    const double option = target->options->step_world;
    const ewa_bounds *bounds = target->bounds;
    const bool has_box = bounds && bounds->finite_count > 0;
    ewa_coordinate_grid grid;
    ewa_cloud_grid(target->prototype, &grid);
    double extent_world = 0;
    for (int c = 0; c < 3 && has_box; c++)
        extent_world = fmax(extent_world, bounds->high_world[c] - bounds->low_world[c]);
    // A millionth of a small object is finer than the finest step of a large one.
    const double fine = extent_world > 0 ? floor(log10(extent_world) + 1e-9) - 6 : FINEST;
    const int finest = fine < MINIMUM ? MINIMUM : fine < FINEST ? (int)fine : FINEST;
    const bool in_degrees = ewa_cloud_crs_unit(target->prototype) == EWA_CRS_DEGREES;
    for (int c = 0; c < 3; c++) {
        const bool degrees = in_degrees && c < 2;
        double *scale = &plan->table.scale[c], *offset = &plan->offset_world[c];
        *scale = option > 0 ? option : grid.step_world[c];
        *offset = grid.step_world[c] > 0 ? grid.offset_world[c] : 0;
        if (!has_box) {
            if (*scale <= 0) *scale = degrees ? 1e-7 : 1e-3;
            continue;
        }
        const double low = bounds->low_world[c], high = bounds->high_world[c];
        if (*scale > 0) {
            const bool keeps = grid.step_world[c] > 0 && *scale == grid.step_world[c];
            if (keeps && fits(low, high, *scale, *offset)) continue;
            // The same grid, counted from elsewhere.
            const double centre = new_offset(low, high, *scale);
            *offset = keeps ? *offset + nearbyint((centre - *offset) / *scale) * *scale : centre;
            if (fits(low, high, *scale, *offset)) continue;
            if (option > 0) return fail_range(target, c, *scale);
            ewa_report(target->context, EWA_SEVERITY_WARNING,
                       "%s: %c in the steps of %g that the points came in does not fit the 32 bits of LAS; a "
                       "coarser step is taken",
                       target->name, "xyz"[c], *scale);
        }
        const double coarsest = degrees ? 1e-6 : 1e-2;
        *scale = degrees ? new_scale(low, high, FINEST_DEGREES, COARSEST_DEGREES)
                         : new_scale(low, high, finest, COARSEST);
        if (*scale <= 0) return fail_range(target, c, coarsest);
        *offset = new_offset(low, high, *scale);
    }
    return EWA_OK;
}
