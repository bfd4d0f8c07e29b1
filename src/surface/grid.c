// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Surfels in memory that survives, filled packet by packet.
#include "surface/grid.h"

#include <math.h>
#include <string.h>

enum { LANES = EWA_PACKET_LANES };

ewa_status ewa_grid_reserve(ewa_context *context, ewa_grid *grid, uint64_t group_count, double cutoff) {
    const uint64_t packet_count = group_count * EWA_GRID_GROUP;
    if (packet_count > UINT32_MAX / LANES)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%llu samples are more than a renderer holds",
                        (unsigned long long)(packet_count * LANES));
    ewa_surfels *s = &grid->surfels;
    EWA_TRY(ewa_buffer_reserve(context, &grid->packet_buffer, (size_t)packet_count, sizeof *s->packets));
    EWA_TRY(ewa_buffer_reserve(context, &grid->bounds_buffer, (size_t)packet_count, EWA_BOUNDS_BYTES));
    grid->kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_pack_kernels);
    *s = (ewa_surfels){
        .context = context,
        .packet_count = (uint32_t)packet_count,
        .packets = grid->packet_buffer.data,
        .bounds_memory = grid->bounds_buffer.data,
        .bounds_stride = (size_t)packet_count,
        .unit = 1,
        .cutoff = cutoff,
        .ellipses = true,
        .unit_coverage = 1,
    };
    ewa_packets_view_bounds(s);
    return EWA_OK;
}

void ewa_grid_free(ewa_context *context, ewa_grid *grid) {
    ewa_buffer_free(context, &grid->packet_buffer);
    ewa_buffer_free(context, &grid->bounds_buffer);
}

/// Gives the lanes outside of `mask` the numbers of one inside, but a sigma of 0.
static void empty_lanes(ewa_packet *packet, uint32_t mask) {
    const uint32_t from = (uint32_t)__builtin_ctz(mask);
    for (uint32_t left = ~mask & 0xffff; left; left &= left - 1) {
        const uint32_t to = (uint32_t)__builtin_ctz(left);
        packet->x[to] = packet->x[from], packet->y[to] = packet->y[from], packet->z[to] = packet->z[from];
        packet->sigma[to] = 0;
        packet->oct_x[to] = packet->oct_x[from], packet->oct_y[to] = packet->oct_y[from];
        packet->angle[to] = packet->angle[from], packet->ratio[to] = packet->ratio[from];
        packet->red[to] = packet->green[to] = packet->blue[to] = 0;
    }
}

void ewa_grid_end_group(ewa_grid *grid, uint64_t group, const uint16_t masks[EWA_GRID_GROUP],
                        const double start[3]) {
    const ewa_surfels *s = &grid->surfels;
    const uint64_t first = group * EWA_GRID_GROUP;
    ewa_packet *packets = &s->packets[first];
    const ewa_packet *whole = NULL;
    for (uint32_t k = 0; k < EWA_GRID_GROUP; k++) {
        if (!masks[k]) continue;
        if (masks[k] != 0xffff) empty_lanes(&packets[k], masks[k]);
        whole = &packets[k];
    }
    for (uint32_t k = 0; k < EWA_GRID_GROUP; k++) {
        if (masks[k]) continue;
        if (whole) packets[k] = *whole;
        for (uint32_t i = 0; i < LANES; i++) packets[k].sigma[i] = 0;
    }
    if (whole) {
        double starts[EWA_GRID_GROUP][3];
        for (uint32_t k = 0; k < EWA_GRID_GROUP; k++) memcpy(starts[k], start, sizeof starts[k]);
        grid->kernels->bound_packets(packets, EWA_GRID_GROUP, (const double(*)[3])starts, (float)s->cutoff,
                                     INFINITY, &s->bounds, first);
    }
    for (uint32_t k = 0; k < EWA_GRID_GROUP; k++) {
        if (masks[k]) continue;
        s->bounds.center_x[first + k] = s->bounds.center_y[first + k] = s->bounds.center_z[first + k] = 0;
        s->bounds.radius[first + k] = 0;
        s->bounds.cone[first + k] = 0;
    }
}
