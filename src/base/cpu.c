// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which instruction sets this machine has.
#include "base/base.h"

uint32_t ewa_cpu_detect(void) {
    uint32_t features = 0;
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) features |= EWA_CPU_AVX2;
    if ((features & EWA_CPU_AVX2) && __builtin_cpu_supports("avx512f") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512vl"))
        features |= EWA_CPU_AVX512;
#elif defined(__aarch64__)
    features |= EWA_CPU_NEON; // part of the base instruction set
#endif
    return features;
}
