// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The kernels of Gaussians over the wide type. Reference: src/reference/gaussian.c, docs/math.md section 12;
// equality class of the versions among themselves: the same bytes.
#include "volume/gaussian_draw.h"
#include "volume/gaussian_project.h"

const ewa_gaussian_kernels EWA_VERSION(ewa_gaussian_kernels) = {
    .project = project,
    .mark = mark,
    .draw = draw,
};
