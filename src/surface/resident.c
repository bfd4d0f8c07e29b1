// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The resident form's memory, and what is known of all of it together.
#include "base/base.h"
#include "surface/color_form.h"
#include "surface/extras.h"
#include "surface/packets.h"

#include <math.h>
#include <string.h>

enum { LANES = EWA_PACKET_LANES, MAX_PARTS = 64 };

static inline double maximum(double a, double b) { return a > b ? a : b; }

void ewa_packets_view_bounds(ewa_surfels *surfels) {
    const size_t stride = surfels->bounds_stride;
    double *centers = surfels->bounds_memory;
    uint32_t *cones = (uint32_t *)(void *)(centers + 3 * stride);
    uint16_t *halves = (uint16_t *)(void *)(cones + stride);
    surfels->bounds = (ewa_packet_bounds){.center_x = centers,
                                          .center_y = centers + stride,
                                          .center_z = centers + 2 * stride,
                                          .cone = cones,
                                          .radius = halves,
                                          .colors = halves + stride};
}

static void free_packets(ewa_surfels *surfels) {
    ewa_context *context = surfels->context;
    ewa_release(context, surfels->packets, surfels->packet_count, sizeof *surfels->packets);
    ewa_release(context, surfels->bounds_memory, surfels->bounds_stride, EWA_BOUNDS_BYTES);
    surfels->packets = NULL;
    surfels->bounds_memory = NULL;
}

ewa_status ewa_packets_allocate(ewa_surfels *surfels, uint32_t packet_count) {
    ewa_context *context = surfels->context;
    free_packets(surfels);
    surfels->serial = ewa_serial_next(context);
    surfels->packet_count = packet_count;
    surfels->bounds_stride = ((size_t)packet_count + LANES - 1) / LANES * LANES;
    surfels->packets = ewa_allocate(context, surfels->packet_count, sizeof *surfels->packets);
    surfels->bounds_memory = ewa_allocate_zeroed(context, surfels->bounds_stride, EWA_BOUNDS_BYTES);
    if (!surfels->packets || !surfels->bounds_memory) return EWA_ERROR_MEMORY;
    ewa_packets_view_bounds(surfels);
    return EWA_OK;
}

void ewa_packet_empty_lanes(ewa_packet *packet, uint32_t count) {
    for (uint32_t i = count; i < LANES; i++) {
        packet->x[i] = packet->y[i] = packet->z[i] = packet->sigma[i] = 0;
        packet->oct_x[i] = packet->oct_y[i] = 0;
        packet->angle[i] = packet->ratio[i] = packet->red[i] = packet->green[i] = packet->blue[i] = 0;
    }
}

void ewa_surfels_destroy(ewa_surfels **surfels) {
    if (!surfels) return;
    ewa_surfels *old = *surfels;
    while (old) {
        ewa_surfels *coarser = old->coarser;
        ewa_context *context = old->context;
        ewa_extras_free(context, old);
        if (old->points) ewa_release(context, old->points, (size_t)old->packet_count * LANES, sizeof *old->points);
        free_packets(old);
        ewa_release(context, old, 1, sizeof *old);
        old = coarser;
    }
    *surfels = NULL;
}

/// The largest major and minor sigmas, in units of the set: of each part, then of all.
typedef struct sigma_job {
    const ewa_surfels *surfels;
    double largest[MAX_PARTS][2];
} sigma_job;

static void find_largest_sigmas(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    sigma_job *job = data;
    const ewa_surfels *surfels = job->surfels;
    double major[LANES] = {0}, minor[LANES] = {0};
    const uint64_t end = ewa_split(surfels->packet_count, MAX_PARTS, part + 1);
    for (uint64_t i = ewa_split(surfels->packet_count, MAX_PARTS, part); i < end; i++) {
        const ewa_packet *packet = &surfels->packets[i];
        for (int lane = 0; lane < LANES; lane++)
            major[lane] = maximum(major[lane], (double)packet->sigma[lane]);
        for (int lane = 0; lane < LANES && surfels->ellipses; lane++) {
            const double root = packet->ratio[lane] / 65535.0;
            minor[lane] = maximum(minor[lane], (double)packet->sigma[lane] * root * root * root * root);
        }
    }
    double *largest = job->largest[part];
    largest[0] = largest[1] = 0;
    for (int lane = 0; lane < LANES; lane++) {
        largest[0] = maximum(largest[0], major[lane]);
        largest[1] = maximum(largest[1], surfels->ellipses ? minor[lane] : major[lane]);
    }
}

void ewa_packets_sum_up(ewa_surfels *surfels) {
    const ewa_packet_bounds *bounds = &surfels->bounds;
    double smallest = INFINITY, largest_limit = 0; // limits of packets' colours
    bool even = true;
    uint32_t reach_code = 0;
    for (uint32_t i = 0; i < surfels->packet_count; i++) {
        if (!bounds->radius[i]) continue;
        const double limit = ewa_color_form_limit(bounds->colors[i]);
        if (bounds->radius[i] > reach_code) reach_code = bounds->radius[i];
        smallest = fmin(smallest, limit), largest_limit = maximum(largest_limit, limit);
        even = even && ewa_color_form_is_even(bounds->colors[i]);
    }
    surfels->largest_color = largest_limit > 0 ? largest_limit : 1;
    surfels->fine_colors =
        largest_limit > EWA_PLAIN_COLORS && (!even || largest_limit > EWA_PLAIN_COLORS * smallest);
    const uint32_t bits = reach_code << EWA_RADIUS_SHIFT;
    float reach;
    memcpy(&reach, &bits, sizeof reach);
    surfels->reach_world = (double)reach * surfels->unit;
    sigma_job job = {.surfels = surfels};
    ewa_parallel(surfels->context, find_largest_sigmas, &job, MAX_PARTS);
    for (int i = 0; i < 2; i++) {
        double largest = 0;
        for (int part = 0; part < MAX_PARTS; part++) largest = maximum(largest, job.largest[part][i]);
        surfels->largest_sigmas_world[i] = largest * surfels->unit;
    }
}

void ewa_surfels_describe(const ewa_surfels *surfels, ewa_surfels_info *info) {
    ewa_bounds bounds = surfels->extent;
    for (int c = 0; c < 3 && surfels->count; c++) {
        bounds.low_world[c] += surfels->origin_world[c];
        bounds.high_world[c] += surfels->origin_world[c];
    }
    *info = (ewa_surfels_info){
        .point_count = surfels->count,
        .left_out_count = surfels->left_out_count,
        .unit_coverage = surfels->unit_coverage,
        .transparent = surfels->opacities != NULL,
        .bounds = bounds,
        .material_count = (uint32_t)surfels->max_material + 1,
    };
    for (const ewa_surfels *level = surfels; level; level = level->coarser) {
        info->level_count++;
        info->resident_bytes += sizeof *level + level->packet_count * sizeof *level->packets +
                                EWA_BOUNDS_BYTES * level->bounds_stride + ewa_extras_bytes(level) +
                                (level->points ? (size_t)level->packet_count * LANES * sizeof *level->points : 0);
    }
}
