// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One tile from its packets to its pixels.
#ifndef EWA_SRC_SURFACE_TILE_H
#define EWA_SRC_SURFACE_TILE_H

#include "surface/bin.h"
#include "surface/view.h"

enum {
    EWA_KEPT_RECORDS = 1 << 18, ///< 20 MiB per worker
    EWA_LISTS = 2,              ///< entries of lists per kept record
    EWA_MAX_LAYERS = 255,       ///< surfaces of a pixel that are looked for
};

/// What a walk over a tile's splats is for.
typedef enum ewa_tile_pass {
    EWA_PASS_VISIBILITY,
    EWA_PASS_ACCUMULATE,
    EWA_PASS_SPREAD,
    EWA_PASS_GATHER,
    EWA_PASS_EDGE_VISIBILITY,
    EWA_PASS_EDGE_ACCUMULATE
} ewa_tile_pass;

typedef struct ewa_tile_source ewa_tile_source;

/// Packets of a tile, of one source, in runs; the last may be short.
typedef struct ewa_tile_packets {
    const ewa_tile_source *source;
    const uint32_t *ids;
    uint64_t count;
} ewa_tile_packets;

/// Of one source, those of a tile that may be seen, and those that others hide; room for all in either.
typedef struct ewa_tile_split {
    uint32_t *shown, *hidden;
    uint64_t shown_count, hidden_count;
} ewa_tile_split;

/// A run of a tile whose splats are kept for the second pass.
typedef struct ewa_kept_run {
    const ewa_tile_source *source;
    ewa_sorted_run sorted;
    uint32_t near_first, near_count;
} ewa_kept_run;

/// What one worker needs for its tiles; sized once per frame by ewa_tile_scratch_reserve().
typedef struct ewa_tile_scratch {
    ewa_run run;
    ewa_record *records;
    ewa_load *loads;
    float *opacities;   ///< NULL: all are opaque
    uint8_t *materials; ///< NULL: all have the same
    uint32_t *surfels;  ///< of the records; NULL: nobody asks
    ewa_clip *clips;    ///< of the records that have some; NULL: none has
    uint16_t *order;
    uint32_t *listed;   ///< splats behind marked blocks, block by block
    float *listed_keys; ///< ewa_edge_splats.largest_keys of them
    ewa_edge_boxes boxes[EWA_BOX_LEVELS];
    uint32_t *near_surfels;
    ewa_kept_run *kept;
    size_t record_capacity, kept_capacity;
    uint32_t kept_count, near_count;    ///< of the kept runs; boxes[0].count is how many records they have
    ewa_tile_split *split;              ///< [source]
    uint32_t *packets;                  ///< their memory
    uint32_t *ordered;                  ///< packets of a tile and a source
    float *depths;                      ///< by packet, then by group of packets
    float min_key;                      ///< of all splats that are shown
    bool has_near;                      ///< some of them are near surfels
    uint64_t record_count, small_count; ///< of a tile, and how many of them are of few pixels
    float cells[EWA_TILE_CELLS * EWA_TILE_CELLS];
    float *nearest, *pixels;
    bool mostly_small; ///< most splats of the worker's last tile were of few pixels: how the next is drawn
    ewa_sums sums;
    ewa_edges edges;
    ewa_gather gather;
    uint32_t gather_rows[EWA_MAX_TILE_BLOCKS];
    ewa_buffer record_buffer, load_buffer, order_buffer, list_buffer, box_buffer, near_buffer, opacity_buffer,
        material_buffer, surfel_buffer, gather_buffer, clip_buffer, kept_buffer, plane_buffer, pixel_buffer, packet_buffer, split_buffer;
    uint32_t edge_rows[EWA_MAX_TILE_BLOCKS], edge_rows_left[EWA_MAX_TILE_BLOCKS],
        beyond_rows[EWA_MAX_TILE_BLOCKS];
    ewa_side_sums
        side; ///< of the first surface; its planes for back-facing splats serve those behind it, too
    uint32_t back_facing_rows[2][EWA_MAX_TILE_BLOCKS], cut_rows[2][EWA_MAX_TILE_BLOCKS];
    uint32_t finalized_rows[EWA_MAX_TILE_BLOCKS];
    uint32_t visits[5][EWA_MAX_TILE_BLOCKS * EWA_MAX_TILE_BLOCKS];
    uint32_t
        high_rows[5]
                 [EWA_MAX_TILE_BLOCKS]; ///< of the sums of both surfaces, of back-facing splats, of both cuts
    uint64_t drawn_count, fragment_count, hidden_splat_count, broken_pixel_count;
    double setup_s, visibility_s, accumulate_s, edge_s, resolve_s;
} ewa_tile_scratch;

/// A source of a frame, as its tiles see it.
typedef struct ewa_tile_source {
    const ewa_surfels *surfels;
    bool hides; ///< takes part in finding the nearest surfaces
    ewa_packet_source packets;
    ewa_view view;
    ewa_bins bins;
} ewa_tile_source;

/// What all tiles of a frame share.
typedef struct ewa_tile_job {
    ewa_context *context;
    const ewa_pipeline_kernels *kernels;
    ewa_tile_source *sources;
    uint32_t source_count;
    ewa_tiles tiles;
    uint32_t first_tile;  ///< of those that are drawn
    bool all_hide;        ///< all sources do
    uint64_t largest_bin; ///< packets of the fullest tile, of all sources
    ewa_view view;        ///< what those of the sources have in common
    ewa_resolve resolve;
    float materials[EWA_MAX_MATERIALS][EWA_MATERIAL_CHANNELS];
    uint32_t channel_count;
    uint32_t terms_per_carry; ///< of sums that are gathered with care
    uint32_t layers;          ///< surfaces that are composited at most
    bool merge_last;          ///< the last of them is all that is left
    bool with_normals, with_depth, with_opacity, with_materials, with_clips, fine_sums, count_fragments;
    bool with_small;           ///< splats of few pixels have sums of their own
    uint8_t *blank;            ///< as ewa_render_job's
    uint32_t first_row_px;     ///< of the band
    const ewa_gather *gather;  ///< back from pixels to colours, but for the planes; NULL: a picture is drawn
    ewa_tile_scratch *scratch; ///< [worker]
} ewa_tile_job;

/// Makes room for the tiles of a frame; allocates nothing once warm.
ewa_status ewa_tile_scratch_reserve(ewa_context *context, ewa_tile_scratch *scratch, const ewa_tile_job *job);
void ewa_tile_scratch_free(ewa_context *context, ewa_tile_scratch *scratch);

/// How many floats the planes of a tile take, and points a worker at some: its own, unless it is told otherwise after
/// ewa_tile_scratch_reserve().
size_t ewa_tile_plane_floats(const ewa_tile_job *job);
void ewa_tile_planes_bind(const ewa_tile_job *job, ewa_tile_scratch *scratch, float *planes);

/// Sets `tile` to tile `index` of the picture in the worker's planes.
void ewa_tile_place(const ewa_tile_job *job, ewa_tile_scratch *scratch, uint32_t index, ewa_tile *tile);

/// First pass over the splats of a tile; returns whether its runs are kept. Second pass: over these, or, where they are not,
/// over those that are not hidden by the surface in tile->nearest.
bool ewa_tile_find_nearest(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *scratch,
                           uint32_t index);
void ewa_tile_sum_nearest(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *scratch,
                          uint32_t index, bool kept);

/// Which splats of the kept runs lie in which blocks of a tile, where there is room to keep that.
typedef struct ewa_edge_lists {
    bool whole; ///< all splats are kept, and serve to the end
    bool begun;
    uint32_t used; ///< of scratch->listed
    uint32_t first[EWA_MAX_TILE_BLOCKS * EWA_MAX_TILE_BLOCKS],
        count[EWA_MAX_TILE_BLOCKS * EWA_MAX_TILE_BLOCKS];
} ewa_edge_lists;

/// Makes ready for passes behind the first surface in the blocks that scratch->edges.rows marks, of a tile whose runs are
/// kept: the hidden packets that may reach these are kept as well. lists->whole: there was room for all.
void ewa_tile_keep_behind(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *scratch,
                          ewa_edge_lists *lists);

/// One pass over the splats of a tile beyond scratch->edges.passed, in the blocks that scratch->edges.rows marks; others
/// are to be closed (-infinity). Of the kept runs, if lists->whole.
void ewa_tile_draw_behind(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *scratch,
                          uint32_t index, ewa_edge_lists *lists, ewa_tile_pass what);

/// Gathers the surfaces behind the first one where it covers pixels partly, hidden packets included; `kept`
/// when all runs of those that are shown are kept. With tile->gather, goes back from each to its splats. Returns whether there are such pixels; scratch->edge_rows
/// marks them.
bool ewa_tile_draw_edges(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *scratch, bool kept);

/// Draws tile `tile` of those that are drawn; an ewa_task.
void ewa_tile_draw(void *job, uint32_t tile, uint32_t worker);

#endif
