// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A picture on irregular points of a plane. Texture and view have the same axes, and the texture's kernels
// and the pixel filter are separable, so that the truth is a product of three matrices: rows, pixels,
// columns.
#include "quality/acquire_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLES = 1024 };

#define FILTER_SIGMA 0.35 // pixels, the renderer's default
#define FILTER_REACH 1.05 // its cutoff in pixels

ewa_status acquire_checker(ewa_context *context, uint32_t size_px, uint32_t check_px, ewa_image *image) {
    const ewa_status status = ewa_image_create(context, size_px, size_px, 3, image);
    if (status != EWA_OK) return status;
    for (uint32_t y = 0; y < size_px; y++)
        for (uint32_t x = 0; x < size_px; x++)
            for (uint32_t c = 0; c < 3; c++)
                image->pixels[3 * ((size_t)y * size_px + x) + c] = (x / check_px + y / check_px) % 2 ? 0 : 1;
    return EWA_OK;
}

/// Weight of a texture pixel at `distance` pixels of the texture.
static double kernel(const acquire_scene *scene, double distance) {
    const double u = distance / scene->pixel_sigma_px;
    return fabs(u) < 5 ? exp(-0.5 * u * u) : 0;
}

/// One row per pixel of the view: shares of the texture's pixels along one axis.
static double *make_shares(const acquire_scene *scene, uint32_t size_px) {
    double *shares = calloc((size_t)ACQUIRE_SIDE * size_px, sizeof *shares);
    OWNED(check_free) double *one = calloc(size_px, sizeof *one);
    const double px_per_view = size_px / (ACQUIRE_ROW * scene->view_px_per_cell);
    const double reach = 5 * scene->pixel_sigma_px + 1;
    for (int v = 0; shares && one && v < ACQUIRE_SIDE; v++) {
        double *row = shares + (size_t)v * size_px, total = 0;
        for (int i = 0; i < SAMPLES; i++) {
            const double offset = (2 * (i + 0.5) / SAMPLES - 1) * FILTER_REACH;
            const double weight = exp(-0.5 * offset * offset / (FILTER_SIGMA * FILTER_SIGMA));
            const double at = 0.5 * size_px + (v + 0.5 + offset - 0.5 * ACQUIRE_SIDE) * px_per_view;
            const int low = (int)fmax(0, floor(at - reach)), high = (int)fmin(size_px - 1, ceil(at + reach));
            double sum = 0;
            for (int k = low; k <= high; k++) sum += one[k] = kernel(scene, k + 0.5 - at);
            for (int k = low; k <= high && sum > 0; k++) row[k] += weight * one[k] / sum;
            total += weight;
        }
        for (uint32_t k = 0; k < size_px; k++) row[k] /= total;
    }
    return shares;
}

ewa_status acquire_truth(const acquire_scene *scene, ewa_image *picture) {
    const uint32_t width = scene->texture.width_px, height = scene->texture.height_px;
    ewa_status status = ewa_image_create(scene->context, ACQUIRE_SIDE, ACQUIRE_SIDE, 3, picture);
    double *across = make_shares(scene, width), *down = make_shares(scene, height);
    OWNED(check_free) double *rows = calloc((size_t)height * ACQUIRE_SIDE * 3, sizeof *rows);
    if (!across || !down || !rows) status = EWA_ERROR_MEMORY;
    for (uint32_t y = 0; y < height && status == EWA_OK; y++)
        for (int v = 0; v < ACQUIRE_SIDE; v++)
            for (uint32_t x = 0; x < width; x++) {
                const double share = across[(size_t)v * width + x];
                const float *pixel = scene->texture.pixels + 3 * ((size_t)y * width + x);
                for (int c = 0; c < 3 && share != 0; c++)
                    rows[((size_t)y * ACQUIRE_SIDE + (size_t)v) * 3 + (size_t)c] += share * (double)pixel[c];
            }
    for (int v = 0; v < ACQUIRE_SIDE && status == EWA_OK; v++)
        for (uint32_t y = 0; y < height; y++) {
            const double share = down[(size_t)v * height + y];
            for (int k = 0; k < 3 * ACQUIRE_SIDE && share != 0; k++)
                picture->pixels[(size_t)v * 3 * ACQUIRE_SIDE + (size_t)k] +=
                    (float)(share * rows[(size_t)y * 3 * ACQUIRE_SIDE + (size_t)k]);
        }
    free(across);
    free(down);
    return status;
}

ewa_status acquire_points(const acquire_scene *scene, ewa_cloud **cloud) {
    WITH_DEFAULTS(ewa_generate_options, options);
    options.point_count = ACQUIRE_ROW * ACQUIRE_ROW;
    options.size_world = ACQUIRE_ROW;
    options.jitter = scene->jitter;
    options.radius_scale = scene->radius_scale;
    options.texcoords = true;
    return ewa_cloud_generate(scene->context, &options, cloud);
}

ewa_status acquire_draw(const acquire_scene *scene, const ewa_cloud *cloud, ewa_image *picture) {
    const double eye[3] = {0, 0, ACQUIRE_ROW}, target[3] = {0, 0, 0}, up[3] = {0, 1, 0};
    ewa_camera camera;
    ewa_camera_init(&camera);
    camera.projection = EWA_ORTHOGRAPHIC;
    camera.width_px = camera.height_px = ACQUIRE_SIDE;
    camera.fx_px = camera.fy_px = scene->view_px_per_cell;
    camera.cx_px = camera.cy_px = 0.5 * ACQUIRE_SIDE;
    ewa_camera_look_at(&camera, eye, target, up);
    WITH_DEFAULTS(ewa_render_options, options);
    options.shading = EWA_SHADING_NONE;
    options.edge_antialiasing = false, options.supersampling = 1;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = NULL;
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = NULL;
    OWNED(ewa_image_free) ewa_image drawn = {0};
    ewa_status status = ewa_surfels_create(cloud, NULL, &surfels);
    if (status == EWA_OK) status = ewa_renderer_create(scene->context, &renderer);
    if (status == EWA_OK) status = ewa_image_create(scene->context, ACQUIRE_SIDE, ACQUIRE_SIDE, 4, &drawn);
    const ewa_frame frame = {.rgba = drawn.pixels};
    if (status == EWA_OK) status = ewa_render(renderer, surfels, &camera, &options, &frame, NULL);
    if (status == EWA_OK) status = ewa_image_create(scene->context, ACQUIRE_SIDE, ACQUIRE_SIDE, 3, picture);
    for (size_t i = 0; i < (size_t)ACQUIRE_SIDE * ACQUIRE_SIDE && status == EWA_OK; i++)
        memcpy(picture->pixels + 3 * i, drawn.pixels + 4 * i, 3 * sizeof *drawn.pixels);
    return status;
}

double acquire_rms(const acquire_scene *scene, const ewa_image *a, const ewa_image *b) {
    const int half = (int)fmin(0.5 * ACQUIRE_SIDE, 0.5 * ACQUIRE_ROW * scene->view_px_per_cell - 2);
    double sum = 0;
    for (int y = -half; y < half; y++)
        for (int x = -half; x < half; x++)
            for (int c = 0; c < 3; c++) {
                const size_t i = (size_t)((y + ACQUIRE_SIDE / 2) * ACQUIRE_SIDE + x + ACQUIRE_SIDE / 2) * 3;
                const double difference = (double)a->pixels[i + (size_t)c] - (double)b->pixels[i + (size_t)c];
                sum += difference * difference;
            }
    return sqrt(sum / (12.0 * half * half));
}
