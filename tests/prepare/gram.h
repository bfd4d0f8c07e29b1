// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Systems to solve: inner products of Gaussians at scattered points of the plane.
#ifndef EWA_TESTS_GRAM_H
#define EWA_TESTS_GRAM_H

#include "check.h"
#include "colors/sparse.h"

#include <math.h>

/// A matrix with memory of its own.
typedef struct owned {
    ewa_sparse view;
    uint64_t *row_starts;
    uint32_t *columns;
    double *values;
} owned;

static inline void owned_free(owned *matrix) {
    free(matrix->row_starts);
    free(matrix->columns);
    free(matrix->values);
}

/// The inner products of Gaussians of deviation `sigma` at the jittered points of a side x side grid.
static inline owned make_gram(uint32_t side, double sigma) {
    const uint32_t size = side * side;
    const int reach = 1 + (int)ceil(6 * sigma);
    check_random random = {7};
    OWNED(check_free) double *at = malloc(2 * (size_t)size * sizeof *at);
    const size_t maximum = (size_t)size * (size_t)((2 * reach + 1) * (2 * reach + 1));
    owned made = {.row_starts = malloc((size + 1) * sizeof(uint64_t)),
                  .columns = malloc(maximum * sizeof(uint32_t)),
                  .values = malloc(maximum * sizeof(double))};
    assert_true(at && made.row_starts && made.columns && made.values);
    for (uint32_t i = 0; i < size; i++) {
        at[2 * i] = i % side + check_uniform(&random, -0.3, 0.3);
        at[2 * i + 1] = i / side + check_uniform(&random, -0.3, 0.3);
    }
    uint64_t entries = 0;
    for (uint32_t i = 0; i < size; i++) {
        made.row_starts[i] = entries;
        for (int dy = -reach; dy <= reach; dy++)
            for (int dx = -reach; dx <= reach; dx++) {
                const int x = (int)(i % side) + dx, y = (int)(i / side) + dy;
                if (x < 0 || y < 0 || x >= (int)side || y >= (int)side) continue;
                const uint32_t j = (uint32_t)y * side + (uint32_t)x;
                const double d2 = pow(at[2 * i] - at[2 * j], 2) + pow(at[2 * i + 1] - at[2 * j + 1], 2);
                if (d2 > 36 * sigma * sigma) continue;
                made.columns[entries] = j;
                made.values[entries++] = exp(-d2 / (4 * sigma * sigma));
            }
    }
    made.row_starts[size] = entries;
    made.view = (ewa_sparse){size, made.row_starts, made.columns, made.values};
    return made;
}

/// Right sides whose solution is known, by a product.
static inline double *make_sides(const ewa_sparse *matrix, uint32_t side_count, double **truth) {
    check_random random = {11};
    const size_t count = (size_t)matrix->size * side_count;
    *truth = malloc(count * sizeof(double));
    double *sides = calloc(count, sizeof(double));
    assert_true(*truth && sides);
    for (size_t i = 0; i < count; i++) (*truth)[i] = check_uniform(&random, -1, 1);
    for (uint32_t row = 0; row < matrix->size; row++)
        for (uint64_t k = matrix->row_starts[row]; k < matrix->row_starts[row + 1]; k++)
            for (uint32_t s = 0; s < side_count; s++)
                sides[(size_t)row * side_count + s] +=
                    matrix->values[k] * (*truth)[(size_t)matrix->columns[k] * side_count + s];
    return sides;
}

#endif
