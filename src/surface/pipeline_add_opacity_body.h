// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours, normals and opacities. Reference: src/reference/surface.c, docs/math.md section 6.
#include "surface/pipeline_add.h"

ADD_SET(add_opacity, ADD_NORMAL | ADD_OPACITY)

add_run *const EWA_VERSION(ewa_add_opacity)[ADD_KINDS] = {
    add_opacity, add_opacity_depth, add_opacity_height, add_opacity_beyond,
};
