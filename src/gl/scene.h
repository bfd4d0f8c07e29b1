// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What programs see of a frame, as src/gl/shaders/band.glsl, scene.glsl, cull.glsl and sums.glsl declare it.
#ifndef EWA_SRC_GL_SCENE_H
#define EWA_SRC_GL_SCENE_H

#include "surface/view.h"

enum {
    EWA_GL_ORTHOGRAPHIC = 1,
    EWA_GL_CULL_BACK = 2,
    EWA_GL_ELLIPSES = 4,
    EWA_GL_AFFINE = 8,
    EWA_GL_SOURCE = 16,
    EWA_GL_CIRCULAR = 32,
    EWA_GL_RAYCAST = 64,
    EWA_GL_POINTS = 128,
    EWA_GL_HIDES = 256,
    EWA_GL_SEE_THROUGH = 1024, ///< what is behind surfaces shows through them
    EWA_GL_RECORD_BYTES = 96
};

/// A source's ewa_view.
typedef struct ewa_gl_view {
    double focal_px[2], principal_px[2];
    float rotation[9];
    float scale;
    float fx_px, fy_px, inverse_fx, inverse_fy;
    float zoom, fx_zoomed, fy_zoomed;
    float broad;
    float cutoff, cutoff2, inverse_cutoff, center_scale;
    float prefilter2_px2, reach_px;
    float point_x, point_y, point_major, point_minor, point_sigma;
    float tolerance, grazing;
    float exponent_scale, exponent_end;
    float sum_scale, color_scale, depth_scale;
    uint32_t doublings, flags;
    float contour_shift, contour_sine2, curvature_scale;
} ewa_gl_view;

/// Where a source's packets are: of its ewa_view what culling reads.
typedef struct ewa_gl_placement {
    double linear[9], anchor[3], offset[3];
    double sections[EWA_MAX_SECTION_PLANES][4];
    float side_planes[4][3];
    float cx_px, cy_px, margin_px, section_reach;
    uint32_t section_count, width_px, height_px, material;
} ewa_gl_placement;

/// What all programs see of a band of rows; as std140 has it.
typedef struct ewa_gl_band_block {
    uint32_t picture_px[2], band_px[2], first_px[2];
    uint32_t tiles_per_row, tile_count, tile_side_px;
    float exponent_end;
    uint32_t layers, merge_last, with_codes;
    int32_t plane_at[4]; ///< of rgba, depth, normal, coverage; -1: not wanted
    uint32_t pair_capacity, list_capacity, unit_capacity, request_capacity;
    uint32_t unit_splats, group_limit, parts, has_host_records;
} ewa_gl_band_block;

/// What programs count, before the arguments of indirect dispatches.
typedef struct ewa_gl_tally {
    uint32_t pair_count, kept_count, near_count, clip_count, list_count, carry, unit_count, broken_count;
    uint32_t culled_groups, divided_groups;
    uint32_t stopped_count; ///< pixels whose program the driver ended early
    uint32_t unfinished_count, round_count; ///< tiles of which more rounds over edges are to come; rounds that others took
    uint32_t pad[3];
} ewa_gl_tally;

/// Packets of one source that lie side by side in a page, and whose surfels have `streams` (bits of ewa_gl_stream). Culling has a
/// group of invocations for each EWA_GL_GROUP_PACKETS, from `first_group` on.
typedef struct ewa_gl_segment {
    uint32_t first_group, at, count, source, first, streams, pad[2];
} ewa_gl_segment;

enum { EWA_GL_GROUP_PACKETS = 64 };

/// Arguments of indirect dispatches, in the order in which they follow the counts.
enum { EWA_GL_OF_LISTS, EWA_GL_OF_UNITS, EWA_GL_OF_PAGES, EWA_GL_ARGUMENT_BYTES = 16 };

/// A surfel that the host is asked for something of.
typedef struct ewa_gl_host_request {
    uint32_t surfel, source, field, pad;
} ewa_gl_host_request;

/// A packet in a field, a tile of work, a unit of it, and a record in a list, as programs have them.
enum { EWA_GL_PAIR_BYTES = 40, EWA_GL_TILE_BYTES = 24, EWA_GL_UNIT_BYTES = 16, EWA_GL_ENTRY_BYTES = 8 };

/// ewa_clip.
typedef struct ewa_gl_clip {
    float lines[EWA_CLIP_LINES][8];
    uint32_t count, either, pad[2];
} ewa_gl_clip;

/// ewa_near_record.
typedef struct ewa_gl_near {
    float u[3], v[3], w[3], z[3];
    float depth_low, depth_high, tolerance;
    float color[3], normal[3], opacity, material[EWA_MATERIAL_CHANNELS];
    uint32_t flags, source, pad[2];
    ewa_gl_clip clip;
} ewa_gl_near;

/// ewa_resolve.
typedef struct ewa_gl_resolve {
    float unit_coverage_inverse, alpha_scale, covering, front_scale;
    float color_unit, material_units[EWA_MATERIAL_CHANNELS];
    float opacity, depth_unit, depth_per_share, texels_per_radian2;
    float material[EWA_MATERIAL_CHANNELS];
    float environment_from_camera[9];
    float background[4];
    float ray_x[2], ray_y[2];
    float to_world[9];
    uint32_t flags, shading, light_count, level_count;
    struct {
        uint32_t headlight;
        float toward[3], color[3];
    } lights[EWA_MAX_LIGHTS];
    struct {
        uint32_t width, height, first, pad;
    } levels[EWA_MAX_ENVIRONMENT_LEVELS];
    float materials[EWA_MAX_MATERIALS][EWA_MATERIAL_CHANNELS]; ///< of surfels
} ewa_gl_resolve;

void ewa_gl_view_set(ewa_gl_view *to, const ewa_view *from, bool hides);

/// `material` is that of surfels that have none of their own.
void ewa_gl_placement_set(ewa_gl_placement *to, const ewa_view *from, uint8_t material);
void ewa_gl_clip_set(ewa_gl_clip *to, const ewa_clip *from);
void ewa_gl_near_set(ewa_gl_near *to, const ewa_near_record *from, uint32_t source);
/// All but the surfels' materials, which are 0.
void ewa_gl_resolve_set(ewa_gl_resolve *to, const ewa_resolve *from);

#endif
