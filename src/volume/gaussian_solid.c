// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Gaussians as opaque surfaces: of four samples of a pixel each shows the nearest ellipsoid or dot, so that the order of the splats
// does not matter. A record has rays in the splat's standard deviations (gaussian_kernels.h), where an ellipsoid is a ball.
#include "volume/gaussian_solid.h"
#include "image/srgb.h"

#include <math.h>
#include <string.h>

/// What faces away from the eye has that share of its colour left.
static const float DARKEST = 0.4f;

/// Splats after which it is looked whether more can show.
enum { LOOK_AFTER = 64, SIDE = 2 * EWA_GAUSSIAN_TILE_PX };

/// A ray's way to a splat's surface.
typedef struct solid_hit {
    float z, g[3];
} solid_hit;

/// Where sample `index` of a row of samples lies.
static float place_of(uint32_t first_px, uint32_t index) { return (float)first_px + 0.25f + 0.5f * (float)index; }

/// The nearest surface of an ellipsoid that the ray through (u, v), from the middle of the record, meets between two depths.
static bool meet(const ewa_gaussian_solids *solids, const float *s, float u, float v, float enter, float leave, solid_hit *hit) {
    const float r2 = solids->radius * solids->radius, length = s[RECORD_LENGTH];
    for (int k = 0; k < 3; k++) hit->g[k] = u * s[RECORD_G + 3 * k] + (v * s[RECORD_G + 3 * k + 1] + s[RECORD_G + 3 * k + 2]);
    const float lateral2 = hit->g[0] * hit->g[0] + hit->g[1] * hit->g[1];
    float middle = hit->g[2], half;
    if (solids->view->orthographic) {
        if (!(lateral2 < r2)) return false;
        half = sqrtf(r2 - lateral2) / length;
    } else {
        const float square = lateral2 + hit->g[2] * hit->g[2], inside = r2 * square - length * length * lateral2;
        if (!(inside > 0)) return false;
        half = sqrtf(inside) / square;
        middle = length * hit->g[2] / square;
        if (enter < 0) enter = 0;
    }
    hit->z = middle - half;
    if (!(hit->z > enter)) hit->z = middle + half; // the far side, where the near one is cut away, or behind the eye
    return hit->z > enter && hit->z < leave;
}

/// The range of depths that sections leave of a ray.
static void find_range(const ewa_gaussian_solids *solids, const ewa_gaussian_tile *tile, float x, float y, float *enter, float *leave) {
    *enter = -INFINITY, *leave = INFINITY;
    if (!solids->view->with_sections) return;
    double low, high;
    ewa_ray_sections_range(tile->sections, (double)x, (double)y, &low, &high);
    *enter = (float)(low / solids->view->unit_camera), *leave = (float)(high / solids->view->unit_camera);
}

/// Puts a splat into the samples of a row that it may show in.
static void draw_row(const ewa_gaussian_solids *solids, const ewa_gaussian_tile *tile, uint32_t id, uint32_t row,
                     ewa_solid_samples *samples) {
    const float *s = tile->records[id];
    const float y = place_of(tile->y_px, row), v = y - s[RECORD_Y];
    float middle = s[RECORD_X], half;
    if (solids->dots) {
        half = sqrtf(fmaxf(solids->radius * solids->radius - v * v, 0));
    } else {
        const float down = s[RECORD_BY] * v;
        half = sqrtf(fmaxf(s[RECORD_LIMIT] - down * down, 0)) / s[RECORD_AX];
        middle -= s[RECORD_AY] * v / s[RECORD_AX];
    }
    const float left = 2 * (middle - half - (float)tile->x_px) - 1, right = 2 * (middle + half - (float)tile->x_px) + 1;
    const uint32_t first = left > 0 ? left < SIDE ? (uint32_t)left : SIDE : 0, end = right < 2 * (float)tile->width_px
                                                                                        ? right > 0 ? (uint32_t)right + 1 : 0
                                                                                        : 2 * tile->width_px;
    for (uint32_t column = first; column < end && column < 2 * tile->width_px; column++) {
        const float x = place_of(tile->x_px, column), u = x - s[RECORD_X];
        const size_t at = (size_t)row * SIDE + column;
        float enter, leave;
        solid_hit hit = {.z = s[RECORD_DOT_Z]};
        find_range(solids, tile, x, y, &enter, &leave);
        const bool is_hit = solids->dots ? u * u + v * v <= solids->radius * solids->radius && hit.z > enter && hit.z < leave
                                      : meet(solids, s, u, v, enter, leave, &hit);
        if (!is_hit || !(hit.z < samples->z[at])) continue;
        samples->z[at] = hit.z;
        samples->ids[at] = id;
    }
}

static void draw_splat(const ewa_gaussian_solids *solids, const ewa_gaussian_tile *tile, uint32_t id, ewa_solid_samples *samples) {
    const float *s = tile->records[id];
    if (!(s[RECORD_LOG2_ALPHA] >= solids->log2_min)) return;
    const float reach = solids->dots ? solids->radius : s[RECORD_REACH];
    const float top = 2 * (s[RECORD_Y] - reach - (float)tile->y_px) - 1, bottom = 2 * (s[RECORD_Y] + reach - (float)tile->y_px) + 1;
    const uint32_t rows = 2 * tile->height_px, first = top > 0 ? top < SIDE ? (uint32_t)top : SIDE : 0;
    for (uint32_t row = first; row < rows && (float)row <= bottom; row++) draw_row(solids, tile, id, row, samples);
}

/// Colour, linear, and normal, camera space, of what a sample shows.
static void shade(const ewa_gaussian_solids *solids, const ewa_gaussian_tile *tile, uint32_t id, float x, float y, float z,
                  float color[3], float normal[3]) {
    const ewa_gaussian_view *view = solids->view;
    const float *s = tile->records[id], u = x - s[RECORD_X], v = y - s[RECORD_Y], length = s[RECORD_LENGTH];
    float light = 1;
    memset(normal, 0, 3 * sizeof *normal);
    if (!solids->dots) {
        const float slope_x = (x - view->cx_px) / view->fx_px, slope_y = (y - view->cy_px) / view->fy_px;
        const bool ortho = view->orthographic;
        for (int k = 0; k < 3; k++) {
            const float gx = s[RECORD_G + 3 * k], gy = s[RECORD_G + 3 * k + 1], g = u * gx + (v * gy + s[RECORD_G + 3 * k + 2]);
            // The place on the ball, and the row of the map to it.
            float place = k < 2 ? (ortho ? g : z * g) : ortho ? (z - g) * length : z * g - length;
            float row[3] = {gx * view->fx_px, gy * view->fy_px, 0};
            if (ortho && k == 2)
                row[0] *= -length, row[1] *= -length, row[2] = length;
            else if (!ortho)
                row[2] = g - row[0] * slope_x - row[1] * slope_y;
            for (int c = 0; c < 3; c++) normal[c] += place * row[c];
        }
        float ray[3] = {ortho ? 0 : slope_x, ortho ? 0 : slope_y, 1};
        const float facing = normal[0] * ray[0] + normal[1] * ray[1] + normal[2] * ray[2];
        const float size = sqrtf(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
        const float turn = size > 0 ? (facing > 0 ? -1 : 1) / size : 0;
        for (int c = 0; c < 3; c++) normal[c] *= turn;
        const float away = sqrtf(ray[0] * ray[0] + ray[1] * ray[1] + 1);
        light = DARKEST + (1 - DARKEST) * fminf(fabsf(facing) * fabsf(turn) / away, 1);
    }
    for (int c = 0; c < 3; c++)
        color[c] = light * ewa_srgb_decoded[(uint8_t)(255 * fminf(s[RECORD_COLOR + c], 1) + 0.5f)];
}

/// Puts a pixel's samples, those before its surface and those behind it, together with what the planes have of it.
static void resolve(const ewa_gaussian_solids *solids, const ewa_gaussian_tile *tile, uint32_t column, uint32_t row,
                    const ewa_solid_samples *samples) {
    const size_t pixel = (size_t)(tile->y_px + row) * solids->width_px + tile->x_px + column;
    float *rgba = solids->rgba + 4 * pixel, front[4] = {0}, back[4] = {0}, sum[3] = {0}, nearest = INFINITY;
    const float surface = solids->depth[pixel], share = 1.0f / EWA_SOLID_SAMPLES;
    for (uint32_t i = 0; i < EWA_SOLID_SAMPLES; i++) {
        const uint32_t sx = 2 * column + i % 2, sy = 2 * row + i / 2;
        const size_t at = (size_t)sy * SIDE + sx;
        if (!(samples->z[at] < INFINITY)) continue;
        const float z = (float)((double)samples->z[at] * solids->view->unit_camera);
        float color[3], normal[3];
        shade(solids, tile, samples->ids[at], place_of(tile->x_px, sx), place_of(tile->y_px, sy), samples->z[at], color, normal);
        float *to = z < surface ? front : back;
        for (int c = 0; c < 3; c++) to[c] += share * color[c], sum[c] += z < surface ? normal[c] : 0;
        to[3] += share;
        nearest = fminf(nearest, z);
    }
    if (front[3] + back[3] <= 0) return;
    const float left = 1 - rgba[3], open = 1 - front[3];
    for (int c = 0; c < 4; c++) rgba[c] = front[c] + open * rgba[c] + (left > 0 ? left * back[c] : 0);
    const float covered = solids->coverage[pixel];
    if (covered < 1) solids->coverage[pixel] = covered + (1 - covered) * (front[3] + back[3]);
    if (!(nearest < surface)) return;
    solids->depth[pixel] = nearest;
    const float size = sqrtf(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    for (int c = 0; c < 3; c++) {
        float world = 0;
        for (int k = 0; k < 3; k++) world += solids->view->turn[k][c] * sum[k];
        solids->normal[3 * pixel + (size_t)c] = size > 0 ? world / size : 0;
    }
}

void ewa_gaussian_solids_draw(const ewa_gaussian_solids *solids, ewa_gaussian_tile *tile, ewa_solid_samples *samples) {
    for (size_t i = 0; i < EWA_SOLID_TILE_SAMPLES; i++) samples->z[i] = INFINITY;
    for (uint32_t i = 0; i < tile->count; i++) {
        const uint32_t id = tile->ids[i];
        if (i % LOOK_AFTER == 0 && i) {
            float farthest = -INFINITY;
            for (uint32_t row = 0; row < 2 * tile->height_px; row++)
                for (uint32_t column = 0; column < 2 * tile->width_px; column++)
                    farthest = fmaxf(farthest, samples->z[(size_t)row * SIDE + column]);
            if (tile->records[id][RECORD_ORDER] > farthest) break;
        }
        draw_splat(solids, tile, id, samples);
        tile->block_count++;
    }
    for (uint32_t row = 0; row < tile->height_px; row++)
        for (uint32_t column = 0; column < tile->width_px; column++) resolve(solids, tile, column, row, samples);
}
