// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How fast segments are clipped.
#ifndef EWA_BENCH_CLIP_H
#define EWA_BENCH_CLIP_H

#include "cli/base/session.h"

/// Number of segments per call of what bench_clip() times.
enum { BENCH_CLIP_SEGMENTS = 1 << 15 };

/// Clips BENCH_CLIP_SEGMENTS random segments, ends included, `run_count` times on the context's threads; the
/// mean time of a call goes to `run_s`. Errors: those of ewa_clip_segments(), EWA_ERROR_MEMORY.
ewa_status bench_clip(ewa_context *context, double *run_s, int run_count);

#endif
