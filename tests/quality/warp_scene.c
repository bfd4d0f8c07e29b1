// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A room to warp pictures of, and how alike two pictures are.
#include "warp_scene.h"

#include <math.h>
#include <string.h>

enum { RAYS = 4, WINDOW = 8, SPHERES = 3 };

typedef struct sphere {
    double center[3], radius;
} sphere;

static const sphere SPHERE[SPHERES] = {
    {{-0.9, 0.45, 3.2}, 0.55}, {{0.75, 0.65, 2.6}, 0.35}, {{0.35, -0.35, 4.0}, 0.5}};
static const double FLOOR_Y = 1, WALL_Z = 6, BOARD_Z = 2.9;

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Smooth bands of several widths: detail down to a few pixels, but none below.
static void texture(int object, double u, double v, double color[3]) {
    const double fine = sin(17 * u) * sin(19 * v), coarse = sin(3.1 * u + 1.7 * v + object),
                 tilted = sin(9 * (u + v) + 2 * object);
    color[0] = 0.45 + 0.2 * fine + 0.2 * coarse;
    color[1] = 0.40 + 0.2 * tilted + 0.15 * coarse;
    color[2] = 0.35 + 0.15 * fine - 0.15 * tilted + 0.05 * object;
    const double check = (floor(2 * u) + floor(2 * v)) * 0.5;
    if (check != floor(check))
        for (int c = 0; c < 3; c++) color[c] *= 0.45;
    for (int c = 0; c < 3; c++) color[c] = fmin(fmax(color[c], 0.01), 0.99);
}

static void take(warp_hit *hit, double t, int object, double u, double v) {
    hit->z = t; // rays have z 1 in the camera
    hit->object = object;
    texture(object, u, v, hit->color);
}

warp_hit warp_scene_hit(const ewa_camera *camera, double x, double y) {
    const double *m = camera->world_to_camera;
    double eye[3], ray[3];
    const double slope[3] = {(x - camera->cx_px) / camera->fx_px, (y - camera->cy_px) / camera->fy_px, 1};
    ewa_camera_eye(camera, eye);
    for (int c = 0; c < 3; c++) ray[c] = m[c] * slope[0] + m[4 + c] * slope[1] + m[8 + c] * slope[2];
    warp_hit hit = {.object = -1, .z = INFINITY, .color = {0.02, 0.02, 0.02}};
    double t = (FLOOR_Y - eye[1]) / ray[1];
    if (t > 0) take(&hit, t, 0, eye[0] + t * ray[0], eye[2] + t * ray[2]);
    t = (WALL_Z - eye[2]) / ray[2];
    if (t > 0 && t < hit.z) take(&hit, t, 1, eye[0] + t * ray[0], eye[1] + t * ray[1]);
    t = (BOARD_Z - eye[2]) / ray[2];
    const double bx = eye[0] + t * ray[0], by = eye[1] + t * ray[1];
    if (t > 0 && t < hit.z && fabs(bx + 0.05) < 0.12 && by > -0.9 && by < 1) take(&hit, t, 2, bx, by);
    for (int i = 0; i < SPHERES; i++) {
        double to[3];
        for (int c = 0; c < 3; c++) to[c] = eye[c] - SPHERE[i].center[c];
        const double a = dot(ray, ray), b = dot(ray, to),
                     under = b * b - a * (dot(to, to) - SPHERE[i].radius * SPHERE[i].radius);
        if (under < 0) continue;
        t = (-b - sqrt(under)) / a;
        if (!(t > 0) || t >= hit.z) continue;
        double n[3];
        for (int c = 0; c < 3; c++) n[c] = (to[c] + t * ray[c]) / SPHERE[i].radius;
        take(&hit, t, 3 + i, 0.8 * atan2(n[0], -n[2]), 0.8 * asin(n[1]));
    }
    for (int c = 0; c < 3; c++) hit.point_world[c] = eye[c] + hit.z * ray[c];
    return hit;
}

ewa_camera warp_scene_camera(uint32_t width_px, uint32_t height_px, double shift_x, double shift_y,
                             double shift_z) {
    ewa_camera camera;
    ewa_camera_init(&camera);
    camera.width_px = width_px;
    camera.height_px = height_px;
    ewa_camera_set_fov(&camera, 50);
    const double eye[3] = {shift_x, -0.2 + shift_y, shift_z},
                 target[3] = {0.6 * shift_x, 0.15 + 0.5 * shift_y, 4}, up[3] = {0, -1, 0};
    ewa_camera_look_at(&camera, eye, target, up);
    return camera;
}

void warp_scene_picture(const ewa_camera *camera, uint8_t *rgb8, float *depth) {
    for (uint32_t y = 0; y < camera->height_px; y++) {
        for (uint32_t x = 0; x < camera->width_px; x++) {
            const size_t pixel = (size_t)y * camera->width_px + x;
            double sum[3] = {0};
            for (int k = 0; k < RAYS * RAYS; k++) {
                const warp_hit hit =
                    warp_scene_hit(camera, x + (k % RAYS + 0.5) / RAYS, y + ((k / RAYS) + 0.5) / RAYS);
                for (int c = 0; c < 3; c++) sum[c] += hit.color[c] / (RAYS * RAYS);
            }
            for (int c = 0; c < 3; c++)
                rgb8[3 * pixel + c] = (uint8_t)(255 * ewa_srgb_from_linear((float)sum[c]) + 0.5f);
            if (depth) depth[pixel] = (float)warp_scene_hit(camera, x + 0.5, y + 0.5).z;
        }
    }
}

void warp_scene_seen(const ewa_camera *target, const ewa_camera *from, uint8_t *seen) {
    const double *m = from->world_to_camera;
    for (uint32_t y = 0; y < target->height_px; y++) {
        for (uint32_t x = 0; x < target->width_px; x++) {
            const warp_hit hit = warp_scene_hit(target, x + 0.5, y + 0.5);
            double p[3];
            for (int r = 0; r < 3; r++) p[r] = dot(&m[4 * r], hit.point_world) + m[4 * r + 3];
            const double u = from->fx_px * p[0] / p[2] + from->cx_px,
                         v = from->fy_px * p[1] / p[2] + from->cy_px;
            // A pixel from the border on, so that the surface goes on to all sides.
            const bool inside =
                p[2] > 0 && u > 1 && v > 1 && u < from->width_px - 1 && v < from->height_px - 1;
            seen[(size_t)y * target->width_px + x] =
                inside && warp_scene_hit(from, u, v).z > p[2] * (1 - 1e-6) ? 255 : 0;
        }
    }
}

static double luma(const uint8_t *rgb8) { return 0.299 * rgb8[0] + 0.587 * rgb8[1] + 0.114 * rgb8[2]; }

/// SSIM of one window; 8-bit range.
static double window_ssim(uint32_t width, const uint8_t *a, const uint8_t *b) {
    double sum_a = 0, sum_b = 0, sum_aa = 0, sum_bb = 0, sum_ab = 0;
    for (uint32_t y = 0; y < WINDOW; y++) {
        for (uint32_t x = 0; x < WINDOW; x++) {
            const double p = luma(a + 3 * ((size_t)y * width + x)), q = luma(b + 3 * ((size_t)y * width + x));
            sum_a += p, sum_b += q, sum_aa += p * p, sum_bb += q * q, sum_ab += p * q;
        }
    }
    const double n = WINDOW * WINDOW, c1 = 0.01 * 255 * 0.01 * 255, c2 = 0.03 * 255 * 0.03 * 255;
    const double mean_a = sum_a / n, mean_b = sum_b / n;
    const double var_a = (sum_aa - n * mean_a * mean_a) / (n - 1),
                 var_b = (sum_bb - n * mean_b * mean_b) / (n - 1);
    const double covariance = (sum_ab - n * mean_a * mean_b) / (n - 1);
    return (2 * mean_a * mean_b + c1) * (2 * covariance + c2) /
           ((mean_a * mean_a + mean_b * mean_b + c1) * (var_a + var_b + c2));
}

picture_likeness picture_compare(uint32_t width_px, uint32_t height_px, const uint8_t *rgb8_a,
                                 const uint8_t *rgb8_b, const uint8_t *counts) {
    picture_likeness result = {.pixel_count = 0};
    double squares = 0, similarity = 0;
    uint64_t windows = 0;
    for (uint32_t y = 0; y < height_px; y++) {
        for (uint32_t x = 0; x < width_px; x++) {
            const size_t pixel = (size_t)y * width_px + x;
            if (!counts || counts[pixel]) {
                for (int c = 0; c < 3; c++) {
                    const double d = (double)rgb8_a[3 * pixel + c] - rgb8_b[3 * pixel + c];
                    squares += d * d;
                }
                result.pixel_count++;
            }
            bool whole = x + WINDOW <= width_px && y + WINDOW <= height_px;
            for (uint32_t k = 0; whole && counts && k < WINDOW * WINDOW; k++)
                whole = counts[pixel + (size_t)(k / WINDOW) * width_px + k % WINDOW] != 0;
            if (!whole) continue;
            similarity += window_ssim(width_px, rgb8_a + 3 * pixel, rgb8_b + 3 * pixel);
            windows++;
        }
    }
    const double mean = squares / (3.0 * (double)result.pixel_count);
    result.psnr_db = mean > 0 ? 10 * log10(255.0 * 255.0 / mean) : INFINITY;
    result.ssim = windows ? similarity / (double)windows : NAN;
    return result;
}
