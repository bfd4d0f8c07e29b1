// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The sRGB curve for hot loops: 8-bit codes from and to linear light by table, exact and the same on every
// machine. Based on: IEC 61966-2-1:1999, section 5.2 (piecewise curve).
#ifndef EWA_SRC_IMAGE_SRGB_H
#define EWA_SRC_IMAGE_SRGB_H

#include "ewa/image.h"

#include <string.h>

enum {
    EWA_SRGB_FIRST_BITS = 0x39000000, ///< bits of 2^-13; everything below has code 0
    EWA_SRGB_BUCKET_SHIFT = 16,       ///< buckets of 1/128 octave, which hold at most one threshold each
    EWA_SRGB_BUCKET_COUNT = 1664,
};

/// Linear light of the 256 codes, correctly rounded.
extern const float ewa_srgb_decoded[256];

/// [k] is the smallest float that rounds to code k; [256] is out of reach.
extern const float ewa_srgb_threshold[257];

/// Code of the first float of each bucket.
extern const uint8_t ewa_srgb_bucket_code[EWA_SRGB_BUCKET_COUNT];

/// Returns round(255 srgb(linear)), exact for every float; clamped to [0, 255]; NaN gives 0.
static inline uint8_t ewa_srgb8_from_linear(float linear) {
    const float lowest = 0x1p-13f, highest = 0x1.fffffep-1f;
    float clamped = linear > lowest ? linear : lowest;
    clamped = clamped < highest ? clamped : highest;
    uint32_t bits;
    memcpy(&bits, &clamped, sizeof bits);
    const uint32_t code = ewa_srgb_bucket_code[(bits - EWA_SRGB_FIRST_BITS) >> EWA_SRGB_BUCKET_SHIFT];
    return (uint8_t)(code + (clamped >= ewa_srgb_threshold[code + 1]));
}

/// The curve in double precision, within 1e-15 of the exact one; from + - * / and sqrt only, so that every
/// machine gives the same bits. Input within [0, 1].
double ewa_srgb_encode(double linear);
double ewa_srgb_decode(double srgb);

#endif
