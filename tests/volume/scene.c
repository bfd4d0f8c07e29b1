// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volumes with known contents, cameras around them, pictures of them.
#include "volume/scene.h"
#include "reference/volume.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void require(ewa_status status, const char *what) {
    if (status == EWA_OK) return;
    fprintf(stderr, "%s: %s\n", what, ewa_status_name(status));
    exit(1);
}

ewa_volume scene_volume(ewa_context *context, const uint32_t dims[3], const double spacing[3],
                        scene_field *field, const void *data) {
    ewa_volume volume;
    require(ewa_volume_create(context, dims, EWA_F32, &volume), "volume");
    for (int axis = 0; axis < 3; axis++) {
        volume.index_to_world[5 * axis] *= spacing[axis];
        volume.index_to_world[4 * axis + 3] *= spacing[axis];
    }
    float *to = volume.voxels;
    for (uint32_t k = 0; k < dims[2]; k++)
        for (uint32_t j = 0; j < dims[1]; j++)
            for (uint32_t i = 0; i < dims[0]; i++)
                *to++ = (float)field(data, spacing[0] * (i - 0.5 * (dims[0] - 1.0)),
                                     spacing[1] * (j - 0.5 * (dims[1] - 1.0)),
                                     spacing[2] * (k - 0.5 * (dims[2] - 1.0)));
    return volume;
}

double scene_ones(const void *data, double x, double y, double z) {
    (void)data, (void)x, (void)y, (void)z;
    return 1;
}

double scene_blob(const void *data, double x, double y, double z) {
    const double s = *(const double *)data;
    return exp(-(x * x + y * y + z * z) / (2 * s * s));
}

/// 1 for negative distances, 0 for positive ones, over one unit.
static double inside(double distance) { return fmin(fmax(0.5 - distance, 0), 1); }

double scene_ball(const void *data, double x, double y, double z) {
    return inside(sqrt(x * x + y * y + z * z) - *(const double *)data);
}

double scene_vessels(const void *data, double x, double y, double z) {
    const double half = *(const double *)data;
    double value = 0;
    for (int n = 0; n < 24; n++) {
        // A tube along a slanted, swinging line; thinner ones later.
        const double phase = 2.399963 * n, tilt = 0.5 * sin(1.7 * n), radius = n < 6 ? 1.6 : n < 12 ? 1 : 0.6;
        const double swing = half * 0.12 * sin(z / half * (3 + n % 4) + phase);
        const double at_x = half * 0.75 * cos(phase) * sqrt((n + 1) / 24.0) + tilt * z + swing;
        const double at_y = half * 0.75 * sin(phase) * sqrt((n + 1) / 24.0) - tilt * z * 0.6 + swing;
        const double a = n % 3 == 0 ? x : n % 3 == 1 ? y : z, b = n % 3 == 0 ? y : n % 3 == 1 ? z : x;
        value = fmax(value, inside(hypot(a - at_x, b - at_y) / sqrt(1 + tilt * tilt * 1.36) - radius));
    }
    return value;
}

double scene_checker(const void *data, double x, double y, double z) {
    const double *sides = data;
    if (fmax(fabs(x), fmax(fabs(y), fabs(z))) > sides[1]) return 0;
    const int cell = (int)floor(x / sides[0]) + (int)floor(y / sides[0]) + (int)floor(z / sides[0]);
    return cell & 1 ? 2 : 1;
}

ewa_transfer scene_linear(float red, float green, float blue, float extinction) {
    ewa_transfer transfer = {.point_count = 2, .unit_length_world = 1};
    transfer.points[0] = (ewa_transfer_point){0, {red, green, blue}, 0};
    transfer.points[1] = (ewa_transfer_point){2, {red, green, blue}, 2 * extinction};
    return transfer;
}

ewa_camera scene_camera(uint32_t width_px, uint32_t height_px, const double direction[3], double distance) {
    static const double origin[3] = {0, 0, 0}, up[3] = {0, 1, 0};
    const double length =
        sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    double eye[3];
    for (int axis = 0; axis < 3; axis++) eye[axis] = direction[axis] / length * distance;
    ewa_camera camera;
    ewa_camera_init(&camera);
    camera.width_px = width_px;
    camera.height_px = height_px;
    require(ewa_camera_set_fov(&camera, 40), "camera");
    require(ewa_camera_look_at(&camera, eye, origin, up), "camera");
    return camera;
}

ewa_voxels *scene_voxels(const ewa_volume *volume, const ewa_transfer *transfer) {
    ewa_voxels *voxels;
    require(ewa_voxels_create(volume, transfer, NULL, &voxels), "voxels");
    return voxels;
}

static ewa_volume_stats draw(ewa_context *context, const ewa_voxels *voxels, const ewa_camera *camera,
                             const ewa_volume_options *options, ewa_image *image) {
    ewa_volume_renderer *renderer;
    ewa_volume_stats stats;
    require(ewa_image_create(context, camera->width_px, camera->height_px, 4, image), "image");
    require(ewa_volume_renderer_create(context, &renderer), "renderer");
    const ewa_frame frame = {.rgba = image->pixels};
    require(ewa_volume_render(renderer, voxels, camera, options, &frame, &stats), "render");
    ewa_volume_renderer_destroy(&renderer);
    return stats;
}

ewa_image scene_draw(ewa_context *context, const ewa_voxels *voxels, const ewa_camera *camera,
                     const ewa_volume_options *options) {
    ewa_image image;
    draw(context, voxels, camera, options, &image);
    return image;
}

double scene_point_share(ewa_context *context, const ewa_voxels *voxels, const ewa_camera *camera,
                         const ewa_volume_options *options) {
    ewa_image image;
    const ewa_volume_stats stats = draw(context, voxels, camera, options, &image);
    ewa_image_free(&image);
    return stats.point_share;
}

ewa_image scene_draw_reference(const ewa_volume *volume, const ewa_transfer *transfer,
                               const ewa_camera *camera, const ewa_volume_options *options) {
    ewa_image image;
    require(ewa_image_create(volume->context, camera->width_px, camera->height_px, 4, &image), "image");
    const ewa_frame frame = {.rgba = image.pixels};
    require(ewa_volume_render_reference(volume, transfer, camera, options, &frame), "reference");
    return image;
}
