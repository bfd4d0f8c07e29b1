// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The hot loops of the neighbour search for AVX2.
#define WIDE_AVX2
#define KERNELS ewa_search_kernels_avx2
#include "cloud/neighbours_body.h"
