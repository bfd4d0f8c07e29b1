// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The thread that draws: one picture at a time, given up between two tiles when a better one is wanted.
#ifndef EWA_VIEWER_PAINTER_H
#define EWA_VIEWER_PAINTER_H

#include "turns.h"
#include "viewer.h"

#include <pthread.h>

enum { PAINT_TEXT_BYTES = 512 };

/// What a picture shows. What it points to is borrowed until the painter is at rest.
typedef struct paint_scene {
    ewa_camera camera;
    ewa_scene *scene;
    ewa_scene_options options;
    bool octrees;        ///< some are visible:
    octree_turns *turns; ///< of who uses them
    bool coarse;         ///< it is drawn coarser than it is to be in the end
    bool reduced;        ///< the picture is smaller than the window's
    uint64_t arrived_count; ///< nodes that had come before
} paint_scene;

/// What drawing took.
typedef struct paint_stats {
    ewa_render_stats render;
    uint32_t missing_count, loaded_count; ///< nodes of octrees that were not there, and that were read
} paint_stats;

/// A picture that was drawn.
typedef struct paint_result {
    uint8_t *rgba8;
    size_t capacity_bytes;
    uint32_t width_px, height_px;
    uint64_t ticket;      ///< of its scene
    uint64_t drawn_count; ///< pictures that were drawn, this one included
    bool whole;           ///< at full size with all there is
    ewa_camera camera;
    uint32_t level;
    double drawn_s;
    uint64_t splat_count;
    uint64_t arrived_count; ///< of the scene: later nodes may be missing
    bool lacks_nodes;       ///< nodes of octrees that it needs were not there; false: those that come later change nothing
    bool
        to_refine; ///< nodes of octrees are missing, and some were read: the same scene gets better when drawn again
} paint_result;

/// What draws, of one thread.
typedef struct paint_tools {
    ewa_context *context;
    ewa_scene_renderer *renderer;
    char message[PAINT_TEXT_BYTES]; ///< the last error's
} paint_tools;

ewa_status paint_tools_make(const viewer_options *options, ewa_backend_kind backend, ewa_progress_callback *progress, void *user,
                            paint_tools *tools);
void paint_tools_free(paint_tools *tools);
/// Draws a scene here and now into the planes of a frame. `stats` may be NULL.
ewa_status paint_scene_draw(paint_tools *tools, const paint_scene *scene, const ewa_frame *frame,
                            paint_stats *stats);

typedef struct painter painter;

/// One that is stepped has no thread, and draws in painter_wait() only; a whole picture is given up when the services say that an
/// event waits.
ewa_status painter_create(const viewer_options *options, painter **made);
void painter_destroy(painter **painter);

/// Hands over a scene, which replaces one that waits. `whole`: it is given up for the next one.
void painter_post(painter *painter, const paint_scene *scene, uint64_t ticket, bool whole);
/// Whether a scene is drawn now or waits.
bool painter_is_busy(painter *painter);
/// Gives up a whole picture that is being drawn, and one that waits; a quick one is finished.
void painter_hurry(painter *painter);
/// Gives up everything for good. Returns whether nothing is drawn any more.
bool painter_stop(painter *painter);
/// Gives up everything and waits until nothing that was handed over is used any more.
void painter_rest(painter *painter);
/// Waits until nothing is drawn; draws what was handed over, where there is no thread.
void painter_wait(painter *painter);
/// Gives the newest picture: valid until the next call; NULL: none yet. `*failure` says why the last one was not
/// drawn, once; NULL: it was.
const paint_result *painter_newest(painter *painter, const char **failure);

#endif
