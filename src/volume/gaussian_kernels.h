// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The hot loops of Gaussians: what goes in and out of them. One body (gaussian_body.h), one file per
// instruction set, the same bytes from each. Formulas: docs/math.md section 12.
//
// `project` makes records of the splats of a packet that some pixel may show. Then, one tile at a time,
// `mark` finds the blocks of 4x4 pixels that each of its splats touches, and `draw` composites them, block by
// block.
#ifndef EWA_SRC_VOLUME_GAUSSIAN_KERNELS_H
#define EWA_SRC_VOLUME_GAUSSIAN_KERNELS_H

#include "ewa/mixture.h"
#include "volume/layers.h"
#include "volume/section.h"
#include "volume/splats.h"

enum {
    EWA_GAUSSIAN_TILE_PX = 32,
    EWA_GAUSSIAN_ROW_BLOCKS = EWA_GAUSSIAN_TILE_PX / 4,
    EWA_GAUSSIAN_SORT_BITS = 8,
    EWA_GAUSSIAN_SORTED = 1 << EWA_GAUSSIAN_SORT_BITS, ///< splats of a block at once
    EWA_GAUSSIAN_AT_ONCE = 64,       ///< splats that come before some are composited, at least
    EWA_GAUSSIAN_MAX_AT_ONCE = 1024, ///< and at most
};

/// What pixels need of a splat. With the offset (u, v) of a pixel's centre from (X, Y):
///
///     ellipse, filtered   q^2 = (AX u + AY v)^2 + (BY v)^2, at most LIMIT
///     ray's direction     g_k = Gk_X u + Gk_Y v + Gk, for k = 1, 2, 3
///     passes it at        m^2 = LENGTH^2 (g1^2 + g2^2) / (g1^2 + g2^2 + g3^2)
///     in the depth        z = LENGTH g3 / (g1^2 + g2^2 + g3^2)
///     dot                 q^2 = RECORD_DOT ((u - RECORD_DOT_X)^2 + (v - RECORD_DOT_Y)^2), where that is less than m^2
///
/// The direction is in the splat's standard deviations, turned so that the third axis points from the eye to the
/// centre, which is LENGTH away. Orthographic: m^2 is g1^2 + g2^2, z is g3, LENGTH how many standard deviations a
/// unit of depth is.
enum {
    RECORD_X,
    RECORD_Y,
    RECORD_AX,
    RECORD_AY,
    RECORD_BY,
    RECORD_LIMIT,
    RECORD_G,
    RECORD_LENGTH = RECORD_G + 9,
    RECORD_LOG2_ALPHA, ///< in the middle
    RECORD_LOW,        ///< depths that pixels see it at
    RECORD_HIGH,
    RECORD_ORDER,                    ///< by centres: the centre's depth; by rays: RECORD_LOW; by the nearest: where it begins
    RECORD_COLOR,                    ///< display values
    RECORD_REACH = RECORD_COLOR + 3, ///< half of the ellipse's height
    RECORD_TOUCH,                    ///< v where the ellipse is farthest to the right
    RECORD_DOT, ///< of a trained 2D Gaussian: one over the variance of its dot; of others -1
    RECORD_DOT_X,
    RECORD_DOT_Y, ///< its middle, from (X, Y)
    RECORD_DOT_Z,
    RECORD_FLOATS,
};

typedef float ewa_gaussian_record[RECORD_FLOATS];

/// Camera and options of a frame in single precision.
typedef struct ewa_gaussian_view {
    bool orthographic, trained, by_center, keep, with_depth;
    bool with_surface;  ///< planes of opaque surfaces
    bool with_sections; ///< section planes
    bool flat;          ///< as 2DGS trains: where rays cross it, and at least a dot; not `trained` then
    bool with_flat;     ///< some set is
    bool by_nearest;    ///< opaque ones are in the order in which they begin
    bool expected;      ///< depth is the mean of all that shows
    bool normals;       ///< colours are 0.5 + n / 2 of normals n, which are mixed as they are; those of volumes are 0.5
    float fx_px, fy_px, cx_px, cy_px;
    float width_px, height_px;
    float last_column, last_row; ///< of the tiles
    float turn[3][3];            ///< rows, acts on columns
    float origin[3], eye[3], forward[3];
    float slopes[4], near;
    float cutoff2, prefilter_px2, dot_px2, log2_min, minimum_alpha, minimum_transmittance;
    uint32_t harmonic_count; ///< that are stored beyond degree 0, three colours
    uint32_t sh_degree;      ///< that are used
    float set_unit;          ///< of the packets, in units of the view: a power of two
    double unit_camera;
} ewa_gaussian_view;

/// Where the visible splats of some packets go; `count` of them are there.
typedef struct ewa_gaussian_found {
    ewa_gaussian_record *records;
    uint32_t *keys;       ///< sort as RECORD_ORDER does
    int32_t *first, *end; ///< tiles, as in ewa_bin_items
    uint32_t count, near_count;
} ewa_gaussian_found;

/// A splat or volume layer as the pixels of a block hit it.
typedef struct ewa_gaussian_hit {
    _Alignas(64) float z[16], alpha[16];
    float deviation[16];           ///< in depth, along the rays
    uint32_t active;               ///< pixels that show it and have not composited it
    uint32_t id;                   ///< record, of a splat
    const ewa_volume_layer *layer; ///< of a volume; NULL: a splat
} ewa_gaussian_hit;

/// Sort buffer: a row for each splat.
typedef struct ewa_gaussian_sort_buffer {
    _Alignas(64) int32_t keys[EWA_GAUSSIAN_SORTED][16]; ///< depth and row
    float alphas[EWA_GAUSSIAN_SORTED][16], deviations[EWA_GAUSSIAN_SORTED][16], colors[3][EWA_GAUSSIAN_SORTED];
    uint32_t chosen[EWA_GAUSSIAN_SORTED];
    float linear[EWA_GAUSSIAN_SORTED];              ///< 1: a layer of a volume; where there are some
    float layer_colors[3][EWA_GAUSSIAN_SORTED][16]; ///< theirs
} ewa_gaussian_sort_buffer;

/// The layers of a volume in the part of the picture that a tile belongs to.
typedef struct ewa_gaussian_volume {
    const ewa_volume_layers *ahead,
        *all;    ///< of what lies in front of the surfaces; where there are none: the same
    double unit; ///< of their depths, in units of the view
} ewa_gaussian_volume;

/// A tile while it is drawn; room for `count` of everything, in whole sixteens.
typedef struct ewa_gaussian_tile {
    uint32_t x_px, y_px, width_px, height_px;
    const ewa_gaussian_record *records;
    const uint32_t *ids; ///< [count] records, by RECORD_ORDER
    uint32_t count;
    uint8_t *marks;           ///< [row of blocks][room]: bit c: column c
    size_t room;              ///< of a row of marks
    uint32_t *row_ids;        ///< of splats in a row of blocks
    uint8_t *row_marks;       ///< theirs
    uint32_t *block_ids;      ///< of splats in a block
    ewa_gaussian_hit *hit;    ///< splats that some pixel of a block shows
    uint32_t *waiting, *free; ///< of those: that wait; of no use now
    ewa_gaussian_sort_buffer *sort_buffer;
    const ewa_ray_sections *sections;
    const ewa_gaussian_volume *volumes;
    uint32_t volume_count;
    uint32_t first_row, first_column; ///< of its blocks, in the volumes' tiles
    uint64_t block_count, sorted_count;
} ewa_gaussian_tile;

typedef struct ewa_gaussian_kernels {
    /// Adds those splats of a packet that some pixel may show.
    void (*project)(const ewa_gaussian_view *view, const ewa_splat_packet *packet,
                    const int16_t (*harmonics)[EWA_SPLAT_LANES], ewa_gaussian_found *found);

    /// Sets the marks of a tile's splats.
    void (*mark)(ewa_gaussian_tile *tile);

    /// Composites and writes the tile's pixels.
    void (*draw)(const ewa_gaussian_view *view, ewa_gaussian_tile *tile, const ewa_volume_target *to);
} ewa_gaussian_kernels;

EWA_DECLARE_VERSIONS(const ewa_gaussian_kernels, ewa_gaussian_kernels);

#endif
