// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The kernel tables that exist in this build. No section of docs/math.md is about them.
#ifndef EWA_SRC_KERNELS_ROAD_VARIANTS_H
#define EWA_SRC_KERNELS_ROAD_VARIANTS_H

#include "kernels/road.h"

extern const ewa_road_kernels ewa_road_kernels_portable;
#if defined(__x86_64__)
extern const ewa_road_kernels ewa_road_kernels_avx2;
extern const ewa_road_kernels ewa_road_kernels_avx512;
#endif

#endif
