// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which packets each tile has to look at.
#ifndef EWA_SRC_SURFACE_BIN_H
#define EWA_SRC_SURFACE_BIN_H

#include "surface/packets.h"
#include "surface/pipeline.h"
#include "tiling/tiles.h"

/// Bins of a source in a frame; its memory survives from frame to frame. Zero-initialise.
typedef struct ewa_bins {
    ewa_bin_lists lists;      ///< packets of each tile, ascending
    ewa_packet_places places; ///< of the packets that some tile has
    const ewa_pipeline_kernels *kernels;
    const ewa_view *view;
    const ewa_surfels *surfels;
    ewa_buffer places_buffer, lanes_buffer;
} ewa_bins;

/// Makes room for what a source has in the bins of a frame, which has then to be filled.
ewa_status ewa_bins_start(ewa_context *context, ewa_bins *bins, const ewa_pipeline_kernels *kernels,
                          const ewa_view *view, const ewa_surfels *surfels);

/// What ewa_bin_lists_fill_all() is to fill the bins with, one for each tile of the picture; the result does not
/// depend on the number of workers. `bins` has been started, and is borrowed.
ewa_bin_request ewa_bins_request(ewa_bins *bins);
void ewa_bins_free(ewa_context *context, ewa_bins *bins);

#endif
