// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Points that are no surface, by how fast the number of neighbours grows with their distance: as its first power on a
// curve, its second on a surface, its third in space.
//
// Based on: P. Grassberger, I. Procaccia, "Measuring the Strangeness of Strange Attractors", 1983 (the dimension of a
// set by distances of its points).
#include "base/base.h"
#include "cloud/cloud.h"
#include "estimate/sparse.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    HANDFUL = 128,      // points that show no surface, wherever they lie
    MAX_SPARSE = 4096,  // more are not looked at
    NEAR = 4, FAR = 16, // neighbours whose distances are compared; an eighth of a handful
};

/// Dimensions of curves and of what is strewn; surfaces of few points have 1.7 to 2.2.
static const double CURVE_DIMENSION = 1.4, SPACE_DIMENSION = 2.5;

static int compare_doubles(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/// The dimension around a point: log(16 / 4) / log(r16 / r4) of its neighbours; `nearest2` has room for FAR + 1. 0: other
/// points lie at the same place.
static double dimension_at(const double (*places)[3], size_t count, size_t own, double *nearest2) {
    for (int k = 0; k <= FAR; k++) nearest2[k] = INFINITY;
    for (size_t i = 0; i < count; i++) {
        double distance2 = 0;
        for (int c = 0; c < 3; c++) distance2 += (places[i][c] - places[own][c]) * (places[i][c] - places[own][c]);
        if (!(distance2 < nearest2[FAR])) continue;
        int at = FAR;
        for (; at > 0 && nearest2[at - 1] > distance2; at--) nearest2[at] = nearest2[at - 1];
        nearest2[at] = distance2;
    }
    const double ratio2 = nearest2[FAR] / nearest2[NEAR];
    return ratio2 > 1 && ratio2 < INFINITY ? 2 * log((double)FAR / NEAR) / log(ratio2) : 0;
}

/// Finds the median dimension of some places.
static double median_dimension(const double (*places)[3], size_t count, double *dimensions) {
    double nearest2[FAR + 1];
    size_t told = 0;
    for (size_t i = 0; i < count; i++) {
        const double dimension = dimension_at(places, count, i, nearest2);
        if (dimension > 0) dimensions[told++] = dimension;
    }
    qsort(dimensions, told, sizeof *dimensions, compare_doubles);
    return told ? dimensions[told / 2] : 0;
}

ewa_status ewa_cloud_is_sparse(const ewa_cloud *cloud, bool *sparse) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    *sparse = count <= HANDFUL;
    if (*sparse || count > MAX_SPARSE || !position) return EWA_OK;
    ewa_context *context = ewa_cloud_context(cloud);
    double(*places)[3] = ewa_allocate(context, count, sizeof *places);
    double *dimensions = ewa_allocate(context, count, sizeof *dimensions);
    if (places && dimensions) {
        ewa_attribute_read_f64(position, 0, count, &places[0][0]);
        size_t kept = 0;
        for (uint64_t i = 0; i < count; i++)
            if (isfinite(places[i][0] + places[i][1] + places[i][2])) memmove(places[kept++], places[i], sizeof *places);
        const double dimension = median_dimension((const double(*)[3])places, kept, dimensions);
        *sparse = kept <= HANDFUL || (dimension > 0 && dimension < CURVE_DIMENSION) || dimension > SPACE_DIMENSION;
    }
    const ewa_status status = places && dimensions ? EWA_OK : EWA_ERROR_MEMORY;
    ewa_release(context, places, count, sizeof *places);
    ewa_release(context, dimensions, count, sizeof *dimensions);
    return status;
}
