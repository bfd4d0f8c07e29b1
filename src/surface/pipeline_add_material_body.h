// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours, normals and materials. Reference: src/reference/surface.c, docs/math.md section 6.
#include "surface/pipeline_add.h"

ADD_SET(add_material, ADD_NORMAL | ADD_MATERIAL)

add_run *const EWA_VERSION(ewa_add_material)[ADD_KINDS] = {
    add_material, add_material_depth, add_material_height, add_material_beyond,
};
