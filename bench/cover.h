// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How many pixels the splats of a cloud cover, and radii for a wanted number.
#ifndef EWA_BENCH_COVER_H
#define EWA_BENCH_COVER_H

#include "cli/base/session.h"

/// Pixels that the filtered ellipses of a cloud cover on average, from some thousand of its points. The cloud
/// has positions, normals and radii; `prefilter_px` is the pixel filter's deviation.
double bench_cover_px(const ewa_cloud *cloud, const ewa_camera *camera, double prefilter_px);

/// Multiplies all radii of a cloud by the number at which its splats cover `covered_px` pixels on average.
/// Returns false after reporting when the pixel filter alone covers more.
bool bench_cover_scale(cli_session *session, ewa_cloud *cloud, const ewa_camera *camera, double prefilter_px,
                       double covered_px);

#endif
