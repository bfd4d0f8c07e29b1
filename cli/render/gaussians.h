// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How commands that draw let Gaussians be drawn.
#ifndef EWA_CLI_RENDER_GAUSSIANS_H
#define EWA_CLI_RENDER_GAUSSIANS_H

#include "ewa/gaussian_render.h"

/// Rows for the table of a command that has ewa_gaussian_options at `offset`.
#define GAUSSIAN_OPTIONS(offset)                                                                             \
    {"projection", OPTION_OF(ewa_gaussian_options, offset, projection)},                                     \
        {"order", OPTION_OF(ewa_gaussian_options, offset, order)},                                           \
        {"gaussian-near", OPTION_OF(ewa_gaussian_options, offset, near_world),                               \
         .absent = "auto: 0.2 as in training, or 2 % of the diagonal of the box shown where that is less"},  \
        {"gaussian-filter", OPTION_OF(ewa_gaussian_options, offset, filter)},                                \
        {"gaussian-merge", OPTION_OF(ewa_gaussian_options, offset, merge_px)},                               \
        {"gaussian-display", OPTION_OF(ewa_gaussian_options, offset, display)},                              \
        {"ellipsoid-radius", OPTION_OF(ewa_gaussian_options, offset, ellipsoid_radius)},                     \
        {"gaussian-dot", OPTION_OF(ewa_gaussian_options, offset, dot_px)},                                   \
        {"gaussian-depth", OPTION_OF(ewa_gaussian_options, offset, depth)},                                  \
    {                                                                                                        \
        "sh-degree", OPTION_OF(ewa_gaussian_options, offset, sh_degree)                                      \
    }

/// The library's defaults, but for the near plane: as suits what is shown.
static inline void gaussians_set_defaults(ewa_gaussian_options *options) {
    ewa_gaussian_options_init(options, sizeof *options);
    options->near_world = 0;
}

#endif
