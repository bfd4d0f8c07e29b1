// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The kernels of volumes for AVX2 with FMA.
#define WIDE_AVX2
#define VOLUME_NAME    "avx2"
#define VOLUME_KERNELS ewa_volume_kernels_avx2
#include "volume/kernels_body.h"
