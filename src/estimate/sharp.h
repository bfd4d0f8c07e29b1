// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Whether a cloud is of flat faces that meet in sharp edges, where round discs are ragged.
#ifndef EWA_SRC_ESTIMATE_SHARP_H
#define EWA_SRC_ESTIMATE_SHARP_H

#include "estimate/curvature.h"

/// Tells by a note what mends the edges of a cloud most of which is flat. `strewn` says how little each place is part of a
/// surface, of UINT8_MAX; NULL: nothing does.
void ewa_sharp_note(ewa_context *context, uint32_t place_count, const curvature_input *input, const uint8_t *strewn);

#endif
