// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a fully covered pixel expects of the sum of kernels: q0 of math.md section 7.
//
// A kernel of unit peak integrates to sigma_u sigma_v (1 - exp(-F^2 / 2)) over its support in the scale of
// rho = exp(-r^2 / 2) / (2 pi); times surfels per area this is the mean of the sum over the surface. The
// median over surfels keeps sparse borders and doubled surfaces from deciding for everything else.
#include "base/base.h"
#include "splat/packets.h"

#include <math.h>
#include <stdlib.h>

enum {
    SAMPLES = 1021,  // odd, so that the median is one of them
    NEIGHBOURS = 16, // whose farthest one gives the density
    WINDOW = 512,    // neighbours are looked for among so many surfels on each side in Morton order
};

static int compare_doubles(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// Keeps the NEIGHBOURS smallest values of a stream, the largest of them first.
static void keep_smallest(double smallest[NEIGHBOURS], double value) {
    if (value >= smallest[0]) return;
    int i = 0;
    for (; i + 1 < NEIGHBOURS && smallest[i + 1] > value; i++) smallest[i] = smallest[i + 1];
    smallest[i] = value;
}

static double coverage_at(const ewa_surfels *surfels, uint32_t index) {
    const ewa_packet *packet = &surfels->packets[index / EWA_PACKET_LANES];
    const uint32_t lane = index % EWA_PACKET_LANES;
    const double x = packet->x[lane], y = packet->y[lane], z = packet->z[lane];
    double distance2[NEIGHBOURS];
    for (int i = 0; i < NEIGHBOURS; i++) distance2[i] = INFINITY;
    const uint32_t first = index > WINDOW ? index - WINDOW : 0;
    const uint32_t end = surfels->count - index > WINDOW ? index + WINDOW : surfels->count;
    for (uint32_t i = first; i < end; i++) {
        if (i == index) continue;
        const ewa_packet *other = &surfels->packets[i / EWA_PACKET_LANES];
        const uint32_t l = i % EWA_PACKET_LANES;
        const double dx = other->x[l] - x, dy = other->y[l] - y, dz = other->z[l] - z;
        keep_smallest(distance2, dx * dx + dy * dy + dz * dz);
    }
    const double sigma_u = packet->sigma[lane], sigma_v = sigma_u * packet->ratio[lane] / 65535.0;
    const double pi = 3.14159265358979323846;
    // The farthest neighbour lies on the rim of the circle: it counts half, the surfel itself counts whole.
    const double density =
        distance2[0] > 0 && isfinite(distance2[0]) ? (NEIGHBOURS + 0.5) / (pi * distance2[0]) : 0;
    const double alone = 1 / (pi * surfels->cutoff * surfels->cutoff);
    return fmax(sigma_u * sigma_v * density, alone);
}

double ewa_packets_unit_coverage(const ewa_surfels *surfels) {
    const double kept = 1 - exp(-0.5 * surfels->cutoff * surfels->cutoff);
    if (surfels->count == 0) return kept;
    double values[SAMPLES];
    const uint32_t samples = surfels->count < SAMPLES ? surfels->count : SAMPLES;
    for (uint32_t i = 0; i < samples; i++)
        values[i] = coverage_at(surfels, (uint32_t)((uint64_t)i * surfels->count / samples));
    qsort(values, samples, sizeof *values, compare_doubles);
    return kept * values[samples / 2];
}
