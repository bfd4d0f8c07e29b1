// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One surfel as one camera sees it, in double precision: what the reference rasterises pixel by pixel.
#ifndef EWA_SRC_REFERENCE_SPLAT_H
#define EWA_SRC_REFERENCE_SPLAT_H

#include "homogeneous/placement.h"
#include "homogeneous/vec.h"
#include "surface/semantics.h"
#include "surface/surfel.h"

/// A camera and the options that decide where a splat lies and what it weighs. Lengths in camera space are in
/// units of the placement.
typedef struct ewa_reference_view {
    bool orthographic;
    int32_t width_px, height_px;
    double fx_px, fy_px, cx_px, cy_px; ///< orthographic: pixels per unit of camera space
    ewa_placement placement;
    double farthest_slope; ///< length of the longest ray (x, y, 1) to the picture
    ewa_kernel kernel;
    ewa_cull cull;
    double cutoff;                                    ///< F
    double prefilter_px;                              ///< h
    double tolerance;                                 ///< kappa
    double contour_shift, contour_sine2;              ///< c and S of semantics.h, contours; c = 0: nothing moves
    bool transparent;                                 ///< what is behind surfaces shows through them
    double point_sigma_px;                            ///< of points (semantics.h); 0: surfels as they are
    double sections_world[EWA_MAX_SECTION_PLANES][4]; ///< as the options have them
    double sections[EWA_MAX_SECTION_PLANES][4]; ///< for points from the surfels' origin, with unit normals
    uint32_t section_count;
} ewa_reference_view;

/// A surfel in camera space and its picture.
typedef struct ewa_reference_splat {
    bool drawn;                             ///< false: dropped, nothing else is set
    bool by_rays;                           ///< near: no ellipse, evaluated ray by ray
    int32_t x_begin, x_end, y_begin, y_end; ///< pixels that may count; empty when outside of the picture
    double center_px[2];                    ///< of the ellipse
    double moved_px[2];                     ///< from there to where it is drawn (contour.h)
    bool concave;                            ///< moved, and of no layer behind the first
    double variance_px2[3];                 ///< V: xx, xy, yy, without the prefilter
    double inverse[3];                      ///< V'^-1: xx, xy, yy
    double peak;                            ///< sqrt(|V| / |V'|) / 2 pi
    /// Source, raycast: (w u, w v, w) = x times this, (u, v) in the surfel's plane; x = (x, y, 1) a pixel's
    /// ray (source: its place relative to the centre, in pixels, with w = 1).
    ewa_mat3 plane_from_ray;
    double plane[3];          ///< 1/z, orthographic: z, is plane . (x, y, 1) for pixel coordinates x, y
    double half_range;        ///< R of semantics.h
    double key_low, key_high; ///< range of 1/z (orthographic: -z)
    double epsilon;           ///< tolerance of the visibility test
    bool is_back;             ///< the surfel faces away: its normal is turned towards the viewer
    ewa_vec3 center, axis_u, axis_v, normal; ///< camera space, normal unit, towards the viewer
    ewa_vec3 normal_world;
    ewa_vec3 color;
    double opacity; ///< [0, 1]
    uint32_t clip_count;
    double clip[EWA_CLIP_LINES]
               [3];   ///< of the pixel x, y, clip . (x, y, 1) pixels from the line is how far inside
    bool clip_either; ///< of the first two
} ewa_reference_splat;

/// A splat at a pixel.
typedef struct ewa_reference_sample {
    double distance2; ///< r^2, squared Mahalanobis distance under the filtered kernel; the splat counts below
                      ///< F^2
    double weight;    ///< rho, times the share
    double z;         ///< clamped
    double share;     ///< of the pixel's square that clip lines leave, (0, 1]
    double inward[2]; ///< share < 1: on the screen, from what is cut off to what is kept; at most of length 1
} ewa_reference_sample;

/// Both structs must have been checked; `cutoff` is the surfels', which points do not use. Surfels are in the
/// world as they are, camera space is the camera's.
void ewa_reference_view_make(const ewa_camera *camera, double cutoff, const ewa_render_options *options,
                             ewa_reference_view *view);

/// Places the camera of such a view before surfels within `box`, relative to `origin_world`.
void ewa_reference_view_place(const ewa_camera *camera, const double origin_world[3], const ewa_bounds *box,
                              ewa_reference_view *view);

/// Returns the direction through a point of the picture, z = 1 (camera space).
ewa_vec3 ewa_reference_ray(const ewa_reference_view *view, double x_px, double y_px);

/// Projects a surfel (docs/math.md sections 3 to 6, semantics.h).
void ewa_reference_project(const ewa_reference_view *view, const ewa_surfel *surfel,
                           ewa_reference_splat *splat);

/// Evaluates a drawn splat at a point of the picture, whether it lies in the box or not. Returns whether the
/// splat has a value there; it may lie beyond the cutoff.
bool ewa_reference_sample_at(const ewa_reference_view *view, const ewa_reference_splat *splat, double x_px,
                             double y_px, ewa_reference_sample *sample);

#endif
