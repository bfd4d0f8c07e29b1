// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Adding texels to a tile and resolving it, AVX-512.
#define WIDE_AVX512
#define POINTS  ewa_texture_draw_points_avx512
#define SPLATS  ewa_texture_draw_splats_avx512
#define RESOLVE ewa_texture_resolve_avx512
#include "resample/texture_body.h"
