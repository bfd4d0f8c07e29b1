// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the parts of forward texture mapping share: the plan of a picture, the sums of a tile, the contract of
// the kernels, and one texel's kernel in double precision (docs/math.md sections 3, 4, 11).
#ifndef EWA_SRC_TEXTURE_TEXTURE_H
#define EWA_SRC_TEXTURE_TEXTURE_H

#include "base/base.h"
#include "ewa/resample.h"
#include "tiling/tiles.h"
#include "wide/isa.h"

enum {
    EWA_TEXTURE_TILE = 64,   ///< pixels along a side of a tile
    EWA_TEXTURE_PITCH = 72,  ///< pixels along a row of sums: one before the tile, the rest behind it
    EWA_TEXTURE_NODE_U = 32, ///< texels along u of what is drawn at once
    EWA_TEXTURE_NODE_V = 8,
    EWA_TEXTURE_MAX_LEVELS = 64,
};

/// Levels along one axis of a texture: texels of level l are runs of size[l] texels.
typedef struct ewa_texture_axis {
    uint32_t level_count;
    uint32_t stored_count; ///< levels that differ: further ones of a repeated texture hold the mean
    uint32_t count[EWA_TEXTURE_MAX_LEVELS];  ///< whole texels of a level in the texture
    uint32_t factor[EWA_TEXTURE_MAX_LEVELS]; ///< size[l] / size[l - 1]
    double size[EWA_TEXTURE_MAX_LEVELS];
} ewa_texture_axis;

/// A linear function of picture coordinates, or of texture coordinates: a x + b y + c.
typedef struct ewa_texture_line {
    double a, b, c;
} ewa_texture_line;

/// What all tiles of a picture share.
typedef struct ewa_texture_plan {
    ewa_context *context;
    ewa_texture_source source;
    ewa_texture_target target;
    ewa_texture_options options;
    double map[3][3];          ///< [u v 1] map = w [x y 1], scaled so that |w| is about 1
    double inverse[3][3];      ///< [x y 1] inverse = [u v 1] / w, for that scale
    double determinant;        ///< |det map|
    double tangent_w;          ///< length of the change of w over one sigma along u and v, the steepest way
    double far_w;              ///< repeated textures are drawn up to here
    ewa_texture_line edges[4]; ///< of picture coordinates: all >= 0 where the texture is
    uint32_t edge_count;
    bool flat;       ///< levels would cost more than they spare: all is drawn from the texture itself
    bool with_alpha; ///< the texels have an alpha: sums of weights are kept apart
    ewa_texture_axis axes[2];
    float *levels[EWA_TEXTURE_MAX_LEVELS]
                 [EWA_TEXTURE_MAX_LEVELS]; ///< [u][v]: 4 floats per texel; NULL: not made
} ewa_texture_plan;

/// Sums of a tile: pixel (x, y) of the tile is at (y + 1) EWA_TEXTURE_PITCH + x + 1.
typedef struct ewa_texture_sums {
    float *color;  ///< 4 per pixel: sums of weight times colour; the last is of alpha, or else of weights
    float *weight; ///< 1 per pixel, with alpha only
} ewa_texture_sums;

/// Texels of one level, a rectangle of at most EWA_TEXTURE_NODE_U x EWA_TEXTURE_NODE_V, to be added to a
/// tile.
typedef struct ewa_texture_block {
    uint32_t width, height;
    float row_start[EWA_TEXTURE_NODE_V][3]; ///< homogeneous, tile coordinates: centre of a row's first texel
    float step_u[3], step_v[3];             ///< from texel to texel
    float colors[EWA_TEXTURE_NODE_V][EWA_TEXTURE_NODE_U][4]; ///< linear, premultiplied; opaque ones end in 1
    float area_scale; ///< sigma^2 |det map| of the level: the area of a kernel is this over w^3
} ewa_texture_block;

/// Numbers that the kernels need beside a block.
typedef struct ewa_texel_filter {
    float cutoff2;     ///< F^2
    float prefilter2;  ///< h^2
    float reach_px;    ///< F h
    float sigma;       ///< of a texel
    float determinant; ///< sigma^2 |det map| of the texture itself
} ewa_texel_filter;

/// Adds a block to the sums of a tile; every version does the same operations in the same order. Splats have
/// w > plan.tangent_w * EWA_TEXTURE_NEAR all over the block. Returns how many texels touch the tile.
typedef uint32_t ewa_texture_draw(const ewa_texel_filter *filter, const ewa_texture_block *block,
                                  const ewa_texture_sums *sums);

/// Writes the pixels of a tile from its sums. `coverage`, EWA_TEXTURE_TILE numbers per row, may be NULL:
/// all 1.
typedef void ewa_texture_resolve(const ewa_texture_target *target, const float background[4],
                                 const ewa_tile_rect *tile, const ewa_texture_sums *sums,
                                 const float *coverage);

typedef struct ewa_texture_kernels {
    ewa_texture_draw *points, *splats;
    ewa_texture_resolve *resolve;
} ewa_texture_kernels;

EWA_DECLARE_VERSIONS(const ewa_texture_kernels, ewa_texture_kernels);

/// Distance to the eye plane, in supports of a texel, below which the projected kernel is evaluated along
/// rays.
#define EWA_TEXTURE_NEAR 1.25

/// How a texel is seen: an ellipse with its filter, or, near the eye plane, its disc along rays.
typedef struct ewa_texel_kernel {
    double center_px[2];
    double conic[3];   ///< xx, xy, yy of the filtered variance's inverse
    double half_px[2]; ///< half sides of the support's box; infinite along rays
    double amplitude;
    bool along_rays;
    double center_texels[2];
} ewa_texel_kernel;

/// Checks the arguments and fills the plan; nothing is allocated.
ewa_status ewa_texture_plan_make(ewa_context *context, const ewa_texture_source *source, const ewa_mat3 *map,
                                 const ewa_texture_options *options, const ewa_texture_target *target,
                                 ewa_texture_plan *plan);

/// Projects the texel with centre (u, v), as a point or as a splat. Returns false where it is not seen.
bool ewa_texel_place(const ewa_texture_plan *plan, double u, double v, bool as_point,
                     ewa_texel_kernel *kernel);

/// Whether a texel is so small that the hybrid method draws it as a point.
bool ewa_texel_is_minified(const ewa_texture_plan *plan, double u, double v);

/// Weight of a texel at a place of the picture; 0 beyond the cutoff.
double ewa_texel_weight(const ewa_texture_plan *plan, const ewa_texel_kernel *kernel, double x_px,
                        double y_px);

/// Reads texel (column, row), linear and premultiplied; the last number is 1 for opaque sources.
void ewa_texel_read(const ewa_texture_source *source, uint32_t column, uint32_t row, float color[4]);

/// The same for `count` texels from `column` on, in one row.
void ewa_texel_read_row(const ewa_texture_source *source, uint32_t column, uint32_t row, uint32_t count,
                        float (*colors)[4]);

/// Share of a pixel that the texture covers.
double ewa_texture_coverage(const ewa_texture_plan *plan, uint32_t x, uint32_t y);

/// Whether the texture covers all pixels of a rectangle.
bool ewa_texture_covers(const ewa_texture_plan *plan, uint32_t x, uint32_t y, uint32_t width,
                        uint32_t height);

/// Writes one pixel of the target: `color` linear, premultiplied with its own alpha color[3]; `coverage` as
/// above.
void ewa_texture_put(const ewa_texture_plan *plan, uint32_t x, uint32_t y, const float color[4],
                     float coverage);

/// Finds the levels along both axes.
void ewa_texture_levels_describe(ewa_texture_plan *plan);

/// Makes the levels [u][v] that are marked, and those that they are made from.
ewa_status ewa_texture_levels_make(ewa_texture_plan *plan, const uint8_t *wanted, ewa_texture_stats *stats);
void ewa_texture_levels_free(ewa_texture_plan *plan);

/// Copies texels of a level, from (u, v) on, wrapped when repeated, into a block whose width and height are
/// set.
void ewa_texture_levels_read(const ewa_texture_plan *plan, uint32_t level_u, uint32_t level_v, int64_t u,
                             int64_t v, ewa_texture_block *block);

/// What drawing a tile counts.
typedef struct ewa_texture_counts {
    uint64_t splat_count, point_count, texel_count, point_texel_count;
} ewa_texture_counts;

/// What a worker draws with.
typedef struct ewa_texture_brush {
    const ewa_texture_kernels *kernels;
    ewa_texel_filter filter;
    ewa_texture_sums sums;
    ewa_texture_block *block;
    ewa_texture_counts counts;
    double spared_texels; ///< where levels are only counted: texels that levels draw less
    uint8_t *wanted;      ///< when not NULL, nothing is drawn: levels that would be are marked, [u][v]
} ewa_texture_brush;

/// Draws, in a fixed order, every texel that reaches the tile whose first pixel is (x, y).
void ewa_texture_walk(const ewa_texture_plan *plan, ewa_texture_brush *brush, uint32_t x, uint32_t y);

/// Interpolates between the four texels around a pixel's centre; false where that is not in front.
bool ewa_texture_interpolate(const ewa_texture_plan *plan, uint32_t x, uint32_t y, float color[4]);

/// The same picture in double precision, one texel after another and without levels: slow, plain, and the
/// definition of what ewa_texture_map() draws. Not with `repeat`.
ewa_status ewa_texture_map_reference(ewa_context *context, const ewa_texture_source *source,
                                     const ewa_mat3 *map, const ewa_texture_options *options,
                                     const ewa_texture_target *target);

#endif
