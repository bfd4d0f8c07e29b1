// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tables of the colormaps: sRGB at 256 even places from 0 to 1.
#ifndef EWA_SRC_COLORMAP_H
#define EWA_SRC_COLORMAP_H

#include <stdint.h>

extern const uint8_t ewa_colormap_viridis[256][3], ewa_colormap_turbo[256][3], ewa_colormap_plasma[256][3],
    ewa_colormap_inferno[256][3], ewa_colormap_magma[256][3], ewa_colormap_cividis[256][3],
    ewa_colormap_coolwarm[256][3];

#endif
