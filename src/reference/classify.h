// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a voxel looks like under a transfer function, for the reference of volumes (docs/math.md section 12).
#ifndef EWA_SRC_REFERENCE_CLASSIFY_H
#define EWA_SRC_REFERENCE_CLASSIFY_H

#include "ewa/volume.h"
#include "homogeneous/vec.h"

/// A voxel that can be seen.
typedef struct ewa_reference_voxel {
    ewa_vec3 color;        ///< linear, straight
    double extinction;     ///< optical depth per shortest spacing of the volume
    ewa_vec3 normal_world; ///< unit, towards lower values; zero where there is no gradient
} ewa_reference_voxel;

/// The shortest step between voxels along an axis of the grid; 0 where the axes lie in one plane.
double ewa_reference_spacing(const ewa_volume *volume);

/// Whether a voxel can be seen, and what it looks like then.
bool ewa_reference_classify(const ewa_volume *volume, const ewa_transfer *transfer, uint32_t i, uint32_t j,
                            uint32_t k, ewa_reference_voxel *voxel);

#endif
