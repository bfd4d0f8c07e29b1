// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Boxes along the axes.
#ifndef EWA_SRC_MATH_BOX_H
#define EWA_SRC_MATH_BOX_H

#include <math.h>

/// Puts a finite box around what an affine map (row by row) makes of it.
static inline void ewa_box_transform(const double map[16], double low[3], double high[3]) {
    const double from_low[3] = {low[0], low[1], low[2]}, from_high[3] = {high[0], high[1], high[2]};
    for (int r = 0; r < 3; r++) {
        low[r] = high[r] = map[4 * r + 3];
        for (int c = 0; c < 3; c++) {
            const double a = map[4 * r + c] * from_low[c], b = map[4 * r + c] * from_high[c];
            low[r] += fmin(a, b);
            high[r] += fmax(a, b);
        }
    }
}

#endif
