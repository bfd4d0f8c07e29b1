// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The road's kernels over the wide type. The including file defines WIDE_AVX512, WIDE_AVX2 or WIDE_PORTABLE,
// ROAD_NAME and ROAD_KERNELS; this file undefines them. Reference: src/splat/reference.c, docs/math.md
// sections 2 to 9; equality class of the versions among themselves: the same bytes.
#include "kernels/road_cull.h"
#include "kernels/road_edges.h"
#include "kernels/road_eye_dome.h"
#include "kernels/road_variants.h"

const ewa_road_kernels ROAD_KERNELS = {
    .name = ROAD_NAME,
    .cull = cull,
    .set_cells = set_cells,
    .depths = depths,
    .hide = hide,
    .setup = setup,
    .visibility = visibility,
    .near_visibility = near_visibility,
    .clear_nearest = clear_nearest,
    .clear_sums = clear_sums,
    .accumulate = accumulate,
    .near_accumulate = near_accumulate,
    .settle = settle,
    .find_edges = find_edges,
    .edge_boxes = edge_boxes,
    .edge_list = edge_list,
    .edge_pass = edge_pass,
    .edge_near_pass = edge_near_pass,
    .edge_take_all = edge_take_all,
    .edge_compose = edge_compose,
    .resolve = resolve,
    .dome_keys = dome_keys,
    .dome_shade = dome_shade,
};

#undef ROAD_NAME
#undef ROAD_KERNELS
