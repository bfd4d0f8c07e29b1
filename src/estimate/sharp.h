// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Whether a cloud is of flat faces that meet in sharp edges, where round discs are ragged.
#ifndef EWA_SRC_ESTIMATE_SHARP_H
#define EWA_SRC_ESTIMATE_SHARP_H

#include "estimate/curvature.h"

#include <stdbool.h>

/// The note of clouds that are so.
#define EWA_SHARP_NOTE "estimate.sharp_edges"

/// Whether most of a cloud is flat, and some of it sharp. `strewn` says how little each place is part of a surface, of
/// UINT8_MAX; NULL: nothing does.
bool ewa_sharp_find(uint32_t place_count, const curvature_input *input, const uint8_t *strewn);

#endif
