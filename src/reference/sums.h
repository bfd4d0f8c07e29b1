// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What gathers of one surface at a pixel in the reference, and what it comes to (docs/math.md sections 6 to
// 8; semantics.h: facing, clip lines, resolve).
#ifndef EWA_SRC_REFERENCE_SUMS_H
#define EWA_SRC_REFERENCE_SUMS_H

#include "reference/splat.h"

/// Sums over splats.
typedef struct ewa_reference_sums {
    double weight;  ///< q
    ewa_vec3 color; ///< weighted by opacity too
    ewa_vec3 normal_world;
    double z, opacity;
    double material[5]; ///< ambient, diffuse, specular, shininess, reflection
} ewa_reference_sums;

/// Sums over the splats that a clip line cuts at the pixel, as far as it does.
typedef struct ewa_reference_cut {
    double kept;      ///< of weights
    double whole;     ///< of weights over shares
    double inward[2]; ///< of the latter times ewa_reference_sample.inward
} ewa_reference_cut;

/// A surface at a pixel.
typedef struct ewa_reference_gathered {
    ewa_reference_sums facing, is_back; ///< splats that face the viewer; those that face away
    ewa_reference_cut cut;
} ewa_reference_gathered;

/// Adds a splat with what it shows, `weight` in all but for its weight. `material` as in ewa_reference_sums.
void ewa_reference_gather(ewa_reference_gathered *to, const ewa_reference_splat *splat,
                          const ewa_reference_sample *sample, double weight, double opacity,
                          const float material[5]);

/// Returns the sums that the pixel shows; `merged`: of all surfaces that are left, not of one.
ewa_reference_sums ewa_reference_settle(const ewa_reference_gathered *surface, double unit_coverage,
                                        bool merged);

/// What a surface covers of a pixel.
typedef struct ewa_reference_cover {
    double share;     ///< [0, 1]
    double whole;     ///< what it would be without clip lines
    double inward[2]; ///< mean direction in which clip lines keep its splats; 0 without lines
} ewa_reference_cover;

/// `threshold` is tau.
ewa_reference_cover ewa_reference_cover_of(const ewa_reference_gathered *surface, double unit_coverage,
                                           double threshold, bool merged);

/// Returns what a surface covers of the part of the pixel that the first one leaves open.
double ewa_reference_cover_behind(const ewa_reference_cover *first, const ewa_reference_cover *behind);

#endif
