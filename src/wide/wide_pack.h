// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of wide.h: lanes one after another, where there is no instruction for it.

/// Writes the lanes where m is set one after another; may write 16 numbers.
static inline void wf_pack(float *p, wm m, wf a) {
    float lanes[16];
    wf_store(lanes, a);
    for (uint32_t bits = wm_bits(m); bits; bits &= bits - 1) *p++ = lanes[__builtin_ctz(bits)];
}
static inline void wi_pack(int32_t *p, wm m, wi a) {
    int32_t lanes[16];
    wi_store(lanes, a);
    for (uint32_t bits = wm_bits(m); bits; bits &= bits - 1) *p++ = lanes[__builtin_ctz(bits)];
}
