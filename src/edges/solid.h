// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A closed surface of surfels as a solid: a tree over its surfels, and the surface near any place as one or
// two planes.
#ifndef EWA_SRC_EDGES_SOLID_H
#define EWA_SRC_EDGES_SOLID_H

#include "ewa/prepare.h"
#include "homogeneous/vec.h"

enum {
    EWA_SOLID_ARITY = 8,      ///< surfels of a leaf, nodes under a node
    EWA_SOLID_MAX_LEVELS = 12 ///< 8^11 leaves
};

/// A surfel of a solid; positions relative to the solid's origin, axes one standard deviation long.
typedef struct ewa_solid_surfel {
    ewa_vec3 center, normal, axis[2];
    double reach;   ///< length of the longer axis times the cutoff
    uint32_t point; ///< of the cloud
} ewa_solid_surfel;

/// The box of a node's centres and the longest reach of its surfels.
typedef struct ewa_solid_node {
    ewa_vec3 low, high;
    double reach;
} ewa_solid_node;

/// The surfels of a cloud in the order of a tree: node n of a level has the nodes 8 n to 8 n + 7 of the level
/// below, leaves the surfels.
typedef struct ewa_solid {
    ewa_context *context;
    const ewa_cloud *cloud;
    uint32_t capacity, count; ///< of the cloud's points, of the surfels among them
    ewa_solid_surfel *surfels;
    uint32_t level_count;
    uint32_t level_first[EWA_SOLID_MAX_LEVELS], level_nodes[EWA_SOLID_MAX_LEVELS];
    ewa_solid_node *nodes;
    size_t node_count;
} ewa_solid;

/// Reads a cloud with normals and radii, or axes; surfels that cannot be drawn are left out. `origin_world`
/// is the place that the surfels' positions are relative to. Free with ewa_solid_close(), also after a
/// failure. Errors: EWA_ERROR_ARGUMENT (names what is missing, prefixed by `name`), EWA_ERROR_MEMORY.
ewa_status ewa_solid_open(const ewa_cloud *cloud, const char *name, const double origin_world[3],
                          double cutoff, ewa_solid *solid);
void ewa_solid_close(ewa_solid *solid);

/// Reads the clip lines of a surfel; returns how many there are. `either` is set to what clip_mode says.
uint32_t ewa_solid_lines(const ewa_solid *solid, uint32_t surfel, ewa_vec3 lines[2], bool *either);

/// How far the areas of the surfels, as vectors, are from adding up to nothing, as a share of their sum: 0
/// for a closed surface that is sampled evenly, 0.5 for a hemisphere.
double ewa_solid_openness(const ewa_solid *solid);

/// The surface near a place: one plane, or two at an edge. A plane is its unit normal and the signed distance
/// of the place from it.
typedef struct ewa_local_surface {
    uint32_t plane_count;
    ewa_vec3 normal[2];
    double distance[2];
    bool convex;           ///< two planes: inside is behind both of them; else behind either
    double nearest, reach; ///< distance of the nearest centre, reach of its surfel
    double mean_distance;  ///< from the planes of all the nearest surfels; its sign tells the side of a place
                           ///< that is farther away than they are apart, at any kind of corner
} ewa_local_surface;

/// Returns the distance of the nearest centre, and the reach of its surfel; the solid has surfels. Any
/// thread.
double ewa_solid_nearest(const ewa_solid *solid, ewa_vec3 place, double *reach);

/// Looks at the surface near a place; the solid has surfels. Any thread.
void ewa_solid_look(const ewa_solid *solid, ewa_vec3 place, ewa_local_surface *surface);

#endif
