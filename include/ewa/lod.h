// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clouds that are larger than memory: octrees of points in files, COPC and EPT, of which a picture takes the
// nodes that it needs, as fine as it shows them; and COPC files made from any clouds, with surfels at every
// level. docs/scale.md.
#ifndef EWA_LOD_H
#define EWA_LOD_H

#include "ewa/base.h"
#include "ewa/camera.h"
#include "ewa/cloud.h"
#include "ewa/options.h"
#include "ewa/render.h"

#ifdef __cplusplus
extern "C" {
#endif

/// An octree of points in a file, with the nodes that are in memory.
typedef struct ewa_lod ewa_lod;

/// Whether a path is a COPC file, by content, a folder of EPT or its "ept.json". Reports nothing.
EWA_API bool ewa_lod_probe(ewa_context *context, const char *path);

/// Whether a path is an octree that no other reader takes: a folder of EPT or its "ept.json". Reports nothing.
EWA_API bool ewa_lod_is_folder(ewa_context *context, const char *path);

/// Opens an octree and reads its hierarchy. The caller closes `*lod`, which is NULL after a failure. Errors:
/// EWA_ERROR_IO, EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_lod_open(ewa_context *context, const char *path, ewa_lod **lod);

/// Closes the file, frees the nodes and sets `*lod` to NULL; accepts NULL and a pointer to NULL.
EWA_API void ewa_lod_close(ewa_lod **lod);

/// Facts about an octree.
typedef struct ewa_lod_info {
    const char *kind;                ///< "COPC 1.0", "EPT 1.1.0"; stays until the octree is closed
    uint64_t point_count;            ///< as the hierarchy says
    ewa_bounds bounds;               ///< of the points, as the file says
    double low_world[3], side_world; ///< the root's cube
    double spacing_world;            ///< of the root's points
    uint32_t node_count, level_count;
    bool merged;                ///< surfels represent nodes' points at every level (ewa_lod_build())
    uint64_t merged_count;      ///< how many there are
    bool surfels;               ///< points have normals and radii, or axes
    const ewa_cloud *prototype; ///< no points; attributes, origin, grid and notes of the points
    const ewa_cloud *represented; ///< no points; attributes of surfels that represent points; NULL: there are none
} ewa_lod_info;

EWA_API void ewa_lod_describe(const ewa_lod *lod, ewa_lod_info *info);

/// Reads whole levels, from the coarsest on, as long as they have at most `maximum_points` > 0 points
/// together, but the first that has any, whatever it has: what the whole looks like. The caller owns
/// `*cloud`. Errors as ewa_lod_open().
EWA_API ewa_status ewa_lod_sample(ewa_lod *lod, uint64_t maximum_points, ewa_cloud **cloud);

/// Reads the points of a box, from the nodes that intersect it, of levels down to a spacing: `low_world` and
/// `high_world`, 3 numbers each, world units, both sides included; `spacing_world` >= 0, 0: all points. The
/// caller owns `*cloud`. Errors as ewa_lod_open().
EWA_API ewa_status ewa_lod_read(ewa_lod *lod, const double low_world[3], const double high_world[3],
                                double spacing_world, ewa_cloud **cloud);

/// How fine a picture is. Fill with ewa_lod_options_init().
typedef struct ewa_lod_options {
    size_t struct_size;
    /// A node is drawn by the surfels that represent its points where these are no farther apart than so many
    /// pixels, else by its parts; (0, 64]; default 1.
    double spacing_px;
    /// The same only where they are expected to be off by no more than so much, rms, in 1/255 of the light of a
    /// screen's white, as measured when the file was made; [0, 255]; default 3; 0: always all points.
    double error;
    /// Nodes that are kept in memory, and what is drawn at a time: where a picture needs more, it is drawn in
    /// bands, the same bytes; and levels of streamed Gaussians, coarser ones where more is needed; [16777216, 1.125899907e15]; default 1073741824
    uint64_t memory_bytes;
    /// Seconds for reading nodes: what has not been read then, or does not fit in memory, is drawn coarser,
    /// and counted as missing. The coarsest and what is large in the middle of the picture come first; [0,
    /// 1e15]; default 0: as long as it takes
    double load_s;
    /// With a renderer of several ranks (ewa/cluster.h), each draws a part of the surfels of about the same
    /// size: this one part `share` of `share_count`; all of these must fit in its memory. [0, 1048576];
    /// default 0
    uint32_t share;
    uint32_t share_count; ///< [0, 1048576]; default 0: no parts
    /// About so many surfels or points are drawn of octrees, or streamed Gaussians: where it would be more, spacing and error, or merge_px, grow by
    /// one factor; [0, 9.007199255e15]; default 0: 8 for each pixel that they cover
    uint64_t max_splats;
    /// Nothing is read: the picture is drawn of the nodes in memory (ewa_scene_reader), what it lacks is drawn coarser and
    /// counted as missing, and an octree of which nothing is in memory is not drawn; default false
    bool resident_only;
} ewa_lod_options;

EWA_API extern const ewa_option_table ewa_lod_options_table;
EWA_API void ewa_lod_options_init(ewa_lod_options *options, size_t struct_size);

/// What a picture of an octree took.
typedef struct ewa_lod_stats {
    ewa_render_stats render; ///< of all bands together
    uint64_t surfel_count;   ///< in the nodes that were drawn
    uint32_t node_count;     ///< that were drawn
    uint32_t loaded_count;   ///< of them, that were not in memory
    uint32_t missing_count;  ///< that a finer picture needs, but for which there was no time
    uint32_t band_count;
    uint64_t resident_bytes; ///< of the nodes that are kept
    double choose_s, load_s; ///< wall clock
    double coarser;          ///< times the spacing and the error that were asked for, so that no more surfels were drawn
} ewa_lod_stats;

/// Draws an octree: every part as coarse as the options allow, from surfels that represent many points to the
/// points, and over a range of distances the weighted mean of both, so that nothing pops when the camera
/// moves. Points without normals and radii get them by ewa_cloud_estimate(), node by node. The same bytes for
/// every number of threads and every `memory_bytes`, with `load_s` 0. `options`, `lod_options` and `stats`
/// may be NULL; `level` and `budget_s` of the options do not count. Errors: as ewa_render() and
/// ewa_lod_open(); EWA_ERROR_LIMIT (a row of tiles needs more than `memory_bytes`).
EWA_API ewa_status ewa_lod_render(ewa_lod *lod, ewa_renderer *renderer, const ewa_camera *camera,
                                  const ewa_render_options *options, const ewa_lod_options *lod_options,
                                  const ewa_frame *frame, ewa_lod_stats *stats);

/// What is drawn together; borrowed during the call.
typedef struct ewa_lod_scene {
    ewa_lod *const *lods; ///< [lod_count]; one that is there several times has nodes in memory for each
    uint32_t lod_count;
    uint32_t surfels_count;
    const ewa_surfels *const *surfels; ///< [surfels_count], drawn whole beside the octrees
} ewa_lod_scene;

/// Draws octrees and surfels in one frame, in which the surfaces of all meet and blend; ewa_lod_render() is the short form
/// for one octree. `memory_bytes` is for the nodes of all octrees together. Of several ranks (`share`),
/// octrees are shared by their nodes, and surfels i are drawn by part i mod share_count. Without octrees it
/// is ewa_render_begin(), ewa_render_add() and ewa_render_finish(); beside octrees `budget_s` does not count,
/// and `level` only for the surfels. The same bytes in any order of both. Octrees may be of other contexts
/// than the renderer, whose threads must not use them meanwhile. Errors: as ewa_lod_render() and
/// ewa_render_add().
EWA_API ewa_status ewa_lod_scene_render(const ewa_lod_scene *scene, ewa_renderer *renderer,
                                        const ewa_camera *camera, const ewa_render_options *options,
                                        const ewa_lod_options *lod_options, const ewa_frame *frame,
                                        ewa_lod_stats *stats);

/// How an octree is made. Fill with ewa_lod_build_options_init().
typedef struct ewa_lod_build_options {
    size_t struct_size;
    uint64_t memory_bytes; ///< for points at hand; [67108864, 1.125899907e15]; default 2147483648
    /// Only part `subset` of `subset_count` is made, into a file of its own for ewa_lod_merge(), on any machine;
    /// [0, 65535]; default 0
    uint32_t subset;
    uint32_t subset_count; ///< [1, 65536]; default 1: all at once
    bool keep_going;       ///< step over damaged pieces of the files; default false
    /// Names of attributes of one number that surfels which represent points have, too, comma-separated, borrowed during the
    /// call, 16 at most: what pictures of levels are coloured and filtered by. Of floats and of strengths of light they have the
    /// mean by area, of other whole numbers, which are codes, that of most area. "": none; default NULL: classification and
    /// intensity, of those that the points have
    const char *attributes;
} ewa_lod_build_options;

EWA_API extern const ewa_option_table ewa_lod_build_options_table;
EWA_API void ewa_lod_build_options_init(ewa_lod_build_options *options, size_t struct_size);

/// What making an octree took.
typedef struct ewa_lod_build_stats {
    uint64_t point_count, left_out_count; ///< left out: without finite coordinates
    uint64_t merged_count;                ///< surfels that represent others
    uint32_t node_count, level_count;
    uint64_t temporary_bytes;                                                 ///< of the temporary file
    double statistics_s, distribute_s, estimate_s, merge_s, write_s, total_s; ///< wall clock
} ewa_lod_build_stats;

/// Makes one COPC file of the points of any files: the points with all their attributes, each in one node,
/// with normals and radii as they are, or estimated piece by piece; and, for other programs to skip, surfels
/// that represent the points of each node. Files are read twice; a temporary file, beside the output and gone
/// when the process ends however it ends, takes up to 40 bytes per point of common scans. The same file for
/// every number of threads. `options` and `stats` may be NULL. Errors: as ewa_cloud_reader_open() and
/// ewa_cloud_writer_open(); EWA_ERROR_FORMAT (a file changed while it was read).
EWA_API ewa_status ewa_lod_build(ewa_context *context, const char *const *paths, uint32_t path_count,
                                 const char *out, const ewa_lod_build_options *options,
                                 ewa_lod_build_stats *stats);

/// Makes the file of all its parts (ewa_lod_build_options.subset), in any order: the same bytes as made at once. Errors:
/// EWA_ERROR_FORMAT (a file is no such part, or of other points; a part is missing or comes twice), EWA_ERROR_IO,
/// EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_lod_merge(ewa_context *context, const char *const *parts, uint32_t part_count,
                                 const char *out, ewa_lod_build_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
