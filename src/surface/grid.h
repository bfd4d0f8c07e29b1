// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Surfels in memory that survives, filled packet by packet by who knows where neighbours are: samples on a
// grid need neither a cloud nor the Morton order.
#ifndef EWA_SRC_SURFACE_GRID_H
#define EWA_SRC_SURFACE_GRID_H

#include "base/base.h"
#include "surface/pack.h"
#include "surface/packets.h"

enum { EWA_GRID_GROUP = 16 }; ///< packets that are bounded together

/// Zero-initialise; free with ewa_grid_free().
typedef struct ewa_grid {
    ewa_surfels surfels; ///< what is drawn; the buffers own its memory
    ewa_buffer packet_buffer, bounds_buffer;
    const ewa_pack_kernels *kernels;
} ewa_grid;

/// Makes room for `group_count` groups of packets, for opaque ellipses that end at `cutoff` standard
/// deviations. The caller sets the packets and the forms of their colours, the number of surfels and the
/// origin. Errors: EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_grid_reserve(ewa_context *context, ewa_grid *grid, uint64_t group_count, double cutoff);

void ewa_grid_free(ewa_context *context, ewa_grid *grid);

/// Ends a group of which all packets are set, their positions relative to `start`: lanes that are not in
/// `masks[packet]` become empty, whatever they hold, and packets without lanes are culled whatever the
/// camera. Any thread, one group each.
void ewa_grid_end_group(ewa_grid *grid, uint64_t group, const uint16_t masks[EWA_GRID_GROUP],
                        const double start[3]);

#endif
