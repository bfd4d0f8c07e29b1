// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Edges and corners in one neighbourhood: two or three planes, and how the solid behind them is made of their
// half spaces.
#ifndef EWA_SRC_EDGES_FEATURE_FIT_H
#define EWA_SRC_EDGES_FEATURE_FIT_H

#include "ewa/base.h"

enum {
    FEATURE_PLANES = 3,
    FEATURE_POINTS = 96, ///< most points of a neighbourhood
};

/// The points of a neighbourhood relative to its middle, and their unit normals, which agree along the
/// surface.
typedef struct feature_points {
    uint32_t count;
    double x[FEATURE_POINTS], y[FEATURE_POINTS], z[FEATURE_POINTS];
    float normal[FEATURE_POINTS][3];
} feature_points;

/// A piecewise plane surface. Plane p has the heights h_p(x) = normal_p . x - offset_p; the surface is where
/// outer(h_0, inner(h_1, h_2)) is 0 (two planes: outer(h_0, h_1)), each of them max (the solids' common part:
/// a convex edge) or min (their union: a concave one).
typedef struct feature_model {
    uint32_t plane_count; ///< 0 (smooth), 2 (edge) or 3 (corner)
    bool outer_max, inner_max;
    double normal[FEATURE_PLANES][3]; ///< unit, outward
    double offset[FEATURE_PLANES];    ///< in the length unit of the points
} feature_model;

/// What a fit is judged by; lengths in the unit of the points.
typedef struct feature_scale {
    double spacing, noise;
    double cos_threshold; ///< planes whose normals differ by less are one smooth surface
} feature_scale;

/// Returns the index of the plane that the surface follows at a place.
uint32_t ewa_feature_active(const feature_model *model, const double place[3]);

/// Returns the height of a place over plane p.
static inline double feature_height(const feature_model *model, uint32_t p, const double place[3]) {
    const double *n = model->normal[p];
    return n[0] * place[0] + n[1] * place[1] + n[2] * place[2] - model->offset[p];
}

/// Returns the root mean square distance of the points from the quadric that fits them best, with as many
/// degrees of freedom taken off as that has; 0 for six points or less.
double ewa_feature_quadric_residual(const feature_points *points);

/// Fits an edge or a corner. `model->plane_count` is 0 when a quadric describes the points as well, when the
/// planes differ by less than the threshold, or when one has hardly any points.
///
/// Hypotheses are planes through small groups of points spread over the neighbourhood. The pair and then the
/// triple with the least truncated squares is refined by assigning points and fitting planes in turns. No
/// random numbers: the same points in the same order give the same bytes.
void ewa_feature_fit(const feature_points *points, const feature_scale *scale, feature_model *model);

/// A clip line of the active plane in world units: keep across . (x - place) + distance >= 0 for x on the
/// plane.
typedef struct feature_line {
    double across[3]; ///< unit, in the plane, towards what is kept
    double distance;  ///< from the place's foot on the plane; negative beyond the line
} feature_line;

/// Finds the lines that bound plane `active` of a model within `reach` of the foot of a place; returns how
/// many, the nearest first. `either`: one of two lines holds, not both.
uint32_t ewa_feature_lines(const feature_model *model, uint32_t active, const double place[3], double reach,
                           feature_line lines[2], bool *either);

#endif
