// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volumes, inner side.
#ifndef EWA_SRC_IMAGE_VOLUME_H
#define EWA_SRC_IMAGE_VOLUME_H

#include "ewa/volume.h"

/// Converts `count` voxels in memory order from `first` on to floats.
void ewa_volume_read(const ewa_volume *volume, uint64_t first, size_t count, float *numbers);

/// The same for every `stride`-th voxel.
void ewa_volume_read_column(const ewa_volume *volume, uint64_t first, size_t stride, size_t count,
                            float *numbers);

#endif
