// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Decimal numbers for scales: nice steps, and their text without needless digits.
#ifndef EWA_SRC_FURNITURE_DECIMAL_H
#define EWA_SRC_FURNITURE_DECIMAL_H

#include <stdbool.h>
#include <stdint.h>

/// digits times 10^exponent.
typedef struct ewa_decimal {
    int64_t digits;
    int exponent;
} ewa_decimal;

enum { EWA_DECIMAL_BYTES = 48 };

double ewa_decimal_value(ewa_decimal number);

/// Writes a number, the same in every locale: its -exponent places behind the point; with a power of ten where that
/// would be long. Numbers of one exponent have as many places.
void ewa_decimal_write(ewa_decimal number, char text[EWA_DECIMAL_BYTES]);

/// Gives the shortest number that is within a 2^24th of a finite `value`; from 0.01 on, with at most six places behind
/// the point.
ewa_decimal ewa_decimal_near(double value);

/// Gives the largest of 1, 2 and 5 times a power of ten that is at most `maximum`; false unless that is
/// positive, finite and at least 1e-290.
bool ewa_decimal_nice(double maximum, ewa_decimal *nice);

/// Multiples of a step of 1, 2 or 5 times a power of ten: step * first to step * last.
typedef struct ewa_ticks {
    ewa_decimal step;
    int64_t first, last;
} ewa_ticks;

/// Gives the ticks within [low, high]: steps so small that there are at most `maximum` >= 1 of them between
/// the ends. False when there is none, an end is not finite, or the ends are too near to each other to be
/// told apart in so few digits.
bool ewa_ticks_find(double low, double high, uint32_t maximum, ewa_ticks *ticks);

/// Number `index` of the ticks, counted as their first and last are.
ewa_decimal ewa_ticks_at(const ewa_ticks *ticks, int64_t index);

#endif
