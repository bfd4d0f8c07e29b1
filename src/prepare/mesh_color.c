// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours of places on a mesh. Textures are read bilinearly from the level whose texels are as wide as the
// place, so that fine patterns become their mean instead of noise.
#include "prepare/mesh_color.h"
#include "base/base.h"
#include "image/srgb.h"

#include <math.h>
#include <string.h>

/// Halves an image: every pixel the mean of the up to four below it.
static ewa_status halve(const ewa_image *from, ewa_image *to) {
    const uint32_t width = (from->width_px + 1) / 2, height = (from->height_px + 1) / 2,
                   channels = from->channel_count;
    const ewa_status status = ewa_image_create(from->context, width, height, channels, to);
    if (status != EWA_OK) return status;
    for (uint32_t y = 0; y < height; y++) {
        const size_t y0 = 2 * (size_t)y, y1 = y0 + 1 < from->height_px ? y0 + 1 : y0;
        for (uint32_t x = 0; x < width; x++) {
            const size_t x0 = 2 * (size_t)x, x1 = x0 + 1 < from->width_px ? x0 + 1 : x0;
            for (uint32_t c = 0; c < channels; c++) {
                const float *p = from->pixels + c;
                const size_t w = from->width_px;
                to->pixels[((size_t)y * width + x) * channels + c] =
                    0.25f * (p[(y0 * w + x0) * channels] + p[(y0 * w + x1) * channels] +
                             p[(y1 * w + x0) * channels] + p[(y1 * w + x1) * channels]);
            }
        }
    }
    return EWA_OK;
}

static bool is_opaque(const ewa_image *image) {
    if (image->channel_count != 4) return true;
    const size_t count = (size_t)image->width_px * image->height_px;
    for (size_t i = 0; i < count; i++)
        if (image->pixels[4 * i + 3] < 1) return false;
    return true;
}

ewa_status ewa_mesh_colors_make(const ewa_mesh *mesh, mesh_colors *colors) {
    ewa_context *context = mesh->context;
    *colors = (mesh_colors){.mesh = mesh};
    if (!mesh->colors && !mesh->material_count) return EWA_OK;
    bool opaque = true;
    for (uint32_t t = 0; mesh->material_count && t < mesh->triangle_count; t++)
        if (mesh->triangle_materials[t] >= mesh->material_count)
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "sample: triangle %u has material %u, there are %u",
                            t, mesh->triangle_materials[t], mesh->material_count);
    for (uint32_t v = 0; mesh->colors && v < mesh->vertex_count; v++)
        opaque = opaque && mesh->colors[4 * (size_t)v + 3] >= 1;
    colors->textures = ewa_allocate_zeroed(context, mesh->material_count, sizeof *colors->textures);
    if (!colors->textures) return EWA_ERROR_MEMORY;
    for (uint32_t m = 0; m < mesh->material_count; m++) {
        mesh_texture *texture = &colors->textures[m];
        const ewa_image *image = &mesh->materials[m].texture;
        opaque = opaque && mesh->materials[m].base_color[3] >= 1;
        if (!image->pixels || !mesh->texcoords) continue;
        if (image->channel_count != 1 && image->channel_count != 3 && image->channel_count != 4)
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "sample: the texture of material %u has %u channels",
                            m, image->channel_count);
        opaque = opaque && is_opaque(image);
        texture->levels[0] = *image;
        texture->level_count = 1;
        while (texture->level_count < MESH_TEXTURE_LEVELS) {
            const ewa_image *last = &texture->levels[texture->level_count - 1];
            if (last->width_px == 1 && last->height_px == 1) break;
            const ewa_status status = halve(last, &texture->levels[texture->level_count]);
            if (status != EWA_OK) return status;
            texture->level_count++;
        }
    }
    colors->component_count = opaque ? 3 : 4;
    return EWA_OK;
}

void ewa_mesh_colors_free(mesh_colors *colors) {
    if (!colors->mesh || !colors->textures) return;
    for (uint32_t m = 0; m < colors->mesh->material_count; m++)
        for (uint32_t l = 1; l < colors->textures[m].level_count; l++)
            ewa_image_free(&colors->textures[m].levels[l]);
    ewa_release(colors->mesh->context, colors->textures, colors->mesh->material_count,
                sizeof *colors->textures);
    *colors = (mesh_colors){0};
}

/// Pixel index of a repeating coordinate, and the share of the next one.
static void wrap(double at, uint32_t size, uint32_t index[2], float *share) {
    const double unit = at - floor(at), place = unit * size - 0.5, low = floor(place);
    const int64_t first = (int64_t)low;
    index[0] = (uint32_t)((first + size) % size);
    index[1] = (index[0] + 1) % size;
    *share = (float)(place - low);
}

/// Multiplies a straight colour with the texture at (s, t), seen `width` texels of the finest level wide.
static void apply_texture(const mesh_texture *texture, double s, double t, double width, float color[4]) {
    if (!isfinite(s) || !isfinite(t)) return;
    uint32_t level = 0;
    while (level + 1 < texture->level_count && width > 1.4142135623730951) level++, width /= 2;
    const ewa_image *image = &texture->levels[level];
    uint32_t x[2], y[2];
    float share_x, share_y, sum[4] = {0};
    wrap(s, image->width_px, x, &share_x);
    wrap(1 - t, image->height_px, y, &share_y);
    for (uint32_t c = 0; c < image->channel_count; c++) {
        float row[2];
        for (int j = 0; j < 2; j++) {
            const float *line = image->pixels + (size_t)y[j] * image->width_px * image->channel_count + c;
            const float a = line[(size_t)x[0] * image->channel_count],
                        b = line[(size_t)x[1] * image->channel_count];
            row[j] = a + share_x * (b - a);
        }
        sum[c] = row[0] + share_y * (row[1] - row[0]);
    }
    if (image->channel_count == 1) sum[1] = sum[2] = sum[0];
    if (image->channel_count == 4) {
        for (int c = 0; c < 3 && sum[3] > 0; c++) sum[c] /= sum[3];
        color[3] *= sum[3];
    }
    for (int c = 0; c < 3; c++) color[c] *= sum[c];
}

void ewa_mesh_color_at(const mesh_colors *colors, uint32_t triangle, const double weight[3],
                       double area_world, double width_world, uint8_t color[4]) {
    const ewa_mesh *mesh = colors->mesh;
    const uint32_t *vertex = mesh->triangles + 3 * (size_t)triangle;
    float mixed[4] = {1, 1, 1, 1};
    for (int c = 0; mesh->colors && c < 4; c++) {
        double sum = 0;
        for (int k = 0; k < 3; k++) sum += weight[k] * (double)mesh->colors[4 * (size_t)vertex[k] + c];
        mixed[c] = (float)sum;
    }
    if (mesh->material_count) {
        const uint32_t material = mesh->triangle_materials[triangle];
        const mesh_texture *texture = &colors->textures[material];
        for (int c = 0; c < 4; c++) mixed[c] *= mesh->materials[material].base_color[c];
        if (texture->level_count) {
            const float *uv[3];
            double at[2] = {0, 0};
            for (int k = 0; k < 3; k++) {
                uv[k] = mesh->texcoords + 2 * (size_t)vertex[k];
                at[0] += weight[k] * (double)uv[k][0];
                at[1] += weight[k] * (double)uv[k][1];
            }
            const double texels = 0.5 *
                                  fabs((double)(uv[1][0] - uv[0][0]) * (double)(uv[2][1] - uv[0][1]) -
                                       (double)(uv[1][1] - uv[0][1]) * (double)(uv[2][0] - uv[0][0])) *
                                  texture->levels[0].width_px * texture->levels[0].height_px;
            apply_texture(texture, at[0], at[1], width_world * sqrt(texels / area_world), mixed);
        }
    }
    for (int c = 0; c < 3; c++) color[c] = ewa_srgb8_from_linear(mixed[c]);
    if (colors->component_count == 4)
        color[3] = mixed[3] > 0 ? (uint8_t)(255 * (mixed[3] < 1 ? mixed[3] : 1) + 0.5f) : 0;
}
