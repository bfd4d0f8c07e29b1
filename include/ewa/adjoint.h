// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Derivatives of pictures of surfels: from a loss of a picture to what it changes per number of a cloud and of a
// camera.
#ifndef EWA_ADJOINT_H
#define EWA_ADJOINT_H

#include "ewa/render.h"

#ifdef __cplusplus
extern "C" {
#endif

/// What a loss changes per number of a frame's planes: of the camera's size, rows from the top, tightly packed, finite;
/// NULL: nothing.
typedef struct ewa_frame_cotangent {
    const float *rgba;     ///< 4 per pixel: by ewa_frame.rgba
    const float *depth;    ///< 1 per pixel, per world unit; pixels that show nothing have none
    const float *normal;   ///< 3 per pixel: by the unit normal in world space
    const float *coverage; ///< 1 per pixel
} ewa_frame_cotangent;

/// What a loss changes per small motion of a camera, and per number of its lens.
typedef struct ewa_camera_cotangent {
    double rotation[3];     ///< per radian: camera-space points p become p + r x p
    double translation[3];  ///< per unit of camera space: p become p + t
    double focal_px[2];     ///< by fx_px, fy_px
    double principal_px[2]; ///< by cx_px, cy_px
} ewa_camera_cotangent;

/// Where derivatives go; NULL: not computed. Of a cloud's streams: [point][component], 0 for points that are not drawn
/// and for streams that do not make its surfels.
typedef struct ewa_gradient {
    double *color;    ///< 3 per point: by linear light
    double *opacity;  ///< 1 per point: by the alpha of the colour, [0, 1]; 0 where nothing is transparent
    double *position; ///< 3 per point, per world unit
    double *normal;   ///< 3 per point: by the stream's numbers, of any length
    double *radius;   ///< 1 per point, per world unit
    double *tangent_u, *tangent_v; ///< 3 per point, per world unit
    ewa_camera_cotangent *camera;
    double *rgba; ///< 4 per pixel: no derivative, but the picture that they are of, as ewa_frame.rgba in double precision
} ewa_gradient;

/// Takes the cotangents of a picture as ewa_render() draws it with a supersampling of 1 to those of what made it: the same
/// bytes for every number of threads, every instruction set and every order of the points. Colours alone go back through
/// the pipeline itself, in single precision: they are the derivative of the picture that it draws of the surfels that it
/// makes, within 1e-5 of the largest. With anything else, `rgba` too, and where
/// lights are several or coloured, all is in double precision. What jumps has no
/// derivative and counts as fixed: which surfels are seen at which pixels and on which surface, what clip lines leave
/// of pixels, q0, and where surfels lie that touch the plane of the eye (docs/math.md section 15). Curvatures that move splats
/// at contours are constants. `cotangent` may be
/// NULL. `unit_coverage`: q0, as ewa_surfels_describe() gives it; 0: measured. The cloud's float or double streams are
/// taken as they are, not as surfels round them. A warning says when the camera sees no surfel. Kernels: perspective,
/// affine. Errors: EWA_ERROR_ARGUMENT (camera, options, cotangents that are not finite: plane and pixel; NULL),
/// EWA_ERROR_UNSUPPORTED (options without a derivative here, named: other kernels, one pass, points of a size,
/// highlights, eye-dome lighting, levels of detail, more parts of pixels), EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_CANCELLED.
EWA_API ewa_status ewa_render_backward(const ewa_cloud *cloud, const ewa_surfels_options *surfels_options,
                                       double unit_coverage, const ewa_camera *camera,
                                       const ewa_render_options *options, const ewa_frame_cotangent *cotangent,
                                       const ewa_gradient *gradient);

#ifdef __cplusplus
}
#endif
#endif
