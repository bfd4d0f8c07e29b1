// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The contract of the sampling kernels: depths to surfels. Each does the same correctly rounded operations in
// the same order, so all give the same bytes.
// docs/math.md section 11.
//
// Planes are linear in the key 1/z over the picture, so that everything about neighbours is decided by first
// and second differences of keys. NaN marks a pixel without a depth: comparisons with it are false.
#ifndef EWA_SRC_WARP_SAMPLE_H
#define EWA_SRC_WARP_SAMPLE_H

#include "surface/packet.h"
#include "wide/isa.h"

#include <stddef.h>

enum {
    EWA_WARP_REACH = 2,  ///< neighbours on each side that a slope looks at
    EWA_WARP_FRONT = 16, ///< numbers before and behind a row that are NaN
    EWA_WARP_BACK = 48,
    EWA_WARP_BLOCK_PX = 4, ///< a block of 4 x 4 samples is a packet
};

/// A source camera and the limits of its surfaces, in single precision.
typedef struct ewa_warp_lens {
    float ray_x[2], ray_y[2]; ///< slope of column x: ray_x[0] x + ray_x[1], at the pixel's centre
    float from_camera[9];     ///< world from camera, row-major, scale included
    float sigma;              ///< of a sample, in units of the spacing
    float jump, steep;        ///< largest differences of keys over the larger one: at any rate, of planes
    float bend;               ///< largest second difference of a plane, likewise
    float crease_x, crease_y; ///< second difference from which two sides are two planes
    float noise;              ///< of the keys; 0: none
    float drop_flying;        ///< 1 or 0
} ewa_warp_lens;

/// Rows of numbers of one strip of a picture, `stride` apart, with room before and behind.
typedef struct ewa_warp_rows {
    float *keys;                    ///< first sample of the first row; NaN: masked
    float *slope_x, *slope_y;       ///< what the key changes per pixel
    float *distance_x, *distance_y; ///< to the neighbours, in pixels
    size_t stride;
} ewa_warp_rows;

typedef struct ewa_warp_kernels {
    /// Averages each of `count` keys of a row with those within EWA_WARP_REACH pixels that differ by little
    /// more than the noise: the mean of a plane's keys around a pixel is that pixel's. Rows as for slopes().
    void (*smooth)(float noise, const float *keys, size_t stride, uint32_t count, float *smoothed);

    /// Measures `count` samples of a row into `rows` from number `at` on: slopes, distances and which of the
    /// keys stay. `keys` points into rows of EWA_WARP_REACH more on each side, `stride` apart; writes up to a
    /// multiple of 16. Returns how many were dropped as flying.
    uint32_t (*slopes)(const ewa_warp_lens *lens, const float *keys, size_t stride, uint32_t count,
                       const ewa_warp_rows *rows, size_t at);

    /// Makes surfels of the 4 x 4 samples at column x, row y of the picture, number `at` of `samples`:
    /// positions from the eye into the packet, normals and axes. Returns the mask of those that exist; the
    /// others have harmless numbers.
    uint32_t (*block)(const ewa_warp_lens *lens, uint32_t x, uint32_t y, const ewa_warp_rows *samples,
                      size_t at, ewa_packet *packet, float normal[3][16], float axis_u[3][16],
                      float axis_v[3][16]);
} ewa_warp_kernels;

EWA_DECLARE_VERSIONS(const ewa_warp_kernels, ewa_warp_kernels);

#endif
