// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What every version of src/wide does with sixteen lanes: inputs, and the results of each operation.
#ifndef EWA_TESTS_WIDE_OPERATIONS_H
#define EWA_TESTS_WIDE_OPERATIONS_H

#include "wide/isa.h"

#include <stdint.h>

typedef struct wide_input {
    float a[16], b[16], c[16];   ///< any floats
    float k[16], coefficients[5]; ///< any, and none small
    float share[16], odd[16], sum[16]; ///< at most 1; with an odd last digit, less than 2^20; whole, in [2^23, 2^24)
    float whole[16];             ///< within int32
    int32_t i[16], j[16];        ///< any numbers
    int32_t at[16];              ///< in [0, 256)
    uint16_t u16[16];
    float table[256];
    double d[16], e[16], f[16];
    uint32_t bits;
    int shift;
} wide_input;

typedef struct wide_output {
    float add[16], sub[16], mul[16], div[16], sqrt[16], abs[16], floor[16], min[16], max[16], fma[16], fnma[16];
    float fma_twice[16], horner[16], fma_whole[16];
    float select[16], keep[16], from_i[16], gather[16], lookup[16], lookup32[16], rows[16], repeat4[16], spread4[16];
    float transposed[256], store4[64], load4[64], packed[32], eight[8], joined[8];
    double double_fma[16], double_fnma[16], double_add[16], double_sub[16], widened[16];
    float narrowed[16];
    int32_t int_of[16], wi_add[16], wi_sub[16], wi_min[16], wi_max[16], wi_or[16], wi_and[16], wi_shl[16], wi_sar[16];
    int32_t from_u16[16], from_i16[16], int_rows[64], wi_packed[32];
    uint8_t u8[16];
    uint32_t less, less_equal, bits, both, either, neither;
} wide_output;

typedef void wide_operations(const wide_input *in, wide_output *out);
EWA_DECLARE_VERSIONS(wide_operations, wide_operate);

#endif
