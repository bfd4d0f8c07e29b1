// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which version of the kernels of volumes runs: start with plain C, overwrite from the weakest on.
#include "base/base.h"
#include "volume/kernels.h"

const ewa_volume_kernels *ewa_volume_kernels_choose(uint32_t cpu_features) {
    const ewa_volume_kernels *chosen = &ewa_volume_kernels_portable;
#if defined(__x86_64__)
    if (cpu_features & EWA_CPU_AVX2) chosen = &ewa_volume_kernels_avx2;
    if (cpu_features & EWA_CPU_AVX512) chosen = &ewa_volume_kernels_avx512;
#else
    (void)cpu_features;
#endif
    return chosen;
}
