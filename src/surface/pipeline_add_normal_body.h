// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours and normals. Reference: src/reference/surface.c, docs/math.md section 6.
#include "surface/pipeline_add.h"

ADD_SET(add_normal, ADD_NORMAL)
ACCUMULATE(add_normal_fine, ADD_NORMAL | ADD_FINE)

add_run *const EWA_VERSION(ewa_add_normal)[ADD_KINDS] = {
    add_normal, add_normal_depth, add_normal_height, add_normal_beyond, add_normal_fine,
};
