// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Textures onto surfels: filtered, or by least squares.
#ifndef EWA_ACQUIRE_H
#define EWA_ACQUIRE_H

#include "ewa/base.h"
#include "ewa/cloud.h"
#include "ewa/image.h"
#include "ewa/options.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Streams that say where points are on a picture: "texcoord" F32 2 (s, t), (0, 0) bottom left and (1, 1) top
/// right of the picture; "texcoord_s" and "texcoord_t" F32 3, what s and t gain along the surface, per world
/// unit (gradients within the surface); "texture" 1 (an integer type), which picture it is, the first without
/// this stream; "texture_part" 1 (an integer type), which part of the surface between sharp edges: kernels of
/// different parts have nothing to do with each other; without it clip lines tell that. Points whose
/// coordinates are not finite, or of a picture that there is not, have no texture.
#define EWA_TEXCOORD     "texcoord"
#define EWA_TEXCOORD_S   "texcoord_s"
#define EWA_TEXCOORD_T   "texcoord_t"
#define EWA_TEXTURE      "texture"
#define EWA_TEXTURE_PART "texture_part"

/// What EWA_TEXTURE_OPTIMAL minimises. r_k are the kernels, S their sum, f the texture on the surface.
typedef enum ewa_texture_fit {
    EWA_FIT_NORMALIZED = 0, ///< |S f - sum w_k r_k|^2: the error of the drawn, normalised surface, weighted
                            ///< by S^2. A constant texture gives constant colours
    EWA_FIT_SUM = 1,        ///< |f - sum w_k r_k|^2, SS equation 10, times the mean of S
} ewa_texture_fit;

/// How a texture comes onto points. Fill with ewa_acquire_options_init().
typedef struct ewa_acquire_options {
    size_t struct_size;
    ewa_texture_filter filter; ///< default EWA_TEXTURE_OPTIMAL
    ewa_texture_fit fit;       ///< default EWA_FIT_NORMALIZED
    ewa_texture_wrap wrap_s;   ///< default EWA_TEXTURE_REPEAT
    ewa_texture_wrap wrap_t;   ///< default EWA_TEXTURE_REPEAT
    double pixel_sigma_px; ///< standard deviation of the Gaussian that stands for one pixel of the picture,
                           ///< in pixels; [0.3, 8]; SS has 1; default 0.5
    double cutoff;         ///< F: a "radius" is so many standard deviations; (0, 4]; default 3
    double ridge;          ///< pull of the optimal colours towards the filtered ones, in units of a
                           ///< kernel's own square; [1e-6, 1]; default 5e-3
    bool modulate;         ///< multiply with the "color" that the cloud has; default false: replace it
} ewa_acquire_options;

EWA_API extern const ewa_option_table ewa_acquire_options_table;
EWA_API void ewa_acquire_options_init(ewa_acquire_options *options, size_t struct_size);

/// What was done.
typedef struct ewa_acquire_report {
    uint64_t textured_count; ///< points that have a texture
    uint64_t pair_count;     ///< entries of the matrix (EWA_TEXTURE_OPTIMAL)
    uint32_t iterations;     ///< of the conjugate gradient; 0: a factor
    double gradient; ///< what is left of the gradient, over that at the filtered colours; the largest of the
                     ///< channels
    double ridge;    ///< that the colours were made with
} ewa_acquire_report;

/// Gives surfels with texture coordinates the colours of pictures: "color" F32, linear, 3 components, or 4
/// (straight alpha) when a picture or the colours to modulate are not opaque. Optimal colours may leave [0,
/// 1]; nothing but output clamps them. What has no texture is white.
///
/// - `cloud`: "position", what surfels need (see ewa_surfels_create()), "texcoord", "texcoord_s",
///   "texcoord_t", which stay
/// - `textures`: `texture_count` pictures of 1, 3 or 4 channels, linear light; no pixels: none
/// - Pixels are Gaussians, mapped by the Jacobian of each point; kernels wider than some pixels read smaller
///   copies of the picture. The filtered colour is the mean of the texture under the kernel, cut by its clip
///   lines.
/// - Optimal: kernels of one part whose supports overlap interact, the less the more their normals differ.
///   One sparse, symmetric, positive definite system, all channels at once (docs/math.md section 10). Should
///   it not be definite (kernels that overlap by far too much), the ridge is raised. Kernels on the same
///   place of which two charts say different things stay near their filtered colours.
///
/// `options` and `report` may be NULL. The result does not depend on the number of threads. Progress stages:
/// "texture", and that of the solver. After a failure the cloud keeps its colours. Errors: EWA_ERROR_ARGUMENT
/// (message names what is missing or out of range), EWA_ERROR_LIMIT (more than 4,000 kernels overlap one),
/// EWA_ERROR_NUMERIC, EWA_ERROR_MEMORY, EWA_CANCELLED. Optimal needs about 700 bytes per point meanwhile.
/// Based on M. Zwicker, H. Pfister, J. van Baar, M. Gross, "Surface Splatting", 2001, section 5 and appendix
/// A.
EWA_API ewa_status ewa_cloud_acquire(ewa_cloud *cloud, const ewa_image *textures, uint32_t texture_count,
                                     const ewa_acquire_options *options, ewa_acquire_report *report);

#ifdef __cplusplus
}
#endif
#endif
