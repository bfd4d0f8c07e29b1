// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Surfels as double-precision structs, read from a cloud: the one place that knows what its streams mean.
#ifndef EWA_SRC_SURFACE_SURFEL_H
#define EWA_SRC_SURFACE_SURFEL_H

#include "cloud/color.h"
#include "ewa/render.h"

/// One surfel in world space. Its covariance is axis_u' axis_u + axis_v' axis_v (docs/math.md section 2).
typedef struct ewa_surfel {
    double center[3]; ///< world axes, from the cloud's origin: adding that would round
    double axis_u_world[3],
        axis_v_world[3];    ///< orthogonal, length = sigma, |u| >= |v|, radius_scale included
    double normal_world[3]; ///< unit; +-(u x v), on the side of the cloud's normal if it has one
    double color_linear[3]; ///< of any sign: coefficients whose mean is a colour
    double alpha;           ///< [0, 1]
    double material;        ///< whole, [0, 255]
    /// Clip lines: keep a u + b v + c >= 0 at center + u axis_u + v axis_v; a = b = 0: no line.
    double clip[2][3];
    double curvature_world; ///< "signed_curvature", of the eight digits that packets keep of it
    bool billboard;     ///< a circle parallel to the picture, of no surface: its axes tell its size alone
    double clip_either; ///< 1: what one of two lines keeps is kept; 0: what both keep
} ewa_surfel;

/// A billboard's sigma over that of its disc: it covers as much as discs of all directions do on average, half of what
/// one does that faces the viewer.
#define EWA_BILLBOARD_SCALE 0.7071067811865476

/// Largest magnitude of a coordinate and of an axis, and the inverse of the smallest axis: surfels outside
/// are not drawn, so that no square of what is left overflows.
#define EWA_SURFEL_LIMIT 1e36

/// Smallest |v| / |u| that is an ellipse; thinner ones are lines without a normal and are not drawn.
#define EWA_SURFEL_MIN_ASPECT 1e-6

/// The streams of a cloud that make surfels. Valid until the cloud's streams change.
typedef struct ewa_surfel_reader {
    const ewa_attribute *position, *normal, *radius, *tangent_u, *tangent_v, *color; ///< NULL: not used
    const ewa_attribute *clip[2], *clip_mode, *border, *material, *surfaceness, *curvature;
    double origin_world[3];  ///< of the positions
    double sigma_per_radius; ///< radius_scale / F
    double axis_scale;       ///< radius_scale
    ewa_color_table colors;
} ewa_surfel_reader;

/// Finds the streams: "position" with "tangent_u" and "tangent_v" (the axes win), or with "normal" and
/// "radius".
///
/// Clip lines ("clip0", "clip1", "clip_mode") belong to tangent axes: without these they are not used. A line
/// whose a and b are 0, or with a number that is not finite, is none.
///
/// A "color" of 3 or 4 components is used when there is one: unsigned integers are sRGB over their whole
/// range, signed ones over their non-negative half (alpha is linear), floats are linear, of any sign;
/// alpha is clamped to [0, 1]. A component that is not finite makes the colour an opaque EWA_DEFAULT_GREY, as
/// no colour does. A "material" that is no whole number in [0, 255] is 0. `options` are checked ones. Errors:
/// EWA_ERROR_ARGUMENT with a message that names the missing or misshapen attribute.
ewa_status ewa_surfel_reader_open(const ewa_cloud *cloud, const ewa_surfels_options *options,
                                  ewa_surfel_reader *reader);

/// Reads points [first, first + count) into `surfels`; `drawable[i]` tells whether surfels[i] can be drawn:
/// position and axes finite and within EWA_SURFEL_LIMIT, radius > 0, normal not zero, aspect at least
/// EWA_SURFEL_MIN_ASPECT. What cannot be drawn has undefined members. Returns how many are drawable. Any
/// thread.
uint64_t ewa_surfel_read(const ewa_surfel_reader *reader, uint64_t first, uint64_t count, ewa_surfel *surfels,
                         bool *drawable);

/// Whether a point is no part of a surface: its surfaceness is below EWA_SURFACE_LIMIT, and it has no clip line but a
/// border, which does not count then. Any thread.
bool ewa_surfel_is_billboard(const ewa_surfel_reader *reader, uint64_t point);

/// Sets for each of the points [first, first + count) whether it has a clip line. Any thread.
void ewa_surfel_mark_clipped(const ewa_surfel_reader *reader, uint64_t first, uint64_t count, uint8_t *clipped);

/// Reads the material of one point as ewa_surfel_read() does. Any thread.
uint8_t ewa_surfel_material(const ewa_surfel_reader *reader, uint64_t point);

/// Reads the signed curvature of one point as ewa_surfel_read() does. Any thread.
double ewa_surfel_curvature(const ewa_surfel_reader *reader, uint64_t point);

/// Reads the alpha of one point as ewa_surfel_read() does. Any thread.
double ewa_surfel_alpha(const ewa_surfel_reader *reader, uint64_t point);

#endif
