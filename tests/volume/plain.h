// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures of volumes by the words of ewa/volume_render.h alone: nothing of the library but its types. Every
// voxel is met by every pixel's ray, in double precision.
#ifndef EWA_TESTS_VOLUME_PLAIN_H
#define EWA_TESTS_VOLUME_PLAIN_H

#include "ewa/ewa.h"

/// Draws a float volume of at most 4096 voxels: rgba [height][width][4], linear and premultiplied, over the
/// options' background; `depth` [height][width] where half of the light is gone, infinite where it is not;
/// may be NULL. Of the options, surface_depth and surface_rgba, level, method and minimum_transmittance are
/// not looked at; the index is exact.
void plain_draw(const ewa_volume *volume, const ewa_transfer *transfer, const ewa_camera *camera,
                const ewa_volume_options *options, double *rgba, double *depth);

#endif
