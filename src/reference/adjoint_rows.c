// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tiles of a frame, row by row: which splats count at each pixel.
#include "reference/adjoint_rows.h"
#include "base/base.h"

#include <stdlib.h>
#include <string.h>

enum { KEY_NUMBERS = 17 };

ewa_reference_tiles ewa_reference_tiles_of(const ewa_reference_splat *splat, uint32_t side_px) {
    if (!splat->drawn || splat->x_begin >= splat->x_end || splat->y_begin >= splat->y_end)
        return (ewa_reference_tiles){0, 0};
    const uint32_t x0 = (uint32_t)splat->x_begin / side_px, x1 = ((uint32_t)splat->x_end + side_px - 1) / side_px;
    const uint32_t y0 = (uint32_t)splat->y_begin / side_px, y1 = ((uint32_t)splat->y_end + side_px - 1) / side_px;
    return (ewa_reference_tiles){x0 | y0 << 16, x1 | y1 << 16};
}

ewa_status ewa_reference_rows_reserve(ewa_context *context, ewa_reference_rows *rows, uint32_t splats, uint32_t layers,
                                      uint32_t side_px) {
    const size_t count = splats, fragments = count * side_px;
    rows->capacity = splats, rows->layer_capacity = layers < splats ? layers : splats, rows->side_px = side_px;
    rows->splats = ewa_allocate(context, count, sizeof *rows->splats);
    rows->order = ewa_allocate(context, count, sizeof *rows->order);
    rows->fragments = ewa_allocate(context, fragments, sizeof *rows->fragments);
    rows->sorted = ewa_allocate(context, fragments, sizeof *rows->sorted);
    rows->columns = ewa_allocate(context, fragments, sizeof *rows->columns);
    rows->layers = ewa_allocate(context, rows->layer_capacity, sizeof *rows->layers);
    const bool all = rows->splats && rows->order && rows->fragments && rows->sorted && rows->columns && rows->layers;
    return all ? EWA_OK : EWA_ERROR_MEMORY;
}

void ewa_reference_rows_free(ewa_context *context, ewa_reference_rows *rows) {
    const size_t count = rows->capacity, fragments = count * rows->side_px;
    ewa_release(context, rows->splats, count, sizeof *rows->splats);
    ewa_release(context, rows->order, count, sizeof *rows->order);
    ewa_release(context, rows->fragments, fragments, sizeof *rows->fragments);
    ewa_release(context, rows->sorted, fragments, sizeof *rows->sorted);
    ewa_release(context, rows->columns, fragments, sizeof *rows->columns);
    ewa_release(context, rows->layers, rows->layer_capacity, sizeof *rows->layers);
}

/// The numbers that tell two splats apart.
static void read_key(const ewa_reference_splat *splat, double key[KEY_NUMBERS]) {
    const ewa_vec3 vectors[5] = {splat->center, splat->color, splat->normal_world, splat->axis_u, splat->axis_v};
    for (int i = 0; i < 5; i++) vec3_store(vectors[i], key + 3 * i);
    key[15] = splat->moved_px[0], key[16] = splat->moved_px[1];
}

/// Orders splats by depth, and those of one depth by all that they look like: a pixel's sums are added up in that
/// order.
static int compare_splats(const void *a, const void *b) {
    const ewa_reference_splat *left = *(const ewa_reference_splat *const *)a;
    const ewa_reference_splat *right = *(const ewa_reference_splat *const *)b;
    if (left->center.z != right->center.z) return left->center.z < right->center.z ? -1 : 1;
    double keys[2][KEY_NUMBERS];
    read_key(left, keys[0]), read_key(right, keys[1]);
    for (int i = 0; i < KEY_NUMBERS; i++)
        if (keys[0][i] != keys[1][i]) return keys[0][i] < keys[1][i] ? -1 : 1;
    return (left->opacity > right->opacity) - (left->opacity < right->opacity);
}

void ewa_reference_rows_fill(const ewa_reference_frame *frame, ewa_reference_rows *rows, const uint32_t *points,
                             uint32_t count) {
    for (uint32_t k = 0; k < count; k++) {
        ewa_surfel surfel;
        ewa_reference_frame_project(frame, points[k], 1, &surfel, &rows->splats[k]);
        rows->order[k] = &rows->splats[k];
    }
    if (count) qsort(rows->order, count, sizeof *rows->order, compare_splats);
}

void ewa_reference_rows_walk(const ewa_reference_frame *frame, ewa_reference_rows *rows, uint32_t count, uint32_t x,
                             uint32_t width, uint32_t y, ewa_reference_pixel *pixel, void *user) {
    uint32_t counts[EWA_REFERENCE_MAX_TILE_PX + 1] = {0}, found = 0;
    const int32_t left = (int32_t)x, right = left + (int32_t)width;
    for (uint32_t k = 0; k < count; k++) {
        const ewa_reference_splat *splat = rows->order[k];
        if ((int32_t)y < splat->y_begin || (int32_t)y >= splat->y_end) continue;
        const int32_t begin = splat->x_begin > left ? splat->x_begin : left;
        const int32_t end = splat->x_end < right ? splat->x_end : right;
        for (int32_t at = begin; at < end; at++) {
            if (!ewa_reference_fragment_make(frame, splat, (uint64_t)(splat - rows->splats), at + 0.5, y + 0.5,
                                             &rows->fragments[found]))
                continue;
            rows->columns[found++] = (uint8_t)(at - left);
            counts[at - left + 1]++;
        }
    }
    for (uint32_t i = 0; i < width; i++) counts[i + 1] += counts[i];
    uint32_t next[EWA_REFERENCE_MAX_TILE_PX];
    memcpy(next, counts, width * sizeof *next);
    for (uint32_t i = 0; i < found; i++) rows->sorted[next[rows->columns[i]]++] = rows->fragments[i];
    for (uint32_t i = 0; i < width; i++)
        pixel(user, x + i, y, rows->sorted + counts[i], counts[i + 1] - counts[i]);
}
