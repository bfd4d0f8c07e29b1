// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures of volumes: the resident form of a volume under a transfer function, the renderer of splats and
// points, and its double-precision reference.
#ifndef EWA_VOLUME_RENDER_H
#define EWA_VOLUME_RENDER_H

#include "ewa/camera.h"
#include "ewa/render.h"
#include "ewa/volume.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { EWA_MAX_VOLUME_LEVELS = 4 };

/// How a volume becomes voxels. Fill with ewa_voxels_options_init().
typedef struct ewa_voxels_options {
    size_t struct_size;
    /// Level l + 1 holds the means of 2x2x2 voxels of level l, for a first picture that is fast
    /// (ewa_volume_options.level); [1, EWA_MAX_VOLUME_LEVELS]; default 2
    uint32_t level_count;
} ewa_voxels_options;

EWA_API extern const ewa_option_table ewa_voxels_options_table;
EWA_API void ewa_voxels_options_init(ewa_voxels_options *options, size_t struct_size);

/// The resident form of a volume under a transfer function: those of its voxels that have an extinction, with
/// their colours and gradients, in blocks of 8x8x8. Immutable once made; any number of renderers of the same
/// context may draw it.
typedef struct ewa_voxels ewa_voxels;

/// Classifies a volume. Blocks whose values the transfer function leaves empty are skipped by their lowest and
/// largest value; voxels that are NaN are empty. Neither volume nor transfer function is needed afterwards.
/// `options` may be NULL. Errors: EWA_ERROR_ARGUMENT (index_to_world not finite or not invertible, points of
/// the transfer function out of order or not finite, options), EWA_ERROR_LIMIT (a dimension over 2^21),
/// EWA_ERROR_MEMORY, EWA_CANCELLED.
EWA_API ewa_status ewa_voxels_create(const ewa_volume *volume, const ewa_transfer *transfer,
                                     const ewa_voxels_options *options, ewa_voxels **voxels);

/// Frees voxels; sets `*voxels` to NULL; accepts NULL and a pointer to NULL.
EWA_API void ewa_voxels_destroy(ewa_voxels **voxels);

/// Facts about voxels.
typedef struct ewa_voxels_info {
    uint64_t voxel_count;    ///< of the volume
    uint64_t occupied_count; ///< of those: with an extinction, at full resolution
    uint64_t block_count;    ///< of 8x8x8 voxels
    uint64_t skipped_count;  ///< of those: by their smallest and largest value
    uint32_t level_count;
    size_t resident_bytes; ///< all levels
    ewa_bounds bounds;     ///< of the occupied voxels' centres; finite_count: how many these are
    double spacing_world;  ///< the smallest distance between neighbours along an axis of the grid
} ewa_voxels_info;

EWA_API void ewa_voxels_describe(const ewa_voxels *voxels, ewa_voxels_info *info);

/// What a voxel is drawn as.
typedef enum ewa_volume_method {
    EWA_VOLUME_HYBRID = 0, ///< splats where magnified, points where minified (HFR section 4)
    EWA_VOLUME_SPLATS = 1,
    EWA_VOLUME_POINTS = 2, ///< with a filter of at most 0.9 px: magnified volumes have holes
} ewa_volume_method;

/// How a pixel of a splat finds its place in the footprint (docs/math.md section 12).
typedef enum ewa_volume_index {
    EWA_INDEX_EXACT = 0, ///< how far the pixel's ray passes the voxel's centre, also off the axis
    EWA_INDEX_TABLE = 1, ///< HFR 4.2: by the place in the ellipse and the cone's half angle alpha, tabled up
                         ///< to 15 degrees, by the formula beyond
} ewa_volume_index;

/// How a picture of a volume is made. Fill with ewa_volume_options_init().
///
/// Every voxel is a Gaussian of standard deviation `sigma` voxels along each axis of the grid, that is
/// Sigma = sigma^2 A A' for the grid's axes A, whose integral is the voxel's extinction times its size. A ray
/// that meets the optical depth t of a voxel keeps exp(-t) of what is behind. Front to back by depth units,
/// splats are composited one by one, those of a unit in the order of their distances; points of a unit are
/// summed, then composited.
typedef struct ewa_volume_options {
    size_t struct_size;
    ewa_volume_method method;
    ewa_volume_index index;
    double sigma;              ///< in voxels; [0.3, 2]; default 0.6
    double cutoff;             ///< F, standard deviations at which splats end; [1, 4]; default 3
    double prefilter_px;       ///< h, standard deviation of the pixel filter; [0, 4]; 0: none; default 0.35
    double point_threshold_px; ///< spacing on the screen up to which voxels are points, while the filter with
        ///< which these are as good as splats holds them (0.8 px); [0, 1.5]; default 1.2
    double depth_unit;    ///< in smallest spacings of the grid; [0.25, 16]; default 1
    uint32_t level;       ///< which of the voxels' levels; 0 (default): all voxels
    double density_scale; ///< multiplies every extinction; [0, 1e15]; default 1
    /// Where less than this of what is behind would show, nothing more is drawn; [0, 0.999999]; 0: everything
    /// is drawn; default 1/512
    double minimum_transmittance;
    ewa_shading shading; ///< by the gradient, seen from both sides; default EWA_SHADING_NONE
    ewa_light lights[EWA_MAX_LIGHTS];
    uint32_t light_count;  ///< of `lights`; 0 (default): one white headlight
    ewa_material material; ///< reflection is not used; default ewa_material_init()
    float background[4];   ///< linear, [0, 1e15], straight alpha; default transparent black
    /// Opaque surfaces within the volume, as ewa_render() gives them (frame.depth and frame.rgba): planes of
    /// the camera's size, borrowed during the call. What lies behind surface_depth (camera-space z) is not
    /// drawn, the rest over surface_rgba (linear, premultiplied), which then replaces the background. Both
    /// NULL (default): none.
    const float *surface_depth, *surface_rgba;
    /// Section planes a, b, c, d in world space: what of a ray lies where a x + b y + c z + d < 0 for one of them is
    /// left out; normals not all 0, of any length
    double section_planes[EWA_MAX_SECTION_PLANES][4];
    uint32_t section_count; ///< of `section_planes`; [0, EWA_MAX_SECTION_PLANES]; default 0
    /// The surfaces' normals (3 per pixel) and coverage (1 per pixel), for frame.normal and frame.coverage, as
    /// ewa_render() gives them: planes of the camera's size, borrowed during the call. NULL (default): normals are 0,
    /// coverage is the alpha of surface_rgba. Without surface_depth: NULL
    const float *surface_normal, *surface_coverage;
    bool mark_splats; ///< voxels that are splats are red, so that points are told from them; default false
} ewa_volume_options;

/// What splats have in place of their colour when they are marked, before light (linear).
#define EWA_MARKED_SPLAT_RED   0.8
#define EWA_MARKED_SPLAT_OTHER 0.03 ///< green and blue

EWA_API extern const ewa_option_table ewa_volume_options_table;
EWA_API void ewa_volume_options_init(ewa_volume_options *options, size_t struct_size);

/// What a frame took. Stage times are summed over workers, in seconds of thread time.
typedef struct ewa_volume_stats {
    uint64_t voxel_count;  ///< resident, of the level drawn
    uint64_t culled_count; ///< of those: in blocks outside of the picture
    uint64_t near_count;   ///< of those: at the eye, drawn ray by ray
    uint64_t hidden_count; ///< over all tiles: voxels behind saturated pixels
    uint64_t splat_count;  ///< drawn, over all tiles: a voxel in two tiles counts twice
    uint64_t point_count;  ///< likewise
    double point_share;    ///< of what was drawn
    double bin_s, setup_s, points_s, splats_s, resolve_s;
    double total_s; ///< wall clock of the call
} ewa_volume_stats;

/// A reusable object that owns all memory of a frame; nothing is allocated once it is warm.
typedef struct ewa_volume_renderer ewa_volume_renderer;

/// Makes a renderer; the caller owns it. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_volume_renderer_create(ewa_context *context, ewa_volume_renderer **renderer);

/// Frees a renderer; sets `*renderer` to NULL; accepts NULL and a pointer to NULL.
EWA_API void ewa_volume_renderer_destroy(ewa_volume_renderer **renderer);

/// Draws voxels, front to back. The frame's depth, normal and coverage are of voxels and surfaces together, as
/// those of ewa_gaussian_render(). The same bytes for every number of threads and every instruction set. Voxels
/// whose kernels reach a perspective camera's eye plane are drawn ray by ray, before all others.
/// `options` and `stats` may be NULL. Implements HFR section 4 and docs/math.md section 12; held by tests to a
/// renderer in plain double precision. Errors: EWA_ERROR_ARGUMENT (camera, options, a level that the voxels do
/// not have), EWA_ERROR_MEMORY, EWA_CANCELLED.
EWA_API ewa_status ewa_volume_render(ewa_volume_renderer *renderer, const ewa_voxels *voxels,
                                     const ewa_camera *camera, const ewa_volume_options *options,
                                     const ewa_frame *frame, ewa_volume_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
