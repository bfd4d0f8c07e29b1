// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Plain discs, eight at a time in double precision: projected, and from their sums back to their points. Written once in
// discs_body.h and compiled per instruction set; the same bytes from each. Reference: src/reference/splat.c, contour.c and
// adjoint_splat.c.
#ifndef EWA_SRC_ADJOINT_DISCS_H
#define EWA_SRC_ADJOINT_DISCS_H

#include "reference/adjoint_splat.h"
#include "wide/isa.h"

enum { EWA_DISC_LANES = 8 };

/// What of a view, and of the cloud that it is of, plain discs need.
typedef struct ewa_disc_view {
    ewa_mat3 linear; ///< as ewa_placement
    ewa_vec3 anchor, offset;
    double fx_px, fy_px, cx_px, cy_px, width_px, height_px;
    double cutoff, cutoff2;      ///< F; F^2 of the perspective kernel, else 0
    double prefilter_px, tolerance;
    double contour_shift, contour_sine2; ///< nothing moves: the latter is below 0
    double concave_from; ///< of what is left of a way (EWA_CONTOUR_CONCAVE) from which on it counts; transparent: infinite
    double back_from;    ///< n.p (flat: nz) from which on nothing is drawn; infinite without culling
    double unit, scale;          ///< of camera space, world units; of lengths there by those in the world
    double sigma_per_radius;
    bool flat; ///< orthographic
} ewa_disc_view;

/// Eight points' numbers.
typedef struct ewa_disc_points {
    double position[3][EWA_DISC_LANES], normal[3][EWA_DISC_LANES], radius[EWA_DISC_LANES], curvature[EWA_DISC_LANES];
} ewa_disc_points;

/// What they are on the screen, as ewa_reference_splat.
typedef struct ewa_disc_splats {
    double drawn[EWA_DISC_LANES]; ///< 1; 0: not, -1: it is near, and nothing else is set
    double is_back[EWA_DISC_LANES], concave[EWA_DISC_LANES];
    double box[4][EWA_DISC_LANES]; ///< whole numbers: x_begin, x_end, y_begin, y_end
    double center_px[2][EWA_DISC_LANES], moved_px[2][EWA_DISC_LANES], variance_px2[3][EWA_DISC_LANES];
    double inverse[3][EWA_DISC_LANES], peak[EWA_DISC_LANES], plane[3][EWA_DISC_LANES];
    double half_range[EWA_DISC_LANES], key_low[EWA_DISC_LANES], key_high[EWA_DISC_LANES], epsilon[EWA_DISC_LANES];
    double center[3][EWA_DISC_LANES], axis_u[3][EWA_DISC_LANES], axis_v[3][EWA_DISC_LANES], normal[3][EWA_DISC_LANES];
    double normal_world[3][EWA_DISC_LANES];
} ewa_disc_splats;

/// Sums of discs, and where they lead.
typedef struct ewa_disc_cotangents {
    double sums[EWA_MOMENT_COUNT][EWA_DISC_LANES]; ///< whole numbers of units
    double drawn[EWA_DISC_LANES];                  ///< as of its splat
    double position[3][EWA_DISC_LANES], normal[3][EWA_DISC_LANES], radius[EWA_DISC_LANES];
    double camera[EWA_CAMERA_NUMBERS][EWA_DISC_LANES];
} ewa_disc_cotangents;

typedef struct ewa_disc_kernels {
    /// Projects eight points.
    void (*project)(const ewa_disc_view *view, const ewa_disc_points *points, ewa_disc_splats *splats);

    /// Takes the sums of eight points to the rest of `cotangents`. `units` of terms: of colours, all else, and
    /// depths.
    void (*pull_back)(const ewa_disc_view *view, const ewa_disc_points *points, const double units[3],
                      ewa_disc_cotangents *cotangents);
} ewa_disc_kernels;

EWA_DECLARE_VERSIONS(const ewa_disc_kernels, ewa_disc_kernels);

#endif
