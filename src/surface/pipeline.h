// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The hot loops of the pipeline, written once in pipeline_body.h and compiled per instruction set; the same
// bytes from each. Their reference is src/reference/surface.c; rules and numbers are those of
// docs/math.md sections 2 to 9 and of semantics.h.
//
// A frame: cull packets into tile rectangles; then per tile, run by run (32 packets): set up records, sort
// them by the shape of their box in 4x4-pixel blocks, lower `nearest`; when all runs are done turn `nearest`
// into the bound of the second pass, accumulate all records, resolve.
#ifndef EWA_SRC_SURFACE_PIPELINE_H
#define EWA_SRC_SURFACE_PIPELINE_H

#include "ewa/render.h"
#include "image/environment.h"
#include "surface/packet.h"
#include "surface/semantics.h"
#include "tiling/bin.h"
#include "wide/isa.h"
#include "wide/lights.h"

#include <stdbool.h>
#include <stddef.h>

enum {
    EWA_BLOCK_PX = 4, ///< a block is 4x4 pixels, one 16-lane vector
    EWA_BLOCK_LANES = 16,
    EWA_RUN_PACKETS = 32, ///< packets that are set up before their depths are used
    EWA_RUN_RECORDS = EWA_RUN_PACKETS * EWA_PACKET_LANES,
    EWA_ROW_CLASSES = 5,                                    ///< boxes of 1, 2, 3, 4 and more rows of blocks
    EWA_COLUMN_CLASSES = 4,                                 ///< boxes of 1, 2, 3, 4 columns
    EWA_STEEP_CLASS = EWA_ROW_CLASSES * EWA_COLUMN_CLASSES, ///< first class of steep splats
    EWA_WIDE_CLASS = 2 * EWA_STEEP_CLASS,                   ///< wider boxes, parts of large splats
    EWA_CLIP_CLASS = EWA_WIDE_CLASS + 1,                    ///< splats with clip lines
    EWA_SMALL_CLASS = EWA_CLIP_CLASS + 1,                   ///< boxes of 1 to 3 columns and rows of pixels
    EWA_SMALL_PX = 3,
    EWA_CLASS_COUNT = EWA_SMALL_CLASS + EWA_SMALL_PX * EWA_SMALL_PX,
    EWA_SMALL_X_SHIFT = 22, ///< in ewa_record.box: the box's first pixel in its block
    EWA_SMALL_Y_SHIFT = 30,
    EWA_PIXEL_FLOATS = 8,         ///< of ewa_tile.pixels
    EWA_BACK_FACING_BIT = 1 << 6, ///< in ewa_record.box: faces away from the viewer
    EWA_STEEP_BIT = 1 << 7,       ///< in ewa_record.box: steep or wide
    EWA_CONCAVE_BIT = 1 << 14,    ///< in ewa_record.box: of no layer behind the first: at a contour, seen from inside
    EWA_CLIP_BIT = 1 << 15,       ///< in ewa_record.box: clipped
    EWA_MATERIAL_CHANNELS = 5,    ///< ambient, diffuse, specular, shininess, reflection
    EWA_MAX_CHANNELS = 9 + EWA_MATERIAL_CHANNELS,
    EWA_SUM_UNITS =
        1 << 22, ///< the range of sums, and at most of a weight of 1; splats have up to 1 / (2 pi)
    EWA_MAX_TERM_UNITS = 667600, ///< no less than EWA_SUM_UNITS / (2 pi)
    EWA_TERMS_PER_CARRY = 6,     ///< of EWA_MAX_TERM_UNITS
    EWA_MAX_ROOM = 64,           ///< surfaces' worth of weight that sums have room for at most
    EWA_CUT_CHANNELS = 4,        ///< of splats that clip lines cut: kept weight, whole weight, direction
    EWA_CELL_BLOCKS = 4, ///< along a side of a cell, for which one depth decides whether packets are hidden
    EWA_TILE_CELLS = 8,  ///< cells along a side of the largest tile
    EWA_FIELD_PX = 128,  ///< side of a field: squares of the picture in which places are measured
    EWA_GROUP_RECORDS = 64,
    EWA_BOX_LEVELS = 3,       ///< of ewa_edge_boxes
    EWA_BOX_GUARD = 0x8080,   ///< a bit above each number, so that they can be compared by one subtraction
    EWA_EYE_DOME_REACH = 4,   ///< pixels that eye-dome lighting looks away
    EWA_MAX_TILE_BLOCKS = 32, ///< along a side, so that a row of blocks is a word of bits
};

/// Largest s that the kernels' exponential takes before it doubles: cutoffs up to 3 need two doublings.
#define EWA_EXPONENT_END 1.13

/// Everything about camera and options that the kernels read. Camera space has a unit of its own, a power of
/// two near the scene's size from the eye, so that no square leaves single precision; packets have theirs.
typedef struct ewa_view {
    double linear[9], anchor[3],
        offset[3];                       ///< packets' centres to camera space: linear (c - anchor) + offset
    double focal_px[2], principal_px[2]; ///< orthographic: pixels per unit
    float rotation[9];                   ///< camera from world, row-major, without scale
    float scale;                         ///< of lengths in packets to camera space
    float fx_px, fy_px, cx_px, cy_px;
    float zoom;                 ///< power of two near the larger focal length
    float fx_zoomed, fy_zoomed; ///< focal lengths over it
    float broad; ///< a sigma of this many depths (orthographic: this large) is drawn by pixel rays
    float cutoff, cutoff2;
    float prefilter2_px2; ///< h^2
    float reach_px;       ///< F h; points: F point_sigma_px
    float margin_px;      ///< beyond which no splat reaches past the outline of its packet's sphere
    float curvature_scale; ///< 2 over the focal length and the lengths in packets
    float contour_shift;  ///< c of semantics.h, contours; 0: splats stay where they are
    float contour_sine2;  ///< S
    bool transparent;     ///< what is behind surfaces shows through them
    float point_sigma_px; ///< of points (semantics.h); 0: surfels as they are
    float tolerance;      ///< kappa F
    float grazing; ///< 1, or 0 with one pass: whether the tolerance grows where surfels are seen edge-on
    float exponent_scale; ///< s = exponent_scale r^2, so that exp(-r^2/2) = exp(-s)^(2^doublings)
    float exponent_end;   ///< exponent_scale F^2
    uint32_t doublings;
    uint32_t width_px, height_px;
    uint32_t tile_px;
    bool orthographic, cull_back, ellipses;
    bool affine;                    ///< V is that of the affine map: all kernels but perspective
    bool source, circular, raycast; ///< what becomes of V; neither: affine
    float sum_scale;   ///< units of sums per weight: the largest weight has at most EWA_SUM_UNITS / (2 pi)
    float color_scale; ///< per colour
    float depth_scale; ///< orthographic: depths times this are within [-1, 1]
    const float (
        *materials)[EWA_MATERIAL_CHANNELS]; ///< [code], over the largest; NULL: surfels have no codes
    float side_planes[4][3]; ///< inward unit normals of the frustum's sides through the eye, widened by
                             ///< margin_px
    double sections[EWA_MAX_SECTION_PLANES][4]; ///< unit normal inward, distance from where packets' centres
    uint32_t section_count;                     ///< are measured from, in their unit
    float section_reach;                        ///< F; 0 for points
} ewa_view;

/// Packets' centres in camera space, one entry each, written by `cull` for those that it keeps. Surfels are
/// projected relative to their centre's picture, so that they lose nothing by its distance from the eye, from
/// the axis or from the world's origin.
///
/// Perspective: x = slope_x z + rest_x, slope_x a float near x / z (0 where packets touch the eye plane),
/// likewise y. Orthographic: x = slope_x + rest_x.
typedef struct ewa_packet_places {
    float *slope_x, *slope_y, *rest_x, *rest_y, *depth;
    uint16_t *lanes; ///< a bit per surfel that the section planes leave; NULL: no planes
    uint16_t *cuts;  ///< a bit per surfel that one of them cuts; NULL: none is
} ewa_packet_places;

/// One splat in one tile. Places are measured from the middle of the field, of EWA_FIELD_PX pixels a side,
/// that the tile lies in, and centres are rounded so that their distances from pixels there are exact: what a
/// pixel gets does not depend on how the picture is cut into tiles. dx, dy below are measured from the
/// splat's centre to a pixel's centre.
///
/// Plain splats compare planes: their key, and that of z + eps (perspective: its tangent at the centre). The
/// key of steep ones (semantics.h) is clamped first, and the key of z + eps made of it: bound_scale key +
/// bound_offset; wide ones in perspective have bound_scale 0, bound_offset eps, and key / (1 + eps key).
///
/// Raycast splats hold V in xx, xy, yy (pipeline_raycast.h).
typedef struct ewa_record {
    float offset_x, offset_y; ///< upper left corner of the box minus the splat's centre, pixels
    float xx, xy, yy;         ///< s = xx dx^2 + xy dx dy + yy dy^2
    float key, key_x, key_y;  ///< 1/z (orthographic: -z) at the centre and its gradient per pixel
    union {
        struct {
            float bound, bound_x, bound_y; ///< plain
        };
        struct {
            float bound_scale, bound_offset, key_high; ///< steep or wide
        };
    };
    float key_low;          ///< the key is nowhere below, plain or not
    float red, green, blue; ///< times the resampling kernel's peak and the surfel's opacity, in units of sums
    uint32_t
        box; ///< first column | EWA_BACK_FACING_BIT | EWA_STEEP_BIT | first row << 8 | EWA_CONCAVE_BIT | EWA_CLIP_BIT | columns
             ///< << 16 | rows << 24, in blocks; first pixel in its block << EWA_SMALL_X_SHIFT, _Y_SHIFT
} ewa_record;

static inline uint32_t ewa_box_columns(uint32_t box) { return box >> 16 & 0x3f; }
static inline uint32_t ewa_box_rows(uint32_t box) { return box >> 24 & 0x3f; }

/// Marks the blocks of a record's box.
static inline void ewa_mark_box(uint32_t *rows, uint32_t box) {
    const uint32_t columns = (uint32_t)(((1ull << ewa_box_columns(box)) - 1) << (box & 0x3f));
    const uint32_t first = box >> 8 & 0x3f, end = first + ewa_box_rows(box);
    for (uint32_t row = first; row < end; row++) rows[row] |= columns;
}

/// A clip line on the screen: the pixel whose centre is x, y in the field is x_inward x + y_inward y + offset
/// pixels inside. A line that is not there keeps everything: 0, 0, 1, and 0.
typedef struct ewa_clip_line {
    float x_inward, y_inward, offset;
    float reach;                  ///< |x_inward| / 2 + |y_inward| / 2: the square ends so far from its centre
    float narrow;                 ///< the smaller of |x_inward|, |y_inward|
    float per_narrow, per_widths; ///< 1 / narrow (0 for 0), 1 / twice the larger
} ewa_clip_line;

/// The clip lines of a splat. What all keep is kept.
typedef struct ewa_clip {
    ewa_clip_line line[EWA_CLIP_LINES];
    uint32_t count; ///< of `line`, at least 2
    bool either;    ///< of the first two lines: what one of them keeps is kept
} ewa_clip;

/// A splat of a run that has clip lines.
typedef struct ewa_clipped {
    uint32_t record; ///< in the run
    uint32_t surfel; ///< packet * 16 + lane
} ewa_clipped;

/// A surfel that is drawn by pixel rays: U, V, W, Z are linear in the field's pixel coordinates; u = U/W, v =
/// V/W in standard deviations, z = Z/W.
typedef struct ewa_near_record {
    float u[3], v[3], w[3], z[3]; ///< at the field's origin, per x, per y
    float depth_low, depth_high;
    float tolerance;
    float color[3], normal[3]; ///< colour times opacity
    float opacity;
    float material[EWA_MATERIAL_CHANNELS];
    bool is_back, clipped;
    ewa_clip clip;
    uint32_t surfel; ///< packet * 16 + lane
} ewa_near_record;

/// The part of a splat that only the second pass reads.
typedef struct ewa_load {
    float normal[3]; ///< camera space, unit, towards the viewer; times peak
    float peak;      ///< of the resampling kernel, in units of sums
} ewa_load;

/// Where packets are, and what belongs to them.
typedef struct ewa_packet_source {
    const ewa_packet *packets;
    const uint16_t *colors; ///< the form of their colours
    ewa_packet_places places;
    const uint16_t *opacities;  ///< [packet][lane], times 65535; NULL: all are opaque
    const uint16_t *clip_masks; ///< [packet]: lanes with clip lines; NULL: none
    const uint16_t *curvatures; ///< [packet][lane]: upper halves of floats; NULL: no splat moves
    const uint8_t *materials;   ///< [packet][lane]: codes; NULL: all have `material`
    uint8_t material;
    bool billboards; ///< there may be some
} ewa_packet_source;

/// A run of packets as splats of a tile. `records` and `loads` have room for EWA_PACKET_LANES more than are
/// written.
typedef struct ewa_run {
    ewa_record *records;
    ewa_load *loads;
    float *opacities;   ///< times the kernel's peak; NULL: all are opaque
    uint8_t *materials; ///< NULL: all have the same
    uint32_t *surfels;  ///< packet * 16 + lane; NULL: nobody asks
    int32_t *boxes;     ///< ewa_record.box, beside each other for ewa_edge_boxes, likewise
    float *key_lows;    ///< ewa_record.key_low
    uint8_t classes[EWA_RUN_RECORDS + EWA_PACKET_LANES];
    uint32_t near_surfels[EWA_RUN_RECORDS]; ///< packet * 16 + lane
    ewa_clipped clipped[EWA_RUN_RECORDS];
    uint32_t count, near_count, clipped_count;
    uint32_t small_count; ///< that are of few pixels, as small splats or not
    float min_key;        ///< the smallest ewa_record.key_low
} ewa_run;

/// A run's splats in the order of their classes: class c is order[class_first[c] .. class_first[c + 1]).
typedef struct ewa_sorted_run {
    const ewa_record *records;
    const ewa_load *loads;
    const float *opacities;   ///< NULL: all are opaque
    const uint8_t *materials; ///< NULL: all have the same
    const uint32_t *surfels;  ///< NULL: nobody asks
    const ewa_clip *clips;    ///< of the records that have EWA_CLIP_BIT
    const uint16_t *order;
    uint16_t class_first[EWA_CLASS_COUNT + 1];
} ewa_sorted_run;

/// Sums of a tile's pixels, in units (pipeline_sums.h).
typedef struct ewa_sums {
    float *planes;       ///< [block][channel][16]
    float *high;         ///< the same: bits of integers, what has been carried, of blocks that have some
    size_t fine;         ///< numbers from either to what the units of terms leave; 0: that is lost
    bool careful;        ///< terms are counted, so that sums have no bounds
    uint32_t max_visits; ///< between two carries
    uint32_t *visits;    ///< [block]: terms since something was carried (pipeline_sums.h)
    uint32_t *high_rows; ///< [block row]: bit per block column of which something has been carried
} ewa_sums;

/// Side accumulators next to a surface's own sums, only in the blocks that need them: of a block that is not
/// marked, nothing is initialised. With unclipped splats only `cut` and `cut_rows` may be NULL.
typedef struct ewa_side_sums {
    ewa_sums is_back;           ///< as ewa_tile.sums: of back-facing splats
    ewa_sums cut;               ///< EWA_CUT_CHANNELS; finalized: covered share, nothing, mean direction inward
    uint32_t *back_facing_rows; ///< [block row]: bit per block column
    uint32_t *cut_rows;
} ewa_side_sums;

/// What passes back from pixels to colours read and write (pipeline_gather.h). They go from first surfaces and those behind
/// to their splats; with `filled`, from first surfaces that fill their pixels, as if these showed nothing else.
typedef struct ewa_gather {
    const float *rgba;    ///< what a loss changes per number of the picture's colours, as ewa_frame.rgba; NULL: `weights`
    const float *weights; ///< the same of all colours of a pixel, one number each; NULL: 1
    float units;          ///< of sums per such a number; a power of two
    float *planes;        ///< [block][EWA_GATHER_PLANES][16]
    uint32_t *rows;       ///< [block row]: bit per block column that has planes
    bool beyond;          ///< of a surface behind the first
    bool filled;
    float minimum_alpha;  ///< with `filled`: of pixels that count
    bool squares;         ///< squares of what splats are of pixels, not these
    const float *colors;  ///< with `filled`: [surfel][4], whose picture takes the place of `rgba`, times `weights`; NULL: none
    float *shown;         ///< that picture, as ewa_frame.rgba, alpha 1 where pixels count, else 0; NULL: not wanted
    int64_t *sums;        ///< [surfel][3], in units; added to by all tiles; NULL: not wanted
    uint8_t *shared;      ///< [packet]: whether several tiles have it
} ewa_gather;

enum { EWA_GATHER_PLANES = 11, EWA_GATHER_BITS = 20 }; ///< no term is more than 2^EWA_GATHER_BITS units

/// A tile and its pixels, block by block (row-major), 16 lanes per block (4 rows of 4 pixels).
typedef struct ewa_tile {
    int32_t x_px, y_px;           ///< origin in the picture
    float field_x_px, field_y_px; ///< and from the middle of its field
    int32_t width_px, height_px;  ///< part inside the picture
    uint32_t blocks_per_row, block_rows;
    float *nearest; ///< [block][16]: the smallest key that counts, the largest key of z + eps
    ewa_sums sums;  ///< weight, r, g, b [, normal x, y, z] [, z] [, material] [, opacity]
    ewa_side_sums side;
    uint32_t channel_count;
    bool with_normals, with_depth;
    bool with_opacity;   ///< with_normals then too
    bool with_materials; ///< with_normals then too, and a channel for the depth with or without one
    bool with_fine;      ///< what the units of terms leave is summed of all channels, not only for depths
    const ewa_gather *gather; ///< for the pass that gathers
    const float *passed; ///< [block][16]: only keys below count, for surfaces behind the first; NULL: all do
    float *pixels;       ///< [row][column][EWA_PIXEL_FLOATS]: sums of small splats: normal, weight, r, g, b,
                         ///< nothing; NULL: no splat is small
    bool only_small;     ///< all splats are: other sums have nothing
    uint32_t *beyond_rows;  ///< [block row]: bit per block column that a splat may reach behind `nearest`
    uint32_t *finalized_rows; ///< [block row]: bit per block column whose sums begin at 0
} ewa_tile;

/// The blocks of a tile whose edges show what lies behind, and what that is.
typedef struct ewa_edges {
    uint32_t *rows; ///< [block row]: bit per block column
    float *passed;  ///< [block][16]: the smallest key of the surfaces that are done
    float *reach; ///< [block]: the largest of `passed`: what is nowhere beyond it is not wanted; -infinity in
                  ///< blocks that are not marked
    float *nearest; ///< [block][16]: the smallest key of the surface that is being gathered
    ewa_sums sums;  ///< as ewa_tile's
    ewa_side_sums side;
    float *behind; ///< [block][4][16]: premultiplied r, g, b and alpha of all surfaces but the first
} ewa_edges;

/// Boxes of a tile's records, or of groups of EWA_GROUP_RECORDS of them, or of EWA_BLOCK_LANES groups: first
/// column | first row << 8, and last column | last row << 8 | EWA_BOX_GUARD. Room for a multiple of 16 each.
typedef struct ewa_edge_boxes {
    int32_t *first, *last;
    float *key_low;
    uint32_t count;
} ewa_edge_boxes;

/// Splats that may lie behind a marked block, in the order in which they are summed. The lists have room for
/// EWA_BLOCK_LANES more.
typedef struct ewa_edge_splats {
    const ewa_record *records;
    const ewa_load *loads;
    const float *opacities;   ///< NULL: all are opaque
    const uint8_t *materials; ///< NULL: all have the same
    const ewa_clip *clips;    ///< of the records that have EWA_CLIP_BIT
    uint32_t *indices;        ///< of records and loads
    float *largest_keys;      ///< no key of the splat that is beyond edges->passed is larger
    uint32_t count;
} ewa_edge_splats;

/// How surfaces are shaded.
typedef enum ewa_pipeline_shading {
    EWA_PIPELINE_UNSHADED,
    EWA_PIPELINE_LAMBERT, ///< one white light on the one material's ambient and diffuse: a factor for all colours
    EWA_PIPELINE_LIGHTS, ///< any lights, no highlights
    EWA_PIPELINE_PHONG,  ///< everything
} ewa_pipeline_shading;

/// How pixels become colours, and where they go. Planes as in ewa_frame, of the whole picture.
typedef struct ewa_resolve {
    float unit_coverage_inverse; ///< 1 / q0, for weights in units of sums, as are the next
    float alpha_scale;           ///< 1 / (tau q0)
    float covering;              ///< tau q0
    float front_scale;           ///< 1 / (EWA_FRONT q0)
    float color_unit, material_units[EWA_MATERIAL_CHANNELS]; ///< of their sums, over that of weights
    float opacity;                                           ///< of all surfaces, beside the surfels' own
    bool edge_antialiasing, transparent, one_pass, orthographic;
    ewa_pipeline_shading shading;
    uint32_t light_count;
    ewa_kernel_light lights[EWA_MAX_LIGHTS]; ///< in camera space
    float material[EWA_MATERIAL_CHANNELS];   ///< of all surfaces in tiles without materials
    const ewa_environment *environment;      ///< NULL: none
    float environment_from_camera[9];        ///< rotation, row-major
    float background[4];                     ///< linear, premultiplied
    float ray_x[2], ray_y[2];                ///< slope = ray[0] pixel + ray[1]
    float to_world[9];                       ///< world from camera, row-major, without scale
    uint32_t width_px;
    float depth_unit;      ///< world units of 1 in camera space
    float depth_per_share; ///< orthographic: camera space of 1 in sums of depths
    uint8_t *rgba8;
    float *rgba, *depth, *normal, *coverage;
} ewa_resolve;

/// A picture that gets eye-dome lighting.
typedef struct ewa_eye_dome {
    uint32_t width_px, height_px;
    bool orthographic;
    float inverse_height;  ///< orthographic: 1 / the height of the view in world units
    float exponent;        ///< light = 2^(exponent sum over all pairs)
    const float *depth;    ///< as ewa_frame's
    const float *surfaces; ///< as ewa_frame's rgba, over nothing
    float *keys;           ///< [height + 2 EWA_EYE_DOME_REACH][key_stride], the picture in the middle
    size_t key_stride;     ///< a multiple of 16, at least width + 2 EWA_EYE_DOME_REACH + 15
    float background[4];   ///< linear, premultiplied
    uint8_t *rgba8;        ///< may be NULL
    float *rgba;           ///< may be NULL, may be `surfaces`
} ewa_eye_dome;

/// The kernels of one instruction set.
typedef struct ewa_pipeline_kernels {

    /// Lists those of packets [first, first + count) that may touch some tile, from entry `first` of `kept`
    /// on, and writes their places; `first` and the room of `kept` and `places` are multiples of 16. Returns
    /// how many there are.
    uint32_t (*cull)(const ewa_view *view, const ewa_packet *packets, const ewa_packet_bounds *bounds,
                     uint32_t first, uint32_t count, const ewa_packet_places *places,
                     const ewa_bin_items *kept);

    /// Sets cells[row][column] (rows of EWA_TILE_CELLS) to the smallest tile->nearest in each cell.
    void (*set_cells)(const ewa_tile *tile, float *cells);

    /// Sets depths[i] to where packet ids[i] begins in camera space. Room for a multiple of 16.
    void (*depths)(const ewa_view *view, const ewa_packet_bounds *bounds, const ewa_packet_places *places,
                   const uint32_t *ids, uint32_t count, float *depths);

    /// Splits packets into those that may show in front of their cells' keys and those that are hidden, each
    /// in order; returns how many may show. `shown` and `hidden` have room for one more than there are;
    /// `hidden` may be `ids`.
    uint32_t (*hide)(const ewa_view *view, const ewa_packet_bounds *bounds, const ewa_packet_places *places,
                     const ewa_tile *tile, const float *cells, const uint32_t *ids, uint32_t count,
                     uint32_t *shown, uint32_t *hidden);

    /// Sets up `count` <= EWA_RUN_PACKETS packets for one tile into `run`; `packet_ids` holds `announced` >=
    /// count numbers, those of later runs too, so that packets can be fetched ahead.
    void (*setup)(const ewa_view *view, const ewa_packet_source *packets, const uint32_t *packet_ids,
                  uint32_t count, uint32_t announced, const ewa_tile *tile, ewa_run *run);

    /// Raises tile->nearest to the key of z + eps where a run's splats count.
    void (*visibility)(const ewa_view *view, const ewa_tile *tile, const ewa_sorted_run *run);
    void (*near_visibility)(const ewa_view *view, const ewa_tile *tile, const ewa_near_record *records,
                            uint32_t count);

    /// Sets nearest to -infinity.
    void (*clear_nearest)(const ewa_tile *tile);

    /// Adds a run's splats to tile->sums, small ones to tile->pixels, where their key reaches tile->nearest;
    /// marks in tile->beyond_rows where some may not.
    void (*accumulate)(const ewa_view *view, const ewa_tile *tile, const ewa_sorted_run *run);
    void (*near_accumulate)(const ewa_view *view, const ewa_tile *tile, const ewa_near_record *records,
                            uint32_t count);

    /// Sets tile->gather->planes, of settled sums of the first surface (edge_compose() does of those behind).
    void (*set_gather)(const ewa_tile *tile, const ewa_resolve *resolve);

    /// Adds tile->gather->colors of a run's splats to the planes; then makes these what is gathered, and stores what is shown.
    void (*spread)(const ewa_view *view, const ewa_tile *tile, const ewa_sorted_run *run);
    void (*near_spread)(const ewa_view *view, const ewa_tile *tile, const ewa_near_record *records,
                        uint32_t count);
    void (*turn_gather)(const ewa_tile *tile, const ewa_resolve *resolve);

    /// Adds a run's splats, where they were accumulated, times the planes to tile->gather->sums.
    void (*gather)(const ewa_view *view, const ewa_tile *tile, const ewa_sorted_run *run);
    void (*near_gather)(const ewa_view *view, const ewa_tile *tile, const ewa_near_record *records,
                        uint32_t count);

    /// Adds tile->pixels to the sums and makes of these what shows (semantics.h: facing, clip lines). False: some sum
    /// was too large; start the sums over and accumulate with care.
    bool (*finalize)(const ewa_tile *tile, const ewa_resolve *resolve);

    /// Sets the sums to zero and clears the side accumulators.
    void (*clear_sums)(const ewa_tile *tile);

    /// Leaves marked, of the blocks that edges->rows marks, those with a partly covered pixel, and starts their
    /// planes; returns how many. Columns beyond the tile may be marked.
    uint32_t (*find_edges)(const ewa_tile *tile, const ewa_resolve *resolve, const ewa_edges *edges);

    /// Fills levels[0], which setup() has begun, and the other levels; once for all that is set up.
    void (*edge_boxes)(ewa_edge_boxes levels[EWA_BOX_LEVELS]);

    /// Lists the records that may lie behind a marked block, in order; returns how many, and may write 16
    /// more.
    uint32_t (*edge_list)(const ewa_edge_boxes levels[EWA_BOX_LEVELS], uint32_t row, uint32_t column,
                          float reach, uint32_t *indices);

    /// One of the two passes over splats beyond edges->passed, in one marked block. The first drops those
    /// that are nowhere beyond.
    void (*edge_pass)(const ewa_view *view, const ewa_tile *tile, const ewa_edges *edges, uint32_t row,
                      uint32_t column, ewa_edge_splats *splats, bool second_pass);
    void (*edge_near_pass)(const ewa_view *view, const ewa_tile *tile, const ewa_edges *edges,
                           const ewa_near_record *records, uint32_t count, bool second_pass);

    /// Starts edges->nearest over: every splat beyond edges->passed counts for the next surface.
    void (*edge_take_all)(const ewa_tile *tile, const ewa_edges *edges);

    /// Puts the gathered surface, `merged` or not from several, under edges->behind and starts the next one;
    /// unmarks blocks that are closed or have nothing more. Returns how many stay marked.
    uint32_t (*edge_compose)(const ewa_tile *tile, const ewa_resolve *resolve, const ewa_edges *edges,
                             bool merged);

    /// Writes the tile's pixels to the planes; edges->behind (`edges` may be NULL) is under the blocks that
    /// `edge_rows` marks. Returns how many pixels got a colour that is infinite or no number.
    uint32_t (*resolve)(const ewa_tile *tile, const ewa_resolve *resolve, const ewa_edges *edges,
                        const uint32_t *edge_rows);

    /// Eye-dome lighting: fills row [0, height + 2 EWA_EYE_DOME_REACH) of the keys.
    void (*eye_dome_keys)(const ewa_eye_dome *eye_dome, uint32_t row);
    /// Writes row [0, height) of the picture, when all keys are there.
    void (*eye_dome_shade)(const ewa_eye_dome *eye_dome, uint32_t row);
} ewa_pipeline_kernels;

EWA_DECLARE_VERSIONS(const ewa_pipeline_kernels, ewa_pipeline_kernels);

#endif
