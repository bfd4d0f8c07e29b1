// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scenes of a known amount of work, and the statistics of repeated measurements.
#ifndef EWA_CLI_BENCH_SCENE_H
#define EWA_CLI_BENCH_SCENE_H

#include "session.h"

/// Makes a plane of `point_count` points seen from above by a camera of the given size, so that every splat
/// is in the picture and next to none is hidden. NULL after reporting.
ewa_cloud *bench_scene_make(cli_session *session, uint64_t point_count, const option_size *size,
                            ewa_camera *camera);

/// Gives all discs of a cloud the radius at which their filtered ellipses cover `covered_px` pixels on
/// average. `prefilter_px` is the pixel filter's deviation. Returns false after reporting when no radius
/// does.
bool bench_scene_cover(cli_session *session, ewa_cloud *cloud, const ewa_camera *camera, double prefilter_px,
                       double covered_px);

/// Times of one thing that was done again and again.
typedef struct bench_sample {
    double lowest, quartile, median; ///< quartile: a quarter of the times are lower
} bench_sample;

/// Sorts the times and summarises them; zeros when there are none.
bench_sample bench_summarise(double *times, size_t count);

#endif
