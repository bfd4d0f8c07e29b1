// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which instruction sets this machine has.
#include "base/base.h"

#if defined(__x86_64__)
#include <cpuid.h>

/// Registers that the system keeps for each thread, as bits of XCR0. By its bytes: assemblers want a flag for its name.
static uint32_t kept_registers(void) {
    uint32_t low, high;
    __asm__ volatile(".byte 0x0f, 0x01, 0xd0" : "=a"(low), "=d"(high) : "c"(0)); // xgetbv
    return low;
}

// Not by __builtin_cpu_supports(), which some compilers' libraries for musl and Windows answer with 0. Intel 64 and IA-32
// Architectures Software Developer's Manual, volume 1, sections 14.3, 14.7.1 and 15.2 to 15.4.
uint32_t ewa_cpu_detect(void) {
    enum { YMM = 0x06, ZMM = 0xe6 };
    const uint32_t avx512 = bit_AVX512F | bit_AVX512DQ | bit_AVX512BW | bit_AVX512VL;
    uint32_t a, b, c, d, b7, c7;
    if (!__get_cpuid(1, &a, &b, &c, &d) || !(c & bit_OSXSAVE) || !(c & bit_AVX) || !(c & bit_FMA)) return 0;
    if (!__get_cpuid_count(7, 0, &a, &b7, &c7, &d) || !(b7 & bit_AVX2)) return 0;
    const uint32_t kept = kept_registers();
    if ((kept & YMM) != YMM) return 0;
    return (b7 & avx512) == avx512 && (kept & ZMM) == ZMM ? EWA_CPU_AVX2 | EWA_CPU_AVX512 : EWA_CPU_AVX2;
}
#else
uint32_t ewa_cpu_detect(void) {
#if defined(__aarch64__)
    return EWA_CPU_NEON; // part of the base instruction set
#else
    return 0;
#endif
}
#endif
