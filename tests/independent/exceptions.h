// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scenes whose road is below 45 dB, and why.
#ifndef EWA_TESTS_EXCEPTIONS_H
#define EWA_TESTS_EXCEPTIONS_H

#include "tests/independent/random_scene.h"

typedef enum scene_reason {
    /// Whether a surfel ends or hides another at a pixel is within rounding there, and all of the pixel's
    /// colour hangs
    /// on it: hard edges, one pass, sheets that meet. Elsewhere the limit holds.
    SCENE_DECISIONS,
    /// One scale for the colours of a cloud: a bright one takes the others' precision.
    SCENE_BRIGHT,
    /// Positions are floats about one origin, and numbers of the camera are squared in single precision.
    SCENE_RANGE,
} scene_reason;

typedef struct scene_exception {
    const char *set; ///< "random" or "named"
    uint64_t number;
    scene_reason reason;
} scene_exception;

static const scene_exception scene_exceptions[] = {
    {"random", 8, SCENE_DECISIONS},   {"random", 85, SCENE_DECISIONS},  {"random", 97, SCENE_BRIGHT},
    {"random", 127, SCENE_DECISIONS}, {"random", 217, SCENE_BRIGHT},    {"random", 256, SCENE_BRIGHT},
    {"random", 274, SCENE_BRIGHT},    {"random", 307, SCENE_BRIGHT},    {"random", 321, SCENE_DECISIONS},
    {"random", 323, SCENE_BRIGHT},    {"random", 339, SCENE_BRIGHT},    {"random", 350, SCENE_BRIGHT},
    {"random", 357, SCENE_BRIGHT},    {"random", 415, SCENE_DECISIONS}, {"random", 434, SCENE_DECISIONS},
    {"random", 454, SCENE_DECISIONS}, {"random", 461, SCENE_BRIGHT},    {"random", 485, SCENE_BRIGHT},
    {"random", 509, SCENE_BRIGHT},    {"random", 532, SCENE_BRIGHT},    {"random", 539, SCENE_BRIGHT},
    {"random", 551, SCENE_BRIGHT},    {"random", 644, SCENE_BRIGHT},    {"random", 672, SCENE_BRIGHT},
    {"random", 694, SCENE_DECISIONS}, {"random", 845, SCENE_BRIGHT},    {"random", 867, SCENE_BRIGHT},
    {"random", 869, SCENE_BRIGHT},    {"random", 876, SCENE_BRIGHT},    {"random", 885, SCENE_BRIGHT},
    {"random", 894, SCENE_BRIGHT},    {"random", 895, SCENE_DECISIONS}, {"random", 978, SCENE_BRIGHT},
    {"named", 3, SCENE_BRIGHT},       {"named", 6, SCENE_RANGE},        {"named", 8, SCENE_RANGE},
    {"named", 9, SCENE_RANGE},        {"named", 10, SCENE_RANGE},       {"named", 11, SCENE_RANGE},
};

#endif
