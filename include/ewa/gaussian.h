// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sets of trained Gaussians: what the files of 3D and 2D Gaussian splatting hold.
#ifndef EWA_GAUSSIAN_H
#define EWA_GAUSSIAN_H

#include "ewa/base.h"
#include "ewa/cloud.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { EWA_MAX_SH_DEGREE = 4 };

/// Gaussians with their colours by direction. A caller may fill one with memory of its own, for which
/// ewa_gaussians_free() is then not called.
///
/// Number i has the covariance R S S' R' of the rotation R by its quaternion and the scales S, peak 1, and
/// lets 1 - opacity * its value through. Its colour seen along the unit direction d, from the eye to the centre,
/// is max(0, 0.5 + sum of harmonics k times the real spherical harmonic Y_k(d)), as in 3DGS; a display
/// value, sRGB, as the pictures that it was trained on: these are composited as they are.
typedef struct ewa_gaussians {
    ewa_context *context;
    uint32_t count;
    uint32_t sh_degree; ///< L, [0, EWA_MAX_SH_DEGREE]
    bool flat;          ///< 2D Gaussians: the third scale is 0, the third axis is the normal
    bool antialiased; ///< trained with a pixel filter that keeps what a Gaussian adds, not one that thickens
    double origin[3]; ///< world units; centres are relative to it
    float *centers;   ///< 3 per Gaussian, world units
    float *scales;    ///< 3 per Gaussian, standard deviations, world units, finite, >= 0
    float *rotations; ///< 4 per Gaussian, unit quaternion w x y z, from the axes to the world
    float *opacities; ///< 1 per Gaussian, [0, 1]
    float *harmonics; ///< (L + 1)^2 coefficients of red green blue per Gaussian; order and signs as in 3DGS
    uint16_t *classes; ///< 1 per Gaussian, the codes of "classification" of clouds; NULL: they have none
} ewa_gaussians;

/// Makes a set with everything zero; the caller frees it with ewa_gaussians_free(). Errors (set zeroed):
/// EWA_ERROR_ARGUMENT (sh_degree), EWA_ERROR_LIMIT (count over max_points, bytes over max_memory_bytes),
/// EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_gaussians_create(ewa_context *context, uint32_t count, uint32_t sh_degree,
                                        ewa_gaussians *gaussians);

/// Gives each Gaussian of a set the class 0, unless they have classes. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_gaussians_add_classes(ewa_gaussians *gaussians);

/// Frees the streams and zeroes the struct; accepts NULL and a zeroed struct.
EWA_API void ewa_gaussians_free(ewa_gaussians *gaussians);

/// Measures the box around the centres, in world units, origin included. Errors: EWA_ERROR_ARGUMENT.
EWA_API ewa_status ewa_gaussians_measure(const ewa_gaussians *gaussians, ewa_bounds *bounds);

/// Maps space: centres, axes and the directions of the colours. `world_to_world` is row-major, acts on column
/// vectors, its last row is 0 0 0 1; its linear part becomes scales and a turn, after a mirroring of the second
/// axis where it mirrors, by which the colours go. The translation goes into the origin. Errors:
/// EWA_ERROR_ARGUMENT, EWA_ERROR_NUMERIC (no inverse, a number that is not finite; the set is then as before).
EWA_API ewa_status ewa_gaussians_transform(ewa_gaussians *gaussians, const double world_to_world[16]);

/// Makes a set of those whose byte in `marks`, one for each, is not 0, in their order, with every number. The caller frees
/// `*kept`, zeroed after a failure. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_gaussians_keep(const ewa_gaussians *gaussians, const uint8_t *marks, ewa_gaussians *kept);

/// Makes surfels of a set, for which 2D Gaussians are meant: "position", float, with the set's origin,
/// "tangent_u" and "tangent_v" along the two longest axes, one standard deviation long, "normal" along the
/// shortest, "color" in linear light, that of the constant harmonic, clamped to [0, 1], with the opacity as
/// alpha, and as "opacity"; "size", the longest standard deviation; "classification" of those that have classes. The caller owns `*cloud`, which is NULL after a
/// failure. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_gaussians_to_cloud(const ewa_gaussians *gaussians, ewa_cloud **cloud);

/// Makes the points that a camera has to have in its picture (ewa_framing_create()): the centres within `core`
/// (ewa_splats_info.core) with an opacity of at least 0.1, "position", double, world units, and "radius", two of
/// their longest standard deviations; the corners of the core where there are none. The caller owns `*cloud`, which is
/// NULL after a failure. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_gaussians_outline(const ewa_gaussians *gaussians, const ewa_bounds *core,
                                         ewa_cloud **cloud);

#ifdef __cplusplus
}
#endif
#endif
