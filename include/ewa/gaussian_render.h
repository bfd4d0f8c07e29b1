// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures of trained Gaussians: their resident form, the renderer, and its double-precision reference.
#ifndef EWA_GAUSSIAN_RENDER_H
#define EWA_GAUSSIAN_RENDER_H

#include "ewa/camera.h"
#include "ewa/gaussian.h"
#include "ewa/render.h"

#ifdef __cplusplus
extern "C" {
#endif

/// The resident form of a set of Gaussians, in an order of its own, so that the order of the set does not
/// matter: about 150 bytes each with harmonics of degree 3, 200 with levels.
/// Immutable once made; any number of renderers of the same context may draw it.
typedef struct ewa_splats ewa_splats;

/// Makes Gaussians resident. Those that are not finite or have no opacity are left out; the shorter scales
/// are made at least 1e-4 of the longest, so that flat Gaussians have a depth along every ray. `levels`: sets of 2^17
/// and more, but for 2D ones, get levels, among which ewa_gaussian_options.merge_px chooses, in twice the time. The set
/// is not needed afterwards. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_LIMIT (more than 2^26), EWA_ERROR_MEMORY,
/// EWA_CANCELLED.
EWA_API ewa_status ewa_splats_create(const ewa_gaussians *gaussians, bool levels, ewa_splats **splats);

/// Frees splats; sets `*splats` to NULL; accepts NULL and a pointer to NULL.
EWA_API void ewa_splats_destroy(ewa_splats **splats);

/// Facts about splats.
typedef struct ewa_splats_info {
    uint32_t splat_count; ///< resident
    uint32_t sh_degree;
    bool antialiased; ///< as the set was
    bool has_levels;  ///< among which ewa_gaussian_options.merge_px chooses
    bool has_classes; ///< by which they can be coloured, "classification"
    size_t resident_bytes;
    ewa_bounds bounds; ///< of all centres
    /// A box that far floaters do not widen, for framing: of the middle 96 % of the opacities along
    /// each axis.
    ewa_bounds core;
    /// What suits as ewa_gaussian_options.near_world: its default, which is of 3DGS' own scenes, or 2 % of the
    /// core's diagonal where that is less, for scenes in other units.
    double near_world;
} ewa_splats_info;

EWA_API void ewa_splats_describe(const ewa_splats *splats, ewa_splats_info *info);

/// How a Gaussian gets onto the screen (docs/math.md section 12).
typedef enum ewa_gaussian_projection {
    EWA_PROJECTION_TRAINED = 0, ///< the affine map at its centre, as in training (3DGS)
    EWA_PROJECTION_EXACT = 1,   ///< what each pixel's ray meets of it, right at every angle
} ewa_gaussian_projection;

/// What is in front of what.
typedef enum ewa_gaussian_order {
    EWA_ORDER_OF_PROJECTION = 0, ///< EWA_ORDER_CENTER of EWA_PROJECTION_TRAINED, EWA_ORDER_RAY of EWA_PROJECTION_EXACT
    EWA_ORDER_CENTER = 1, ///< in all pixels by the depth of the centre, as in training (3DGS)
    EWA_ORDER_RAY = 2,    ///< in each pixel by the depth at which its ray passes the greatest density (StopThePop)
} ewa_gaussian_order;

/// What the pixel filter does to a Gaussian's height.
typedef enum ewa_gaussian_filter {
    /// As the set was trained; 2D Gaussians in the trained projection then show where rays cross them, no smaller than a dot of
    /// 5/3 of the filter's variance, as 2DGS trains them
    EWA_FILTER_OF_SET = 0,
    EWA_FILTER_THICKEN = 1, ///< nothing: small Gaussians get more visible (3DGS)
    EWA_FILTER_KEEP = 2,    ///< lowers it, so that the integral stays (Mip-Splatting, "antialiased")
} ewa_gaussian_filter;

/// What is shown of Gaussians.
typedef enum ewa_gaussian_display {
    EWA_DISPLAY_BLENDED = 0,    ///< what they were trained to show
    EWA_DISPLAY_ELLIPSOIDS = 1, ///< opaque ellipsoids, lit from the eye
    EWA_DISPLAY_POINTS = 2,     ///< opaque dots at their centres
} ewa_gaussian_display;

/// What the depth of a pixel is.
typedef enum ewa_gaussian_depth {
    EWA_DEPTH_MEDIAN = 0,   ///< where half of the light is gone
    EWA_DEPTH_EXPECTED = 1, ///< the mean of all that shows, by how much it shows
} ewa_gaussian_depth;

/// How a picture of Gaussians is made. Fill with ewa_gaussian_options_init().
typedef struct ewa_gaussian_options {
    size_t struct_size;
    ewa_gaussian_projection projection;
    ewa_gaussian_filter filter;
    double prefilter_px2; ///< variance of the pixel filter, px^2; [0, 16]; default 0.3
    double cutoff;        ///< F, standard deviations at which every Gaussian ends; [1, 6]; default 4
    double minimum_alpha; ///< less of a Gaussian is not drawn; [1e-6, 0.5]; default 1/255
    /// A pixel where less than this of what is behind would show gets nothing more; [0, 0.999999]; default
    /// 1/512
    double minimum_transmittance;
    /// EWA_PROJECTION_TRAINED, perspective: centres nearer than that along the axis are not drawn; [0, 1e15];
    /// default 0.2
    double near_world;
    uint32_t sh_degree;  ///< harmonics beyond it are not used; [0, EWA_MAX_SH_DEGREE]; default 4
    float background[4]; ///< linear, [0, 1e15], straight alpha; default transparent black
    /// Opaque surfaces among the Gaussians, as ewa_render() gives them (frame.depth and frame.rgba over nothing):
    /// planes of the camera's size, borrowed during the call. What of a Gaussian lies behind surface_depth
    /// (camera-space z) along a pixel's ray is not drawn over surface_rgba (linear, premultiplied), but in that part of
    /// a pixel that its alpha leaves free, over the background. Both NULL (default): none.
    const float *surface_depth, *surface_rgba;
    /// Section planes a, b, c, d in world space: what of a ray lies where a x + b y + c z + d < 0 for one of them is
    /// left out; normals not all 0, of any length
    double section_planes[EWA_MAX_SECTION_PLANES][4];
    uint32_t section_count; ///< of `section_planes`; [0, EWA_MAX_SECTION_PLANES]; default 0
    /// The surfaces' normals (3 per pixel) and coverage (1 per pixel), for frame.normal and frame.coverage, as
    /// ewa_render() gives them: planes of the camera's size, borrowed during the call. NULL (default): normals are 0,
    /// coverage is the alpha of surface_rgba. Without surface_depth: NULL
    const float *surface_normal, *surface_coverage;
    ewa_gaussian_order order; ///< default EWA_ORDER_OF_PROJECTION
    /// Of splats that have levels (ewa_splats_create()): parts whose Gaussians are within so many pixels of what
    /// stands for them (RMS, where the part is nearest) are drawn by that; [0, 1000], px; default 0: all Gaussians are drawn
    double merge_px;
    /// Default EWA_DISPLAY_BLENDED. Ellipsoids and dots are those of Gaussians whose opacity is at least `minimum_alpha`, in their
    /// colours, opaque surfaces among the others; of the options above, `near_world`, of dots, `merge_px`, `sh_degree`, the
    /// background, the surfaces and the sections count for them.
    ewa_gaussian_display display;
    double ellipsoid_radius; ///< EWA_DISPLAY_ELLIPSOIDS: standard deviations; [0.1, 4]; default 1
    double dot_px;           ///< EWA_DISPLAY_POINTS: diameter; [1, 8], px; default 2
    ewa_gaussian_depth depth; ///< of frame.depth; default EWA_DEPTH_MEDIAN
} ewa_gaussian_options;

EWA_API extern const ewa_option_table ewa_gaussian_options_table;
EWA_API void ewa_gaussian_options_init(ewa_gaussian_options *options, size_t struct_size);

/// What a frame took. Stage times are summed over workers, in seconds of thread time.
typedef struct ewa_gaussian_stats {
    uint64_t splat_count;   ///< resident
    uint64_t visible_count; ///< of those: some pixel may show them
    uint64_t near_count;    ///< of those: at the eye, drawn ray by ray
    uint64_t tile_count;    ///< over all tiles: a splat in two counts twice
    uint64_t block_count;   ///< over blocks of 4x4 pixels, as ellipsoids and dots over tiles: what was evaluated
    uint64_t sorted_count; ///< of those: rows of keys that were sorted; again where only some pixels were due
    double project_s, bin_s, draw_s;
    double total_s; ///< wall clock of the call
} ewa_gaussian_stats;

/// A reusable object that owns all memory of a frame; nothing is allocated once it is warm.
typedef struct ewa_gaussian_renderer ewa_gaussian_renderer;

/// Makes a renderer; the caller owns it. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_gaussian_renderer_create(ewa_context *context, ewa_gaussian_renderer **renderer);

/// Frees a renderer; sets `*renderer` to NULL; accepts NULL and a pointer to NULL.
EWA_API void ewa_gaussian_renderer_destroy(ewa_gaussian_renderer **renderer);

/// Draws Gaussians, front to back in every pixel, in the order of `options`; of those at one depth in that of
/// their places. Colours are composited as display values, as in training; frame.rgba is linear as everywhere. The other planes are of Gaussians and surfaces together:
/// depth is where half of the light is gone, else that of the surface, else +infinity, or as `options` say; normal is that of the
/// surface where it gave the depth, else of length 1 along the mean of the shortest axes, turned to the eye, by how much each shows
/// (by EWA_DEPTH_EXPECTED with the surface's), in world axes, for which all is drawn twice; coverage is c + a max(0, 1 - c), with the surface's c and the alpha a
/// of the Gaussians. Where no Gaussian is, they are the surface's planes, to the byte. The same bytes for every
/// number of threads, every instruction set and every order of the set. `options` and `stats` may be NULL.
/// Implements docs/math.md section 12, Gaussians; held by tests to a renderer in plain double precision.
/// Errors: EWA_ERROR_ARGUMENT (camera, options), EWA_ERROR_MEMORY, EWA_CANCELLED.
EWA_API ewa_status ewa_gaussian_render(ewa_gaussian_renderer *renderer, const ewa_splats *splats,
                                       const ewa_camera *camera, const ewa_gaussian_options *options,
                                       const ewa_frame *frame, ewa_gaussian_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
