// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volumes: numbers on a regular grid, and what colour and opacity they stand for.
#ifndef EWA_VOLUME_H
#define EWA_VOLUME_H

#include "ewa/base.h"

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
    bool anatomical;           ///< the world's axes are a patient's: to the left, backwards, up
} ewa_volume;

/// Makes a volume of zeros with one world unit between voxels and its middle at the origin; the caller frees
/// it with ewa_volume_free(). Errors (volume zeroed): EWA_ERROR_ARGUMENT (a dim that is 0, another type),
/// EWA_ERROR_LIMIT (bytes over max_memory_bytes), EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_volume_create(ewa_context *context, const uint32_t dims[3], ewa_type type,
                                     ewa_volume *volume);

/// Frees the voxels and zeroes the struct; accepts NULL and a zeroed struct.
EWA_API void ewa_volume_free(ewa_volume *volume);

/// What the voxels hold.
typedef struct ewa_volume_facts {
    uint64_t voxel_count, finite_count; ///< a NaN and an infinity are no numbers
    double low, high, mean;             ///< of the finite numbers; zeros when there are none
    uint64_t histogram[256];            ///< counts of finite numbers in equal steps from low to high
    double spacing_world[3];            ///< distance of the voxels along each axis
    double low_world[3], high_world[3]; ///< box around the voxels' centres
} ewa_volume_facts;

/// Measures a volume; two passes over the voxels. Errors: EWA_ERROR_ARGUMENT.
EWA_API ewa_status ewa_volume_measure(const ewa_volume *volume, ewa_volume_facts *facts);

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

/// Fills a transfer function from the volume alone, by its kind (docs/volume_files.md): labels get a colour each, one
/// slice greys, a field translucent shells, a scan its materials, the densest solid; noise gets fog, and a warning. The
/// unit of length goes with the volume's size, so that it looks the same at every resolution. Errors:
/// EWA_ERROR_ARGUMENT, EWA_ERROR_NUMERIC (no finite voxel, or all are equal), EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_transfer_automatic(const ewa_volume *volume, const ewa_volume_facts *facts,
                                          ewa_transfer *transfer);

/// Returns the name of preset `index`, counted from 0, and in `*what` (may be NULL) a few words; NULL beyond
/// the last. Any thread.
EWA_API const char *ewa_transfer_preset_name(uint32_t index, const char **what);

/// Fills a transfer function from a preset. Those for CT have their values in Hounsfield units where the
/// volume's range is that of CT (about -1000 for air), and in shares of its range otherwise. Errors:
/// EWA_ERROR_ARGUMENT (no such name), EWA_ERROR_NUMERIC (no finite voxel, or all are equal).
EWA_API ewa_status ewa_transfer_preset(const ewa_volume *volume, const ewa_volume_facts *facts,
                                       const char *name, ewa_transfer *transfer);

#ifdef __cplusplus
}
#endif
#endif
