// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Facts about sources that ranks exchange: enough to agree on scales, not what is drawn.
#ifndef EWA_SRC_CLUSTER_SOURCES_H
#define EWA_SRC_CLUSTER_SOURCES_H

#include "cluster/exchange.h"
#include "surface/backend.h"
#include "surface/packets.h"

/// The sources of all ranks: this one's, and proxies (surface/proxy.h) for those of the others, in the order
/// of the ranks, so that every rank has the same scales. Zero-initialise.
typedef struct ewa_joint_sources {
    ewa_buffer facts, sources, proxy; ///< of all ranks; proxy: ewa_surfels
    uint32_t count;
    uint64_t splat_count; ///< of all
} ewa_joint_sources;

/// Exchanges the sources of a frame and sets `*joint` to the frame with those of all. Errors: EWA_ERROR_ARGUMENT (other
/// cutoffs than those of the other ranks), EWA_ERROR_MEMORY, those of the exchange.
ewa_status ewa_joint_sources_gather(ewa_context *context, const ewa_exchange *exchange,
                                    ewa_joint_sources *room, const ewa_render_job *frame,
                                    ewa_render_job *joint);

void ewa_joint_sources_free(ewa_context *context, ewa_joint_sources *room);

#endif
