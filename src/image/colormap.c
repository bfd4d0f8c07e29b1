// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours for numbers: the published tables (colormap_table.c names them), lines between their places.
#include "image/colormap.h"
#include "ewa/image.h"

#include <stddef.h>

/// The table of a colormap; NULL for gray, which needs none.
static const uint8_t (*find_table(ewa_colormap colormap))[3] {
    switch (colormap) {
    case EWA_COLORMAP_VIRIDIS:
        return ewa_colormap_viridis;
    case EWA_COLORMAP_TURBO:
        return ewa_colormap_turbo;
    case EWA_COLORMAP_PLASMA:
        return ewa_colormap_plasma;
    case EWA_COLORMAP_INFERNO:
        return ewa_colormap_inferno;
    case EWA_COLORMAP_MAGMA:
        return ewa_colormap_magma;
    case EWA_COLORMAP_CIVIDIS:
        return ewa_colormap_cividis;
    case EWA_COLORMAP_COOLWARM:
        return ewa_colormap_coolwarm;
    case EWA_COLORMAP_GRAY:
        break;
    }
    return NULL;
}

void ewa_colormap_color(ewa_colormap colormap, double number, uint8_t srgb[3]) {
    const double place = 255 * (number > 0 ? (number < 1 ? number : 1) : 0);
    const uint8_t(*table)[3] = find_table(colormap);
    if (!table) {
        srgb[0] = srgb[1] = srgb[2] = (uint8_t)(place + 0.5);
        return;
    }
    const int low = place < 254 ? (int)place : 254;
    const double share = place - low;
    for (int c = 0; c < 3; c++)
        srgb[c] = (uint8_t)((1 - share) * table[low][c] + share * table[low + 1][c] + 0.5);
}
