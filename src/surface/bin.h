// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which packets each tile has to look at.
#ifndef EWA_SRC_SURFACE_BIN_H
#define EWA_SRC_SURFACE_BIN_H

#include "road/tiles.h"
#include "surface/packets.h"
#include "surface/road.h"

/// Bins of a frame; its memory survives from frame to frame. Zero-initialise.
typedef struct ewa_bins {
    ewa_tiles tiles;
    ewa_bin_lists lists;      ///< packets of each tile, ascending
    ewa_packet_places places; ///< of the packets that some tile has
    uint64_t culled_packet_count;
    ewa_buffer places_buffer, lanes_buffer;
} ewa_bins;

/// Fills the bins in parallel; the result does not depend on the number of workers.
ewa_status ewa_bins_fill(ewa_context *context, ewa_bins *bins, const ewa_road_kernels *kernels,
                         const ewa_view *view, const ewa_surfels *surfels);
void ewa_bins_free(ewa_context *context, ewa_bins *bins);

#endif
