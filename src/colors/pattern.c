// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Marble, wood and noise under a Gaussian: all are made of waves, whose means are known.
//
// A wave a cos(2 pi (k.x + phase)) under a Gaussian of covariance Sigma has the mean exp(-2 pi^2 k Sigma k')
// times itself. Noise is a sum of such waves with random directions. Marble and wood are periodic functions
// of a phase that noise bends: each harmonic m of the function has the mean exp(-2 pi^2 m^2 V) times itself,
// V being the variance of the phase under the footprint: that of its linear part, g Sigma g' with g its
// gradient, and that of the waves of the noise which the footprint averages out.
//
// Based on K. Perlin, "An image synthesizer", 1985 (marble), and J. P. Lewis, "Algorithms for solid noise
// synthesis", 1989, section 3 (noise by its spectrum).
#include "colors/pattern.h"
#include "math/gaussian.h"
#include "math/wave.h"

#include <math.h>

static const double TWO_PI = 6.283185307179586;
static const double TWO_PI_SQUARED = 19.739208802178716;

/// Uniform in [0, 1), one after another (splitmix64 of S. Vigna, 2015).
static double next_uniform(uint64_t *state) {
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/// Fills a field with octaves from `frequency` up, each `gain` times as strong as the one before; `stretch`
/// multiplies the wave vectors per axis.
static void make_noise(uint64_t seed, double frequency, double gain, ewa_vec3 stretch, pattern_noise *noise) {
    uint64_t state = seed;
    double variance = 0, amplitude = 1;
    pattern_wave *wave = noise->waves;
    for (int octave = 0; octave < PATTERN_OCTAVES; octave++, frequency *= 2, amplitude *= gain)
        for (int i = 0; i < PATTERN_OCTAVE_WAVES; i++, wave++) {
            ewa_vec3 k;
            double length2;
            do {
                k.x = 2 * next_uniform(&state) - 1;
                k.y = 2 * next_uniform(&state) - 1;
                k.z = 2 * next_uniform(&state) - 1;
                length2 = vec3_dot(k, k);
            } while (length2 > 1 || length2 < 0.01);
            const double length = frequency * (0.7 + 0.7 * next_uniform(&state)) / sqrt(length2);
            wave->k = vec3_make(k.x * length * stretch.x, k.y * length * stretch.y, k.z * length * stretch.z);
            wave->phase = next_uniform(&state);
            wave->amplitude = amplitude;
            variance += 0.5 * amplitude * amplitude;
        }
    for (int i = 0; i < PATTERN_OCTAVES * PATTERN_OCTAVE_WAVES; i++)
        noise->waves[i].amplitude /= sqrt(variance);
}

/// A field under a footprint.
typedef struct noise_mean {
    double value, lost; // mean; variance that the footprint has averaged out
    ewa_vec3 gradient;  // of the mean
} noise_mean;

static noise_mean mean_of_noise(const pattern_noise *noise, const pattern_footprint *footprint) {
    noise_mean mean = {0};
    for (int i = 0; i < PATTERN_OCTAVES * PATTERN_OCTAVE_WAVES; i++) {
        const pattern_wave *wave = &noise->waves[i];
        const double a = vec3_dot(wave->k, footprint->u), b = vec3_dot(wave->k, footprint->v),
                     left = ewa_exp(-TWO_PI_SQUARED * (a * a + b * b)), amplitude = left * wave->amplitude;
        mean.lost += 0.5 * wave->amplitude * wave->amplitude * (1 - left * left);
        if (left < 1e-6) continue;
        const double turns = vec3_dot(wave->k, footprint->place) + wave->phase;
        mean.value += amplitude * ewa_wave(turns);
        // The derivative of cos is -sin, a quarter of a turn ahead.
        mean.gradient =
            vec3_add(mean.gradient, vec3_scale(wave->k, TWO_PI * amplitude * ewa_wave(turns + 0.25)));
    }
    return mean;
}

/// Coefficients of a function of period 1 from 64 samples; higher harmonics are damped so that a jump does
/// not ring (C. Lanczos' sigma factors).
static void make_profile(const double samples[64], pattern_profile *profile) {
    *profile = (pattern_profile){0};
    for (int i = 0; i < 64; i++) profile->mean += samples[i] / 64;
    for (int m = 1; m <= PATTERN_HARMONICS; m++) {
        const double part = (double)m / (PATTERN_HARMONICS + 1),
                     sigma = ewa_wave(0.5 * part - 0.25) / (0.5 * TWO_PI * part);
        for (int i = 0; i < 64; i++) {
            profile->cosine[m - 1] += sigma * samples[i] * ewa_wave(m * i / 64.0) / 32;
            profile->sine[m - 1] += sigma * samples[i] * ewa_wave(m * i / 64.0 - 0.25) / 32;
        }
    }
}

static double mean_of_profile(const pattern_profile *profile, double turns, double variance) {
    double mean = profile->mean;
    for (int m = 1; m <= PATTERN_HARMONICS; m++) {
        const double exponent = TWO_PI_SQUARED * m * m * variance;
        if (exponent > 20) break;
        mean += ewa_exp(-exponent) * (profile->cosine[m - 1] * ewa_wave(m * turns) +
                                      profile->sine[m - 1] * ewa_wave(m * turns - 0.25));
    }
    return mean;
}

/// A profile of linear.x + bend noise under a footprint.
static double mean_of_bands(const pattern_profile *profile, double linear, ewa_vec3 gradient, double bend,
                            const noise_mean *noise, const pattern_footprint *footprint) {
    const ewa_vec3 g = vec3_add(gradient, vec3_scale(noise->gradient, bend));
    const double a = vec3_dot(g, footprint->u), b = vec3_dot(g, footprint->v);
    return mean_of_profile(profile, linear + bend * noise->value, a * a + b * b + bend * bend * noise->lost);
}

/// Veins of two directions, and clouds.
static double mean_of_marble(const pattern *self, const pattern_footprint *footprint) {
    static const struct {
        double x, y, z, bend, share;
    } veins[] = {{0.62, 0.47, 0.63, 0.42, 0.62}, {-0.35, 0.49, 0.24, 0.34, 0.26}};
    const noise_mean noise = mean_of_noise(&self->noise, footprint);
    double mean = 0.06 + 0.03 * noise.value;
    for (int i = 0; i < 2; i++) {
        const ewa_vec3 gradient = vec3_scale(vec3_make(veins[i].x, veins[i].y, veins[i].z), self->frequency);
        mean += veins[i].share * mean_of_bands(&self->profile, vec3_dot(gradient, footprint->place), gradient,
                                               veins[i].bend, &noise, footprint);
    }
    return mean;
}

/// Rings about the z axis, and fibres along it.
static double mean_of_wood(const pattern *self, const pattern_footprint *footprint) {
    const ewa_vec3 p = footprint->place;
    const double radius = sqrt(p.x * p.x + p.y * p.y);
    const ewa_vec3 outward = radius > 0 ? vec3_make(p.x / radius, p.y / radius, 0) : vec3_make(0, 0, 0);
    const noise_mean noise = mean_of_noise(&self->noise, footprint),
                     grain = mean_of_noise(&self->grain, footprint);
    const double rings = mean_of_bands(&self->profile, self->frequency * radius,
                                       vec3_scale(outward, self->frequency), 0.5, &noise, footprint);
    return 0.85 * rings + 0.08 + 0.045 * grain.value;
}

void ewa_pattern_make(const ewa_procedure_options *options, pattern *made) {
    const double f = options->frequency;
    *made = (pattern){.procedure = options->procedure, .frequency = f};
    double samples[64];
    const bool wood = options->procedure == EWA_PROCEDURE_WOOD;
    for (int i = 0; i < 64; i++) {
        // Late wood grows dark slowly and ends at once; veins are thin.
        const double late = (i / 64.0) * (i / 64.0) * (i / 64.0), crest = 0.5 + 0.5 * ewa_wave(i / 64.0);
        samples[i] = wood ? late : crest * crest * crest * crest * crest * crest;
    }
    make_profile(samples, &made->profile);
    const ewa_vec3 even = vec3_make(1, 1, 1);
    if (wood) {
        make_noise(options->seed, 0.12 * f, 0.4, vec3_make(1, 1, 0.3), &made->noise);
        make_noise(options->seed + 1, 4 * f, 0.55, vec3_make(1, 1, 0.04), &made->grain);
    } else {
        make_noise(options->seed, options->procedure == EWA_PROCEDURE_MARBLE ? 0.5 * f : f, 0.55, even,
                   &made->noise);
    }
}

double ewa_pattern_mean(const pattern *self, const pattern_footprint *footprint) {
    double mean;
    if (self->procedure == EWA_PROCEDURE_CHECKER) {
        const double f = self->frequency;
        const pattern_footprint in_cells = {vec3_scale(footprint->place, f), vec3_scale(footprint->u, f),
                                            vec3_scale(footprint->v, f)};
        mean = 0.5 - 0.5 * ewa_pattern_checker(&in_cells);
    } else if (self->procedure == EWA_PROCEDURE_MARBLE) {
        mean = mean_of_marble(self, footprint);
    } else if (self->procedure == EWA_PROCEDURE_WOOD) {
        mean = mean_of_wood(self, footprint);
    } else {
        mean = 0.5 + 0.17 * mean_of_noise(&self->noise, footprint).value;
    }
    return mean < 0 ? 0 : mean > 1 ? 1 : mean;
}
