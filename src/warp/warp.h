// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The samples of warping, the inner side: sources side by side in one grid of packets.
#ifndef EWA_SRC_WARP_H
#define EWA_SRC_WARP_H

#include "ewa/warp.h"
#include "surface/grid.h"
#include "warp/warp_sample.h"

enum {
    EWA_WARP_STRIP_PX = 16, ///< rows that are sampled together
    EWA_WARP_CELL_PX = 16,  ///< a cell of 16 x 16 samples is a group of packets
};

/// A source that was taken; its image is only valid during ewa_warp_take().
typedef struct ewa_warp_source {
    ewa_depth_image image;
    ewa_warp_lens lens;
    double eye[3];        ///< world axes, from the surfels' origin
    uint64_t first_group; ///< of its cells, row by row
    uint32_t cells_x, first_strip, strip_count;
    float key_low, key_high; ///< limits
    float key_scale;         ///< key of a number 1; disparities: of a number above the offset
    float key_offset;        ///< disparities: in numbers
} ewa_warp_source;

/// Memory of warp_nearest.c: where each sample of a source falls, and which samples the pixels show.
typedef struct ewa_warp_nearest {
    ewa_buffer pixel_buffer, winner_buffer, layer_buffer;
} ewa_warp_nearest;

struct ewa_warp {
    ewa_context *context;
    ewa_renderer *renderer;
    ewa_grid grid;
    ewa_warp_source *sources; ///< in `source_buffer`
    uint32_t source_count, strip_count;
    ewa_buffer source_buffer, strip_buffer, row_buffer, surface_buffer;
    ewa_warp_nearest nearest;
};

/// EWA_WARP_MCMILLAN; `options` are checked ones.
ewa_status ewa_warp_draw_nearest(ewa_warp *warp, const ewa_camera *target, const ewa_render_options *options,
                                 const ewa_frame *frame, uint8_t *holes);

void ewa_warp_nearest_free(ewa_context *context, ewa_warp_nearest *nearest);

#endif
