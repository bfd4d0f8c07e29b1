// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The packing kernel, AVX-512.
#define KERNEL ewa_pack_avx512
#include "splat/pack_body.h"
