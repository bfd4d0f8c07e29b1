// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What only some clouds have beside packets: opacities, materials, curvatures and clip lines.
#ifndef EWA_SRC_SURFACE_EXTRAS_H
#define EWA_SRC_SURFACE_EXTRAS_H

#include "surface/packets.h"
#include "surface/surfel.h"

/// Makes the streams that the reader's cloud of `point_count` points calls for; order[i] is the point in lane i % 16
/// of packet i / 16, or EWA_NO_POINT. What it leaves after an error is freed with the rest.
ewa_status ewa_extras_make(ewa_context *context, ewa_surfels *surfels, const ewa_surfel_reader *reader,
                           uint64_t point_count, const uint32_t *order);

void ewa_extras_free(ewa_context *context, ewa_surfels *surfels);

size_t ewa_extras_bytes(const ewa_surfels *surfels);

#endif
