// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The sampling kernels, AVX-512.
#define WIDE_AVX512
#define WARP_KERNELS ewa_warp_kernels_avx512
#include "resample/warp_body.h"
