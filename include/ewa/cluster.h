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

/// Some bytes; of none, `data` may be NULL.
typedef struct ewa_parcel {
    void *data;
    size_t size_bytes;
} ewa_parcel;

enum { EWA_MAX_RANKS = 1 << 20 };
#define EWA_ALL_RANKS UINT32_MAX

/// How the processes (ranks) of a frame exchange what they have: one collective operation, as MPI, threads or anything
/// else can offer it. All ranks call it in the same order.
typedef struct ewa_exchange {
    void *user;
    uint32_t rank, rank_count; ///< rank in [0, rank_count), rank_count in [1, EWA_MAX_RANKS]
    uint32_t picture_rank;     ///< which rank gets the pictures of joint renderers; EWA_ALL_RANKS: each
    /// Gives given[r] to each other rank r and fills taken[r] with what that gives, `rank_count` parcels each; those
    /// of the rank itself are left alone. What one gives has the size of what the other takes. Returns when the
    /// rank has taken all and may change what it has given. A failure on one rank has to fail on all, or end them.
    ewa_status (*swap)(void *user, const ewa_parcel *given, const ewa_parcel *taken);
} ewa_exchange;

/// Gives `size_bytes` bytes of each rank to all, in the order of the ranks: rank_count * size_bytes. Errors:
/// EWA_ERROR_ARGUMENT, EWA_ERROR_MEMORY, those of the exchange.
EWA_API ewa_status ewa_exchange_gather(ewa_context *context, const ewa_exchange *exchange, const void *mine,
                                       size_t size_bytes, void *all);

/// Replaces each number by its sum over all ranks. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_MEMORY, those of the
/// exchange.
EWA_API ewa_status ewa_exchange_add(ewa_context *context, const ewa_exchange *exchange, int64_t *values,
                                    size_t count);

/// Makes a renderer whose frames are those of all ranks' sources: every rank begins a frame with the same camera and
/// options and the same planes, adds the sources that it has, maybe none, and finishes it; exchange->picture_rank gets
/// the picture, others find some of its tiles in theirs. The same bytes as of one process that adds all of the
/// sources, whatever rank has which.
///
/// A tile of 64 x 64 pixels in which only one rank has splats is drawn by that rank alone; of one in which several
/// have some, the sums of all meet at one of these. Memory beside the sources: the picture, some
/// 100 bytes a pixel of the tiles that a rank has splats in, and 100 to 700 a pixel of those whose sums meet at it.
/// `exchange` is copied. Frames have no levels of detail by budget and are drawn whole. The caller
/// destroys the renderer. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_MEMORY. Errors of frames: those of
/// ewa_render_finish() and of the exchange; ranks that fail while others do not are for the exchange to end.
EWA_API ewa_status ewa_renderer_create_joint(ewa_context *context, const ewa_exchange *exchange,
                                             ewa_renderer **renderer);

#ifdef __cplusplus
}
#endif
#endif
