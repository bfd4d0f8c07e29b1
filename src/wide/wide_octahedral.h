// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Unit vectors from octahedral coordinates over the wide type.
//
// Octahedral normals: Meyer et al., "On Floating-Point Normal Vectors", 2010.
#ifndef EWA_SRC_WIDE_WIDE_OCTAHEDRAL_H
#define EWA_SRC_WIDE_WIDE_OCTAHEDRAL_H

#include "wide/wide_functions.h"

static inline wf with_sign_of(wf magnitude, wf sign) {
    return wf_select(wf_lt(sign, wf_set(0)), wf_sub(wf_set(0), magnitude), magnitude);
}

/// The unit vectors of octahedral coordinates.
static inline void unfold(wf u, wf v, wf n[3]) {
    const wf zero = wf_set(0);
    const wf z = wf_sub(wf_sub(wf_set(1), wf_abs(u)), wf_abs(v));
    const wf fold = wf_max(wf_sub(zero, z), zero);
    const wf x = wf_sub(u, with_sign_of(fold, u)), y = wf_sub(v, with_sign_of(fold, v));
    const wf inverse = wf_inverse_root(wf_fma(x, x, wf_fma(y, y, wf_mul(z, z))));
    n[0] = wf_mul(x, inverse), n[1] = wf_mul(y, inverse), n[2] = wf_mul(z, inverse);
}

/// Of coordinates times 32767.
static inline void decode_normals(const int16_t x[16], const int16_t y[16], wf n[3]) {
    const wf unit = wf_set(1.0f / 32767.0f);
    unfold(wf_mul(wf_from_i(wi_load_i16(x)), unit), wf_mul(wf_from_i(wi_load_i16(y)), unit), n);
}

#endif
