// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The transpose of drawing, by the pipeline: from a picture's numbers back to the colours of its points, in single
// precision and at the speed of drawing. Reference: src/reference/adjoint.c.
#ifndef EWA_SRC_SURFACE_GATHER_H
#define EWA_SRC_SURFACE_GATHER_H

#include "base/base.h"
#include "ewa/render.h"
#include "surface/shading.h"

/// Whether pictures of such options, complete, are linear in colours in a way that the pipeline goes back: three passes,
/// splats, one white light or none, one sample a pixel, nothing after the resolve.
bool ewa_gather_takes(const ewa_render_options *options, const ewa_shading_setup *shading);

/// Memory that is kept from one way back to the next. Zero-initialise; of one context.
typedef struct ewa_gather_room {
    void *state; ///< of the pipeline
    ewa_buffer colors, sums, shared;
} ewa_gather_room;

void ewa_gather_room_free(ewa_context *context, ewa_gather_room *room);

/// A way back. With A, the matrix that takes linear colours of points to those of a picture as ewa_render() makes it but for
/// the background, the sums are A' rgba, or A' of `weights` in all channels, or A' diag(weights) A colors.
typedef struct ewa_gather_request {
    const ewa_surfels *surfels; ///< of ewa_surfels_create_kept()
    uint64_t point_count;       ///< of their cloud
    ewa_camera camera;
    ewa_render_options options; ///< complete, taken by ewa_gather_takes()
    uint32_t tile_px;           ///< side of tiles; 0: chosen

    const float *rgba;    ///< 4 per pixel, finite; the last has no say; NULL: `weights` counts
    const float *weights; ///< 1 per pixel, finite; NULL: 1

    bool filled;       ///< A has only the pixels that first surfaces fill, each row with the sum 1
    float minimum_alpha; ///< with `filled`: of these
    bool squares;      ///< of the numbers of A, not A itself: with equal weights the diagonal of A' A
    const double *colors; ///< with `filled`: [point][3]; NULL: none
    float *shown; ///< gets A colors, 4 per pixel, the last 1 where A has a row, else all 0; NULL: not wanted
    double *sums; ///< to which the sums are added, [point][3]; NULL: not wanted
    ewa_gather_room *room; ///< NULL: nothing is kept
} ewa_gather_request;

/// Does that. The same bytes for every number of threads, every instruction set and every order of the points, sums also
/// for every side of tiles: terms are rounded to whole numbers of units, 2^-20 of what none is larger than. `*any`, unless
/// NULL, gets whether some surfel may be in the picture. Errors: EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_gather_run(const ewa_gather_request *request, bool *any);

#endif
