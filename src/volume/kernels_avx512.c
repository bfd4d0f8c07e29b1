// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The kernels of volumes for AVX-512.
#define WIDE_AVX512
#define VOLUME_NAME    "avx512"
#define VOLUME_KERNELS ewa_volume_kernels_avx512
#include "volume/kernels_body.h"
