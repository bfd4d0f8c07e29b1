// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The road's kernels in plain C.
#define WIDE_PORTABLE
#define ROAD_NAME    "portable"
#define ROAD_KERNELS ewa_road_kernels_portable
#include "kernels/road_body.h"
