// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// LAS records that tests make up for chunks of LAZ.
#ifndef EWA_TESTS_LAZ_SAMPLE_H
#define EWA_TESTS_LAZ_SAMPLE_H

#include "io/las/laz.h"

#include <math.h>
#include <string.h>

/// What records are like.
typedef enum laz_sample_kind {
    LAZ_SAMPLE_SMOOTH,   ///< as a scanner gives them
    LAZ_SAMPLE_RANDOM,   ///< any bytes
    LAZ_SAMPLE_CONSTANT, ///< all the same
    LAZ_SAMPLE_JUMPS,    ///< smooth, but of several channels and times
    LAZ_SAMPLE_KIND_COUNT,
} laz_sample_kind;

static inline uint32_t laz_sample_random(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(*state >> 33);
}

static inline void laz_sample_put(uint8_t *to, uint64_t number, int byte_count) {
    for (int i = 0; i < byte_count; i++) to[i] = (uint8_t)(number >> (8 * i));
}

/// Fills `count` records of a format.
static inline void laz_sample(laz_sample_kind kind, uint8_t format, uint32_t record_bytes, uint32_t count,
                              uint64_t seed, uint8_t *records) {
    const uint32_t times[11] = {0, 20, 0, 20, 20, 20, 22, 22, 22, 22, 22};
    const uint32_t colors[11] = {0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};
    double time = 300000;
    uint32_t channel = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint8_t *r = records + (size_t)i * record_bytes;
        if (kind == LAZ_SAMPLE_CONSTANT && i > 0) {
            memcpy(r, r - record_bytes, record_bytes);
            continue;
        }
        if (kind == LAZ_SAMPLE_RANDOM || i == 0) {
            for (uint32_t k = 0; k < record_bytes; k++) r[k] = (uint8_t)laz_sample_random(&seed);
            if (kind == LAZ_SAMPLE_RANDOM) continue;
        } else {
            memcpy(r, r - record_bytes, record_bytes);
            r[record_bytes - 1] = (uint8_t)(r[record_bytes - 1] + laz_sample_random(&seed) % 3);
        }
        laz_sample_put(r, (uint32_t)(int32_t)(1e5 * sin(i / 50.0)) + laz_sample_random(&seed) % 9, 4);
        laz_sample_put(r + 4, (uint32_t)(int32_t)(1e5 * cos(i / 77.0)) + laz_sample_random(&seed) % 3, 4);
        laz_sample_put(r + 8, (uint32_t)(int32_t)(1e3 * sin(i / 9.0)), 4);
        laz_sample_put(r + 12, 500 + laz_sample_random(&seed) % 40, 2);
        const uint32_t returns = 1 + laz_sample_random(&seed) % (format < 6 ? 5 : 15);
        const uint32_t number = 1 + laz_sample_random(&seed) % returns;
        if (kind == LAZ_SAMPLE_JUMPS && laz_sample_random(&seed) % 8 == 0)
            channel = laz_sample_random(&seed) % 4;
        if (format < 6) {
            r[14] = (uint8_t)(number | returns << 3 | (i / 60 & 1) << 6);
            r[15] = (uint8_t)(laz_sample_random(&seed) % 4);
            r[16] = (uint8_t)(i / 20);
        } else {
            r[14] = (uint8_t)(number | returns << 4);
            r[15] = (uint8_t)((i / 40 & 1) << 6 | channel << 4);
            r[16] = (uint8_t)(laz_sample_random(&seed) % 40);
            laz_sample_put(r + 18, i / 20 * 30, 2);
            laz_sample_put(r + 20, i / 100, 2);
        }
        const double steps[] = {0, 0, 1e-5, 1e-5, 2e-5, 1.3e-4, -3e-5, 1e-9};
        time += steps[laz_sample_random(&seed) % 8];
        if (kind == LAZ_SAMPLE_JUMPS && laz_sample_random(&seed) % 5 == 0)
            time += 5e4 * ((int)(laz_sample_random(&seed) % 7) - 3);
        uint64_t bits;
        memcpy(&bits, &time, sizeof bits);
        if (times[format]) laz_sample_put(r + times[format], bits, 8);
        for (uint32_t k = 0; colors[format] && k < 3; k++)
            laz_sample_put(r + colors[format] + 2 * k,
                           256 * ((i / 3 + 20 * k) & 255) + laz_sample_random(&seed) % 4, 2);
    }
}

#endif
