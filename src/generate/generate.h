// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Test objects, inner side: a block of cells that an object turns into points. All of it is plain IEEE
// arithmetic (no libm call but sqrt), so that the bytes are the same on every machine.
#ifndef EWA_SRC_GENERATE_GENERATE_H
#define EWA_SRC_GENERATE_GENERATE_H

#include "ewa/prepare.h"

#include <math.h>

enum { EWA_GENERATE_BLOCK = 64, EWA_TERRAIN_MAX_OCTAVES = 11, EWA_TOWN_PATCHES = 3602 };

/// Major and minor radius of the torus whose outer radius is 1.
#define EWA_TORUS_MAJOR (5.0 / 7.0)
#define EWA_TORUS_MINOR (2.0 / 7.0)

/// Cells of one row of one patch, and the points that the object puts there. Lengths are in units of
/// size_world.
typedef struct ewa_generate_block {
    uint32_t count;
    uint32_t patch;                  ///< cube: face 0 to 5 (-x +x -y +y -z +z); town: of its patches; else 0
    double u[EWA_GENERATE_BLOCK];    ///< in: place along the row, [0, 1]
    double v[EWA_GENERATE_BLOCK];    ///< in: place across the rows, [0, 1]; areas on the surface are equal in
                                     ///< (u, v)
    float grain[EWA_GENERATE_BLOCK]; ///< in: independent uniform numbers, [-1, 1)
    double spacing;                  ///< in: square root of a cell's share of the area
    double position[EWA_GENERATE_BLOCK][3];
    double normal[EWA_GENERATE_BLOCK][3]; ///< out: unit
    float color[EWA_GENERATE_BLOCK][3];   ///< out: sRGB, 0 to 255
    double radius[EWA_GENERATE_BLOCK];    ///< out: local spacing
    double curvature[EWA_GENERATE_BLOCK]; ///< out, of what bends: "signed_curvature"
} ewa_generate_block;

/// One octave of the terrain's noise: lattice coordinates (xx x + xy y + x0, yx x + yy y + y0) of (x, y) in
/// [0, 1]^2.
typedef struct ewa_terrain_octave {
    float xx, xy, x0, yx, yy, y0;
    uint32_t key;
} ewa_terrain_octave;

typedef struct ewa_terrain {
    uint32_t octave_count;
    ewa_terrain_octave octaves[EWA_TERRAIN_MAX_OCTAVES];
} ewa_terrain;

/// Heights (units of size_world, may be under water: < 0) with their derivatives by x and y, and a texture
/// number of about [-1, 1], at `count` <= EWA_GENERATE_BLOCK places in [0, 1]^2.
typedef struct ewa_terrain_heights {
    float height[EWA_GENERATE_BLOCK], by_x[EWA_GENERATE_BLOCK], by_y[EWA_GENERATE_BLOCK];
    float texture[EWA_GENERATE_BLOCK];
} ewa_terrain_heights;

/// Chooses the octaves: none is finer than two samples of a grid of `point_count` points.
void ewa_terrain_init(ewa_terrain *terrain, uint64_t seed, uint64_t point_count);
void ewa_terrain_evaluate(const ewa_terrain *terrain, uint32_t count, const double *x, const double *y,
                          ewa_terrain_heights *heights);

typedef enum ewa_town_kind {
    EWA_TOWN_GROUND,
    EWA_TOWN_WALL,
    EWA_TOWN_ROOF,
    EWA_TOWN_CROWN,   ///< leaves in the outer half of an ellipsoid
    EWA_TOWN_TRUNK,   ///< a cylinder
    EWA_TOWN_SCATTER, ///< points a little above the ground
} ewa_town_kind;

/// A part of the town that is sampled evenly. Lengths are in units of size_world.
typedef struct ewa_town_patch {
    ewa_town_kind kind;
    uint32_t thing;   ///< which box or tree it belongs to
    double corner[3]; ///< of a rectangle at u = v = 0; middle of a crown; foot of a trunk
    double along[3];  ///< of a rectangle from u = 0 to 1; of a crown its half axes; of a trunk its radii and its height
    double across[3]; ///< of a rectangle from v = 0 to 1
    double normal[3]; ///< of a rectangle
    double area;
    double height; ///< across its rows
} ewa_town_patch;

/// Lays out the EWA_TOWN_PATCHES patches of a town; returns their area.
double ewa_town_make(uint64_t seed, ewa_town_patch *patches);

void ewa_generate_plane(ewa_generate_block *block);
void ewa_generate_checker(ewa_generate_block *block, double checks);
void ewa_generate_cube(ewa_generate_block *block, double checks);
void ewa_generate_sphere(ewa_generate_block *block);
void ewa_generate_torus(ewa_generate_block *block);
void ewa_generate_terrain(const ewa_terrain *terrain, ewa_generate_block *block);
void ewa_generate_town(const ewa_town_patch *patches, ewa_generate_block *block);

/// Adds "texcoord", "texcoord_s" and "texcoord_t" to a finished object that has normals.
ewa_status ewa_generate_charts(const ewa_generate_options *options, ewa_cloud *cloud);

#endif
