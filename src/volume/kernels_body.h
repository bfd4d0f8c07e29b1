// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The kernels of volumes over the wide type. Reference: src/reference/volume.c,
// docs/math.md section 12; equality class of the versions among themselves: the same bytes.
#include "volume/kernels_append.h"
#include "volume/kernels_layers.h"
#include "volume/kernels_near.h"
#include "volume/kernels_points.h"
#include "volume/kernels_resolve.h"
#include "volume/kernels_splats.h"

const ewa_volume_kernels EWA_VERSION(ewa_volume_kernels) = {
    .append = append,
    .flush = flush,
    .append_near = append_near,
    .draw_near = draw_near,
    .sum_points = sum_points,
    .composite = composite,
    .draw_splats = draw_splats,
    .clear = clear,
    .take_layers = take_layers,
    .resolve = resolve,
};
