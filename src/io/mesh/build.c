// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Filling a mesh piece by piece: lists that grow within the limits, faces that are checked.
#include "io/mesh/build.h"
#include "base/base.h"

enum { FIRST_ITEMS = 64 };

/// Tests of a corner against an ear that any file may cost, about a second; polygon.c grants more by
/// corner.
#define FREE_CUT_TESTS ((uint64_t)1 << 26)

void ewa_mesh_build_open(const ewa_mesh_source *source, ewa_mesh_build *build) {
    *build = (ewa_mesh_build){.source = source, .context = source->context, .look = EWA_MESH_NONE, .cell = EWA_MESH_NONE};
    build->positions.item_bytes = 3 * sizeof(double);
    build->colors.item_bytes = build->face_colors.item_bytes = build->cell_colors.item_bytes = 4 * sizeof(float);
    build->texcoords.item_bytes = 2 * sizeof(float);
    build->normals.item_bytes = 3 * sizeof(float);
    build->corners.item_bytes = build->texcoord_corners.item_bytes = build->normal_corners.item_bytes =
        3 * sizeof(uint32_t);
    build->face_looks.item_bytes = build->face_cells.item_bytes = sizeof(uint32_t);
    build->segments.item_bytes = 2 * sizeof(uint32_t);
    build->looks.item_bytes = sizeof(ewa_mesh_look);
    build->pictures.item_bytes = sizeof(ewa_mesh_picture);
    build->arrays.item_bytes = sizeof(ewa_mesh_array);
    build->scratch.item_bytes = 1;
    build->cut_tests_left = FREE_CUT_TESTS;
}

void ewa_mesh_build_close(ewa_mesh_build *build) {
    ewa_context *context = build->context;
    ewa_mesh_picture *pictures = build->pictures.items;
    for (uint64_t i = 0; i < build->pictures.count; i++) {
        ewa_release(context, pictures[i].name, pictures[i].name_bytes, 1);
        ewa_image_free(&pictures[i].image);
    }
    ewa_mesh_array *arrays = build->arrays.items;
    for (uint64_t i = 0; i < build->arrays.count; i++)
        ewa_release(context, arrays[i].values.items, arrays[i].values.capacity, arrays[i].values.item_bytes);
    ewa_mesh_list *const lists[] = {&build->positions,      &build->colors,      &build->texcoords,
                                    &build->normals,        &build->corners,     &build->texcoord_corners,
                                    &build->normal_corners, &build->face_colors, &build->face_looks,
                                    &build->looks,          &build->pictures,    &build->scratch,
                                    &build->segments,       &build->arrays,      &build->face_cells,
                                    &build->cell_colors};
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++)
        ewa_release(context, lists[i]->items, lists[i]->capacity, lists[i]->item_bytes);
    *build = (ewa_mesh_build){0};
}

ewa_status ewa_mesh_list_grow(ewa_mesh_build *build, ewa_mesh_list *list, uint64_t more) {
    const uint64_t wanted = list->count + more;
    if (wanted <= list->capacity) return EWA_OK;
    uint64_t capacity = list->capacity ? 2 * list->capacity : FIRST_ITEMS;
    if (capacity < wanted) capacity = wanted;
    // All numbers of items are of 32 bits, and one is none.
    if (wanted >= EWA_MESH_NONE)
        return ewa_fail(build->context, EWA_ERROR_LIMIT, "%s: the mesh has over %u vertices or corners", build->source->name,
                        EWA_MESH_NONE - 1);
    EWA_TRY(ewa_memory_check(build->context, capacity * list->item_bytes, "%s: the mesh", build->source->name));
    void *items = ewa_allocate(build->context, capacity, list->item_bytes);
    if (!items) return EWA_ERROR_MEMORY;
    if (list->count) memcpy(items, list->items, list->count * list->item_bytes);
    ewa_release(build->context, list->items, list->capacity, list->item_bytes);
    list->items = items;
    list->capacity = capacity;
    return EWA_OK;
}

/// Makes a list as long as `count`, with copies of an item.
static ewa_status fill_up(ewa_mesh_build *build, ewa_mesh_list *list, uint64_t count, const void *item) {
    if (list->count >= count) return EWA_OK;
    EWA_TRY(ewa_mesh_list_grow(build, list, count - list->count));
    for (; list->count < count; list->count++)
        memcpy((uint8_t *)list->items + list->count * list->item_bytes, item, list->item_bytes);
    return EWA_OK;
}

ewa_status ewa_mesh_add_position(ewa_mesh_build *build, const double position[3]) {
    ewa_status status = EWA_OK;
    const uint64_t limit = ewa_context_limits(build->context)->max_points;
    if (build->positions.count >= limit)
        return ewa_fail(build->context, EWA_ERROR_LIMIT, "%s: more than %llu vertices (max_points)",
                        build->source->name, (unsigned long long)limit);
    double *to = ewa_mesh_list_add(build, &build->positions, &status);
    if (to) memcpy(to, position, 3 * sizeof *to);
    return status;
}

ewa_status ewa_mesh_add_color(ewa_mesh_build *build, const float missing[4], const float color[4]) {
    ewa_status status = fill_up(build, &build->colors, build->positions.count - 1, missing);
    float *to = status == EWA_OK ? ewa_mesh_list_add(build, &build->colors, &status) : NULL;
    if (to) memcpy(to, color, 4 * sizeof *to);
    return status;
}

ewa_status ewa_mesh_add_texcoord(ewa_mesh_build *build, double u, double v) {
    ewa_status status = EWA_OK;
    float *to = ewa_mesh_list_add(build, &build->texcoords, &status);
    if (to) to[0] = (float)u, to[1] = (float)v;
    return status;
}

ewa_status ewa_mesh_add_normal(ewa_mesh_build *build, const double normal[3]) {
    ewa_status status = EWA_OK;
    float *to = ewa_mesh_list_add(build, &build->normals, &status);
    for (int c = 0; to && c < 3; c++) to[c] = (float)normal[c];
    return status;
}

ewa_status ewa_mesh_add_look(ewa_mesh_build *build, uint32_t *look) {
    ewa_status status = EWA_OK;
    if (build->looks.count == EWA_MESH_MAX_LOOKS)
        return ewa_fail(build->context, EWA_ERROR_LIMIT, "%s: more than %d materials", build->source->name,
                        EWA_MESH_MAX_LOOKS);
    ewa_mesh_look *to = ewa_mesh_list_add(build, &build->looks, &status);
    if (!to) return status;
    *to = (ewa_mesh_look){.base_color = {1, 1, 1, 1}, .picture = EWA_MESH_NONE};
    *look = (uint32_t)(build->looks.count - 1);
    return EWA_OK;
}

/// Adds the three numbers of a triangle's corners to a list that begins with the first of them.
static ewa_status add_corners(ewa_mesh_build *build, ewa_mesh_list *list, uint32_t a, uint32_t b,
                              uint32_t c) {
    static const uint32_t none[3] = {EWA_MESH_NONE, EWA_MESH_NONE, EWA_MESH_NONE};
    if (a == EWA_MESH_NONE && b == EWA_MESH_NONE && c == EWA_MESH_NONE) return EWA_OK;
    ewa_status status = fill_up(build, list, build->corners.count - 1, none);
    uint32_t *to = status == EWA_OK ? ewa_mesh_list_add(build, list, &status) : NULL;
    if (to) to[0] = a, to[1] = b, to[2] = c;
    return status;
}

ewa_status ewa_mesh_add_triangle(ewa_mesh_build *build, const ewa_mesh_corner *a, const ewa_mesh_corner *b,
                                 const ewa_mesh_corner *c) {
    static const float white[4] = {1, 1, 1, 1};
    static const uint32_t none = EWA_MESH_NONE;
    const uint64_t limit = ewa_context_limits(build->context)->max_points;
    if (build->corners.count >= limit)
        return ewa_fail(build->context, EWA_ERROR_LIMIT, "%s: more than %llu triangles (max_points)",
                        build->source->name, (unsigned long long)limit);
    ewa_status status = EWA_OK;
    uint32_t *to = ewa_mesh_list_add(build, &build->corners, &status);
    if (!to) return status;
    to[0] = a->position, to[1] = b->position, to[2] = c->position;
    const uint64_t before = build->corners.count - 1;
    EWA_TRY(add_corners(build, &build->texcoord_corners, a->texcoord, b->texcoord, c->texcoord));
    EWA_TRY(add_corners(build, &build->normal_corners, a->normal, b->normal, c->normal));
    if (build->look != EWA_MESH_NONE) {
        status = fill_up(build, &build->face_looks, before, &none);
        uint32_t *look = status == EWA_OK ? ewa_mesh_list_add(build, &build->face_looks, &status) : NULL;
        if (look) *look = build->look;
    }
    if (status == EWA_OK && build->has_face_color) {
        status = fill_up(build, &build->face_colors, before, white);
        float *color = status == EWA_OK ? ewa_mesh_list_add(build, &build->face_colors, &status) : NULL;
        if (color) memcpy(color, build->face_color, sizeof build->face_color);
    }
    if (status == EWA_OK && build->cell != EWA_MESH_NONE) {
        status = fill_up(build, &build->face_cells, before, &none);
        uint32_t *cell = status == EWA_OK ? ewa_mesh_list_add(build, &build->face_cells, &status) : NULL;
        if (cell) *cell = build->cell;
    }
    return status;
}

ewa_status ewa_mesh_add_cell_color(ewa_mesh_build *build, const float color[4]) {
    ewa_status status = EWA_OK;
    float *to = ewa_mesh_list_add(build, &build->cell_colors, &status);
    if (to) memcpy(to, color, 4 * sizeof *color);
    build->has_cell_data = true;
    return status;
}

void ewa_mesh_begin_cell(ewa_mesh_build *build, uint64_t cell) {
    build->cell = cell < EWA_MESH_NONE ? (uint32_t)cell : EWA_MESH_NONE;
    build->has_face_color = cell < build->cell_colors.count;
    if (build->has_face_color) memcpy(build->face_color, (const float *)build->cell_colors.items + 4 * cell, sizeof build->face_color);
}
