// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Normals, spacing and shape of neighbourhoods for AVX2.
#define WIDE_AVX2
#define KERNELS ewa_local_kernels_avx2
#include "prepare/local_body.h"
