// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Forward mapping of planar textures: every texel is sent to the picture, as a splat where it is magnified
// and as a point where it is minified (docs/math.md section 11, docs/texture.md).
//
// Texture coordinates (u, v) and picture coordinates (x, y) are in pixels of each, texel (i, j) covers
// [i, i+1) x [j, j+1). A map takes row vectors: [x w, y w, w] = [u, v, 1] M; what has w > 0 is seen.
//
// Based on: Yuan, Nguyen, Xu, Chen, "Hybrid Forward Resampling and Volume Rendering", 2003, sections 2 and 3.
#ifndef EWA_RESAMPLE_H
#define EWA_RESAMPLE_H

#include "ewa/base.h"
#include "ewa/camera.h"
#include "ewa/homogeneous.h"
#include "ewa/options.h"

#ifdef __cplusplus
extern "C" {
#endif

/// What the numbers of a raster are.
typedef enum ewa_pixel_format {
    EWA_PIXEL_SRGB8 = 0,  ///< uint8_t, sRGB; alpha is linear and straight
    EWA_PIXEL_LINEAR = 1, ///< float, linear light; alpha is premultiplied
} ewa_pixel_format;

/// An image in the caller's memory, read in place. Channels are interleaved: 1 grey, 3 RGB, 4 RGBA.
typedef struct ewa_texture_source {
    const void *pixels; ///< rows from the top
    ewa_pixel_format format;
    uint32_t channel_count; ///< 1, 3 or 4
    uint32_t width_px, height_px;
    size_t stride_bytes; ///< from row to row; floats are aligned to 4 bytes
} ewa_texture_source;

/// The picture to write, in the caller's memory, which must not overlap the source. Without alpha, it is over
/// the background; 1 channel needs a grey source.
typedef struct ewa_texture_target {
    void *pixels; ///< rows from the top
    ewa_pixel_format format;
    uint32_t channel_count; ///< 1, 3 or 4
    uint32_t width_px, height_px;
    size_t stride_bytes; ///< from row to row; bytes between rows are left alone
} ewa_texture_target;

typedef enum ewa_texture_method {
    EWA_TEXTURE_HYBRID = 0,   ///< points where minified along both axes, else splats
    EWA_TEXTURE_SPLAT = 1,    ///< every texel is a splat: the exact ellipse of its disc, filtered
    EWA_TEXTURE_POINT = 2,    ///< every texel is a point under a circular filter: holes where magnified
    EWA_TEXTURE_BILINEAR = 3, ///< backward: the four texels around each pixel's centre, no filter
} ewa_texture_method;

/// How a texture is mapped. Fill with ewa_texture_options_init().
typedef struct ewa_texture_options {
    size_t struct_size;
    ewa_texture_method method; ///< default EWA_TEXTURE_HYBRID
    double prefilter_px;       ///< h, standard deviation of the pixel filter; [0.1, 4]; default 0.3
    double cutoff;             ///< F, standard deviations at which kernels end; [1, 4]; default 3.3
    double sigma_texels;       ///< standard deviation of a texel's disc; [0.3, 2]; default 0.4
    double
        point_spacing_px; ///< hybrid: texels not farther apart than this are points; [0.05, 1]; default 0.5
    bool repeat;          ///< the texture fills its whole plane; not for EWA_TEXTURE_SPLAT; default false
    float background[4];  ///< linear, [0, 1e6], straight alpha; default transparent black
} ewa_texture_options;

EWA_API extern const ewa_option_table ewa_texture_options_table;
EWA_API void ewa_texture_options_init(ewa_texture_options *options, size_t struct_size);

/// What a mapping took.
typedef struct ewa_texture_stats {
    uint64_t splat_count, point_count; ///< drawn, over all tiles: a texel in two tiles counts twice
    uint64_t texel_count;       ///< texels that these stand for: a point of a pre-summed level for several
    uint64_t point_texel_count; ///< of these, those that points stand for
    uint64_t level_bytes;       ///< of pre-summed levels
    double levels_s;            ///< to make those, wall clock
    double total_s;             ///< wall clock of the call
} ewa_texture_stats;

/// Draws a texture through a map. Colours are averaged in linear light, weighted by the kernels; alpha is the
/// share of the pixel that the texture's rectangle covers, exactly, times that of the texels. Texels that are
/// not in front (w <= 0) are left out. Texels closer than half of `point_spacing_px` are drawn from
/// pre-summed levels (averages over 2x1, 1x2, 2x2, ... texels) with the same sum of weights, so that the work
/// per pixel is bounded at horizons. The same bytes for every number of threads and every instruction set;
/// held by tests to plain double precision. `options` and `stats` may be NULL. Errors: EWA_ERROR_ARGUMENT
/// (shapes, options, a map that is not finite), EWA_ERROR_NUMERIC (a singular map), EWA_ERROR_LIMIT (a side
/// over ewa_limits.max_image_side), EWA_ERROR_MEMORY, EWA_CANCELLED; then the picture is undefined.
EWA_API ewa_status ewa_texture_map(ewa_context *context, const ewa_texture_source *source,
                                   const ewa_mat3 *map, const ewa_texture_options *options,
                                   const ewa_texture_target *target, ewa_texture_stats *stats);

/// Makes the map that takes the corners (0, 0), (width, 0), (width, height), (0, height) of a texture to four
/// points of the picture, in pixels. Errors: EWA_ERROR_NUMERIC (map unchanged) when three of them are on a
/// line, when the points are not the corners of a convex quadrangle, or when a number is not finite.
EWA_API ewa_status ewa_texture_map_from_corners(ewa_context *context, uint32_t width_px, uint32_t height_px,
                                                const double corners_px[4][2], ewa_mat3 *map);

/// Makes the map of a texture on a plane of the world, seen by a camera: its corner (0, 0) is at
/// `origin_world`, `across_world` goes from there along its whole first row and `down_world` along its whole
/// first column. Errors: EWA_ERROR_ARGUMENT (camera), EWA_ERROR_NUMERIC (map unchanged) when a number is not
/// finite, the axes are parallel or the plane goes through the eye.
EWA_API ewa_status ewa_texture_map_from_camera(ewa_context *context, uint32_t width_px, uint32_t height_px,
                                               const ewa_camera *camera, const double origin_world[3],
                                               const double across_world[3], const double down_world[3],
                                               ewa_mat3 *map);

#ifdef __cplusplus
}
#endif
#endif
