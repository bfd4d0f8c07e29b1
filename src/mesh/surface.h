// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What is smooth and what is sharp on a triangle mesh. Places are relative to the low corner of its box, so
// that a mesh far from the origin of the world is worked on in the same numbers as the same mesh at it.
#ifndef EWA_SRC_MESH_SURFACE_H
#define EWA_SRC_MESH_SURFACE_H

#include "ewa/mesh.h"
#include "homogeneous/vec.h"

/// One side of a sharp edge or of a border: the edge of one triangle.
typedef struct mesh_edge {
    double a[3], b[3]; ///< relative to the surface's origin
    double inward[3];  ///< unit, in the triangle's plane, perpendicular to the edge
    /// Height of the triangle over the edge and where its foot is, 0 at a and 1 at b.
    double height_world, foot;
    uint32_t triangle;       ///< of the surface
    bool corner_a, corner_b; ///< the edge of this smooth part ends or turns there
} mesh_edge;

/// The triangles that have an area, and their edges that stay sharp.
typedef struct mesh_surface {
    ewa_context *context;
    const ewa_mesh *mesh;
    uint32_t triangle_count;
    uint32_t *source;         ///< triangle of the mesh
    double *area_below;       ///< triangle_count + 1 sums of areas
    float (*normal)[3];       ///< unit, of the triangles
    uint32_t *part;           ///< the smooth part that the triangle belongs to
    uint32_t *corner_group;   ///< 3 per triangle: index into group_normal
    float (*group_normal)[3]; ///< unit; of the triangles around a vertex that meet without a sharp edge
    double crease_cosine;     ///< of the angle from which on edges are sharp
    mesh_edge *edges;
    uint32_t edge_count;
    double origin_world[3], extent_world[3]; ///< box of the triangles: its low corner, its edges
} mesh_surface;

/// Where a vertex of the mesh is, relative to the surface's origin.
static inline ewa_vec3 ewa_mesh_place(const mesh_surface *surface, uint32_t vertex) {
    return vec3_sub(vec3_load(surface->mesh->positions + 3 * (size_t)vertex),
                    vec3_load(surface->origin_world));
}

/// Finds the smooth parts. `spacing_world` is the sampling's, 0 < it: what is smaller than its area becomes
/// part of a neighbour; when it is not known yet, `point_count` gives it. Without `sharp` there are no edges.
/// Errors: EWA_ERROR_ARGUMENT (a triangle with a vertex beyond the last), EWA_ERROR_NUMERIC (no area),
/// EWA_ERROR_MEMORY; `*surface` is then zeroed.
ewa_status ewa_mesh_surface_make(const ewa_mesh *mesh, const ewa_mesh_sample_options *options,
                                 mesh_surface *surface);
void ewa_mesh_surface_free(mesh_surface *surface);

#endif
