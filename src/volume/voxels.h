// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The resident form of a volume: occupied voxels in blocks, 16 bytes each.
#ifndef EWA_SRC_VOLUME_VOXELS_H
#define EWA_SRC_VOLUME_VOXELS_H

#include "ewa/volume_render.h"

enum {
    EWA_BLOCK_SIDE = 8, ///< voxels
    EWA_BLOCK_VOXELS = 512,
    EWA_STREAM_PADDING = 16, ///< numbers after the last voxel that may be read
};

/// A block with voxels in it.
typedef struct ewa_voxel_block {
    uint64_t first;          ///< of its voxels
    uint32_t place[3];       ///< in blocks
    uint16_t count;          ///< of its voxels; > 0
    uint8_t low[3], high[3]; ///< the box of its voxels, both within
} ewa_voxel_block;

/// Voxels of one spacing, block by block. Within a block neighbours are kept apart, so that what is added to
/// their pixels one after another goes to different ones.
typedef struct ewa_voxel_level {
    double index_to_world[12];
    uint32_t dims[3];
    ewa_voxel_block *blocks;
    uint64_t block_count, voxel_count;
    uint16_t *places;    ///< [voxel] within the block: i | j << 3 | k << 6
    uint16_t *colors[3]; ///< [voxel] linear; 65535 is ewa_voxels.color_scale
    float *extinctions;  ///< [voxel] per shortest spacing of level 0
    int32_t *normals;    ///< [voxel] x | y << 10 | z << 20, 10 bits each, 511 is 1; 0: none
} ewa_voxel_level;

/// Makes room for the blocks and voxels that are counted, after which numbers may be read. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_voxel_level_allocate(ewa_context *context, ewa_voxel_level *level);

struct ewa_voxels {
    ewa_context *context;
    uint64_t serial; ///< another one of each
    uint32_t level_count;
    ewa_voxel_level levels[EWA_MAX_VOLUME_LEVELS];
    double color_scale;
    ewa_voxels_info info;
};

#endif
