// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The contract of the batch clipper's kernels: each does the same additions, products and quotients in the
// same order as the others, in single precision, so all give the same bytes. The definition is
// ewa_clip_segment() in double precision; alpha differs from it by the rounding of w +- x, about 2^-22 (|w| +
// |x|) / |b1 - b2|.
#ifndef EWA_SRC_HOMOGENEOUS_CLIP_BATCH_H
#define EWA_SRC_HOMOGENEOUS_CLIP_BATCH_H

#include "ewa/homogeneous.h"
#include "wide/isa.h"

/// Clips segments [first, first + count) of a batch.
typedef void clip_segments_kernel(const ewa_segment_batch *segments, const ewa_segment_clips *clips,
                                  uint64_t first, uint64_t count);

EWA_DECLARE_VERSIONS(clip_segments_kernel, ewa_clip_segments);

#endif
