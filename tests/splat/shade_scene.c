// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scenes for tests of shading.
#include "tests/splat/shade_scene.h"
#include "tests/prepare/check_generated.h"
#include "reference/surface.h"

#include <math.h>

ewa_cloud *shade_sphere(ewa_context *context, uint64_t point_count, const float color[3]) {
    ewa_cloud *cloud = check_object(context, EWA_OBJECT_SPHERE, point_count);
    ewa_cloud_remove(cloud, EWA_COLOR);
    void *data = NULL;
    assert_int_equal(ewa_cloud_add(cloud, EWA_COLOR, EWA_F32, 3, &data), EWA_OK);
    float *colors = data;
    for (uint64_t i = 0; i < 3 * ewa_cloud_point_count(cloud); i++) colors[i] = color[i % 3];
    return cloud;
}

void shade_set_material(ewa_cloud *cloud, int (*of)(const float position[3])) {
    void *data = NULL;
    assert_int_equal(ewa_cloud_add(cloud, EWA_MATERIAL, EWA_I32, 1, &data), EWA_OK);
    int32_t *material = data;
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++)
        material[i] =
            of((const float *)(const void *)((const char *)position->data + i * position->stride_bytes));
}

ewa_camera shade_camera(uint32_t side_px, const double eye_world[3], double fov_deg, double ortho_height) {
    static const double origin[3] = {0, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1};
    ewa_camera camera = check_camera(side_px, side_px);
    const ewa_status status =
        ortho_height > 0 ? ewa_camera_set_ortho(&camera, ortho_height) : ewa_camera_set_fov(&camera, fov_deg);
    assert_int_equal(status, EWA_OK);
    const bool along_y = eye_world[0] == 0 && eye_world[2] == 0;
    assert_int_equal(ewa_camera_look_at(&camera, eye_world, origin, along_y ? z : y), EWA_OK);
    return camera;
}

void shade_ray(const ewa_camera *camera, uint32_t x, uint32_t y, ewa_vec3 *origin, ewa_vec3 *direction) {
    const double slope_x = (x + 0.5 - camera->cx_px) / camera->fx_px,
                 slope_y = (y + 0.5 - camera->cy_px) / camera->fy_px;
    ewa_vec3 axes[3];
    for (int i = 0; i < 3; i++) axes[i] = vec3_load(&camera->world_to_camera[4 * i]);
    double eye[3];
    ewa_camera_eye(camera, eye);
    *origin = vec3_load(eye);
    *direction = axes[2];
    const ewa_vec3 aside = vec3_add(vec3_scale(axes[0], slope_x), vec3_scale(axes[1], slope_y));
    if (camera->projection == EWA_ORTHOGRAPHIC)
        *origin = vec3_add(*origin, aside);
    else
        *direction = vec3_add(*direction, aside);
    *direction = vec3_scale(*direction, 1 / vec3_length(*direction));
}

bool shade_hit_sphere(ewa_vec3 origin, ewa_vec3 direction, ewa_vec3 *normal) {
    const double along = -vec3_dot(origin, direction);
    const double inside = along * along - vec3_dot(origin, origin) + 1;
    if (inside < 0) return false;
    *normal = vec3_add(origin, vec3_scale(direction, along - sqrt(inside)));
    return true;
}

ewa_environment *shade_environment(ewa_context *context, uint32_t height,
                                   void (*light)(ewa_vec3 direction, float rgb[3])) {
    const double pi = acos(-1);
    ewa_image image;
    assert_int_equal(ewa_image_create(context, 2 * height, height, 3, &image), EWA_OK);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < 2 * height; x++) {
            const double latitude = pi * (0.5 - (y + 0.5) / height);
            const double longitude = 2 * pi * (0.5 - (x + 0.5) / (2 * height));
            const double across = cos(latitude);
            const ewa_vec3 d = {across * sin(longitude), sin(latitude), across * cos(longitude)};
            light(d, image.pixels + 3 * ((size_t)y * 2 * height + x));
        }
    ewa_environment *environment = NULL;
    assert_int_equal(ewa_environment_create(&image, &environment), EWA_OK);
    ewa_image_free(&image);
    return environment;
}

void shade_linear_light(ewa_vec3 direction, float rgb[3]) {
    rgb[0] = (float)(0.5 + 0.5 * direction.x);
    rgb[1] = (float)(0.5 + 0.5 * direction.y);
    rgb[2] = (float)(0.5 + 0.5 * direction.z);
}

picture shade_draw(ewa_context *context, const ewa_cloud *cloud, const ewa_camera *camera,
                   const ewa_render_options *options) {
    picture made = picture_make(camera->width_px, camera->height_px);
    ewa_surfels *surfels = check_surfels(cloud, NULL);
    ewa_renderer *renderer = check_renderer(context);
    for (int frame = 0; frame < 2; frame++)
        assert_int_equal(ewa_render(renderer, surfels, camera, options, &made.frame, NULL), EWA_OK);
    ewa_renderer_destroy(&renderer);
    ewa_surfels_destroy(&surfels);
    return made;
}

picture shade_reference(const ewa_cloud *cloud, const ewa_camera *camera, const ewa_render_options *options) {
    ewa_surfels_info info;
    ewa_surfels *surfels = check_surfels(cloud, NULL);
    ewa_surfels_describe(surfels, &info);
    ewa_surfels_destroy(&surfels);
    picture made = picture_make(camera->width_px, camera->height_px);
    assert_int_equal(ewa_render_reference(cloud, NULL, info.unit_coverage, camera, options, &made.frame),
                     EWA_OK);
    return made;
}
