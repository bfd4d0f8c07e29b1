// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Numbers as decimal text: correctly rounded, the same in every locale, never a byte beyond the given end.
#ifndef EWA_SRC_NUMBER_H
#define EWA_SRC_NUMBER_H

#include <stddef.h>
#include <stdint.h>

/// Reads a number that starts at `text`: [+-]digits[.digits][e[+-]digits], or the words nan, inf, infinity in
/// any case, also as Windows prints them: -nan(ind), 1.#QNAN, -1.#IND, 1.#INF. Rounds to nearest even; beyond
/// the range of the type gives infinity, below it zero. Returns the first byte after the number, at most
/// `end`, or NULL when there is no number.
const char *ewa_number_read_f64(const char *text, const char *end, double *value);

/// The same, rounded once to float.
const char *ewa_number_read_f32(const char *text, const char *end, float *value);

/// The same less a whole number, |shift| < 2^53: the double nearest to the difference, rounded once, so that
/// 4200000.125 less 4200000 is what 0.125 is. Only numbers of more than 18 digits behind the point, with an
/// exponent above zero or of a difference beyond 64 bits are rounded before and after.
const char *ewa_number_read_shifted(const char *text, const char *end, int64_t shift, double *value);

/// Reads [+-]digits of at most 18 digits; NULL when there is no such integer. Stops before '.' and 'e'.
const char *ewa_number_read_i64(const char *text, const char *end, int64_t *value);

enum { EWA_NUMBER_BYTES = 32 }; ///< room that any written number fits into

/// Writes a number with as few digits as give the same number when read again; returns the count of bytes, of
/// which none is a final zero. NaN is "nan" whatever its bits.
size_t ewa_number_write_f64(double value, char text[EWA_NUMBER_BYTES]);
size_t ewa_number_write_f32(float value, char text[EWA_NUMBER_BYTES]);
size_t ewa_number_write_i64(int64_t value, char text[EWA_NUMBER_BYTES]);

#endif
