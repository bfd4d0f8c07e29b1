// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Adding texels to a tile, plain C with vector types.
#define WIDE_PORTABLE
#define POINTS ewa_texture_draw_points_portable
#define SPLATS ewa_texture_draw_splats_portable
#include "resample/texture_body.h"
