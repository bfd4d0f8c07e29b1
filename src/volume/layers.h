// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A tile of a picture of voxels as layers, one for each depth unit and block of 4x4 pixels that it changes,
// so that others can be composited between them.
#ifndef EWA_SRC_VOLUME_LAYERS_H
#define EWA_SRC_VOLUME_LAYERS_H

#include "volume/kernels.h"

enum { EWA_NO_LAYER = UINT32_MAX };

/// What a depth unit is in the pixels of a block.
typedef struct ewa_volume_layer {
    _Alignas(64) float alpha[16], color[3][16]; ///< linear, straight
    float z;                                    ///< of the grid's view
    uint32_t next;                              ///< that behind it in the block
} ewa_volume_layer;

/// The layers of a tile, front to back in each block.
typedef struct ewa_volume_layers {
    ewa_volume_layer *layers;
    uint32_t count;
    uint32_t first[EWA_VOLUME_TILE_BLOCKS], last[EWA_VOLUME_TILE_BLOCKS]; ///< EWA_NO_LAYER: none
    _Alignas(
        64) float before[EWA_VOLUME_TILE_BLOCKS][4][16]; ///< premultiplied light, what shows of all behind
} ewa_volume_layers;

#endif
