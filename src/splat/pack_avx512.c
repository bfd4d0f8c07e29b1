// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The packing kernels, AVX-512.
#define WIDE_AVX512
#define PACK_KERNELS ewa_pack_kernels_avx512
#include "splat/pack_body.h"
