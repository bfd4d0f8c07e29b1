// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volumes: numbers on a regular grid, and what colour and opacity they stand for.
#ifndef EWA_VOLUME_H
#define EWA_VOLUME_H

#include "ewa/base.h"
#include "ewa/cloud.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Numbers on a regular grid. A caller may fill one with memory of its own, for which ewa_volume_free() is
/// then not called.
typedef struct ewa_volume {
    ewa_context *context;
    uint32_t dims[3];          ///< voxels along x (fastest), y, z; each > 0
    ewa_type type;             ///< of the voxels: EWA_U8, EWA_I8, EWA_U16, EWA_I16 or EWA_F32
    void *voxels;              ///< dims[2] * dims[1] * dims[0] numbers, x fastest; a NaN is no matter at all
    double index_to_world[12]; ///< row-major 3x4 that acts on columns [i j k 1]: whole i, j, k are the
                               ///< voxels' centres; world units, right-handed or not, invertible
} ewa_volume;

/// Makes a volume of zeros with one world unit between voxels and its middle at the origin; the caller frees
/// it with ewa_volume_free(). Errors (volume zeroed): EWA_ERROR_ARGUMENT (a dim that is 0, another type),
/// EWA_ERROR_LIMIT (bytes over max_memory_bytes), EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_volume_create(ewa_context *context, const uint32_t dims[3], ewa_type type,
                                     ewa_volume *volume);

/// Frees the voxels and zeroes the struct; accepts NULL and a zeroed struct.
EWA_API void ewa_volume_free(ewa_volume *volume);

/// What matter of one value looks like; between points everything is linear in the value.
typedef struct ewa_transfer_point {
    double value;
    float color[3];   ///< linear light, straight
    float extinction; ///< optical depth per unit length: a layer of thickness t lets exp(-extinction t)
                      ///< through, t in units of ewa_transfer.unit_length_world; >= 0
} ewa_transfer_point;

enum { EWA_MAX_TRANSFER_POINTS = 1024 };

/// A transfer function: from values, and optionally from how fast they change, to colour and opacity. Below
/// the first and beyond the last point there is nothing.
typedef struct ewa_transfer {
    ewa_transfer_point points[EWA_MAX_TRANSFER_POINTS]; ///< in ascending order of their values
    uint32_t point_count;                               ///< >= 2
    double unit_length_world; ///< of the extinctions; 0: the volume's smallest spacing
    /// The extinction is multiplied by a ramp over the length of the gradient (value per world unit): 0 at
    /// gradient_low, 1 from gradient_high on; both 0: not asked.
    double gradient_low, gradient_high;
} ewa_transfer;

#ifdef __cplusplus
}
#endif
#endif
