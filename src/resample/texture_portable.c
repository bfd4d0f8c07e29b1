// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Adding texels to a tile and resolving it, plain C with vector types.
#define WIDE_PORTABLE
#define POINTS  ewa_texture_draw_points_portable
#define SPLATS  ewa_texture_draw_splats_portable
#define RESOLVE ewa_texture_resolve_portable
#include "resample/texture_body.h"
