// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Some points of a cloud, the same ones in whatever order the file has them.
#ifndef EWA_SRC_FRAMING_SAMPLING_H
#define EWA_SRC_FRAMING_SAMPLING_H

#include "ewa/cloud.h"

/// Indices of points whose coordinates are finite.
typedef struct point_sample {
    uint64_t *indices;
    size_t count, room; ///< of the indices
} point_sample;

/// Chooses about `wanted` points of a cloud, all when it has no more, by the bits of their coordinates and
/// radii: points in another order give the same ones. Errors: EWA_ERROR_MEMORY. Free in any case.
ewa_status ewa_sample_choose(const ewa_cloud *cloud, size_t wanted, point_sample *sample);
void ewa_sample_free(const ewa_cloud *cloud, point_sample *sample);

#endif
