// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From a camera to clip space, and the planes of its view volume.
//
// Based on: Bloomenthal and Rokne, Homogeneous Coordinates, sections Perspective Projection to Example
// Perspective Transformations; off-axis windows and the far plane at infinity are the same map with other
// numbers.
#include "homogeneous/perspective.h"
#include "homogeneous/clip_planes.h"
#include "homogeneous/noise.h"

static bool map_is_finite(const ewa_mat4 *map) {
    for (int i = 0; i < 4; i++)
        if (!vec4_is_finite(mat4_row(map, i))) return false;
    return true;
}

/// What a camera sees: the box of directions through a window on the near plane (perspective), or the box
/// itself (orthographic). Camera space: z forward.
typedef struct frustum {
    double x_low, x_high, y_low, y_high; ///< need not be symmetric (off-axis)
    double near_z, far_z;
} frustum;

/// HC's map [P]: the window goes to [-1, 1]^2, depth to [0, 1], w' = z / near.
static bool perspective_map(const frustum *f, ewa_mat4 *map) {
    if (!(f->x_low < f->x_high) || !(f->y_low < f->y_high) || !(f->near_z > 0) || !(f->far_z > f->near_z))
        return false;
    double d = f->near_z, width = f->x_high - f->x_low, height = f->y_high - f->y_low;
    double k = isinf(f->far_z) ? 1 : f->far_z / (f->far_z - d); // HC's 1 / (1 - D/F)
    *map =
        (ewa_mat4){{{2 / width, 0, 0, 0},
                    {0, 2 / height, 0, 0},
                    {-(f->x_high + f->x_low) / width / d, -(f->y_high + f->y_low) / height / d, k / d, 1 / d},
                    {0, 0, -k, 0}}};
    return true;
}

/// The affine map of a frustum taken as a box.
static bool box_map(const frustum *f, ewa_mat4 *map) {
    if (!(f->x_low < f->x_high) || !(f->y_low < f->y_high) || !(f->far_z > f->near_z) || isinf(f->far_z))
        return false;
    double width = f->x_high - f->x_low, height = f->y_high - f->y_low, depth = f->far_z - f->near_z;
    *map = (ewa_mat4){
        {{2 / width, 0, 0, 0},
         {0, 2 / height, 0, 0},
         {0, 0, 1 / depth, 0},
         {-(f->x_high + f->x_low) / width, -(f->y_high + f->y_low) / height, -f->near_z / depth, 1}}};
    return true;
}

ewa_status ewa_camera_clip_map(const ewa_camera *camera, double near_z, double far_z,
                               ewa_mat4 *world_to_clip) {
    if (!camera || !world_to_clip) return EWA_ERROR_ARGUMENT;
    bool perspective = camera->projection == EWA_PERSPECTIVE;
    double reach =
        perspective ? near_z : 1; // what a slope (perspective) or a world unit spans on the window's plane
    if (!(camera->fx_px > 0) || !(camera->fy_px > 0)) return EWA_ERROR_NUMERIC;
    frustum seen = {.x_low = -camera->cx_px / camera->fx_px * reach,
                    .x_high = (camera->width_px - camera->cx_px) / camera->fx_px * reach,
                    .y_low = -camera->cy_px / camera->fy_px * reach,
                    .y_high = (camera->height_px - camera->cy_px) / camera->fy_px * reach,
                    .near_z = near_z,
                    .far_z = far_z};
    ewa_mat4 projection, view;
    if (!(perspective ? perspective_map : box_map)(&seen, &projection)) return EWA_ERROR_NUMERIC;
    for (int i = 0; i < 16; i++) view.m[i % 4][i / 4] = camera->world_to_camera[i]; // acts on columns
    ewa_mat4 result = ewa_mat4_concatenate(&view, &projection);
    if (!map_is_finite(&result)) return EWA_ERROR_NUMERIC;
    *world_to_clip = result;
    return EWA_OK;
}

ewa_status ewa_frustum_planes(const ewa_mat4 *map, ewa_vec4 planes[6]) {
    if (!map_is_finite(map)) return EWA_ERROR_NUMERIC;
    ewa_mat4 magnitude = *map;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) magnitude.m[i][j] = fabs(map->m[i][j]);
    ewa_vec4 result[6];
    for (int i = 0; i < 6; i++) {
        ewa_vec4 plane = mat4_mul_vec4(map, clip_planes[i]);
        ewa_vec4 size = mat4_mul_vec4(&magnitude, vec4_abs(clip_planes[i]));
        ewa_vec3 normal = vec3_from_vec4(plane);
        if (vec3_is_noise(normal, vec3_from_vec4(size))) {
            if (is_noise(plane.w, size.w)) return EWA_ERROR_NUMERIC;
            result[i] = vec4_make(0, 0, 0, copysign(1, plane.w));
        } else {
            double length = hypot(hypot(normal.x, normal.y), normal.z);
            result[i] = vec4_make(plane.x / length, plane.y / length, plane.z / length, plane.w / length);
            if (!vec4_is_finite(result[i])) return EWA_ERROR_NUMERIC;
        }
    }
    for (int i = 0; i < 6; i++) planes[i] = result[i];
    return EWA_OK;
}
