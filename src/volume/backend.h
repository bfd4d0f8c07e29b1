// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What may draw frames of a volume in place of the processor, to the same bytes.
#ifndef EWA_SRC_VOLUME_BACKEND_H
#define EWA_SRC_VOLUME_BACKEND_H

#include "volume/render.h"

typedef struct ewa_renderer_info ewa_renderer_info; ///< ewa/gpu.h

/// A back end of a renderer of volumes.
typedef struct ewa_volume_backend {
    /// Draws a frame that is set up, with its target; `*drawn` false: it is the processor's, and why stands in `remark`. Sets what the
    /// device counts and measures of `stats`. Errors: EWA_ERROR_MEMORY, EWA_ERROR_UNSUPPORTED (the device is lost).
    ewa_status (*draw)(void *state, const ewa_voxels *voxels, const ewa_volume_frame *frame, ewa_volume_stats *stats, bool *drawn,
                       char *remark, size_t remark_bytes);
    /// Learns what a frame that it left took the processor.
    void (*learn)(void *state, double took_s);
    /// Sets what a frame that it drew was drawn by, of an info of zeros.
    void (*describe)(const void *state, ewa_renderer_info *info);
    void (*destroy)(ewa_context *context, void *state);
} ewa_volume_backend;

/// Gives a renderer a back end, whose state it destroys.
void ewa_volume_renderer_use(ewa_volume_renderer *renderer, const ewa_volume_backend *backend, void *state);

/// Whether the back end drew the last frame, of which it then sets `info`, of zeros; `*remark`: why it did or did not ("": nobody asks).
bool ewa_volume_renderer_describe(const ewa_volume_renderer *renderer, ewa_renderer_info *info, const char **remark);

#endif
