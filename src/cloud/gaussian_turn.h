// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Turning and mirroring of functions on the sphere that are given by real harmonics.
#ifndef EWA_SRC_GAUSSIAN_TURN_H
#define EWA_SRC_GAUSSIAN_TURN_H

#include "ewa/gaussian.h"

enum { EWA_MAX_SH_ROW = 2 * EWA_MAX_SH_DEGREE + 1 };

/// Maps of the coefficients of each degree beside 0, row-major, square: new ones = map * old ones.
typedef struct ewa_sh_turn {
    double map[EWA_MAX_SH_DEGREE][EWA_MAX_SH_ROW * EWA_MAX_SH_ROW]; ///< [degree - 1], 2 degree + 1 rows
} ewa_sh_turn;

/// Finds the maps after which a function has in direction turn * d the value that it had in d. `turn` is
/// orthogonal, row-major.
void ewa_sh_turn_make(const double turn[9], ewa_sh_turn *made);

/// Maps (degree + 1)^2 coefficients of red, green and blue.
void ewa_sh_turn_apply(const ewa_sh_turn *turn, uint32_t sh_degree, float *harmonics);

/// The real harmonics in a unit direction, in the order and with the signs of 3DGS: (degree + 1)^2 values.
void ewa_sh_values(const double direction[3], uint32_t sh_degree, double *values);

#endif
