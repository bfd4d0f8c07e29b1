// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The sampling kernels, AVX2.
#define WIDE_AVX2
#define WARP_KERNELS ewa_warp_kernels_avx2
#include "resample/warp_body.h"
