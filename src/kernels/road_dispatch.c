// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which version of the road's kernels runs: start with plain C, overwrite from the weakest to the strongest.
#include "base/base.h"
#include "kernels/road_variants.h"

const ewa_road_kernels *ewa_road_kernels_choose(uint32_t cpu_features) {
    const ewa_road_kernels *chosen = &ewa_road_kernels_portable;
#if defined(__x86_64__)
    if (cpu_features & EWA_CPU_AVX2) chosen = &ewa_road_kernels_avx2;
    if (cpu_features & EWA_CPU_AVX512) chosen = &ewa_road_kernels_avx512;
#else
    (void)cpu_features;
#endif
    return chosen;
}
