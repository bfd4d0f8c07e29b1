// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Adding texels to a tile and resolving it, AVX2.
#define WIDE_AVX2
#define POINTS  ewa_texture_draw_points_avx2
#define SPLATS  ewa_texture_draw_splats_avx2
#define RESOLVE ewa_texture_resolve_avx2
#include "resample/texture_body.h"
