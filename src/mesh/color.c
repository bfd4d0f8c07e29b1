// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours of places on a mesh but for its pictures, and where places are on those.
#include "mesh/color.h"
#include "base/base.h"
#include "homogeneous/vec.h"
#include "image/srgb.h"

#include <string.h>

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
    for (uint32_t m = 0; m < mesh->material_count; m++) {
        const ewa_mesh_material *material = &mesh->materials[m];
        if (material->texture >= mesh->material_count)
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "sample: material %u has texture %u, there are %u",
                            m, material->texture, mesh->material_count);
        opaque = opaque && material->base_color[3] >= 1;
        colors->has_pictures =
            colors->has_pictures || (mesh->texcoords && mesh->textures[material->texture].pixels);
    }
    colors->component_count = opaque ? 3 : 4;
    return EWA_OK;
}

void ewa_mesh_color_at(const mesh_colors *colors, uint32_t triangle, const double weight[3], float color[4]) {
    const ewa_mesh *mesh = colors->mesh;
    const uint32_t *vertex = mesh->triangles + 3 * (size_t)triangle;
    for (int c = 0; c < 4; c++) {
        double sum = mesh->colors ? 0 : 1;
        for (int k = 0; mesh->colors && k < 3; k++)
            sum += weight[k] * (double)mesh->colors[4 * (size_t)vertex[k] + (size_t)c];
        color[c] = (float)sum;
        if (mesh->material_count)
            color[c] *= mesh->materials[mesh->triangle_materials[triangle]].base_color[c];
    }
}

void ewa_mesh_color_encode(const mesh_colors *colors, const float color[4], uint8_t *code) {
    for (int c = 0; c < 3; c++) code[c] = ewa_srgb8_from_linear(color[c]);
    if (colors->component_count == 4)
        code[3] = color[3] > 0 ? (uint8_t)(255 * (color[3] < 1 ? color[3] : 1) + 0.5f) : 0;
}

void ewa_mesh_chart_at(const ewa_mesh *mesh, uint32_t triangle, const double weight[3], float texcoord[2],
                       float gradient_s[3], float gradient_t[3]) {
    const uint32_t *vertex = mesh->triangles + 3 * (size_t)triangle;
    ewa_vec3 p[3];
    double at[2] = {0, 0};
    const float *uv[3];
    for (int k = 0; k < 3; k++) {
        p[k] = vec3_load(mesh->positions + 3 * (size_t)vertex[k]);
        uv[k] = mesh->texcoords + 2 * (size_t)vertex[k];
        for (int c = 0; c < 2; c++) at[c] += weight[k] * (double)uv[k][c];
    }
    // Of the barycentric coordinates of the second and the third vertex.
    const ewa_vec3 e1 = vec3_sub(p[1], p[0]), e2 = vec3_sub(p[2], p[0]), n = vec3_cross(e1, e2);
    const double scale = 1 / vec3_dot(n, n);
    const ewa_vec3 by1 = vec3_scale(vec3_cross(e2, n), scale), by2 = vec3_scale(vec3_cross(n, e1), scale);
    float *gradient[2] = {gradient_s, gradient_t};
    for (int c = 0; c < 2; c++) {
        const ewa_vec3 g = vec3_add(vec3_scale(by1, (double)uv[1][c] - (double)uv[0][c]),
                                    vec3_scale(by2, (double)uv[2][c] - (double)uv[0][c]));
        texcoord[c] = (float)at[c];
        gradient[c][0] = (float)g.x, gradient[c][1] = (float)g.y, gradient[c][2] = (float)g.z;
    }
}
