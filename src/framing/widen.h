// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Smallest and largest numbers.
#ifndef EWA_SRC_FRAMING_WIDEN_H
#define EWA_SRC_FRAMING_WIDEN_H

/// Widens [*low, *high] so that it holds `number`, unless that is NaN. Inline, where fmin() and fmax() are calls.
static inline void widen(double *low, double *high, double number) {
    if (number < *low) *low = number;
    if (number > *high) *high = number;
}

#endif
