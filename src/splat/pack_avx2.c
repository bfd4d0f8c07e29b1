// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The packing kernel, AVX2.
#define KERNEL ewa_pack_avx2
#include "splat/pack_body.h"
