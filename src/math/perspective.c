// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Perspective maps, their factors, vanishing points, and the planes of a view volume.
//
// Based on: Bloomenthal and Rokne, Homogeneous Coordinates, sections Perspective Projection to Example
// Perspective Transformations; off-axis windows, reversed depth and the far plane at infinity are the same
// map with other numbers.
#include "math/angle.h"
#include "math/clip_planes.h"
#include "math/noise.h"

static bool map_is_finite(const ewa_mat4 *map) {
    for (int i = 0; i < 4; i++)
        if (!vec4_is_finite(mat4_row(map, i))) return false;
    return true;
}

static ewa_status keep_finite(const ewa_mat4 *result, ewa_mat4 *map) {
    if (!map_is_finite(result)) return EWA_ERROR_NUMERIC;
    *map = *result;
    return EWA_OK;
}

ewa_status ewa_frustum_from_fov(double vertical_fov_rad, double aspect, double near_z, double far_z,
                                ewa_frustum *frustum) {
    if (!(vertical_fov_rad > 0 && vertical_fov_rad < EWA_PI) || !(aspect > 0) || !(near_z > 0) ||
        !(far_z > near_z))
        return EWA_ERROR_NUMERIC;
    double sy = near_z * ewa_tan(vertical_fov_rad / 2), sx = aspect * sy;
    if (!isfinite(sx) || !isfinite(sy)) return EWA_ERROR_NUMERIC;
    *frustum = (ewa_frustum){-sx, sx, -sy, sy, near_z, far_z, false};
    return EWA_OK;
}

ewa_status ewa_frustum_perspective(const ewa_frustum *frustum, ewa_mat4 *map) {
    const ewa_frustum *f = frustum;
    if (!(f->x_low < f->x_high) || !(f->y_low < f->y_high) || !(f->near_z > 0) || !(f->far_z > f->near_z))
        return EWA_ERROR_NUMERIC;
    double d = f->near_z, width = f->x_high - f->x_low, height = f->y_high - f->y_low;
    ewa_mat4 result = {{{2 / width, 0, 0, 0}, {0, 2 / height, 0, 0}, {0, 0, 0, 1 / d}, {0, 0, 0, 0}}};
    result.m[2][0] = -(f->x_high + f->x_low) / width / d;
    result.m[2][1] = -(f->y_high + f->y_low) / height / d;
    double k = isinf(f->far_z) ? 1 : f->far_z / (f->far_z - d); // HC's 1 / (1 - D/F)
    // Reversed depth is w - z; its z term (1 - k) / D is written without the cancellation.
    result.m[2][2] = f->reversed ? -1 / (f->far_z - d) : k / d;
    result.m[3][2] = f->reversed ? k : -k;
    return keep_finite(&result, map);
}

ewa_status ewa_frustum_orthographic(const ewa_frustum *frustum, ewa_mat4 *map) {
    const ewa_frustum *f = frustum;
    if (!(f->x_low < f->x_high) || !(f->y_low < f->y_high) || !(f->far_z > f->near_z) || isinf(f->far_z))
        return EWA_ERROR_NUMERIC;
    double width = f->x_high - f->x_low, height = f->y_high - f->y_low, depth = f->far_z - f->near_z;
    ewa_mat4 result = ewa_mat4_scaling(2 / width, 2 / height, (f->reversed ? -1 : 1) / depth);
    result.m[3][0] = -(f->x_high + f->x_low) / width;
    result.m[3][1] = -(f->y_high + f->y_low) / height;
    result.m[3][2] = f->reversed ? f->far_z / depth : -f->near_z / depth;
    return keep_finite(&result, map);
}

ewa_status ewa_camera_clip_map(const ewa_camera *camera, double near_z, double far_z,
                               ewa_mat4 *world_to_clip) {
    bool perspective = camera->projection == EWA_PERSPECTIVE;
    double reach =
        perspective ? near_z : 1; // what a slope (perspective) or a world unit spans on the window's plane
    if (!(camera->fx_px > 0) || !(camera->fy_px > 0)) return EWA_ERROR_NUMERIC;
    ewa_frustum frustum = {.x_low = -camera->cx_px / camera->fx_px * reach,
                           .x_high = (camera->width_px - camera->cx_px) / camera->fx_px * reach,
                           .y_low = -camera->cy_px / camera->fy_px * reach,
                           .y_high = (camera->height_px - camera->cy_px) / camera->fy_px * reach,
                           .near_z = near_z,
                           .far_z = far_z};
    ewa_mat4 projection, view = ewa_mat4_from_column_form(camera->world_to_camera);
    ewa_status status = perspective ? ewa_frustum_perspective(&frustum, &projection)
                                    : ewa_frustum_orthographic(&frustum, &projection);
    if (status) return status;
    ewa_mat4 result = ewa_mat4_concatenate(&view, &projection);
    return keep_finite(&result, world_to_clip);
}

ewa_status ewa_mat4_perspective(double image_z, ewa_mat4 *map) {
    if (!(fabs(image_z) > 0)) return EWA_ERROR_NUMERIC;
    ewa_mat4 result = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 1 / image_z}, {0, 0, -1, 0}}};
    return keep_finite(&result, map);
}

ewa_status ewa_mat4_projection(double image_z, ewa_mat4 *map) {
    ewa_mat4 result = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 0}, {0, 0, image_z, 1}}};
    return keep_finite(&result, map);
}

ewa_status ewa_mat4_perspective_projection(double image_z, ewa_mat4 *map) {
    if (!(fabs(image_z) > 0)) return EWA_ERROR_NUMERIC;
    ewa_mat4 result = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 1 / image_z}, {0, 0, 0, 0}}};
    return keep_finite(&result, map);
}

ewa_vec4 ewa_vanishing_point(ewa_vec3 direction, const ewa_mat4 *map) {
    return vec4_mul_mat4(vec4_from_vec3(direction, 0), map);
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
            result[i] = vec4_scale(ewa_plane_at_infinity(), copysign(1, plane.w));
        } else {
            double length = hypot(hypot(normal.x, normal.y), normal.z);
            result[i] = vec4_make(plane.x / length, plane.y / length, plane.z / length, plane.w / length);
            if (!vec4_is_finite(result[i])) return EWA_ERROR_NUMERIC;
        }
    }
    for (int i = 0; i < 6; i++) planes[i] = result[i];
    return EWA_OK;
}

double ewa_frustum_distance(const ewa_vec4 planes[6], ewa_vec3 center) {
    ewa_vec4 point = vec4_from_vec3(center, 1);
    double smallest = vec4_dot(planes[0], point);
    for (int i = 1; i < 6; i++) smallest = fmin(smallest, vec4_dot(planes[i], point));
    return smallest;
}
