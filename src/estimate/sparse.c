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
    MAX_SPARSE = 4096,  // of more points only curves are looked for
    MAX_CURVE = 1 << 22,
    SAMPLES = 64, // points of a curve whose neighbours are looked at
    BLOCK_POINTS = 256,
    NEAR = 4, FAR = 16, // neighbours whose distances are compared; an eighth of a handful
};

/// Dimensions of curves and of what is strewn; surfaces of few points have 1.7 to 2.2.
static const double CURVE_DIMENSION = 1.4, SPACE_DIMENSION = 2.5;

/// Of the points of a curve, on lines that no plane goes along.
static const double STREWN_SHARE = 0.99;

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

/// Finds the median dimension around the first `looked_count` of some places.
static double median_dimension(const double (*places)[3], size_t count, size_t looked_count, double *dimensions) {
    double nearest2[FAR + 1];
    size_t told = 0;
    for (size_t i = 0; i < looked_count; i++) {
        const double dimension = dimension_at(places, count, i, nearest2);
        if (dimension > 0) dimensions[told++] = dimension;
    }
    qsort(dimensions, told, sizeof *dimensions, compare_doubles);
    return told ? dimensions[told / 2] : 0;
}

/// Whether nearly all points were found to be no part of a surface.
static bool is_all_strewn(const ewa_cloud *cloud, uint64_t count) {
    const ewa_attribute *surfaceness = ewa_cloud_find(cloud, EWA_SURFACENESS);
    double block[BLOCK_POINTS];
    uint64_t strewn = 0;
    for (uint64_t first = 0; surfaceness && first < count; first += BLOCK_POINTS) {
        const uint64_t these = count - first < BLOCK_POINTS ? count - first : BLOCK_POINTS;
        ewa_attribute_read_f64(surfaceness, first, these, block);
        for (uint64_t i = 0; i < these; i++) strewn += block[i] == 0;
    }
    return (double)strewn >= STREWN_SHARE * (double)count;
}

static uint64_t hash_place(const double p[3]) {
    uint64_t hash = 0;
    for (int c = 0; c < 3; c++) {
        uint64_t bits;
        memcpy(&bits, &p[c], sizeof bits);
        hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return hash;
}

/// Brings SAMPLES places to the front, those of the smallest hashes, whatever the order of the points.
static void bring_samples(double (*places)[3], size_t count) {
    uint64_t hashes[SAMPLES];
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        double own[3];
        memcpy(own, places[i], sizeof own);
        const uint64_t hash = hash_place(own);
        if (kept == SAMPLES && hash >= hashes[SAMPLES - 1]) continue;
        if (kept < SAMPLES) kept++;
        memcpy(places[i], places[kept - 1], sizeof own);
        size_t at = kept - 1;
        for (; at > 0 && hashes[at - 1] > hash; at--) {
            hashes[at] = hashes[at - 1];
            memcpy(places[at], places[at - 1], sizeof own);
        }
        hashes[at] = hash;
        memcpy(places[at], own, sizeof own);
    }
}

ewa_status ewa_cloud_is_sparse(const ewa_cloud *cloud, bool *sparse) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    *sparse = count <= HANDFUL;
    const bool many = count > MAX_SPARSE;
    if (*sparse || !position || (many && (count > MAX_CURVE || !is_all_strewn(cloud, count)))) return EWA_OK;
    ewa_context *context = ewa_cloud_context(cloud);
    double(*places)[3] = ewa_allocate(context, count, sizeof *places);
    double *dimensions = ewa_allocate(context, count, sizeof *dimensions);
    if (places && dimensions) {
        ewa_attribute_read_f64(position, 0, count, &places[0][0]);
        size_t kept = 0;
        for (uint64_t i = 0; i < count; i++)
            if (isfinite(places[i][0] + places[i][1] + places[i][2])) memmove(places[kept++], places[i], sizeof *places);
        if (many) bring_samples(places, kept);
        const size_t looked = many && kept > SAMPLES ? SAMPLES : kept;
        const double dimension = median_dimension((const double(*)[3])places, kept, looked, dimensions);
        *sparse = kept <= HANDFUL || (dimension > 0 && dimension < CURVE_DIMENSION) ||
                  (!many && dimension > SPACE_DIMENSION);
    }
    const ewa_status status = places && dimensions ? EWA_OK : EWA_ERROR_MEMORY;
    ewa_release(context, places, count, sizeof *places);
    ewa_release(context, dimensions, count, sizeof *dimensions);
    return status;
}
