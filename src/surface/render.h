// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The renderer's inner side.
#ifndef EWA_SRC_SURFACE_RENDER_H
#define EWA_SRC_SURFACE_RENDER_H

#include "ewa/render.h"

typedef struct ewa_backend ewa_backend;

/// Makes a renderer whose frames `backend` draws. Errors: EWA_ERROR_MEMORY, those of the back end.
ewa_status ewa_renderer_create_by(ewa_context *context, const ewa_backend *backend, ewa_renderer **renderer);

/// Returns what draws the frames, with its context and state.
const ewa_backend *ewa_renderer_backend(const ewa_renderer *renderer, ewa_context **context, void **state);

/// How a source takes part in a frame.
typedef struct ewa_render_source {
    double weight; ///< of all its kernels; (0, 1]
    /// Whether it takes part in finding the nearest surface of a pixel, and those behind it. One that does not is
    /// added to the surfaces that others make, where it is within their tolerance, and shows nothing elsewhere.
    /// With one pass all hide.
    bool hides;
} ewa_render_source;

/// Adds a source as ewa_render_add_weighted() does. Errors: those.
ewa_status ewa_render_add_source(ewa_renderer *renderer, const ewa_surfels *surfels,
                                 const ewa_render_source *how);

/// Draws of the frame that has been begun only the rows [first_px, end_px), with the bytes that the whole frame
/// has there as long as its sources, or their proxies (surface/proxy.h), are the same; other pixels stay
/// as they are. Each is a multiple of 128, or end_px the frame's height. A frame with eye-dome lighting is to be
/// drawn band by band by one renderer, with nothing else between, the band at its end last: that puts the
/// lighting on all of them; until then its colours are not there. Options that leave open into how many parts pixels are divided
/// leave them whole: a band does not know the frame's surfels. Errors: EWA_ERROR_ARGUMENT (no frame; other
/// rows), EWA_ERROR_UNSUPPORTED (a frame with a budget: bands would be of different levels).
ewa_status ewa_render_set_rows(ewa_renderer *renderer, uint32_t first_px, uint32_t end_px);

/// Has all of these surfels say into how many parts pixels are divided, where the options leave it to surfels: for a process that draws
/// some of them.
void ewa_render_choose_parts(ewa_renderer *renderer, const ewa_surfels *const *surfels, uint32_t count);

/// Has `count` sets of surfels say so for all frames that follow, in the sources' place: levels that stand for them look like them in as
/// many parts. The list and the surfels are the caller's, who keeps them until it says otherwise; 0: the sources do.
void ewa_renderer_set_parts_of(ewa_renderer *renderer, const ewa_surfels *const *surfels, uint32_t count);

/// Frames of many sources, from octrees or ranks, with more surfels than so many have tiles of this side: fewer tiles' records
/// fit in cache than in one of the usual size.
enum { EWA_DENSE_SURFELS = 5000000, EWA_DENSE_TILE_PX = 32 };

/// Side of the squares of a picture that are noted as blank: that of the smallest tiles.
enum { EWA_BLANK_PX = EWA_DENSE_TILE_PX };

/// Sets the side of tiles: 16, 32, 64 or 128 pixels; 0: by the size of the picture. Pictures are the same.
void ewa_renderer_set_tile(ewa_renderer *renderer, uint32_t tile_px);

#endif
