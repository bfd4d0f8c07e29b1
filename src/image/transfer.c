// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Transfer functions: checks, opacity, the unit of length of those that are made for a volume.
#include "image/transfer.h"
#include "base/base.h"
#include "ewa/image.h"

#include <math.h>

enum { UNITS = 128 };

double ewa_extinction_of_opacity(double opacity) {
    double left = 1 - opacity;
    if (!(left > 0x1p-20)) left = 0x1p-20;
    int exponent;
    double m = frexp(left, &exponent);
    if (m < 0.7071067811865476) {
        m *= 2;
        exponent--;
    }
    // log m = 2 artanh((m - 1) / (m + 1)), by its series: |s| < 0.172.
    const double s = (m - 1) / (m + 1), ss = s * s;
    double sum = 0;
    for (int k = 21; k >= 1; k -= 2) sum = sum * ss + 1.0 / k;
    return 0 - (2 * s * sum + 0.6931471805599453 * exponent);
}

void ewa_transfer_add(ewa_transfer *transfer, double value, uint32_t srgb, double extinction) {
    ewa_transfer_point *point = &transfer->points[transfer->point_count++];
    point->value = value;
    point->extinction = (float)extinction;
    for (int c = 0; c < 3; c++)
        point->color[c] = ewa_linear_from_srgb((float)(srgb >> (16 - 8 * c) & 255) / 255.0f);
}

double ewa_transfer_unit(const ewa_volume_facts *facts) {
    double longest = 0;
    for (int k = 0; k < 3; k++) longest = fmax(longest, facts->high_world[k] - facts->low_world[k]);
    return longest > 0 ? longest / UNITS : 1;
}

ewa_status ewa_transfer_check_facts(const ewa_volume *volume, const ewa_volume_facts *facts) {
    if (facts->finite_count && facts->low < facts->high) return EWA_OK;
    return facts->finite_count
               ? ewa_fail(volume->context, EWA_ERROR_NUMERIC,
                          "all voxels are %g: there is nothing to tell apart; say what they look like",
                          facts->low)
               : ewa_fail(volume->context, EWA_ERROR_NUMERIC, "no voxel is a finite number");
}

ewa_status ewa_transfer_check(ewa_context *context, const char *name, const ewa_transfer *transfer) {
    if (!context || !name || !transfer) return EWA_ERROR_ARGUMENT;
    if (transfer->point_count < 2 || transfer->point_count > EWA_MAX_TRANSFER_POINTS)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: %u points, allowed are 2 to %d", name,
                        transfer->point_count, EWA_MAX_TRANSFER_POINTS);
    for (uint32_t i = 0; i < transfer->point_count; i++) {
        const ewa_transfer_point *p = &transfer->points[i];
        bool good = isfinite(p->value) && p->extinction >= 0 && isfinite(p->extinction);
        for (int c = 0; c < 3; c++) good &= p->color[c] >= 0 && isfinite(p->color[c]);
        if (!good)
            return ewa_fail(context, EWA_ERROR_ARGUMENT,
                            "%s: point %u: value, colour or extinction negative or not finite", name, i);
        if (i && p->value < p[-1].value)
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: point %u: its value %g is below the one before",
                            name, i, p->value);
    }
    const double low = transfer->gradient_low, high = transfer->gradient_high;
    if (!(transfer->unit_length_world >= 0) || !isfinite(transfer->unit_length_world))
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: a unit length of %g", name,
                        transfer->unit_length_world);
    if (!(low >= 0) || !(high >= low) || !isfinite(high))
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: a gradient ramp from %g to %g", name, low, high);
    return EWA_OK;
}
