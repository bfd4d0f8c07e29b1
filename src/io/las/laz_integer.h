// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Whole numbers, coded as what they differ from a prediction: how many bits the difference has (a symbol whose
// model depends on a context), its upper eight bits (a symbol), and the rest as it is.
//
// Based on: M. Isenburg, "LASzip: lossless compression of LiDAR data" (2013), section "Integer compressor";
// rapidlasso, "LAZ Specification 1.4".
#ifndef EWA_SRC_LAZ_INTEGER_H
#define EWA_SRC_LAZ_INTEGER_H

#include "io/las/laz_coder.h"

enum {
    EWA_LAZ_HIGH_BITS = 8,                      ///< bits of a difference that have a model
    EWA_LAZ_HIGH_ROOM = 1 << EWA_LAZ_HIGH_BITS, ///< symbols of that model
};

typedef EWA_LAZ_MODEL(256) ewa_laz_model256;

/// Numbers of `bits` bits in `contexts` contexts.
#define EWA_LAZ_INTEGER(bits, contexts)                                                                      \
    struct {                                                                                                 \
        EWA_LAZ_MODEL((bits) + 1) widths[contexts];                                                          \
        ewa_laz_bit lowest;                                                                                  \
        ewa_laz_model256 highs[bits];                                                                        \
    }

/// Codes the difference, which has `bits` bits with its sign; `*width`: how many are needed.
EWA_LAZ_INLINE int32_t ewa_laz_difference(bool encoding, ewa_laz_coder *c, ewa_laz_model *widths,
                                          uint32_t bits, ewa_laz_bit *lowest, ewa_laz_model256 *highs,
                                          int32_t difference, uint32_t *width) {
    // -(2^k - 1)..-2^(k-1) and 2^(k-1)+1..2^k have width k; 0 and 1 width 0.
    uint32_t k = 0;
    if (encoding) {
        const uint32_t size = difference <= 0 ? 0u - (uint32_t)difference : (uint32_t)difference - 1;
        k = size ? 32 - (uint32_t)__builtin_clz(size) : 0;
    }
    k = ewa_laz_symbol_of(encoding, c, widths, bits + 1, bits + 1, k);
    *width = k;
    if (k == 0) return (int32_t)ewa_laz_bit_code(encoding, c, lowest, (uint32_t)difference);
    if (k == 32) return INT32_MIN;
    // Both intervals in one: the lower from 0 on, the upper from 2^(k-1) on.
    const uint32_t all = (1u << k) - 1, half = 1u << (k - 1);
    uint32_t code = difference < 0 ? (uint32_t)difference + all : (uint32_t)difference - 1;
    if (k <= EWA_LAZ_HIGH_BITS) {
        code = ewa_laz_symbol_of(encoding, c, &highs[k - 1].head, 1u << k, EWA_LAZ_HIGH_ROOM, code);
    } else {
        const uint32_t lower_bits = k - EWA_LAZ_HIGH_BITS, mask = (1u << lower_bits) - 1;
        const uint32_t high = ewa_laz_symbol_of(encoding, c, &highs[k - 1].head, EWA_LAZ_HIGH_ROOM,
                                                EWA_LAZ_HIGH_ROOM, code >> lower_bits);
        code = high << lower_bits | ewa_laz_bits(encoding, c, lower_bits, code & mask);
    }
    if (encoding) return difference;
    return (int32_t)(code >= half ? code + 1 : code - all);
}

/// Codes a number of 32 bits, that wraps around.
#define ewa_laz_integer32(encoding, c, integer, context, prediction, number, width)                          \
    (int32_t)((uint32_t)(prediction) +                                                                       \
              (uint32_t)ewa_laz_difference(encoding, c, &(integer)->widths[context].head, 32,                \
                                           &(integer)->lowest, (integer)->highs,                             \
                                           (int32_t)((uint32_t)(number) - (uint32_t)(prediction)), width))

/// Codes a number of 16 bits, that wraps around.
#define ewa_laz_integer16(encoding, c, integer, context, prediction, number)                                 \
    (uint16_t)((uint32_t)(prediction) +                                                                      \
               (uint32_t)ewa_laz_difference(                                                                 \
                   encoding, c, &(integer)->widths[context].head, 16, &(integer)->lowest, (integer)->highs,  \
                   (int16_t)((uint32_t)(number) - (uint32_t)(prediction)), &(uint32_t){0}))

/// Codes a number of 8 bits, that wraps around.
#define ewa_laz_integer8(encoding, c, integer, context, prediction, number)                                  \
    (uint8_t)((uint32_t)(prediction) +                                                                       \
              (uint32_t)ewa_laz_difference(                                                                  \
                  encoding, c, &(integer)->widths[context].head, 8, &(integer)->lowest, (integer)->highs,    \
                  (int8_t)((uint32_t)(number) - (uint32_t)(prediction)), &(uint32_t){0}))

#endif
