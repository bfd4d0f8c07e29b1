// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Axes of Gaussians that point the other way: what that changes are signs, so nothing is rounded.
#include "io/gaussian/gaussian.h"

#include <stdlib.h>

static const int HALF_TURN[3] = {1, -1, -1}; // about x: right, up, back for right, down, front

/// In x, in y and in z a harmonic is even or odd.
static int sign_of_harmonic(uint32_t number, const int sign[3]) {
    uint32_t degree = 0;
    while (ewa_sh_count(degree) <= number) degree++;
    const int order = (int)number - (int)(degree * degree + degree), size = abs(order);
    const bool odd_y = order < 0, odd_z = ((int)degree - size) % 2, odd_x = (size % 2) != odd_y;
    return (odd_x ? sign[0] : 1) * (odd_y ? sign[1] : 1) * (odd_z ? sign[2] : 1);
}

static void make_signs(const int sign[3], ewa_gaussian_signs *signs) {
    for (int k = 0; k < 3; k++) {
        signs->center[k] = (float)sign[k];
        // Of a turn about an axis, the axes beside it count.
        signs->rotation[k] = (float)(sign[(k + 1) % 3] * sign[(k + 2) % 3]);
    }
    for (uint32_t n = 0; n < EWA_SH_ROOM; n++) signs->harmonics[n] = (float)sign_of_harmonic(n, sign);
}

void ewa_gaussian_signs_turn(ewa_gaussian_signs *signs) { make_signs(HALF_TURN, signs); }

void ewa_gaussians_mirror(ewa_gaussians *set, const int sign[3]) {
    const uint32_t coefficients = ewa_sh_count(set->sh_degree);
    ewa_gaussian_signs signs;
    make_signs(sign, &signs);
    for (size_t i = 0; i < set->count; i++) {
        for (size_t k = 0; k < 3; k++) {
            set->centers[3 * i + k] *= signs.center[k];
            set->rotations[4 * i + 1 + k] *= signs.rotation[k];
        }
        float *harmonics = set->harmonics + 3 * i * coefficients;
        for (size_t n = 0; n < coefficients; n++)
            for (size_t k = 0; k < 3; k++) harmonics[3 * n + k] *= signs.harmonics[n];
    }
    for (int k = 0; k < 3; k++) set->origin[k] *= sign[k];
}

void ewa_gaussians_turn(ewa_gaussians *set) { ewa_gaussians_mirror(set, HALF_TURN); }
