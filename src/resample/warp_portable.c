// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The sampling kernels, plain C.
#define WIDE_PORTABLE
#define WARP_KERNELS ewa_warp_kernels_portable
#include "resample/warp_body.h"
