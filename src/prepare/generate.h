// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Test objects, inner side: a block of cells that an object turns into points, random bits, sine and cosine.
//
// Everything here is plain IEEE arithmetic (no libm call but sqrt), so that the bytes are the same on every
// machine.
#ifndef EWA_SRC_PREPARE_GENERATE_H
#define EWA_SRC_PREPARE_GENERATE_H

#include "ewa/prepare.h"

#include <math.h>

enum { EWA_GENERATE_BLOCK = 64, EWA_TERRAIN_MAX_OCTAVES = 11 };

/// Major and minor radius of the torus whose outer radius is 1.
#define EWA_TORUS_MAJOR (5.0 / 7.0)
#define EWA_TORUS_MINOR (2.0 / 7.0)

/// Cells of one row of one patch, and the points that the object puts there. Lengths are in units of
/// size_world.
typedef struct ewa_generate_block {
    uint32_t count;
    uint32_t patch;                  ///< cube: face 0 to 5 (-x +x -y +y -z +z); else 0
    double u[EWA_GENERATE_BLOCK];    ///< in: place along the row, [0, 1]
    double v[EWA_GENERATE_BLOCK];    ///< in: place across the rows, [0, 1]; areas on the surface are equal in
                                     ///< (u, v)
    float grain[EWA_GENERATE_BLOCK]; ///< in: independent uniform numbers, [-1, 1)
    double spacing;                  ///< in: square root of a cell's share of the area
    double position[EWA_GENERATE_BLOCK][3];
    double normal[EWA_GENERATE_BLOCK][3]; ///< out: unit
    float color[EWA_GENERATE_BLOCK][3];   ///< out: sRGB, 0 to 255
    double radius[EWA_GENERATE_BLOCK];    ///< out: local spacing
} ewa_generate_block;

/// One octave of the terrain's noise: lattice coordinates (xx x + xy y + x0, yx x + yy y + y0) of (x, y) in
/// [0, 1]^2.
typedef struct ewa_terrain_octave {
    float xx, xy, x0, yx, yy, y0;
    uint32_t key;
} ewa_terrain_octave;

typedef struct ewa_terrain {
    uint32_t octave_count;
    ewa_terrain_octave octaves[EWA_TERRAIN_MAX_OCTAVES];
} ewa_terrain;

/// Heights (units of size_world, may be under water: < 0) with their derivatives by x and y, and a texture
/// number of about [-1, 1], at `count` <= EWA_GENERATE_BLOCK places in [0, 1]^2.
typedef struct ewa_terrain_heights {
    float height[EWA_GENERATE_BLOCK], by_x[EWA_GENERATE_BLOCK], by_y[EWA_GENERATE_BLOCK];
    float texture[EWA_GENERATE_BLOCK];
} ewa_terrain_heights;

/// Chooses the octaves: none is finer than two samples of a grid of `point_count` points.
void ewa_terrain_init(ewa_terrain *terrain, uint64_t seed, uint64_t point_count);
void ewa_terrain_evaluate(const ewa_terrain *terrain, uint32_t count, const double *x, const double *y,
                          ewa_terrain_heights *heights);

void ewa_generate_plane(ewa_generate_block *block);
void ewa_generate_checker(ewa_generate_block *block, double checks);
void ewa_generate_cube(ewa_generate_block *block, double checks);
void ewa_generate_sphere(ewa_generate_block *block);
void ewa_generate_torus(ewa_generate_block *block);
void ewa_generate_terrain(const ewa_terrain *terrain, ewa_generate_block *block);

/// Adds "texcoord", "texcoord_s" and "texcoord_t" to a finished object that has normals.
ewa_status ewa_generate_charts(const ewa_generate_options *options, ewa_cloud *cloud);

/// 64 random bits from a counter (finaliser of SplitMix64: Steele, Lea, Flood, "Fast Splittable Pseudorandom
/// Number Generators", 2014, figure 16).
static inline uint64_t ewa_generate_random(uint64_t key, uint64_t counter) {
    uint64_t z = key + (counter + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/// Largest integer <= value, for |value| < 2^31; unlike floor() without SSE4.1, no call.
static inline int32_t ewa_generate_floor(double value) {
    const int32_t whole = (int32_t)value;
    return whole - (value < whole);
}

/// Sine and cosine of `turns` full turns, |turns| < 2^50, to 1e-14: exact reduction to half a turn, the
/// Taylor polynomials of half the angle, then the double angle. Without branches, so that loops over it
/// become vectors.
static inline void ewa_generate_sincos(double turns, double *sine, double *cosine) {
    const double round_bias = 0x1.8p52; // adding and taking it away rounds to the nearest integer
    const double x = 3.141592653589793 * (turns - ((turns + round_bias) - round_bias)), xx = x * x;
    const double s =
        x * (1 + xx * (-1.0 / 6 +
                       xx * (1.0 / 120 +
                             xx * (-1.0 / 5040 +
                                   xx * (1.0 / 362880 +
                                         xx * (-1.0 / 39916800 +
                                               xx * (1.0 / 6227020800 +
                                                     xx * (-1.0 / 1307674368000 +
                                                           xx * (1.0 / 355687428096000 +
                                                                 xx * (-1.0 / 121645100408832000))))))))));
    const double c =
        1 + xx * (-0.5 +
                  xx * (1.0 / 24 +
                        xx * (-1.0 / 720 +
                              xx * (1.0 / 40320 +
                                    xx * (-1.0 / 3628800 +
                                          xx * (1.0 / 479001600 +
                                                xx * (-1.0 / 87178291200 +
                                                      xx * (1.0 / 20922789888000 +
                                                            xx * (-1.0 / 6402373705728000 +
                                                                  xx * (1.0 / 2432902008176640000))))))))));
    *sine = 2 * s * c;
    *cosine = (c - s) * (c + s);
}

/// Sine of `turns` full turns, for colours: |turns| < 2^20, error below 1.2e-3: the parabola through the
/// sine's zeros and extremes, blended with its own square.
static inline float ewa_generate_sin(float turns) {
    const float round_bias = 0x1.8p23f;
    const float x = turns - ((turns + round_bias) - round_bias);
    const float parabola = 8 * x - 16 * x * fabsf(x);
    return parabola * (0.775f + 0.225f * fabsf(parabola));
}

#endif
