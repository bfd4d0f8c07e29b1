// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Numbers by their rank: medians, percentiles, least and greatest.
#ifndef EWA_CLI_RANK_H
#define EWA_CLI_RANK_H

#include <stddef.h>

/// Returns the number that would be at place `rank` in [0, count) if the numbers, of which none is NaN, were
/// sorted; shuffles and overwrites them.
double rank_select(double *numbers, size_t count, size_t rank);

/// Widens [*low, *high] so that it holds `number`, unless that is NaN. Inline, where fmin() and fmax() are calls.
static inline void rank_widen(double *low, double *high, double number) {
    if (number < *low) *low = number;
    if (number > *high) *high = number;
}

#endif
