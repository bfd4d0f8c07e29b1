// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Packets of the resident form: where those of a level are, and what is in a lane.
#ifndef EWA_SRC_VOLUME_SPLAT_PACKETS_H
#define EWA_SRC_VOLUME_SPLAT_PACKETS_H

#include "volume/splats.h"

/// The first packet of a part's level, 1 to EWA_SPLAT_LEVELS, and how many it has.
static inline size_t ewa_splats_level(const ewa_splats *splats, uint32_t part, uint32_t level, uint32_t *packets) {
    size_t first = splats->packet_count + (size_t)part * EWA_SPLAT_MERGED_PACKETS;
    *packets = EWA_SPLAT_PART_PACKETS;
    for (uint32_t l = 1; l <= level; l++) {
        if (l > 1) first += *packets;
        *packets /= 4;
    }
    return first;
}

/// Fills a lane with a Gaussian of a set. Any thread.
void ewa_splats_set(ewa_splats *splats, const ewa_gaussians *set, size_t number, size_t packet, size_t lane);

#endif
