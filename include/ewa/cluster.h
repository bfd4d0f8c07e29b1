// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One frame of sources that no single process has: each holds some, all draw together (docs/cluster.md).
#ifndef EWA_CLUSTER_H
#define EWA_CLUSTER_H

#include "ewa/render.h"

#ifdef __cplusplus
extern "C" {
#endif

/// How the processes (ranks) of a frame exchange what they have: three collective operations, as MPI, threads or anything else
/// offers them. Each is called by all ranks in the same order, and returns when the rank has its result. A failure
/// on one rank has to fail on all, or end them.
typedef struct ewa_exchange {
    void *user;
    uint32_t rank, rank_count;
    /// Gives `size_bytes` bytes of each rank to all, in the order of the ranks: rank_count * size_bytes.
    ewa_status (*gather)(void *user, const void *mine, size_t size_bytes, void *all);
    /// Replaces each number by the largest that a rank has there: no NaN, -infinity is the least.
    ewa_status (*take_largest)(void *user, float *values, size_t count);
    /// Replaces each number by the sum over all ranks.
    ewa_status (*add)(void *user, int64_t *values, size_t count);
} ewa_exchange;

/// Makes a renderer whose frames are those of all ranks' sources: every rank begins a frame with the same camera and
/// options, adds the sources that it has, maybe none, and finishes it; each gets the picture, if its frame
/// asks for one. The same bytes as of one process that adds all of the sources, whatever rank has which.
/// Memory beside the sources: 200 to 320 bytes a pixel, with depths or clip lines up to twice that. `exchange` is copied. Frames have no levels of detail by budget and are drawn
/// whole. The caller destroys the renderer. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_MEMORY. Errors of frames: those of
/// ewa_render_finish() and of the exchange; ranks that fail while others do not are for the exchange to end.
EWA_API ewa_status ewa_renderer_create_joint(ewa_context *context, const ewa_exchange *exchange,
                                             ewa_renderer **renderer);

#ifdef __cplusplus
}
#endif
#endif
