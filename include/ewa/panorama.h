// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures of all that is around an eye: equirectangular and fisheye ones, of everything that a scene holds.
#ifndef EWA_PANORAMA_H
#define EWA_PANORAMA_H

#include "ewa/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/// How directions become pixels.
typedef enum ewa_panorama_kind {
    EWA_PANORAMA_NONE,            ///< as the camera says: a plane picture
    EWA_PANORAMA_EQUIRECTANGULAR, ///< longitude to the right, all around, and latitude up, from pole to pole
    EWA_PANORAMA_FISHEYE,         ///< a circle, in which the distance from the middle is the angle from ahead (equidistant)
} ewa_panorama_kind;

/// What a panorama shows.
typedef struct ewa_panorama_options {
    size_t struct_size;     ///< set by ewa_panorama_options_init()
    ewa_panorama_kind kind; ///< default EWA_PANORAMA_NONE
    double fov_deg;         ///< angle across the circle of a fisheye; (0, 360]; default 180
    double up_world[3];     ///< axis that stands upright in an equirectangular picture, whatever the camera's tilt; default 0, 0, 0: the camera's
    double finer;           ///< pixels of the plane pictures that it is made of, along each side of its own; [1, 4]; default 2
} ewa_panorama_options;

EWA_API extern const ewa_option_table ewa_panorama_options_table;
EWA_API void ewa_panorama_options_init(ewa_panorama_options *options, size_t struct_size);

/// Places a camera for a panorama of a scene as ewa_scene_place_camera() does, whose errors it has; but where neither the options nor the
/// scene say where the eye is, it stands in the middle of what there is. Fills `up_world` of the panorama where that is 0, 0, 0. `view` may
/// be NULL.
EWA_API ewa_status ewa_scene_place_panorama(ewa_scene *scene, const ewa_view_options *view, ewa_panorama_options *panorama, ewa_camera *camera);

/// Draws all around a camera's eye: ahead is in the middle. The camera gives the eye, the axes and the size of the picture; of its
/// lens nothing counts. Up to six plane pictures of 90 degrees, on the sides of a cube, each drawn as ewa_scene_draw() does, are sampled
/// at four places of every pixel, bilinearly, and averaged. Depths are distances from the eye, the nearest of the four; sizes of points
/// are pixels of the panorama; where they would be over 256 on the sides, these are as fine as the panorama. Eye-dome lighting looks at
/// pixels of the sides. Outside of a fisheye's circle there is nothing: alpha and coverage 0.
/// By EWA_PANORAMA_NONE it is ewa_scene_draw(). `options` as there; `panorama` may be NULL (defaults). The same bytes for every number of
/// threads. Errors: those of ewa_scene_draw(); EWA_ERROR_ARGUMENT (options; an orthographic camera), EWA_ERROR_LIMIT (too large).
EWA_API ewa_status ewa_scene_draw_panorama(ewa_scene *scene, ewa_scene_renderer *renderer, const ewa_camera *camera,
                                           const ewa_scene_options *options, const ewa_panorama_options *panorama,
                                           const ewa_frame *frame, ewa_scene_stats *stats);

#ifdef __cplusplus
}
#endif

#endif
