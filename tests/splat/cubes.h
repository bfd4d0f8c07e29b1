// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A scene cut into cubes, one source each, as levels of detail draw them.
#ifndef EWA_TESTS_SPLAT_CUBES_H
#define EWA_TESTS_SPLAT_CUBES_H

#include "splat/picture.h"
#include "surface/render.h"

enum { CUBES_MAX = 64 };

/// Surfels by cubes of a grid, without the empty ones.
typedef struct cubes {
    ewa_surfels *part[CUBES_MAX];
    uint32_t count;
} cubes;

/// Cuts a cloud into at most `per_axis`^3 <= CUBES_MAX cubes.
cubes cubes_make(const ewa_cloud *cloud, uint32_t per_axis);
void cubes_free(cubes *made);

/// The largest difference of two bytes of the colours.
uint32_t cubes_largest_step(const picture *a, const picture *b);

#endif
