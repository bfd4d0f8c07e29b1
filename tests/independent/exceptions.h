// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scenes whose pipeline is below 45 dB, and why.
#ifndef EWA_TESTS_EXCEPTIONS_H
#define EWA_TESTS_EXCEPTIONS_H

#include "tests/independent/random_scene.h"

typedef enum scene_reason {
    /// Whether a surfel ends or hides another at a pixel is within rounding there, and all of the pixel's
    /// colour hangs
    /// on it: hard edges, one pass, sheets that meet. Elsewhere the limit holds.
    SCENE_DECISIONS,
} scene_reason;

typedef struct scene_exception {
    const char *set; ///< "random" or "named"
    uint64_t number;
    scene_reason reason;
} scene_exception;

static const scene_exception scene_exceptions[] = {
    {"random", 8, SCENE_DECISIONS},   {"random", 85, SCENE_DECISIONS},  {"random", 127, SCENE_DECISIONS},
    {"random", 334, SCENE_DECISIONS}, {"random", 434, SCENE_DECISIONS}, {"random", 454, SCENE_DECISIONS},
    {"random", 547, SCENE_DECISIONS}, {"random", 649, SCENE_DECISIONS}, {"random", 830, SCENE_DECISIONS},
    {"random", 895, SCENE_DECISIONS},
};

#endif
