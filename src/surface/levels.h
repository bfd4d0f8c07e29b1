// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Levels of detail: coarser surfels that stand for up to four neighbours each, and cover what these cover.
#ifndef EWA_SRC_SURFACE_LEVELS_H
#define EWA_SRC_SURFACE_LEVELS_H

#include "surface/packets.h"

enum { EWA_LEVEL_MIN_SURFELS = 1024 }; ///< a level of fewer is not worth its overhead

/// Makes the levels behind `surfels`, which has none, up to `level_count` with it; the chain ends before a
/// level of fewer than EWA_LEVEL_MIN_SURFELS, or of more than half of those before it. What it leaves after an error is
/// freed with the rest. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_levels_make(ewa_surfels *surfels, uint32_t level_count);

/// Returns the surfels of a level, of the last one if there are fewer, and sets `level` to the one it is.
const ewa_surfels *ewa_levels_find(const ewa_surfels *surfels, uint32_t *level);

#endif
