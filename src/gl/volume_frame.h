// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A frame of a volume as the device sees it (shaders/volume_scene.glsl), and its blocks in tiles, by the processor's own bins.
#ifndef EWA_SRC_GL_VOLUME_FRAME_H
#define EWA_SRC_GL_VOLUME_FRAME_H

#include "gl/device.h"
#include "volume/render.h"

enum {
    EWA_GL_MAX_SPAN = 512,      ///< units of a block, at most
    EWA_GL_POINT_WORDS = 5,     ///< of a record
    EWA_GL_SPLAT_WORDS = 21,    ///< of a record where some are splats
    EWA_GL_STATE_WORDS = 5,     ///< of a pixel that waits for the next dispatch
    EWA_GL_BOUND_WORDS = 2,     ///< of a pixel: where its ray ends and begins
    EWA_GL_TILE_GROUPS = 64,    ///< that draw a tile, 8x8 pixels each
    EWA_GL_TILE_PIXELS = EWA_VOLUME_TILE_PX * EWA_VOLUME_TILE_PX,
};

typedef struct ewa_gl_volume_light {
    float toward[3], color[3];
    uint32_t headlight;
} ewa_gl_volume_light;

typedef struct ewa_gl_volume_view {
    uint32_t orthographic, lit, highlights, with_depth, has_near, mark_splats, with_sections;
    int32_t point_slice;
    uint32_t longest_span, group_limit;
    float fx_px, fy_px, cx_px, cy_px, focal_px;
    float axes[9], to_deviations[9];
    float unit_inverse, unit_offset, color_scale, marked_color[3];
    float point_mass, splat_peak, density, bend;
    float covariance[6], inverse[6];
    float cutoff, cutoff2, prefilter2_px2, reach, splat_margin_px, minimum_transmittance, depth_deviation;
    float to_world[9], toward_viewer[3];
    float ambient, diffuse, specular, shininess, flat_share;
    uint32_t light_count;
    ewa_gl_volume_light lights[EWA_MAX_LIGHTS];
    float background[4];
    uint32_t unit_camera[2], picture_px[2];
    int32_t planes_at[4]; ///< bytes, colours, depths, coverages in the result; -1: not wanted
    uint32_t record_words, bounds_at, turns;
} ewa_gl_volume_view;

/// A block of voxels in a tile.
typedef struct ewa_gl_volume_pair {
    float origin[3];
    int32_t slice_first, slice_last;
    uint32_t first_voxel, count, first_record, first_run, tile, box;
} ewa_gl_volume_pair;

typedef struct ewa_gl_volume_tile {
    int32_t x_px, y_px, width_px, height_px;
    uint32_t first_pair, end_pair, first_record, first_bucket;
    int32_t first_unit, last_unit;
    uint32_t first_near, end_near;
} ewa_gl_volume_tile;

typedef struct ewa_gl_volume_unit {
    uint32_t filter;
    float z, passed;
} ewa_gl_volume_unit;

typedef struct ewa_gl_volume_near {
    float offset[3], square, color[3], extinction, z;
} ewa_gl_volume_near;

/// Tiles that are drawn together, and what they need room for.
typedef struct ewa_gl_volume_part {
    uint32_t first_tile, end_tile, first_pair, end_pair;
    uint32_t records, runs, buckets;
    uint32_t most_units; ///< of splats, of a tile
    uint64_t most_turns; ///< of loops, of a group that draws pixels
} ewa_gl_volume_part;

/// The lists of a frame. Zero-initialise.
typedef struct ewa_gl_volume_lists {
    ewa_buffer pairs, tiles, units, nears, parts, bounds;
    uint32_t pair_count, tile_count, unit_count, near_count, part_count;
    size_t bound_count; ///< floats of `bounds`; 0: nothing bounds rays
    uint32_t record_words;
    ewa_gl_volume_view view;
} ewa_gl_volume_lists;

/// Why a frame is one that the device does not draw; NULL: it does.
const char *ewa_gl_volume_refuse(const ewa_gl *device, const ewa_volume_frame *frame);

/// Lists what the device is told of a frame that it draws; `view` but for the planes and the turns. Errors: EWA_ERROR_LIMIT (one tile
/// is more than buffers hold), EWA_ERROR_MEMORY.
ewa_status ewa_gl_volume_lists_fill(ewa_gl *device, ewa_gl_volume_lists *lists, const ewa_volume_frame *frame);

void ewa_gl_volume_lists_free(ewa_context *context, ewa_gl_volume_lists *lists);

#endif
