// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The road's kernels for AVX2 with FMA.
#define WIDE_AVX2
#define ROAD_NAME    "avx2"
#define ROAD_KERNELS ewa_road_kernels_avx2
#include "kernels/road_body.h"
