// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What both programs of splats see of a source; src/gl/raster.h is the same in C. Pixels are those of the band.

layout(std140) uniform ViewBlock {
    vec4 rotation[3]; // rows of camera from world
    vec4 focal;       // fx_px, fy_px, and 1 over them
    vec4 zoomed;      // fx, fy over zoom; zoom; scale of lengths
    vec4 kernel;      // F, F^2, h^2, reach_px
    vec4 depth;       // tolerance, grazing, broad, slack of keys
    vec4 point;       // x, y, major, minor axis of points
    vec4 sums;        // units per weight, per colour; sigma of points; 1 / zoom
    vec4 place;       // size of the band, principal point, in pixels
    vec4 contour;     // c, S; the bend of a curvature of 1
    vec4 sections[8]; // planes, in camera space
    uvec4 flags;      // ORTHOGRAPHIC, ...; how many planes
};

const uint ORTHOGRAPHIC = 1u, CULL_BACK = 2u, ELLIPSES = 4u, AFFINE = 8u, SOURCE = 16u, CIRCULAR = 32u,
           RAYCAST = 64u, POINTS = 128u, TRANSLUCENT = 512u, SEE_THROUGH = 1024u;

bool has(uint flag) { return (flags.x & flag) != 0u; }

const int MAX_LINES = 4;

uniform int behind; // only what lies beyond the surfaces before counts
