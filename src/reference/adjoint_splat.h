// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One surfel in double precision: sixteen sums over its pixels, and from these to the cotangents of its numbers and of
// the camera (docs/math.md section 15).
#ifndef EWA_SRC_REFERENCE_ADJOINT_SPLAT_H
#define EWA_SRC_REFERENCE_ADJOINT_SPLAT_H

#include "reference/adjoint_pixel.h"

/// The sums of a splat. d = (dx, dy) is a pixel's place from the ellipse's centre, in pixels, where it is drawn; g is what the loss
/// changes per relative change of the kernel there.
enum {
    EWA_MOMENT_COLOR = 0,   ///< three: cotangents of the linear colour
    EWA_MOMENT_OPACITY = 3, ///< of the opacity, where surfaces are transparent
    EWA_MOMENT_NORMAL = 4,  ///< three: of the unit normal in world space, towards the viewer, by what shows it
    EWA_MOMENT_WEIGHT = 7,  ///< sum of g
    EWA_MOMENT_FIRST = 8,   ///< two: g dx, g dy
    EWA_MOMENT_SECOND = 10, ///< three: g dx dx, g dx dy, g dy dy
    EWA_MOMENT_DEPTH = 13,  ///< three: cotangents of the plane of depths, times dx, dy from where the centre was, 1
    EWA_MOMENT_COUNT = 16,
};

/// Whether the splat's plane decides its depth at a pixel, and not its disc's range. Not of near splats.
bool ewa_reference_is_on_plane(const ewa_reference_view *view, const ewa_reference_splat *splat, double x_px,
                               double y_px);

/// Sets what a splat adds to its sums at a pixel. `cotangent` is that of the surface that it is part of there.
void ewa_reference_moments_at(const ewa_reference_view *view, const ewa_reference_splat *splat,
                              const ewa_reference_sample *sample, double x_px, double y_px, bool transparent,
                              const ewa_reference_gathered *cotangent, double terms[EWA_MOMENT_COUNT]);

/// Cotangents of a surfel, world space, each as if the others stayed.
typedef struct ewa_reference_surfel_cotangent {
    ewa_vec3 center, axis_u, axis_v, normal, color;
    double opacity;
    double circle; ///< billboards: of the axes' length, which alone counts
} ewa_reference_surfel_cotangent;

/// Takes a drawn splat's sums to the cotangents of its surfel, and adds what they give the camera's. Those that are
/// drawn ray by ray give colours, opacities and normals only.
void ewa_reference_moments_pull_back(const ewa_reference_view *view, const ewa_reference_splat *splat,
                                     const ewa_surfel *surfel, const double moments[EWA_MOMENT_COUNT],
                                     ewa_reference_surfel_cotangent *to, double camera[EWA_CAMERA_NUMBERS]);

/// Cotangents of a point's attributes, of those that make its surfel: of discs normal and radius, else both axes.
typedef struct ewa_reference_point_cotangent {
    double position[3], normal[3], radius, tangent_u[3], tangent_v[3], color[3], opacity;
} ewa_reference_point_cotangent;

/// Takes the cotangents of the surfel of a point to those of its attributes. Any thread.
void ewa_reference_surfel_pull_back(const ewa_surfel_reader *reader, uint64_t point, const ewa_surfel *surfel,
                                    const ewa_reference_surfel_cotangent *from, ewa_reference_point_cotangent *to);

#endif
