// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Some points of a cloud, the same ones in whatever order the file has them.
#ifndef EWA_CLI_SAMPLING_H
#define EWA_CLI_SAMPLING_H

#include "session.h"

/// Indices of points whose coordinates are finite.
typedef struct point_sample {
    uint64_t *indices;
    size_t count;
} point_sample;

/// Chooses about `wanted` points of a cloud, all when it has no more, by the bits of their coordinates and
/// radii: points in another order give the same ones. Returns false when memory is short; free with
/// free(indices) in any case.
bool sampling_choose(const ewa_cloud *cloud, size_t wanted, point_sample *sample);

#endif
