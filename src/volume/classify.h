// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a volume's voxels look like under a transfer function: colour, extinction, normal.
#ifndef EWA_SRC_VOLUME_CLASSIFY_H
#define EWA_SRC_VOLUME_CLASSIFY_H

#include "ewa/volume.h"
#include "homogeneous/vec.h"

/// A voxel that can be seen.
typedef struct ewa_voxel {
    double color[3];       ///< linear, straight
    double extinction;     ///< optical depth per shortest spacing of the volume
    ewa_vec3 normal_world; ///< unit, towards lower values; zero where there is no gradient
} ewa_voxel;

/// A volume, checked, with its transfer function. Borrows both.
typedef struct ewa_classifier {
    const ewa_volume *volume;
    const ewa_transfer *transfer;
    double unit_length_world; ///< of the transfer function's extinctions
    bool with_ramp;           ///< the gradient counts
    bool has_normals;         ///< it is a grid of more than one slice
    ewa_mat3 units_to_index;  ///< of row vectors, world over the shortest step
    double spacing_world;     ///< the shortest step
} ewa_classifier;

/// Errors: EWA_ERROR_ARGUMENT (index_to_world, dims, type, transfer function), EWA_ERROR_LIMIT (dims).
ewa_status ewa_classifier_make(ewa_context *context, const ewa_volume *volume, const ewa_transfer *transfer,
                               ewa_classifier *classifier);

/// The number at a place within the volume.
double ewa_volume_value(const ewa_volume *volume, uint32_t i, uint32_t j, uint32_t k);

/// Whether a value within [low, high] could be seen.
bool ewa_classifier_reaches(const ewa_classifier *classifier, double low, double high);

/// Whether the voxel at a place can be seen, and what it looks like then; without its normal where that is
/// not asked for.
bool ewa_classify(const ewa_classifier *classifier, uint32_t i, uint32_t j, uint32_t k, bool with_normal,
                  ewa_voxel *voxel);

/// The world place of a whole or broken index.
static inline ewa_vec3 ewa_volume_place(const double index_to_world[12], double i, double j, double k) {
    const double *m = index_to_world;
    return vec3_make(m[0] * i + m[1] * j + m[2] * k + m[3], m[4] * i + m[5] * j + m[6] * k + m[7],
                     m[8] * i + m[9] * j + m[10] * k + m[11]);
}

#endif
