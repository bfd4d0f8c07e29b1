// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A square that is sampled in several ways.
#ifndef EWA_TESTS_SQUARE_H
#define EWA_TESTS_SQUARE_H

#include "prepare/check_prepare.h"

typedef enum sampling { REGULAR, JITTERED, SCATTERED, HEXAGONAL, POISSON, STRETCHED, SAMPLINGS } sampling;

static const double TURN = 0.4;  // of the stretched grid
static const double STRETCH = 3; // of its cells

/// Samples a square of SIDE x SIDE with one sample per unit area, seen from above; returns the count.
enum { SIDE = 80, MAXIMUM = SIDE * SIDE * 5 / 4 };

static inline uint32_t sample_square(sampling kind, float *xyz) {
    check_random random = {(uint64_t)kind + 1};
    uint32_t n = 0;
    const double hex = sqrt(2 / sqrt(3)), rows = hex * sqrt(0.75), longer = sqrt(STRETCH),
                 shorter = 1 / longer;
    for (int i = -2 * SIDE; i < 2 * SIDE; i++) {
        for (int j = -2 * SIDE; j < 2 * SIDE; j++) {
            double x = i + 0.5, y = j + 0.5;
            const double jitter = kind == JITTERED ? 0.5 : kind == SCATTERED ? 1 : 0;
            x += jitter * check_uniform(&random, -0.5, 0.5);
            y += jitter * check_uniform(&random, -0.5, 0.5);
            if (kind == HEXAGONAL) x = (i + 0.5 * (j & 1)) * hex, y = j * rows;
            if (kind == STRETCHED) {
                x = (cos(TURN) * i * longer - sin(TURN) * j * shorter) + SIDE / 2.0;
                y = (sin(TURN) * i * longer + cos(TURN) * j * shorter) + SIDE / 2.0;
            }
            if (kind == POISSON)
                x = check_uniform(&random, -2 * SIDE, 2 * SIDE),
                y = check_uniform(&random, -2 * SIDE, 2 * SIDE);
            if (x < 0 || y < 0 || x >= SIDE || y >= SIDE) continue;
            assert_true(n < MAXIMUM);
            xyz[3 * n] = (float)x;
            xyz[3 * n + 1] = (float)y;
            xyz[3 * n++ + 2] = 0;
        }
    }
    return n;
}

#endif
