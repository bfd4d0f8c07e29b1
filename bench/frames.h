// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Frames of one scene, measured in turns for all numbers of threads and instruction sets.
#ifndef EWA_BENCH_FRAMES_H
#define EWA_BENCH_FRAMES_H

#include "bench/report.h"

enum { BENCH_MAX_FRAMES = 1000, BENCH_MAX_SETS = 3 };

/// Instruction sets to measure with.
typedef struct bench_sets {
    const char *name;
    uint32_t mask; ///< EWA_CPU_* bits
} bench_sets;

/// What to measure each scene with.
typedef struct bench_plan {
    uint32_t threads[OPTION_VECTOR_MAX];
    size_t thread_counts;
    bench_sets sets[BENCH_MAX_SETS]; ///< the one that others are compared with first
    size_t set_count;
    size_t frame_count; ///< at most BENCH_MAX_FRAMES
    ewa_backend_kind backend;
    const char *against; ///< another program to draw each scene in turns with; NULL: none
} bench_plan;

/// Measures and reports the frames of a scene; the last one stays in `rgba8`, 4 bytes for each of the
/// camera's pixels. Returns false after reporting.
bool bench_frames(cli_session *session, const bench_plan *plan, const bench_scene *scene,
                  const ewa_render_options *render, uint8_t *rgba8, const bench_sink *sink);

/// A cloud of another context that borrows all streams of `cloud`, which has to outlive it.
ewa_status bench_borrow(ewa_context *context, const ewa_cloud *cloud, ewa_cloud **borrowed);

#endif
