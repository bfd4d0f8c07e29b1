// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cameras: OpenCV axes (x right, y down, z forward), pixel centres at half integers.
#ifndef EWA_CAMERA_H
#define EWA_CAMERA_H

#include "ewa/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum ewa_projection {
    EWA_PERSPECTIVE = 0,
    EWA_ORTHOGRAPHIC = 1,
} ewa_projection;

/// A pinhole or orthographic camera.
///
/// Camera space p = A w + t for world points w as columns, [A t] the upper three rows of world_to_camera.
/// Perspective: pixel = (fx px / pz + cx, fy py / pz + cy). Orthographic: pixel = (fx px + cx, fy py + cy).
/// Pixel (i, j) covers [i, i+1) x [j, j+1) (docs/math.md section 0).
typedef struct ewa_camera {
    ewa_projection projection;
    uint32_t width_px, height_px;
    double fx_px, fy_px; ///< perspective: pixels per unit of slope; orthographic: pixels per world unit
    double cx_px, cy_px; ///< principal point, honoured exactly, may lie outside the picture
    /// Row-major, acts on column vectors; its upper left 3x3 is a rotation, possibly times a positive scale.
    double world_to_camera[16];
} ewa_camera;

/// Sets 1280x720, 50 degrees vertical field of view, at the origin looking along +z.
EWA_API void ewa_camera_init(ewa_camera *camera);

/// Checks that every number is finite, the size within 1..65536, focal lengths positive, the last row 0 0 0 1
/// and the upper left 3x3 a rotation times a positive scale (to 1e-4 relative). Errors: EWA_ERROR_ARGUMENT
/// with a message that names the member.
EWA_API ewa_status ewa_camera_check(ewa_context *context, const ewa_camera *camera);

/// Places the camera at `eye_world`, looking at `target_world`, with `up_world` pointing up in the picture;
/// an up that is zero or parallel to the view is replaced by the coordinate axis farthest from it. Leaves the
/// intrinsics alone. Errors: EWA_ERROR_NUMERIC when eye and target coincide or a number is not finite (camera
/// unchanged).
EWA_API ewa_status ewa_camera_look_at(ewa_camera *camera, const double eye_world[3],
                                      const double target_world[3], const double up_world[3]);

/// Sets a perspective projection with the given vertical field of view in degrees, in (0, 180), square
/// pixels, the principal point in the middle of the picture, whose size must be set before. Errors (camera
/// unchanged): EWA_ERROR_ARGUMENT, EWA_ERROR_NUMERIC when the focal length is not finite.
EWA_API ewa_status ewa_camera_set_fov(ewa_camera *camera, double vertical_fov_deg);

/// Sets an orthographic projection that shows `height_world` > 0 world units from the bottom to the top,
/// square pixels, the principal point in the middle of the picture, whose size must be set before. Errors
/// (camera unchanged): EWA_ERROR_ARGUMENT, EWA_ERROR_NUMERIC when the scale is not finite.
EWA_API ewa_status ewa_camera_set_ortho(ewa_camera *camera, double height_world);

/// What a picture of another size shows of the one that a camera had.
typedef enum ewa_resize {
    EWA_RESIZE_STRETCH = 0, ///< the same, across and down scaled by factors of their own
    EWA_RESIZE_HEIGHT = 1,  ///< the same from the upper edge to the lower one, at the sides more or less
} ewa_resize;

/// Gives the camera's picture another size, in pixels of at least 1; what is not in 1..65536 is left to ewa_camera_check().
EWA_API void ewa_camera_resize(ewa_camera *camera, ewa_resize keeps, uint32_t width_px, uint32_t height_px);

/// Returns the position of the eye (perspective) or of the camera plane's origin (orthographic) in the world.
EWA_API void ewa_camera_eye(const ewa_camera *camera, double eye_world[3]);

/// Places the camera with its axis along `direction_world` and `up_world` up, so that the whole box is in the
/// picture with at least `margin` (part of the picture's size, in [0, 0.5)) free on every side and the middle
/// of the box in the middle of the picture, wherever the principal point is. Perspective keeps the intrinsics
/// and takes the smallest distance; orthographic keeps fx : fy and scales them. A box without extent is
/// framed as if it were of size 1. Errors (camera unchanged): EWA_ERROR_ARGUMENT, EWA_ERROR_NUMERIC for an
/// empty or infinite box or a zero direction.
EWA_API ewa_status ewa_camera_frame(ewa_camera *camera, const ewa_bounds *bounds,
                                    const double direction_world[3], const double up_world[3], double margin);

/// Carries the camera about the axis `axis_world` through the point `pivot_world`, right-handed by
/// `angle_deg` degrees: a turntable. Multiples of 90 degrees are exact but for one rounding. Errors (camera
/// unchanged): EWA_ERROR_ARGUMENT, EWA_ERROR_NUMERIC for a zero axis or what is not finite.
EWA_API ewa_status ewa_camera_orbit(ewa_camera *camera, const double pivot_world[3],
                                    const double axis_world[3], double angle_deg);

/// A smooth way through key cameras that are evenly spaced in time. The eye follows the cubic spline with
/// continuous acceleration through the keys (natural ends, or periodic), the rotation follows squad through
/// their unit quaternions by the shorter way, intrinsics and scale change linearly between two keys.
/// Based on: K. Shoemake, "Quaternion Calculus and Fast Animation", SIGGRAPH 1987 course 10 (squad).
typedef struct ewa_camera_path ewa_camera_path;

/// Makes a path through `count` >= 1 cameras of one size and projection; a closed one goes on from the last
/// key to the first. The keys are copied; the caller owns `*path`, which is NULL after a failure. Errors,
/// with the number of the key: EWA_ERROR_ARGUMENT, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_camera_path_create(ewa_context *context, const ewa_camera *keys, size_t count,
                                          bool closed, ewa_camera_path **path);

/// Frees a path; sets `*path` to NULL; accepts NULL and a pointer to NULL.
EWA_API void ewa_camera_path_destroy(ewa_camera_path **path);

/// Gives the camera at `place`, counted in keys: 0 is the first key, 1.5 is half-way from the second to the
/// third, `count` is the first key again on a closed path. Whole numbers give the keys bit by bit; places
/// outside of the path give its nearest end. Errors: EWA_ERROR_ARGUMENT (NaN, NULL). Any thread.
EWA_API ewa_status ewa_camera_path_at(const ewa_camera_path *path, double place, ewa_camera *camera);

#ifdef __cplusplus
}
#endif
#endif
