// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The road's kernels for AVX-512.
#define WIDE_AVX512
#define ROAD_NAME    "avx512"
#define ROAD_KERNELS ewa_road_kernels_avx512
#include "kernels/road_body.h"
