// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volumes, inner side.
#ifndef EWA_SRC_IMAGE_VOLUME_H
#define EWA_SRC_IMAGE_VOLUME_H

#include "ewa/volume.h"

/// Converts `count` voxels in memory order from `first` on to floats.
void ewa_volume_read(const ewa_volume *volume, uint64_t first, size_t count, float *numbers);

/// Takes one line of sight, from `at` on in steps of `step`.
typedef void ewa_line_of_sight(void *user, const float *at, ptrdiff_t step, uint32_t count);

/// Looks through a volume from the six sides of its box, along columns that are evenly spread.
ewa_status ewa_volume_look_through(const ewa_volume *volume, ewa_line_of_sight *look, void *user);

#endif
