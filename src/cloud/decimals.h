// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Coordinates that are decimals of a few places: far from the origin, doubles hold them with an error that
// differences of them keep, unless the decimals themselves are subtracted.
#ifndef EWA_SRC_DECIMALS_H
#define EWA_SRC_DECIMALS_H

#include <stdbool.h>
#include <stdint.h>

/// Finds the smallest power of ten, 1 to 10^6, by which all of `count` numbers, `stride` doubles apart, are
/// whole; each is the double nearest to such a decimal. Numbers that are not finite do not count. Returns 0
/// when there is none.
double ewa_decimals_find(const double *numbers, uint64_t count, uint32_t stride);

/// Returns the double nearest to the difference of two such decimals; the difference of the doubles when
/// `parts` is 0.
double ewa_decimals_subtract(double number, double other, double parts);

#endif
