// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The packing kernels, plain C.
#define WIDE_PORTABLE
#define PACK_KERNELS ewa_pack_kernels_portable
#include "splat/pack_body.h"
