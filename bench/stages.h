// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How long it takes what comes before and after a frame: files, normals and radii, surfels, PNG, clipping.
#ifndef EWA_BENCH_STAGES_H
#define EWA_BENCH_STAGES_H

#include "bench/frames.h"

/// Measures and reports the stages for the plan's numbers of threads, with a cloud of positions, normals and
/// radii and a picture of the size of `camera`. Files go to a folder in TMPDIR that is removed afterwards.
/// Returns false after reporting.
bool bench_stages(cli_session *session, const bench_plan *plan, const ewa_cloud *cloud,
                  const ewa_camera *camera, const uint8_t *rgba8, const bench_sink *sink);

#endif
