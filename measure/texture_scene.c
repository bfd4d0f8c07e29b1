// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Textured floors with supersampled truth.
#include "measure/texture_scene.h"

#include <math.h>
#include <string.h>

ewa_texture_source texture_source_of(const ewa_image *image) {
    return (ewa_texture_source){image->pixels,        EWA_PIXEL_LINEAR,
                                image->channel_count, image->width_px,
                                image->height_px,     image->width_px * image->channel_count * 4u};
}

ewa_texture_target texture_target_of(const ewa_image *image) {
    return (ewa_texture_target){image->pixels,        EWA_PIXEL_LINEAR,
                                image->channel_count, image->width_px,
                                image->height_px,     image->width_px * image->channel_count * 4u};
}

/// Copies of an image file, below each other, its sides cut to even ones.
static ewa_status load_fine(ewa_context *context, const char *path, ewa_image *fine) {
    ewa_image image;
    ewa_status status = ewa_image_load(context, path, &image);
    if (status != EWA_OK) return status;
    const uint32_t width = image.width_px & ~1u, height = image.height_px & ~1u,
                   channels = image.channel_count;
    status = ewa_image_create(context, width, height * TEXTURE_COPIES, 3, fine);
    for (uint32_t y = 0; status == EWA_OK && y < fine->height_px; y++)
        for (uint32_t x = 0; x < width; x++)
            for (uint32_t c = 0; c < 3; c++)
                fine->pixels[3 * ((size_t)y * width + x) + c] =
                    image.pixels[channels * ((size_t)(y % height) * image.width_px + x) +
                                 (channels > 2 ? c : 0)];
    ewa_image_free(&image);
    return status;
}

static ewa_status make_checker(ewa_context *context, ewa_image *fine) {
    const uint32_t width = 768, height = 512 * TEXTURE_COPIES;
    const ewa_status status = ewa_image_create(context, width, height, 3, fine);
    for (uint32_t y = 0; status == EWA_OK && y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            for (uint32_t c = 0; c < 3; c++)
                fine->pixels[3 * ((size_t)y * width + x) + c] = (x / 32 + y / 32) % 2 ? 0.02f : 0.8f;
    return status;
}

static ewa_status halve(ewa_context *context, const ewa_image *fine, ewa_image *half) {
    const ewa_status status = ewa_image_create(context, fine->width_px / 2, fine->height_px / 2, 3, half);
    for (uint32_t y = 0; status == EWA_OK && y < half->height_px; y++)
        for (uint32_t x = 0; x < half->width_px; x++)
            for (uint32_t c = 0; c < 3; c++) {
                const float *from = fine->pixels + 3 * ((size_t)2 * y * fine->width_px + 2 * x) + c;
                half->pixels[3 * ((size_t)y * half->width_px + x) + c] =
                    0.25f * (from[0] + from[3] + from[3 * fine->width_px] + from[3 * fine->width_px + 3]);
            }
    return status;
}

/// The floor: two units wide, the eye half a unit above and before its near edge.
static ewa_status make_map(ewa_context *context, const ewa_image *texture, ewa_mat3 *map) {
    ewa_camera camera;
    ewa_camera_init(&camera);
    camera.width_px = camera.height_px = TEXTURE_SIDE;
    ewa_status status = ewa_camera_set_fov(&camera, 60);
    const double eye[3] = {0.13, -0.5, 0.5}, target[3] = {0, 1, 0.05}, up[3] = {0.06, 0, 1};
    if (status == EWA_OK) status = ewa_camera_look_at(&camera, eye, target, up);
    const double length = 2.0 * texture->height_px / texture->width_px;
    const double origin[3] = {-1, length, 0}, across[3] = {2, 0, 0}, down[3] = {0, -length, 0};
    if (status != EWA_OK) return status;
    return ewa_texture_map_from_camera(context, texture->width_px, texture->height_px, &camera, origin,
                                       across, down, map);
}

/// Averages rays through a pixel; returns whether all of them meet the floor. `area` gets texels per pixel.
static bool trace(const texture_scene *scene, const ewa_mat3 *inverse, int x, int y, float color[3],
                  double *area) {
    double sum[3] = {0}, uv[3][2];
    const double u_per_texel = 2; // fine pixels
    for (int j = 0; j < TEXTURE_RAYS; j++) {
        for (int i = 0; i < TEXTURE_RAYS; i++) {
            const ewa_vec3 at = {x + (i + 0.5) / TEXTURE_RAYS, y + (j + 0.5) / TEXTURE_RAYS, 1};
            const ewa_vec3 p = ewa_point2_transform(at, inverse);
            if (!(p.z > 0)) return false;
            const double u = p.x / p.z * u_per_texel, v = p.y / p.z * u_per_texel;
            if (!(u >= 0 && v >= 0 && u < scene->fine.width_px && v < scene->fine.height_px)) return false;
            const float *pixel = scene->fine.pixels + 3 * ((size_t)v * scene->fine.width_px + (size_t)u);
            for (int c = 0; c < 3; c++) sum[c] += (double)pixel[c];
        }
    }
    for (int k = 0; k < 3; k++) {
        const ewa_vec3 at = {x + (k == 1), y + (k == 2), 1};
        const ewa_vec3 p = ewa_point2_transform(at, inverse);
        uv[k][0] = p.x / p.z;
        uv[k][1] = p.y / p.z;
    }
    *area =
        fabs((uv[1][0] - uv[0][0]) * (uv[2][1] - uv[0][1]) - (uv[1][1] - uv[0][1]) * (uv[2][0] - uv[0][0]));
    for (int c = 0; c < 3; c++) color[c] = (float)(sum[c] / (TEXTURE_RAYS * TEXTURE_RAYS));
    return true;
}

ewa_status texture_scene_make(ewa_context *context, const char *path, texture_scene *scene) {
    memset(scene, 0, sizeof *scene);
    ewa_status status = path ? load_fine(context, path, &scene->fine) : make_checker(context, &scene->fine);
    if (status == EWA_OK) status = halve(context, &scene->fine, &scene->texture);
    if (status == EWA_OK) status = make_map(context, &scene->texture, &scene->map);
    if (status == EWA_OK) status = ewa_image_create(context, TEXTURE_SIDE, TEXTURE_SIDE, 3, &scene->truth);
    ewa_mat3 inverse;
    if (status == EWA_OK) status = ewa_mat3_invert(&scene->map, &inverse);
    for (int y = 0; y < TEXTURE_SIDE && status == EWA_OK; y++) {
        for (int x = 0; x < TEXTURE_SIDE; x++) {
            double area = 0;
            float *pixel = scene->truth.pixels + 3 * ((size_t)y * TEXTURE_SIDE + (size_t)x);
            const bool covered = trace(scene, &inverse, x, y, pixel, &area);
            scene->band[y][x] = (int8_t)(!covered ? -1 : area < 1 ? 0 : area < 16 ? 1 : 2);
        }
    }
    return status;
}

void texture_scene_free(texture_scene *scene) {
    ewa_image_free(&scene->fine);
    ewa_image_free(&scene->texture);
    ewa_image_free(&scene->truth);
}

ewa_status texture_scene_draw(ewa_context *context, const texture_scene *scene,
                              const ewa_texture_options *options, ewa_image *picture,
                              ewa_texture_stats *stats) {
    const ewa_texture_source source = texture_source_of(&scene->texture);
    ewa_status status = ewa_image_create(context, TEXTURE_SIDE, TEXTURE_SIDE, 3, picture);
    if (status != EWA_OK) return status;
    const ewa_texture_target target = texture_target_of(picture);
    return ewa_texture_map(context, &source, &scene->map, options, &target, stats);
}

double texture_psnr_db(const texture_scene *scene, const ewa_image *a, const ewa_image *b, int band) {
    double squares = 0;
    uint64_t count = 0;
    for (int y = 0; y < TEXTURE_SIDE; y++) {
        for (int x = 0; x < TEXTURE_SIDE; x++) {
            if (scene->band[y][x] < 0 || (band >= 0 && scene->band[y][x] != band)) continue;
            const size_t at = (size_t)y * TEXTURE_SIDE + (size_t)x;
            for (size_t c = 0; c < 3; c++) {
                const double of_a = (double)ewa_srgb_from_linear(a->pixels[a->channel_count * at + c]);
                const double of_b = (double)ewa_srgb_from_linear(b->pixels[b->channel_count * at + c]);
                squares += (of_a - of_b) * (of_a - of_b);
            }
            count += 3;
        }
    }
    return -10 * log10(squares / (double)count);
}

texture_errors texture_scene_compare(const texture_scene *scene, const ewa_image *picture) {
    texture_errors errors;
    for (int band = 0; band < TEXTURE_BANDS; band++)
        errors.psnr_db[band] = texture_psnr_db(scene, picture, &scene->truth, band);
    errors.all_db = texture_psnr_db(scene, picture, &scene->truth, -1);
    return errors;
}
