// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The pixels of all tiles, from the ranks that own them to those that get the picture.
#include "cluster/joint.h"

#include <string.h>

enum { PLANES = 5 };

typedef struct pixel_plane {
    void *pixels; ///< NULL: nobody asks for them
    size_t size_bytes;
} pixel_plane;

static void planes_of(const ewa_resolve *to, pixel_plane planes[PLANES]) {
    const pixel_plane all[PLANES] = {{to->rgba8, 4 * sizeof *to->rgba8},
                                     {to->rgba, 4 * sizeof *to->rgba},
                                     {to->depth, sizeof *to->depth},
                                     {to->normal, 3 * sizeof *to->normal},
                                     {to->coverage, sizeof *to->coverage}};
    memcpy(planes, all, sizeof all);
}

/// Copies the pixels of a rank's tiles to where they lie after each other, or back; returns how many bytes. Without
/// `post` they are only counted.
static size_t copy_tiles(const ewa_joint *joint, uint32_t rank, char *packed_pixels, bool back) {
    const ewa_tiles *tiles = &joint->job.tiles;
    const size_t width = tiles->width_px;
    pixel_plane planes[PLANES];
    planes_of(&joint->job.resolve, planes);
    size_t bytes = 0;
    for (uint32_t tile = 0; tile < joint->tiles.tile_count; tile++) {
        if (joint->tiles.owners[tile] != rank) continue;
        const ewa_tile_rect rect = ewa_tiles_rect(tiles, tile);
        for (int i = 0; i < PLANES; i++) {
            const size_t row_bytes = rect.width_px * planes[i].size_bytes;
            for (size_t y = 0; y < rect.height_px && planes[i].pixels; y++, bytes += row_bytes) {
                char *at =
                    (char *)planes[i].pixels + ((rect.y_px + y) * width + rect.x_px) * planes[i].size_bytes;
                if (packed_pixels)
                    memcpy(back ? at : packed_pixels + bytes, back ? packed_pixels + bytes : at, row_bytes);
            }
        }
    }
    return bytes;
}

static bool gets_picture(const ewa_exchange *exchange, uint32_t rank) {
    return exchange->picture_rank == EWA_ALL_RANKS || exchange->picture_rank == rank;
}

ewa_status ewa_joint_collect(ewa_joint *joint) {
    const ewa_exchange *exchange = &joint->exchange;
    ewa_messages *messages = &joint->messages;
    const uint32_t own = exchange->rank;
    const bool gets = gets_picture(exchange, own);
    size_t bytes = copy_tiles(joint, own, NULL, false);
    for (uint32_t r = 0; r < exchange->rank_count; r++) {
        const bool comes = gets && r != own;
        messages->given[r] = (ewa_parcel){NULL, r != own && gets_picture(exchange, r) ? bytes : 0};
        messages->taken[r] = (ewa_parcel){NULL, comes ? copy_tiles(joint, r, NULL, false) : 0};
    }
    for (uint32_t r = 0; r < exchange->rank_count; r++) bytes += messages->taken[r].size_bytes;
    EWA_TRY(ewa_buffer_reserve(joint->context, &joint->pixels, bytes, 1));
    char *packed_pixels = joint->pixels.data;
    const size_t own_bytes = copy_tiles(joint, own, packed_pixels, false);
    char *at = packed_pixels + own_bytes;
    for (uint32_t r = 0; r < exchange->rank_count; r++) {
        messages->given[r].data = packed_pixels;
        messages->taken[r].data = at;
        at += messages->taken[r].size_bytes;
    }
    EWA_TRY(ewa_messages_send(exchange, messages));
    for (uint32_t r = 0; r < exchange->rank_count; r++)
        if (messages->taken[r].size_bytes) copy_tiles(joint, r, messages->taken[r].data, true);
    return EWA_OK;
}
