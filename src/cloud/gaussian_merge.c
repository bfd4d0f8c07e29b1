// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One Gaussian for several, of the same moments.
//
// Based on: B. Kerbl et al., "A Hierarchical 3D Gaussian Representation for Real-Time Rendering of Very Large Datasets", 2024,
// section 4.1 (moments weighted by opacity and area); the opacity also by the optical depths of what is behind each other.
#include "cloud/gaussian_merge.h"

#include <math.h>
#include <string.h>

/// No Gaussian takes more of the light, as it is drawn.
static const double MAX_OPACITY = 0.99;

/// The area of an ellipsoid as seen from all sides, over pi: exact for spheres, within 16 % for all (discs).
static double mean_area(const float scales[3]) {
    const double a = (double)scales[0], b = (double)scales[1], c = (double)scales[2];
    return sqrt((a * a * b * b + a * a * c * c + b * b * c * c) / 3);
}

void ewa_gaussian_weigh(const ewa_gaussians *set, size_t i, ewa_gaussian_mass *mass) {
    const double area = mean_area(set->scales + 3 * i), opacity = fmin((double)set->opacities[i], MAX_OPACITY);
    *mass = (ewa_gaussian_mass){.mass = opacity * area, .depth = -log1p(-opacity) * area};
    double axes[9];
    ewa_gaussian_axes(set->rotations + 4 * i, axes);
    for (size_t k = 0; k < 3; k++) {
        const double variance = (double)set->scales[3 * i + k] * (double)set->scales[3 * i + k];
        for (int r = 0, n = 0; r < 3; r++)
            for (int c = r; c < 3; c++) mass->covariance[n++] += variance * axes[3 * r + (int)k] * axes[3 * c + (int)k];
    }
}

/// The class of most mass, of several the first among the members.
static uint16_t heaviest_class(const ewa_gaussians *set, const uint32_t *members, const ewa_gaussian_mass *masses, uint32_t count) {
    uint16_t heaviest = set->classes[members[0]];
    double most = -1;
    for (uint32_t n = 0; n < count; n++) {
        const uint16_t own = set->classes[members[n]];
        if (n && (own == heaviest || own == set->classes[members[n - 1]])) continue; // told already
        double mass = 0;
        for (uint32_t k = 0; k < count; k++) mass += set->classes[members[k]] == own ? masses[k].mass : 0;
        if (mass > most) most = mass, heaviest = own;
    }
    return heaviest;
}

double ewa_gaussians_merge(const ewa_gaussians *set, const uint32_t *members, const ewa_gaussian_mass *masses, uint32_t count,
                           ewa_gaussians *merged, size_t to) {
    enum { NUMBERS = 3 * (EWA_MAX_SH_DEGREE + 1) * (EWA_MAX_SH_DEGREE + 1) };
    const size_t numbers = 3 * (size_t)(set->sh_degree + 1) * (set->sh_degree + 1);
    double mass = 0, depth = 0, center[3] = {0}, harmonics[NUMBERS] = {0}, covariance[6] = {0}, apart2 = 0;
    for (uint32_t n = 0; n < count; n++) {
        const float *at = set->centers + 3 * (size_t)members[n], *color = set->harmonics + numbers * members[n];
        mass += masses[n].mass, depth += masses[n].depth;
        for (size_t k = 0; k < 3; k++) center[k] += masses[n].mass * (double)at[k];
        for (size_t k = 0; k < numbers; k++) harmonics[k] += masses[n].mass * (double)color[k];
    }
    // What has no mass is not drawn, whatever the rest.
    const double share = mass > 0 ? 1 / mass : 0;
    for (size_t k = 0; k < 3; k++) center[k] = mass > 0 ? center[k] * share : (double)set->centers[3 * (size_t)members[0] + k];
    for (uint32_t n = 0; n < count; n++) {
        const float *at = set->centers + 3 * (size_t)members[n];
        const double weight = share * masses[n].mass,
                     off[3] = {(double)at[0] - center[0], (double)at[1] - center[1], (double)at[2] - center[2]};
        for (int r = 0, k = 0; r < 3; r++)
            for (int c = r; c < 3; c++, k++) covariance[k] += weight * (masses[n].covariance[k] + off[r] * off[c]);
        apart2 += weight * (off[0] * off[0] + off[1] * off[1] + off[2] * off[2]);
    }
    const double *v = covariance;
    double columns[3][3] = {{v[0], v[1], v[2]}, {v[1], v[3], v[4]}, {v[2], v[4], v[5]}};
    float *scales = merged->scales + 3 * to;
    memcpy(merged->rotations + 4 * to, set->rotations + 4 * (size_t)members[0], 4 * sizeof(float));
    ewa_gaussian_of_columns(columns, scales, merged->rotations + 4 * to);
    for (size_t k = 0; k < 3; k++) {
        merged->centers[3 * to + k] = (float)center[k];
        scales[k] = sqrtf(scales[k]); // variances
    }
    for (size_t k = 0; k < numbers; k++) merged->harmonics[numbers * to + k] = (float)(harmonics[k] * share);
    if (merged->classes) merged->classes[to] = heaviest_class(set, members, masses, count);
    const double area = mean_area(scales);
    merged->opacities[to] = area > 0 ? (float)fmin(mass / area, -expm1(-depth / area)) : 0;
    return apart2;
}
