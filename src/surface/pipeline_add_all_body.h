// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// All channels. Reference: src/reference/surface.c, docs/math.md section 6.
#include "surface/pipeline_add.h"

ADD_SET(add_all, ADD_NORMAL | ADD_MATERIAL | ADD_OPACITY)

add_run *const EWA_VERSION(ewa_add_all)[ADD_KINDS] = {
    add_all, add_all_depth, add_all_height, add_all_beyond,
};
