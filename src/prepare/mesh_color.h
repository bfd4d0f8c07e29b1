// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours of places on a mesh: vertex colours, materials, textures.
#ifndef EWA_SRC_PREPARE_MESH_COLOR_H
#define EWA_SRC_PREPARE_MESH_COLOR_H

#include "ewa/mesh.h"

enum { MESH_TEXTURE_LEVELS = 17 };

/// A texture with its smaller copies; level 0 is the mesh's own.
typedef struct mesh_texture {
    ewa_image levels[MESH_TEXTURE_LEVELS];
    uint32_t level_count; ///< 0: no texture
} mesh_texture;

typedef struct mesh_colors {
    const ewa_mesh *mesh;
    mesh_texture *textures;   ///< by material
    uint32_t component_count; ///< 0: the mesh has no colours; 3, or 4 when something is not opaque
} mesh_colors;

/// Makes the smaller copies of all textures. Errors: EWA_ERROR_ARGUMENT (channels, a material beyond the
/// last), EWA_ERROR_MEMORY.
ewa_status ewa_mesh_colors_make(const ewa_mesh *mesh, mesh_colors *colors);
void ewa_mesh_colors_free(mesh_colors *colors);

/// Colour of a place of a triangle of the mesh: `weight` of its three vertices; textures are averaged over
/// about `width_world`. `color` gets component_count bytes, sRGB. Any thread.
void ewa_mesh_color_at(const mesh_colors *colors, uint32_t triangle, const double weight[3],
                       double area_world, double width_world, uint8_t color[4]);

#endif
