// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The hot loops of the neighbour search for AVX-512.
#define WIDE_AVX512
#define KERNELS ewa_search_kernels_avx512
#include "cloud/neighbours_body.h"
