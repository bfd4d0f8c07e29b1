// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a fully covered pixel expects of the sum of kernels: q0 of docs/math.md section 7.
//
// A kernel of unit peak integrates to sigma_u sigma_v (1 - exp(-F^2 / 2)) over its support in the scale of
// rho = exp(-r^2 / 2) / (2 pi); times surfels per area this is the mean of the sum over the surface. The
// median over surfels keeps sparse borders and doubled surfaces from deciding for everything else.
#include "base/base.h"
#include "surface/packets.h"

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

static uint64_t lane_count(const ewa_surfels *surfels) {
    return (uint64_t)surfels->packet_count * EWA_PACKET_LANES;
}

/// Takes the surfels of a packet that are in lanes [first, end) of all packets but for the one at `index`;
/// `place` is from the packet's centre.
static void take_packet(const ewa_surfels *surfels, uint32_t p, uint64_t first, uint64_t end, uint64_t index,
                        ewa_vec3 place, double smallest[NEIGHBOURS]) {
    const ewa_packet *packet = &surfels->packets[p];
    double distance2[EWA_PACKET_LANES];
    uint32_t nearer = 0;
    for (uint32_t l = 0; l < EWA_PACKET_LANES; l++) {
        const double dx = (double)packet->x[l] - place.x, dy = (double)packet->y[l] - place.y,
                     dz = (double)packet->z[l] - place.z;
        distance2[l] = dx * dx + dy * dy + dz * dz;
    }
    const double largest = smallest[0];
    for (uint32_t l = 0; l < EWA_PACKET_LANES; l++) nearer |= distance2[l] < largest;
    if (!nearer) return;
    for (uint32_t l = 0; l < EWA_PACKET_LANES; l++) {
        const uint64_t i = (uint64_t)p * EWA_PACKET_LANES + l;
        if (i >= first && i < end && i != index && packet->sigma[l] > 0)
            keep_smallest(smallest, distance2[l]);
    }
}

static double coverage_at(const ewa_surfels *surfels, uint64_t index) {
    const uint32_t home = (uint32_t)(index / EWA_PACKET_LANES);
    const ewa_packet *packet = &surfels->packets[home];
    if (!(packet->sigma[index % EWA_PACKET_LANES] > 0)) index = (uint64_t)home * EWA_PACKET_LANES;
    ewa_packet_surfel surfel;
    ewa_packet_decode(surfels, home, index % EWA_PACKET_LANES, &surfel);
    const ewa_vec3 center = ewa_packet_center(surfels, home);
    double distance2[NEIGHBOURS];
    for (int i = 0; i < NEIGHBOURS; i++) distance2[i] = INFINITY;
    const uint64_t first = index > WINDOW ? index - WINDOW : 0;
    const uint64_t end = lane_count(surfels) - index > WINDOW ? index + WINDOW : lane_count(surfels);
    // From the nearest packets outward, so that most of the others are rejected as a whole.
    for (uint32_t p = home + 1; p-- > first / EWA_PACKET_LANES;) {
        const ewa_vec3 way = vec3_sub(center, ewa_packet_center(surfels, p));
        take_packet(surfels, p, first, end, index, vec3_add(surfel.offset, way), distance2);
    }
    for (uint32_t p = home + 1; p <= (end - 1) / EWA_PACKET_LANES; p++) {
        const ewa_vec3 way = vec3_sub(center, ewa_packet_center(surfels, p));
        take_packet(surfels, p, first, end, index, vec3_add(surfel.offset, way), distance2);
    }
    const double area = vec3_length(surfel.axis_u) * vec3_length(surfel.axis_v);
    const double pi = 3.14159265358979323846;
    // The farthest neighbour lies on the rim of the circle: it counts half, the surfel itself counts whole.
    const double density =
        distance2[0] > 0 && isfinite(distance2[0]) ? (NEIGHBOURS + 0.5) / (pi * distance2[0]) : 0;
    const double alone = 1 / (pi * surfels->cutoff * surfels->cutoff);
    return fmax(area * density, alone);
}

static void sample_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    sampling *s = data;
    for (uint32_t i = task; i < s->sample_count; i += TASKS)
        s->values[i] = coverage_at(s->surfels, i * lane_count(s->surfels) / s->sample_count);
}

double ewa_packets_unit_coverage(const ewa_surfels *surfels) {
    const double kept = 1 - exp(-0.5 * surfels->cutoff * surfels->cutoff);
    if (surfels->count == 0) return kept;
    sampling s = {.surfels = surfels, .sample_count = surfels->count < SAMPLES ? surfels->count : SAMPLES};
    ewa_parallel(surfels->context, sample_task, &s, TASKS);
    qsort(s.values, s.sample_count, sizeof *s.values, compare_doubles);
    return kept * s.values[s.sample_count / 2];
}
