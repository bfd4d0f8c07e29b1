// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours. Reference: src/reference/surface.c, docs/math.md section 6.
#include "surface/pipeline_add.h"

ADD_SET(add_color, 0)
ACCUMULATE(add_color_fine, ADD_FINE)

add_run *const EWA_VERSION(ewa_add_color)[ADD_KINDS] = {
    add_color, add_color_depth, add_color_height, add_color_beyond, add_color_fine,
};
