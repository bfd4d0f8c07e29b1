// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours of places on a mesh but for its pictures, and where places are on those.
#ifndef EWA_SRC_MESH_COLOR_H
#define EWA_SRC_MESH_COLOR_H

#include "ewa/mesh.h"

typedef struct mesh_colors {
    const ewa_mesh *mesh;
    bool has_pictures;
    uint32_t component_count; ///< 0: the mesh has no colours; 3, or 4 when something but a picture is not
                              ///< opaque
} mesh_colors;

/// Errors: EWA_ERROR_ARGUMENT (a material or a texture beyond the last).
ewa_status ewa_mesh_colors_make(const ewa_mesh *mesh, mesh_colors *colors);

/// Vertex colour times base colour at a place of a triangle of the mesh, `weight` of its three vertices:
/// linear, straight alpha. Any thread.
void ewa_mesh_color_at(const mesh_colors *colors, uint32_t triangle, const double weight[3], float color[4]);

/// The same in component_count bytes, sRGB.
void ewa_mesh_color_encode(const mesh_colors *colors, const float color[4], uint8_t *code);

/// Texture coordinates of such a place, and their gradients within the triangle, per world unit.
void ewa_mesh_chart_at(const ewa_mesh *mesh, uint32_t triangle, const double weight[3], float texcoord[2],
                       float gradient_s[3], float gradient_t[3]);

#endif
