// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What draws frames behind ewa_renderer: one table per kind of machine, all held to the same bytes.
#ifndef EWA_SRC_SURFACE_BACKEND_H
#define EWA_SRC_SURFACE_BACKEND_H

#include "surface/render.h"
#include "surface/parts.h"
#include "surface/shading.h"

typedef struct ewa_renderer_info ewa_renderer_info; ///< ewa/gpu.h
typedef struct ewa_gather ewa_gather;               ///< pipeline.h

/// One source of a frame.
typedef struct ewa_frame_source {
    const ewa_surfels *surfels;
    double weight; ///< (0, 1]; of all its kernels
    bool hides;    ///< takes part in finding the nearest surfaces
} ewa_frame_source;

/// A frame whose arguments are checked, with all of its sources.
typedef struct ewa_render_job {
    ewa_camera camera;
    ewa_render_options options; ///< what it points to is borrowed from the caller
    ewa_shading_setup shading;
    ewa_frame frame;
    const ewa_frame_source *sources; ///< of one cutoff
    uint32_t source_count;
    ewa_division parts;      ///< of pixels, chosen where the options do not say
    bool count_fragments; ///< for the stats
    uint32_t tile_px;     ///< side of a tile, a power of two of at most EWA_FIELD_PX; 0: the back end chooses
    uint8_t *blank; ///< [row][column], 0, of squares of EWA_BLANK_PX of the band: 1 is set for one that nothing touches, and whose pixels are
                    ///< left as they are; a back end may write all. NULL: all are written
    const ewa_gather *gather; ///< back from pixels to colours (gather.c); NULL: a picture
    uint32_t first_row_px,
        end_row_px; ///< the band that is drawn: multiples of EWA_FIELD_PX, or the picture's end
} ewa_render_job;

/// A back end. Its state belongs to one renderer, and is used by one thread at a time.
struct ewa_backend {
    const char *name;
    ewa_status (*create)(ewa_context *context, void **state);
    void (*destroy)(ewa_context *context, void *state);
    /// Draws a frame; neither the order of its sources nor how surfels are spread over them changes a byte,
    /// as long as their packets and their unit coverages are the same. Eye-dome lighting is put on a frame in
    /// bands with the one at its end, of what the state's earlier calls drew. Sets all of `stats` but the level.
    ewa_status (*draw)(void *state, const ewa_render_job *job, ewa_render_stats *stats);
    /// Sets what of `info`, with zeros and the back end's name in it, is otherwise. NULL: nothing is.
    void (*describe)(const void *state, ewa_renderer_info *info);
    /// Adds up numbers of all processes that draw a frame together, each of which has a part of its sources. NULL: there are no others.
    ewa_status (*add)(void *state, int64_t *numbers, uint32_t count);
    /// Draws every pixel of a frame as `finer` squared and their averages, as ewa_parts_draw() does by draw(). NULL: that does.
    ewa_status (*draw_parts)(void *state, const ewa_render_job *job, uint32_t finer, ewa_render_stats *stats);
};

/// Threads and vectors of the processor; what others are compared with.
extern const ewa_backend ewa_backend_cpu;

#endif
