// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Gaussians as opaque surfaces: ellipsoids and dots.
#ifndef EWA_SRC_VOLUME_GAUSSIAN_SOLID_H
#define EWA_SRC_VOLUME_GAUSSIAN_SOLID_H

#include "volume/gaussian_kernels.h"

/// Samples of a pixel, 2 x 2.
enum { EWA_SOLID_SAMPLES = 4, EWA_SOLID_TILE_SAMPLES = EWA_SOLID_SAMPLES * EWA_GAUSSIAN_TILE_PX * EWA_GAUSSIAN_TILE_PX };

/// What is drawn, and the planes of surfaces that it becomes a part of.
typedef struct ewa_gaussian_solids {
    const ewa_gaussian_view *view;
    bool dots;
    float radius; ///< of dots, px; of ellipsoids, standard deviations
    float log2_min; ///< of alpha: what has less is not drawn
    uint32_t width_px;
    float *rgba, *depth, *normal, *coverage;
} ewa_gaussian_solids;

/// The nearest surfaces of a tile's samples.
typedef struct ewa_solid_samples {
    float z[EWA_SOLID_TILE_SAMPLES];
    uint32_t ids[EWA_SOLID_TILE_SAMPLES];
} ewa_solid_samples;

/// Draws the splats of a tile, over what the planes have of it. Any thread, of each tile one.
void ewa_gaussian_solids_draw(const ewa_gaussian_solids *solids, ewa_gaussian_tile *tile, ewa_solid_samples *samples);

#endif
