// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The filtered levels of an environment.
//
// A direction (x, y, z) of the environment has longitude atan2(x, z) and latitude atan2(y, |(x, z)|); on a
// level of W x H texels it lies at column W (1/2 - longitude / 2 pi) and row H (1/2 - latitude / pi), texel
// (i, j) having its centre at (i + 1/2, j + 1/2). Columns go around; above the first and below the last row
// lies that row again, half way around.
//
// A footprint of t, an angle, is looked up between the two levels whose texels are nearest to it in height,
// pi / H: at level log2(t H0 / pi), linearly within and between levels.
#ifndef EWA_SRC_IMAGE_ENVIRONMENT_H
#define EWA_SRC_IMAGE_ENVIRONMENT_H

#include "ewa/shade.h"

enum {
    EWA_MAX_ENVIRONMENT_LEVELS = 33, ///< until a side of 2^32 is one
};

typedef struct ewa_environment_level {
    uint32_t width, height;
    float *texels; ///< r, g, b; rows from the top
} ewa_environment_level;

struct ewa_environment {
    ewa_context *context;
    uint64_t serial; ///< another for each environment
    uint32_t level_count;
    ewa_environment_level levels[EWA_MAX_ENVIRONMENT_LEVELS];
};

#endif
