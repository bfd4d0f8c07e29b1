// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Solid patterns and their means under a Gaussian that lies in a plane.
#ifndef EWA_SRC_COLORS_PATTERN_H
#define EWA_SRC_COLORS_PATTERN_H

#include "ewa/procedure.h"
#include "homogeneous/vec.h"

enum {
    PATTERN_OCTAVES = 5,
    PATTERN_OCTAVE_WAVES = 14,
    PATTERN_HARMONICS = 8,
};

/// Where a pattern is asked for: the Gaussian s u + t v around a place, s and t normal.
typedef struct pattern_footprint {
    ewa_vec3 place, u, v;
} pattern_footprint;

/// a cos(2 pi (k.x + phase)).
typedef struct pattern_wave {
    ewa_vec3 k; // turns per unit
    double phase, amplitude;
} pattern_wave;

/// A random field of variance 1 and mean 0, close to Gaussian.
typedef struct pattern_noise {
    pattern_wave waves[PATTERN_OCTAVES * PATTERN_OCTAVE_WAVES];
} pattern_noise;

/// A periodic function of one number, period 1: mean + sum of cosines and sines.
typedef struct pattern_profile {
    double mean, cosine[PATTERN_HARMONICS], sine[PATTERN_HARMONICS];
} pattern_profile;

typedef struct pattern {
    ewa_procedure procedure;
    double frequency;
    pattern_noise noise, grain;
    pattern_profile profile;
} pattern;

/// Prepares a pattern. `options` are checked ones.
void ewa_pattern_make(const ewa_procedure_options *options, pattern *made);

/// Mean of the pattern, [0, 1], under a footprint.
double ewa_pattern_mean(const pattern *pattern, const pattern_footprint *footprint);

/// Mean of (-1)^(floor x + floor y + floor z) under a footprint.
double ewa_pattern_checker(const pattern_footprint *footprint);

#endif
