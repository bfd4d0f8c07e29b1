// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A sphere by rays: its texture, its photographs, and surfels on a Fibonacci lattice.
#include "tests/photos/photo_scene.h"

#include <math.h>

enum { RAYS = 4 }; // along a side of a pixel

static const double GOLDEN = 2.399963229728653; // angle of a Fibonacci lattice
static const double WAVE_SPACINGS = 6;

static double spacing_of(uint32_t count) { return sqrt(4 * 3.14159265358979 / count); }

void photo_scene_texture(const double place_world[3], double wave_world, double color[3]) {
    static const double ways[3][3] = {{1, 0.3, -0.2}, {-0.25, 1, 0.3}, {0.2, -0.3, 1}};
    for (int c = 0; c < 3; c++) {
        double fine = 1, coarse = 0;
        for (int i = 0; i < 3; i++) {
            double along = 0;
            for (int k = 0; k < 3; k++) along += ways[i][k] * place_world[k];
            fine *= sin(6.28318530717959 * along / wave_world + c + i);
            coarse += sin(2.5 * along + 2 * c + i) / 3;
        }
        color[c] = 0.4 + 0.2 * fine + 0.12 * coarse;
    }
}

/// The colour that a ray meets; black, and false, where it misses the sphere.
static bool trace(const ewa_camera *camera, double x_px, double y_px, double wave_world, double color[3]) {
    const double *m = camera->world_to_camera;
    const double ray[3] = {(x_px - camera->cx_px) / camera->fx_px, (y_px - camera->cy_px) / camera->fy_px, 1};
    double eye[3], way[3], b = 0, c = -1, length2 = 0;
    ewa_camera_eye(camera, eye);
    for (int i = 0; i < 3; i++) way[i] = m[i] * ray[0] + m[4 + i] * ray[1] + m[8 + i] * ray[2];
    for (int i = 0; i < 3; i++) length2 += way[i] * way[i], b += eye[i] * way[i], c += eye[i] * eye[i];
    const double root2 = b * b - length2 * c;
    memset(color, 0, 3 * sizeof *color);
    if (root2 <= 0) return false;
    const double t = (-b - sqrt(root2)) / length2;
    const double place[3] = {eye[0] + t * way[0], eye[1] + t * way[1], eye[2] + t * way[2]};
    photo_scene_texture(place, wave_world, color);
    return true;
}

static void take(ewa_context *context, photo_scene *scene, uint32_t index, uint32_t side_px) {
    ewa_photo *photo = &scene->photos[index];
    ewa_camera *camera = &photo->camera;
    // Round the sphere, up and down by turns.
    const double turn = 6.28318530717959 * index / scene->count, up = 0.9 * sin(2.4 * index);
    const double eye[3] = {3.4 * cos(turn), 3.4 * sin(turn), up * 2}, target[3] = {0, 0, 0}, above[3] = {0, 0, 1};
    ewa_camera_init(camera);
    camera->width_px = side_px, camera->height_px = side_px + 8;
    assert_int_equal(ewa_camera_set_fov(camera, 40), EWA_OK);
    assert_int_equal(ewa_camera_look_at(camera, eye, target, above), EWA_OK);
    assert_int_equal(ewa_image_create(context, camera->width_px, camera->height_px, 4, &scene->images[index]), EWA_OK);
    const double wave = WAVE_SPACINGS * spacing_of(scene->point_count);
    float *to = scene->images[index].pixels;
    for (uint32_t y = 0; y < camera->height_px; y++)
        for (uint32_t x = 0; x < camera->width_px; x++) {
            double sum[4] = {0}, color[3];
            for (int ray = 0; ray < RAYS * RAYS; ray++) {
                const double x_px = x + (ray % RAYS + 0.5) / RAYS, y_px = y + (ray / RAYS + 0.5) / RAYS;
                sum[3] += trace(camera, x_px, y_px, wave, color) ? 1.0 / (RAYS * RAYS) : 0;
                for (int c = 0; c < 3; c++) sum[c] += color[c] / (RAYS * RAYS);
            }
            for (int c = 0; c < 3; c++) *to++ = (float)(scene->gain[index][c] * sum[c] + scene->offset[index] * sum[3]);
            *to++ = (float)sum[3];
        }
    photo->image = &scene->images[index];
}

static void borrow(ewa_cloud *cloud, const char *name, uint32_t components, const float *numbers) {
    assert_int_equal(ewa_cloud_borrow(cloud, name, EWA_F32, components, numbers, 0), EWA_OK);
}

photo_scene *photo_scene_make(ewa_context *context, uint32_t point_count, uint32_t count, uint32_t side_px,
                              double gain, double offset) {
    photo_scene *scene = calloc(1, sizeof *scene);
    assert_non_null(scene);
    assert_true(count <= PHOTO_SCENE_MAX);
    scene->point_count = point_count, scene->count = count;
    scene->position = calloc(3 * (size_t)point_count, sizeof(float));
    scene->radius = calloc(point_count, sizeof(float));
    assert_non_null(scene->position);
    assert_non_null(scene->radius);
    for (uint32_t i = 0; i < point_count; i++) {
        const double z = 1 - (2 * i + 1.0) / point_count, ring = sqrt(1 - z * z), angle = GOLDEN * i;
        const double place[3] = {ring * cos(angle), ring * sin(angle), z};
        for (int c = 0; c < 3; c++) scene->position[3 * (size_t)i + (size_t)c] = (float)place[c];
        scene->radius[i] = (float)(1.14 * spacing_of(point_count));
    }
    scene->normal = scene->position;
    assert_int_equal(ewa_cloud_create(context, point_count, &scene->cloud), EWA_OK);
    borrow(scene->cloud, EWA_POSITION, 3, scene->position);
    borrow(scene->cloud, EWA_NORMAL, 3, scene->normal);
    borrow(scene->cloud, EWA_RADIUS, 1, scene->radius);
    check_random random = {42};
    for (uint32_t i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++) scene->gain[i][c] = 1 + check_uniform(&random, -gain, gain);
        scene->offset[i] = check_uniform(&random, -offset, offset);
        take(context, scene, i, side_px);
    }
    return scene;
}

void photo_scene_free(photo_scene **scene) {
    for (uint32_t i = 0; i < (*scene)->count; i++) ewa_image_free(&(*scene)->images[i]);
    ewa_cloud_destroy(&(*scene)->cloud);
    free((*scene)->position), free((*scene)->radius), free(*scene);
    *scene = NULL;
}
