// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures of surfels: the resident form of a cloud, and the renderer.
#ifndef EWA_RENDER_H
#define EWA_RENDER_H

#include "ewa/base.h"
#include "ewa/camera.h"
#include "ewa/cloud.h"
#include "ewa/options.h"
#include "ewa/shade.h"

#ifdef __cplusplus
extern "C" {
#endif

/// How a cloud becomes surfels. Fill with ewa_surfels_options_init().
typedef struct ewa_surfels_options {
    size_t struct_size;
    double cutoff;       ///< F, standard deviations at which kernels end; (0, 4]; default 3
    double radius_scale; ///< multiplies every radius and tangent axis; (0, 1e15]; default 1
    /// Levels of detail: each holds one surfel of about twice the radius for up to four neighbours of the
    /// one before, and the last has 1024 surfels or more; [1, EWA_MAX_LEVELS]; default 1: all surfels only
    uint32_t level_count;
} ewa_surfels_options;

enum { EWA_MAX_LEVELS = 8 };

EWA_API extern const ewa_option_table ewa_surfels_options_table;
EWA_API void ewa_surfels_options_init(ewa_surfels_options *options, size_t struct_size);

/// The resident form of a cloud: Morton order, packets of 16, at most 32 bytes per point, and one more where
/// there are several materials. Immutable once made; any number of renderers of the same context may draw it.
typedef struct ewa_surfels ewa_surfels;

/// Makes surfels from a cloud that has "position", "normal" and "radius", or "position", "tangent_u" and
/// "tangent_v" (see ewa_cloud_estimate() for clouds that have less). Points that cannot be drawn (coordinates
/// not finite, no normal, radius not positive) are left out and counted. The cloud is not needed afterwards.
/// Colourless clouds are light grey; a "material" that is no whole number in [0, 255] counts as 0. Levels of
/// detail beyond the first take about 2/5 more memory. The result does not depend on the order of the points. `options` may be NULL. Errors: EWA_ERROR_ARGUMENT (missing
/// attribute, named), EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_surfels_create(const ewa_cloud *cloud, const ewa_surfels_options *options,
                                      ewa_surfels **surfels);
EWA_API void ewa_surfels_destroy(ewa_surfels **surfels);

/// Facts about surfels.
typedef struct ewa_surfels_info {
    uint64_t point_count;    ///< that can be drawn
    uint64_t left_out_count; ///< of the cloud's points
    size_t resident_bytes;   ///< of all levels
    double unit_coverage; ///< q0 of docs/math.md section 7: the sum of kernels that a covered pixel expects
    bool transparent;     ///< some surfel's colour has an alpha below 1
    ewa_bounds bounds;    ///< of the centres
    uint32_t material_count; ///< 1 + the largest "material"
    uint32_t level_count;    ///< of detail; fewer than were asked for where there are few surfels
} ewa_surfels_info;

EWA_API void ewa_surfels_describe(const ewa_surfels *surfels, ewa_surfels_info *info);

typedef enum ewa_kernel {
    EWA_KERNEL_PERSPECTIVE = 0, ///< exact projected ellipse (PAS; docs/math.md section 3)
    EWA_KERNEL_AFFINE = 1,      ///< Jacobian at the centre (SS; docs/math.md section 3)
    EWA_KERNEL_SOURCE = 2,   ///< the same kernel in the surfel's plane, by backward mapping (SS equation 8)
    EWA_KERNEL_CIRCULAR = 3, ///< circle around the affine, filtered ellipse (SS figure 8, third row)
    EWA_KERNEL_RAYCAST = 4,  ///< exact projective kernel at each pixel (docs/math.md section 9)
} ewa_kernel;

typedef enum ewa_shading {
    EWA_SHADING_NONE = 0,    ///< the surfels' colour
    EWA_SHADING_LAMBERT = 1, ///< times ambient + (1 - ambient) * sum of light max(0, normal . light)
    EWA_SHADING_PHONG = 2,   ///< materials, highlights after Blinn, and the environment (ewa_material)
} ewa_shading;

typedef enum ewa_cull {
    EWA_CULL_NONE = 0, ///< surfels seen from behind are drawn, shaded from the side that is seen
    EWA_CULL_BACK = 1,
} ewa_cull;

enum { EWA_MAX_EDGE_LAYERS = 8, EWA_MAX_SECTION_PLANES = 8, EWA_MAX_SUPERSAMPLING = 8 };

/// More layers than a pixel has: see ewa_render_options.layers.
#define EWA_LAYERS_EXACT UINT32_MAX

/// How a picture is made. Fill with ewa_render_options_init().
typedef struct ewa_render_options {
    size_t struct_size;
    ewa_kernel kernel;
    double prefilter_px; ///< h, standard deviation of the pixel filter; [0, 4]; 0: none; default 0.35
    /// 0 (default): surfels as they are. Else in [1, 256]: each point is a disc of that diameter in pixels,
    /// wherever it lies, parallel to the picture; radii, axes, normals and clip lines do not count, nor do
    /// `kernel`, `prefilter_px`, `cull` and the surfels' cutoff. The disc's alpha falls from 1 to 0 across
    /// its rim, over about a pixel (over a sixteenth of larger diameters), and adds up to its area; without
    /// edge antialiasing, and with one pass, it ends at the rim. For clouds that are no surface.
    double point_size_px;
    double tolerance; ///< kappa of docs/math.md section 6: depth tolerance in units of the support radius;
                      ///< [0, 1e15]; default 1
    uint32_t
        passes; ///< 3: splats of one surface are blended; 1: the nearest splat of each pixel wins; default 3
    bool edge_antialiasing; ///< alpha from coverage; default true
    double edge_threshold;  ///< tau of docs/math.md section 7; (0, 4]; default 0.45
    /// Surfaces that may share an antialiased edge: what lies behind a silhouette shows through its partly
    /// covered pixels, front to back, up to this many surfaces, of which the last is all that is left (docs/math.md
    /// section 8); 1: the background shows through instead; [1, EWA_MAX_EDGE_LAYERS]; default EWA_MAX_EDGE_LAYERS
    uint32_t edge_layers;
    double
        opacity; ///< of every surface, times the surfels' own (the alpha of their colour); [0, 1]; default 1
    /// Surfaces of a pixel that are composited, front to back, where they are transparent (docs/math.md
    /// section 8; SS section 6): 1: the nearest only, as if opaque; L: the L - 1 nearest, and all that lies
    /// behind as one more, with the alpha of as many surfaces as its coverage is worth; EWA_LAYERS_EXACT:
    /// all. 0 (default): all if opacity or a surfel's alpha is below 1, else 1. Surfaces are those of the
    /// visibility test, gathered one after another, so that neither the order of the points nor the number of
    /// layers in front changes what a layer is: unlike the paper's A-buffer, which merges whichever fragments
    /// it holds. With one pass: 1.
    uint32_t layers;
    ewa_cull cull;
    ewa_shading shading; ///< default EWA_SHADING_LAMBERT
    ewa_light lights[EWA_MAX_LIGHTS];
    uint32_t light_count; ///< of `lights`; 0 (default): one white headlight
    double ambient;       ///< of surfaces without a material table; [0, 1]; default 0.15
    /// For EWA_SHADING_PHONG, borrowed during the call: material k is that of the surfels whose "material" is
    /// k (0 where a cloud has none). NULL: ewa_material_init() with `ambient` and diffuse = 1 - ambient, for
    /// all. Where surfels of several materials meet in a pixel, the numbers of ewa_material are averaged by
    /// the surfels' weights, as colours and normals are.
    const ewa_material *materials;
    uint32_t material_count;            ///< [1, EWA_MAX_MATERIALS]; 0 without `materials`
    const ewa_environment *environment; ///< for EWA_SHADING_PHONG, borrowed during the call; NULL: none
    double environment_up[3]; ///< where the environment's +y is in the world; default 0, 1, 0. It is turned
                              ///< there the shortest way: with 0, 0, 1 its +z is the world's -y
    /// Eye-dome lighting: darkens what lies behind its surroundings on the screen, whatever the shading;
    /// needs no normals. [0, 100]; 0 (default): none; 1: strong.
    double eye_dome;
    float background[4]; ///< linear, [0, 1e15], straight alpha; default transparent black
    /// Only what fulfils a x + b y + c z + d >= 0 for every plane a, b, c, d is drawn. World units; finite, a, b, c
    /// not all 0, of any length. Surfels that a plane crosses are cut along it (docs/math.md section 5); points of
    /// `point_size_px` are drawn whole where their place is inside. What lies outside takes next to no time. The
    /// sides are as exact as the surfels' places (docs/conventions.md, precision).
    double section_planes[EWA_MAX_SECTION_PLANES][4];
    uint32_t section_count; ///< of `section_planes`; [0, EWA_MAX_SECTION_PLANES]; default 0
    uint32_t level; ///< of detail, of each source's surfels, or its last one; [0, 7]; default 0: all surfels
    /// Seconds of wall clock that the frame may take: draws the finest level, from `level` on, that this
    /// renderer expects to draw in that time, by what its frames before took; [0, 1e15]; default 0: `level`.
    /// Only which level is drawn depends on time.
    double budget_s;
    /// Every pixel is drawn as so many by so many, and their average (docs/math.md section 7), with `prefilter_px` in pixels of those. [0,
    /// EWA_MAX_SUPERSAMPLING]; 0 (default): 1 where the frame's surfels are as large as pixels, for what is far 2, 4 or 8, which makes parts as
    /// small as they are and changes continuously with the camera; also 1: gradients, references, octrees with a budget, panoramas, eye-dome
    /// lighting. Depths are the nearest of a pixel's, normals and coverages means. With eye-dome lighting: at most 1.
    uint32_t supersampling;
} ewa_render_options;

EWA_API extern const ewa_option_table ewa_render_options_table;
EWA_API void ewa_render_options_init(ewa_render_options *options, size_t struct_size);

/// Where a frame goes: planes of the camera's size, rows from the top, tightly packed; NULL planes are not
/// computed.
typedef struct ewa_frame {
    uint8_t *rgba8; ///< 4 per pixel: sRGB, straight alpha, over the background
    float *rgba;    ///< 4 per pixel: linear, premultiplied, over the background
    float *depth;   ///< 1 per pixel: camera-space z, world units; +infinity where nothing is
    float *normal;  ///< 3 per pixel: unit, world space, towards the viewer; 0 where nothing is
    /// 1 per pixel: sum of kernels over its expectation q0 (1: covered), before the threshold
    float *coverage;
} ewa_frame;

/// What a frame took. Stage times are summed over workers, in seconds of thread time.
typedef struct ewa_render_stats {
    uint64_t splat_count;    ///< resident
    uint64_t culled_count;   ///< of splats: in packets dropped whole
    uint64_t hidden_count;   ///< of splats, over all tiles: in packets wholly behind what was drawn before
    uint64_t drawn_count;    ///< splat records over all tiles: a splat in two tiles counts twice
    uint64_t fragment_count; ///< 4x4-pixel blocks evaluated in the accumulation
    double bin_s, setup_s, visibility_s, accumulate_s, edge_s, resolve_s;
    double total_s; ///< wall clock of the call
    uint32_t level; ///< of detail that was drawn: the coarsest of the sources; 0: all surfels
} ewa_render_stats;

/// Adds what another frame took: counts and times; of the splats, which are there for both, and of the level the larger.
EWA_API void ewa_render_stats_add(ewa_render_stats *sum, const ewa_render_stats *more);

/// A reusable object that owns all memory of a frame; nothing is allocated once it is warm.
typedef struct ewa_renderer ewa_renderer;

EWA_API ewa_status ewa_renderer_create(ewa_context *context, ewa_renderer **renderer);
EWA_API void ewa_renderer_destroy(ewa_renderer **renderer);

/// Draws surfels. The same bytes for every number of threads, every instruction set and every order of the
/// points. `options` and `stats` may be NULL. Implements docs/math.md sections 3 to 7; held by tests to a
/// renderer in plain double precision. A warning says how many pixels have a colour that is infinite or not a
/// number. Errors: EWA_ERROR_ARGUMENT (camera, options, a surfel's material that the table does not have),
/// EWA_ERROR_MEMORY, EWA_CANCELLED.
EWA_API ewa_status ewa_render(ewa_renderer *renderer, const ewa_surfels *surfels, const ewa_camera *camera,
                              const ewa_render_options *options, const ewa_frame *frame,
                              ewa_render_stats *stats);

/// A frame in parts, of which ewa_render() is the short form: begin, add any number of sources, finish. Several
/// sources make one picture, whose surfaces meet and blend as those of one cloud do: the same bytes in any
/// order of the sources; weights are brought to one unit coverage (q0 of docs/math.md section 7), the smallest.
/// Begins a frame; one that was begun before is dropped. `camera`, `options` and `frame` are copied; what they
/// point to is borrowed until the frame is finished. Errors: EWA_ERROR_ARGUMENT (camera, options).
EWA_API ewa_status ewa_render_begin(ewa_renderer *renderer, const ewa_camera *camera,
                                    const ewa_render_options *options, const ewa_frame *frame);

/// Adds a source to the frame that was begun, borrowed until it is finished; the same surfels twice are twice
/// as many surfels. Errors: EWA_ERROR_ARGUMENT (no frame; another cutoff than the sources before; a material
/// that the table does not have), EWA_ERROR_MEMORY; the frame stays as it was.
EWA_API ewa_status ewa_render_add(ewa_renderer *renderer, const ewa_surfels *surfels);

/// Adds a source with a weight in (0, 1] that all of its kernels have: what it adds to a pixel's weighted mean
/// and coverage. Of two sources of one surface with the weights 1 - t and t, the picture goes from one to the
/// other as t grows. It hides what lies behind it whatever its weight. 1: ewa_render_add(). Errors: its;
/// EWA_ERROR_ARGUMENT (another weight).
EWA_API ewa_status ewa_render_add_weighted(ewa_renderer *renderer, const ewa_surfels *surfels, double weight);

/// Draws the frame and ends it, whatever comes of it; without sources, the background. `stats` may be NULL.
/// Errors: EWA_ERROR_ARGUMENT (no frame), EWA_ERROR_MEMORY; EWA_CANCELLED, between two tiles: some of the
/// frame's pixels are drawn then.
EWA_API ewa_status ewa_render_finish(ewa_renderer *renderer, ewa_render_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
