// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The pipeline's kernels over the wide type. Reference: src/reference/surface.c, docs/math.md
// sections 2 to 9; equality class of the versions among themselves: the same bytes.
#include "surface/pipeline_cull.h"
#include "surface/pipeline_edges.h"
#include "surface/pipeline_eye_dome.h"
#include "surface/pipeline_passes.h"

const ewa_pipeline_kernels EWA_VERSION(ewa_pipeline_kernels) = {
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
    .set_gather = set_gather,
    .spread = spread,
    .near_spread = near_spread,
    .turn_gather = turn_gather,
    .gather = gather,
    .near_gather = near_gather,
    .finalize = finalize,
    .find_edges = find_edges,
    .edge_boxes = edge_boxes,
    .edge_list = edge_list,
    .edge_pass = edge_pass,
    .edge_near_pass = edge_near_pass,
    .edge_take_all = edge_take_all,
    .edge_compose = edge_compose,
    .resolve = resolve,
    .eye_dome_keys = eye_dome_keys,
    .eye_dome_shade = eye_dome_shade,
};
