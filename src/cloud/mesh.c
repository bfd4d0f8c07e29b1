// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Memory of triangle meshes.
#include "ewa/mesh.h"
#include "base/base.h"

#include <string.h>

static void free_stream(ewa_context *context, void *stream, size_t count, size_t size_bytes) {
    if (stream) ewa_release(context, stream, count, size_bytes);
}

ewa_status ewa_mesh_create(ewa_context *context, uint32_t vertex_count, uint32_t triangle_count,
                           uint32_t material_count, uint32_t streams, ewa_mesh *mesh) {
    if (!context || !mesh) return EWA_ERROR_ARGUMENT;
    *mesh = (ewa_mesh){0};
    const bool colors = streams & EWA_MESH_COLORS, texcoords = streams & EWA_MESH_TEXCOORDS,
               normals = streams & EWA_MESH_NORMALS;
    const ewa_limits *limits = ewa_context_limits(context);
    const uint64_t vertex_bytes =
        3 * sizeof(double) +
        sizeof(float) * ((colors ? 4u : 0u) + (texcoords ? 2u : 0u) + (normals ? 3u : 0u));
    const uint64_t triangle_bytes = sizeof(uint32_t) * (material_count ? 4u : 3u);
    const uint64_t bytes = vertex_count * vertex_bytes + triangle_count * triangle_bytes +
                           material_count * (uint64_t)(sizeof(ewa_mesh_material) + sizeof(ewa_image));
    if (vertex_count > limits->max_points || triangle_count > limits->max_points)
        return ewa_fail(context, EWA_ERROR_LIMIT, "mesh: %u vertices and %u triangles, max_points is %llu",
                        vertex_count, triangle_count, (unsigned long long)limits->max_points);
    EWA_TRY(ewa_memory_check(context, bytes, "mesh of %u vertices and %u triangles", vertex_count, triangle_count));
    ewa_mesh made = {.context = context,
                     .vertex_count = vertex_count,
                     .triangle_count = triangle_count,
                     .material_count = material_count};
    made.positions = ewa_allocate_zeroed(context, vertex_count, 3 * sizeof(double));
    made.triangles = ewa_allocate_zeroed(context, triangle_count, 3 * sizeof(uint32_t));
    if (colors) made.colors = ewa_allocate_zeroed(context, vertex_count, 4 * sizeof(float));
    if (texcoords) made.texcoords = ewa_allocate_zeroed(context, vertex_count, 2 * sizeof(float));
    if (normals) made.normals = ewa_allocate_zeroed(context, vertex_count, 3 * sizeof(float));
    if (material_count) {
        made.triangle_materials = ewa_allocate_zeroed(context, triangle_count, sizeof(uint32_t));
        made.materials = ewa_allocate_zeroed(context, material_count, sizeof(ewa_mesh_material));
        made.textures = ewa_allocate_zeroed(context, material_count, sizeof(ewa_image));
        for (uint32_t i = 0; made.materials && i < material_count; i++) made.materials[i].texture = i;
    }
    *mesh = made;
    if (made.positions && made.triangles && (made.colors || !colors) && (made.texcoords || !texcoords) &&
        (made.normals || !normals) &&
        (!material_count || (made.triangle_materials && made.materials && made.textures)))
        return EWA_OK;
    ewa_mesh_free(mesh);
    return EWA_ERROR_MEMORY;
}

/// Frees what says how triangles look, vertex colours included.
static void free_look(ewa_mesh *mesh) {
    ewa_context *context = mesh->context;
    for (uint32_t i = 0; mesh->textures && i < mesh->material_count; i++) ewa_image_free(&mesh->textures[i]);
    free_stream(context, mesh->textures, mesh->material_count, sizeof(ewa_image));
    free_stream(context, mesh->colors, mesh->vertex_count, 4 * sizeof(float));
    free_stream(context, mesh->triangle_materials, mesh->triangle_count, sizeof(uint32_t));
    free_stream(context, mesh->materials, mesh->material_count, sizeof(ewa_mesh_material));
}

ewa_status ewa_mesh_set_picture(ewa_mesh *mesh, ewa_image *picture) {
    if (!mesh || !mesh->context || !picture || !picture->pixels) return EWA_ERROR_ARGUMENT;
    ewa_context *context = mesh->context;
    if (!mesh->texcoords)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "mesh: no texture coordinates to put a picture on");
    uint32_t *triangle_materials = ewa_allocate_zeroed(context, mesh->triangle_count, sizeof(uint32_t));
    ewa_mesh_material *material = ewa_allocate_zeroed(context, 1, sizeof *material);
    ewa_image *texture = ewa_allocate_zeroed(context, 1, sizeof *texture);
    if (!triangle_materials || !material || !texture) {
        free_stream(context, triangle_materials, mesh->triangle_count, sizeof(uint32_t));
        free_stream(context, material, 1, sizeof *material);
        free_stream(context, texture, 1, sizeof *texture);
        return EWA_ERROR_MEMORY;
    }
    free_look(mesh);
    for (int c = 0; c < 4; c++) material->base_color[c] = 1;
    *texture = *picture;
    *picture = (ewa_image){0};
    mesh->textures = texture;
    mesh->colors = NULL;
    mesh->triangle_materials = triangle_materials;
    mesh->materials = material;
    mesh->material_count = 1;
    return EWA_OK;
}

void ewa_mesh_free(ewa_mesh *mesh) {
    if (!mesh || !mesh->context) return;
    ewa_context *context = mesh->context;
    free_look(mesh);
    ewa_cloud_destroy(&mesh->attributes);
    free_stream(context, mesh->positions, mesh->vertex_count, 3 * sizeof(double));
    free_stream(context, mesh->normals, mesh->vertex_count, 3 * sizeof(float));
    free_stream(context, mesh->texcoords, mesh->vertex_count, 2 * sizeof(float));
    free_stream(context, mesh->triangles, mesh->triangle_count, 3 * sizeof(uint32_t));
    *mesh = (ewa_mesh){0};
}
