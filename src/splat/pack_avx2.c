// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The packing kernels, AVX2.
#define WIDE_AVX2
#define PACK_KERNELS ewa_pack_kernels_avx2
#include "splat/pack_body.h"
