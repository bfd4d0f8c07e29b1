// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The renderer's inner side.
#ifndef EWA_SRC_SURFACE_RENDER_H
#define EWA_SRC_SURFACE_RENDER_H

#include "ewa/render.h"

/// Sets the side of tiles: 16, 32, 64 or 128 pixels; 0: by the size of the picture. Pictures are the same.
void ewa_renderer_set_tile(ewa_renderer *renderer, uint32_t tile_px);

#endif
