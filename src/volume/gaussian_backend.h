// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What may draw frames of Gaussians in place of the processor, to the same bytes.
#ifndef EWA_SRC_VOLUME_GAUSSIAN_BACKEND_H
#define EWA_SRC_VOLUME_GAUSSIAN_BACKEND_H

#include "volume/gaussian_frame.h"

typedef struct ewa_renderer_info ewa_renderer_info; ///< ewa/gpu.h

/// A back end of a renderer of Gaussians, and its state.
struct ewa_gaussian_backend {
    /// Draws a frame whose views are set and whose parts are listed; `*drawn` false: it is the processor's, and why stands in `remark`.
    /// Sets all of `stats` but the time of the whole. Errors: EWA_ERROR_UNSUPPORTED (the device is lost), EWA_CANCELLED.
    ewa_status (*draw)(void *state, const ewa_gaussian_job *job, ewa_gaussian_stats *stats, bool *drawn, char *remark, size_t remark_bytes);
    /// Learns what a frame that it left took the processor.
    void (*learn)(void *state, double took_s);
    /// Sets of `info` what the device is and what the last frame asked of it.
    void (*describe)(const void *state, ewa_renderer_info *info);
    void (*destroy)(ewa_context *context, void *state);
};

/// Gives a renderer a back end, whose state it destroys.
void ewa_gaussian_renderer_use(ewa_gaussian_renderer *renderer, const ewa_gaussian_backend *backend, void *state);

/// Whether the last frame was drawn by the back end, which sets of `info` what it has to say then; `*remark`: why.
bool ewa_gaussian_renderer_describe(const ewa_gaussian_renderer *renderer, ewa_renderer_info *info, const char **remark);

#endif
