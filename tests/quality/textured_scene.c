// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A small ray caster: triangles are projected, and the rays of their boxes' samples are met with them.
// Intersection after T. Moeller, B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
#include "quality/textured_scene.h"
#include "homogeneous/vec.h"

#include <stdlib.h>

typedef struct hit {
    float depth, color[3];
} hit;

static ewa_vec3 to_camera(const ewa_camera *camera, const double *world) {
    const double *m = camera->world_to_camera;
    double p[3];
    for (int r = 0; r < 3; r++)
        p[r] = m[4 * r] * world[0] + m[4 * r + 1] * world[1] + m[4 * r + 2] * world[2] + m[4 * r + 3];
    return vec3_load(p);
}

static uint32_t wrapped(double index, uint32_t size) {
    const double rest = index - size * floor(index / size);
    return rest < size ? (uint32_t)rest : size - 1;
}

static void look_up(const ewa_image *image, double s, double t, float color[3]) {
    const double x = s * image->width_px - 0.5, y = (1 - t) * image->height_px - 0.5;
    const double fx = x - floor(x), fy = y - floor(y);
    for (uint32_t c = 0; c < 3; c++) {
        double sum = 0;
        for (int k = 0; k < 4; k++) {
            const uint32_t i = wrapped(floor(x) + k % 2, image->width_px),
                           j = wrapped(floor(y) + k / 2, image->height_px);
            const float *pixel = image->pixels + ((size_t)j * image->width_px + i) * image->channel_count;
            sum += (k % 2 ? fx : 1 - fx) * (k / 2 ? fy : 1 - fy) *
                   (double)pixel[image->channel_count == 1 ? 0 : c];
        }
        color[c] = (float)sum;
    }
}

/// The hits of one triangle among the samples, `width` by `height` of them.
static void draw_triangle(const ewa_mesh *mesh, const ewa_camera *camera, uint32_t samples, bool cull,
                          uint32_t triangle, hit *hits) {
    const uint32_t width = camera->width_px * samples, height = camera->height_px * samples;
    const uint32_t *vertex = mesh->triangles + 3 * (size_t)triangle;
    ewa_vec3 p[3];
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int k = 0; k < 3; k++) {
        p[k] = to_camera(camera, mesh->positions + 3 * (size_t)vertex[k]);
        if (!(p[k].z > 0)) return; // scenes lie before the camera
        const double at[2] = {(camera->fx_px * p[k].x / p[k].z + camera->cx_px) * samples,
                              (camera->fy_px * p[k].y / p[k].z + camera->cy_px) * samples};
        for (int c = 0; c < 2; c++) low[c] = fmin(low[c], at[c]), high[c] = fmax(high[c], at[c]);
    }
    const ewa_vec3 e1 = vec3_sub(p[1], p[0]), e2 = vec3_sub(p[2], p[0]);
    if (cull && vec3_dot(vec3_cross(e1, e2), p[0]) >= 0) return;
    const ewa_mesh_material *material = &mesh->materials[mesh->triangle_materials[triangle]];
    for (int64_t y = (int64_t)fmax(0, floor(low[1])); y < (int64_t)fmin(height, ceil(high[1]) + 1); y++)
        for (int64_t x = (int64_t)fmax(0, floor(low[0])); x < (int64_t)fmin(width, ceil(high[0]) + 1); x++) {
            const ewa_vec3 ray = {(((double)x + 0.5) / samples - camera->cx_px) / camera->fx_px,
                                  (((double)y + 0.5) / samples - camera->cy_px) / camera->fy_px, 1};
            const ewa_vec3 h = vec3_cross(ray, e2), q = vec3_cross(vec3_scale(p[0], -1), e1);
            const double det = vec3_dot(e1, h);
            if (det == 0) continue;
            const double u = -vec3_dot(p[0], h) / det, v = vec3_dot(ray, q) / det,
                         depth = vec3_dot(e2, q) / det;
            hit *at = &hits[(size_t)y * width + (size_t)x];
            if (u < 0 || v < 0 || u + v > 1 || !(depth < (double)at->depth)) continue;
            at->depth = (float)depth;
            double st[2] = {0, 0};
            for (int c = 0; c < 2 && mesh->texcoords; c++)
                st[c] = (1 - u - v) * (double)mesh->texcoords[2 * (size_t)vertex[0] + (size_t)c] +
                        u * (double)mesh->texcoords[2 * (size_t)vertex[1] + (size_t)c] +
                        v * (double)mesh->texcoords[2 * (size_t)vertex[2] + (size_t)c];
            for (int c = 0; c < 3; c++) at->color[c] = 1;
            const ewa_image *texture = &mesh->textures[material->texture];
            if (texture->pixels) look_up(texture, st[0], st[1], at->color);
            for (int c = 0; c < 3; c++) at->color[c] *= material->base_color[c];
        }
}

ewa_status textured_cast(const ewa_mesh *mesh, const ewa_camera *camera, uint32_t samples, bool cull,
                         ewa_image *picture) {
    const uint32_t width = camera->width_px, height = camera->height_px;
    const size_t count = (size_t)width * height * samples * samples;
    if (!mesh->material_count) return EWA_ERROR_ARGUMENT;
    hit *hits = calloc(count, sizeof *hits);
    if (!hits) return EWA_ERROR_MEMORY;
    for (size_t i = 0; i < count; i++) hits[i].depth = INFINITY;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) draw_triangle(mesh, camera, samples, cull, t, hits);
    const ewa_status status = ewa_image_create(mesh->context, width, height, 4, picture);
    const float share = 1 / (float)(samples * samples);
    for (size_t i = 0; i < count && status == EWA_OK; i++) {
        if (!(hits[i].depth < INFINITY)) continue;
        const size_t x = i % (width * samples) / samples, y = i / (width * samples) / samples;
        float *pixel = picture->pixels + 4 * (y * width + x);
        for (int c = 0; c < 3; c++) pixel[c] += share * hits[i].color[c];
        pixel[3] += share;
    }
    free(hits);
    return status;
}

double textured_psnr(const ewa_image *a, const ewa_image *b) {
    double sum = 0, count = 0;
    for (size_t i = 0; i < (size_t)a->width_px * a->height_px; i++) {
        const float *p = a->pixels + 4 * i, *q = b->pixels + 4 * i;
        if (p[3] < 0.999f || q[3] < 0.999f) continue;
        for (int c = 0; c < 3; c++) {
            const double difference = (double)ewa_srgb_from_linear(p[c]) - (double)ewa_srgb_from_linear(q[c]);
            sum += difference * difference;
        }
        count += 3;
    }
    return 10 * log10(count / sum);
}
