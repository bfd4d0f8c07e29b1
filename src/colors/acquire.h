// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Textures onto surfels, inner side: surfels with their charts, and what two kernels have to do with each
// other.
#ifndef EWA_SRC_COLORS_ACQUIRE_H
#define EWA_SRC_COLORS_ACQUIRE_H

#include "ewa/acquire.h"
#include "homogeneous/vec.h"
#include "image/texture.h"

enum { EWA_ACQUIRE_NO_TEXTURE = UINT32_MAX };

/// A surfel on a picture. Positions are relative to the cloud's origin, world units.
typedef struct ewa_acquire_point {
    double place[3];
    float normal[3], axis[2][3]; ///< axes one standard deviation long; all zero: no surfel
    float side[2][4];            ///< half spaces that keep: s[0..2] . (x - place) + s[3] >= 0, s[0..2] unit
    uint32_t side_count, part;
    uint32_t texture;     ///< EWA_ACQUIRE_NO_TEXTURE: white
    double at_px[2];      ///< on the picture, y down
    float gradient[2][3]; ///< of at_px, per world unit
    float tint[4];        ///< premultiplied
} ewa_acquire_point;

/// The surfels of a cloud along the Z-order curve, with their pictures.
typedef struct ewa_acquire_set {
    ewa_context *context;
    uint32_t count, texture_count;
    bool has_parts;  ///< parts, and not clip lines, tell who interacts
    uint32_t *order; ///< by place along the curve: point of the cloud
    ewa_acquire_point *points;
    ewa_texture *textures;
    double cutoff, pixel_variance_px2;
    double usual_sigma_world; ///< of the longer axes; also the thickness of all kernels
} ewa_acquire_set;

/// A plane through two kernels, and their product in it: a Gaussian of its own.
typedef struct ewa_acquire_pair {
    ewa_vec3 axis[2];  ///< orthonormal, of the plane
    double between[2]; ///< from the first centre to the second
    double integral;   ///< of the product, world^2: <r_k, r_j>
    double exponent;   ///< integral is its greatest, at distance 0, times exp(-exponent)
    double mean[2];    ///< of the product, from the first centre
    double xx, xy, yy; ///< its covariance
} ewa_acquire_pair;

/// Multiplies two kernels of peak 1; mean and covariance are cut by the half spaces of both. Always in
/// the same order, so that rounding does not depend on who asks. `a` may be `b`.
void ewa_acquire_multiply(const ewa_acquire_set *set, const ewa_acquire_point *a, const ewa_acquire_point *b,
                          ewa_acquire_pair *pair);

/// One kernel alone: its integral, mean and covariance; the latter two are cut.
void ewa_acquire_single(const ewa_acquire_point *point, ewa_acquire_pair *pair);

/// Mean of the texture under one kernel, times the point's tint; premultiplied.
void ewa_acquire_look(const ewa_acquire_set *set, const ewa_acquire_point *point,
                      const ewa_acquire_pair *alone, double color[4]);

/// The same under the product of two kernels, `a` the first of the pair. Where both are on one piece of the
/// picture, the chart between them is interpolated; else it is the mean of what both say, and
/// by how much they disagree is returned.
double ewa_acquire_look_between(const ewa_acquire_set *set, const ewa_acquire_point *a,
                                const ewa_acquire_point *b, const ewa_acquire_pair *pair, double color[4]);

/// Finds pairs that interact.
typedef struct ewa_acquire_grid {
    const ewa_acquire_set *set;
    double cell_world, low[3];
    uint32_t *first; ///< by hash of a cell: bucket_count + 1 sums
    uint32_t *entry; ///< points, ascending in each bucket
    size_t bucket_count;
} ewa_acquire_grid;

enum { EWA_ACQUIRE_MAX_PAIRS = 4000 };

/// Errors: EWA_ERROR_MEMORY.
ewa_status ewa_acquire_grid_make(const ewa_acquire_set *set, ewa_acquire_grid *grid);
void ewa_acquire_grid_free(ewa_acquire_grid *grid);

/// Writes the points that interact with a point, itself among them, ascending, to `others`
/// (EWA_ACQUIRE_MAX_PAIRS; may be NULL) and returns how many there are; at most EWA_ACQUIRE_MAX_PAIRS + 1 are
/// counted. Interaction is mutual. Any thread.
uint32_t ewa_acquire_find(const ewa_acquire_grid *grid, uint32_t point, uint32_t *others);

/// Replaces the filtered colours, 4 per point, premultiplied, by optimal ones. Errors: EWA_ERROR_LIMIT,
/// EWA_ERROR_NUMERIC, EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_acquire_optimize(const ewa_acquire_set *set, const ewa_acquire_options *options,
                                uint32_t channel_count, double (*colors)[4], ewa_acquire_report *report);

#endif
