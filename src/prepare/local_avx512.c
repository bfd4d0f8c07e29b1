// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Normals, spacing and shape of neighbourhoods for AVX-512.
#define WIDE_AVX512
#define KERNELS ewa_local_kernels_avx512
#include "prepare/local_body.h"
