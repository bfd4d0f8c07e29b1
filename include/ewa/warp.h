// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Depth images to new cameras: each pixel with a depth becomes a surfel, or a point of one pixel.
#ifndef EWA_WARP_H
#define EWA_WARP_H

#include "ewa/base.h"
#include "ewa/camera.h"
#include "ewa/cloud.h"
#include "ewa/options.h"
#include "ewa/render.h"

#ifdef __cplusplus
extern "C" {
#endif

/// What the numbers of a depth image, divided by their scale, mean.
typedef enum ewa_depth_kind {
    EWA_DEPTH_Z = 0,         ///< camera-space z, world units
    EWA_DEPTH_RAY = 1,       ///< distance to the eye, world units
    EWA_DEPTH_DISPARITY = 2, ///< pixels: z = fx baseline / (disparity + offset)
} ewa_depth_kind;

/// A picture with depths, borrowed while it is taken; nothing is copied. Fill with ewa_depth_image_init().
typedef struct ewa_depth_image {
    /// That took it; perspective; focal lengths, principal point and scale within 1e-6 to 1e6; its size is
    /// that of both planes.
    ewa_camera camera;
    const void *depth;            ///< rows from the top, numbers of a row side by side, aligned to their type
    ewa_type depth_type;          ///< EWA_U16 or EWA_F32
    size_t depth_stride_bytes;    ///< between rows; 0: tightly packed
    ewa_depth_kind kind;          ///< default EWA_DEPTH_Z
    double depth_scale;           ///< numbers per unit, such as 1000 for millimetres; > 0; default 1
    double baseline_world;        ///< EWA_DEPTH_DISPARITY: distance of the two eyes; > 0
    double disparity_offset_px;   ///< EWA_DEPTH_DISPARITY: difference of the principal points; default 0
    const void *color;            ///< likewise; NULL: grey
    ewa_type color_type;          ///< EWA_U8: sRGB; EWA_F32: linear, premultiplied if there is an alpha
    uint32_t color_channel_count; ///< 1 grey, 3 RGB or 4 RGBA; pixels whose alpha is 0 are masked
    size_t color_stride_bytes;    ///< between rows; 0: tightly packed
} ewa_depth_image;

EWA_API void ewa_depth_image_init(ewa_depth_image *image);

/// Returns the numbers per unit that a file of depths has where nobody says, by the end of its name: 1000 of PNG, where
/// most sensors and programs write millimetres, else and of disparities 1. Any thread.
EWA_API double ewa_depth_file_scale(const char *path, ewa_depth_kind kind);

/// How samples become surfels. Fill with ewa_warp_options_init().
///
/// Pixels are masked that have no depth: 0, negative, NaN or infinite numbers, the largest of 16 bits, and
/// what is nearer or farther than the limits.
typedef struct ewa_warp_options {
    size_t struct_size;
    double cutoff;          ///< F, standard deviations at which kernels end; (0, 4]; default 3
    double radius_spacings; ///< support radius over the distance to the neighbours; [0.5, 10]; default 1.14
    /// Neighbours whose depths differ by more than this share of the smaller one are on different surfaces,
    /// unless their depths continue those beyond them as a plane does; (0, 1]; default 0.02.
    double depth_jump;
    /// Steps of a sensor's depths at distance 1, which grow with the square of the distance, as those of
    /// cameras that find shifts do: keys 1/z that differ by little more are averaged over 5 x 5 pixels; in
    /// 1 / world units, 0.0036 per metre for a first Kinect. [0, 1e6]; 0 (default): depths are taken as they
    /// are.
    double depth_noise;
    bool drop_flying;      ///< mask what hangs between two surfaces that it does not belong to; default true
    double nearest_world;  ///< smallest z; [1e-9, 1e12]; default 1e-6
    double farthest_world; ///< largest z, above nearest_world; [1e-9, 1e12]; default 1e9
} ewa_warp_options;

EWA_API extern const ewa_option_table ewa_warp_options_table;
EWA_API void ewa_warp_options_init(ewa_warp_options *options, size_t struct_size);

/// How a warped picture is made.
typedef enum ewa_warp_method {
    /// Surfels of the size of their surroundings, filtered and blended by ewa_render() (HFR section 3).
    EWA_WARP_HYBRID = 0,
    /// Each sample goes to the pixel it falls into, in McMillan's order, without depth tests: later samples
    /// overwrite. Several sources: the nearest of their pixels. Colours as they are, without shading or
    /// filter; of the options cull and background count.
    EWA_WARP_MCMILLAN = 1,
} ewa_warp_method;

/// A reusable object that owns all memory of warping; nothing is allocated once it is warm.
typedef struct ewa_warp ewa_warp;

EWA_API ewa_status ewa_warp_create(ewa_context *context, ewa_warp **warp);

/// Frees the object; sets `*warp` to NULL; accepts NULL and a pointer to NULL.
EWA_API void ewa_warp_destroy(ewa_warp **warp);

/// What became of the pixels of all sources.
typedef struct ewa_warp_facts {
    uint64_t pixel_count;
    uint64_t sample_count; ///< that have a place in space
    uint64_t flying_count; ///< masked between two surfaces
    double take_s;         ///< wall clock of ewa_warp_take()
} ewa_warp_facts;

/// Takes the samples of `count` >= 1 depth images in place of those before; the images may be changed
/// afterwards. A sample is a surfel at its unprojected pixel whose tangent axes span to the neighbours on the
/// same surface: across jumps of depth and creases they are those of the other side, without neighbours
/// parallel to the picture. The same surfels for any number of threads and every instruction set; the order
/// of the sources changes nothing but the rounding of sums. `options` and `facts` may be NULL. Errors (the
/// samples are gone): EWA_ERROR_ARGUMENT (a camera, an option, a plane, by number and name),
/// EWA_ERROR_UNSUPPORTED (other cameras), EWA_ERROR_LIMIT, EWA_ERROR_MEMORY. Based on: Yuan et al., "Hybrid
/// Forward Resampling and Volume Rendering", 2003, section 3.
EWA_API ewa_status ewa_warp_take(ewa_warp *warp, const ewa_depth_image *images, uint32_t count,
                                 const ewa_warp_options *options, ewa_warp_facts *facts);

/// Sets ewa_render_options to those of warping: as ewa_render_options_init(), but colours without light and
/// a prefilter of 0.25 px, since samples of a grid need less smoothing than scattered ones.
EWA_API void ewa_warp_render_options_init(ewa_render_options *options, size_t struct_size);

/// Draws the samples for another camera. `options` NULL: ewa_warp_render_options_init(). `holes` (NULL: not
/// wanted) receives a byte per pixel: 255 where less than half of a pixel is covered, so that another picture
/// has to fill it, else 0. `stats` (may be NULL): EWA_WARP_HYBRID only. Errors: as ewa_render().
/// EWA_WARP_MCMILLAN based on: McMillan, "An Image-Based Approach to Three-Dimensional Computer Graphics",
/// 1997, chapter 4.
EWA_API ewa_status ewa_warp_draw(ewa_warp *warp, const ewa_camera *target, ewa_warp_method method,
                                 const ewa_render_options *options, const ewa_frame *frame, uint8_t *holes,
                                 ewa_render_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
