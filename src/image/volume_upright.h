// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which way is up in a volume whose file does not say: docs/framing.md.
#ifndef EWA_SRC_IMAGE_VOLUME_UPRIGHT_H
#define EWA_SRC_IMAGE_VOLUME_UPRIGHT_H

#include "ewa/volume.h"

/// Finds what is up by where matter ends: `up_world` becomes a unit vector, and `*why` a few words that live as long as the
/// library; both stay as they are where nothing tells. Costs one look at up to 2 million voxels, and 8 MiB meanwhile. Errors:
/// EWA_ERROR_MEMORY.
ewa_status ewa_volume_find_up(const ewa_volume *volume, double up_world[3], const char **why);

#endif
