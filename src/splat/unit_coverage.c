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
    TASKS = 16,      // of a parallel run
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

/// What the samples share.
typedef struct sampling {
    const ewa_surfels *surfels;
    uint32_t sample_count;
    double values[SAMPLES];
} sampling;

/// Takes the surfels of a packet that are among [first, end) but for the one at `index`.
static void take_packet(const ewa_surfels *surfels, uint32_t p, uint32_t first, uint32_t end, uint32_t index,
                        const double place[3], double smallest[NEIGHBOURS]) {
    const ewa_packet *packet = &surfels->packets[p];
    double distance2[EWA_PACKET_LANES];
    uint32_t nearer = 0;
    for (uint32_t l = 0; l < EWA_PACKET_LANES; l++) {
        const double dx = (double)packet->x[l] - place[0], dy = (double)packet->y[l] - place[1],
                     dz = (double)packet->z[l] - place[2];
        distance2[l] = dx * dx + dy * dy + dz * dz;
    }
    const double largest = smallest[0];
    for (uint32_t l = 0; l < EWA_PACKET_LANES; l++) nearer |= distance2[l] < largest;
    if (!nearer) return;
    for (uint32_t l = 0; l < EWA_PACKET_LANES; l++) {
        const uint32_t i = p * EWA_PACKET_LANES + l;
        if (i >= first && i < end && i != index) keep_smallest(smallest, distance2[l]);
    }
}

static double coverage_at(const ewa_surfels *surfels, uint32_t index) {
    const uint32_t home = index / EWA_PACKET_LANES, lane = index % EWA_PACKET_LANES;
    const ewa_packet *packet = &surfels->packets[home];
    const double place[3] = {(double)packet->x[lane], (double)packet->y[lane], (double)packet->z[lane]};
    double distance2[NEIGHBOURS];
    for (int i = 0; i < NEIGHBOURS; i++) distance2[i] = INFINITY;
    const uint32_t first = index > WINDOW ? index - WINDOW : 0;
    const uint32_t end = surfels->count - index > WINDOW ? index + WINDOW : surfels->count;
    // From the nearest packets outward, so that most of the others are rejected as a whole.
    for (uint32_t p = home + 1; p-- > first / EWA_PACKET_LANES;)
        take_packet(surfels, p, first, end, index, place, distance2);
    for (uint32_t p = home + 1; p <= (end - 1) / EWA_PACKET_LANES; p++)
        take_packet(surfels, p, first, end, index, place, distance2);
    const double sigma_u = (double)packet->sigma[lane], sigma_v = sigma_u * packet->ratio[lane] / 65535.0;
    const double pi = 3.14159265358979323846;
    // The farthest neighbour lies on the rim of the circle: it counts half, the surfel itself counts whole.
    const double density =
        distance2[0] > 0 && isfinite(distance2[0]) ? (NEIGHBOURS + 0.5) / (pi * distance2[0]) : 0;
    const double alone = 1 / (pi * surfels->cutoff * surfels->cutoff);
    return fmax(sigma_u * sigma_v * density, alone);
}

static void sample_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    sampling *s = data;
    for (uint32_t i = task; i < s->sample_count; i += TASKS)
        s->values[i] = coverage_at(s->surfels, (uint32_t)((uint64_t)i * s->surfels->count / s->sample_count));
}

double ewa_packets_unit_coverage(const ewa_surfels *surfels) {
    const double kept = 1 - exp(-0.5 * surfels->cutoff * surfels->cutoff);
    if (surfels->count == 0) return kept;
    sampling s = {.surfels = surfels, .sample_count = surfels->count < SAMPLES ? surfels->count : SAMPLES};
    ewa_parallel(surfels->context, sample_task, &s, TASKS);
    qsort(s.values, s.sample_count, sizeof *s.values, compare_doubles);
    return kept * s.values[s.sample_count / 2];
}
