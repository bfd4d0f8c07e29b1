// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sums of a pixel, surfaces that are made of them, and what a frame does with these. Sums and keys are as they began when a band
// ends: whoever reads them sets them back.

#if WITH_FINE || WITH_DEPTH || WITH_CLIPS
const uint WORDS = 4u;
#else
const uint WORDS = 2u;
#endif

layout(std430, binding = 4) buffer SumBlock { uint sums[]; };       // [channel][word][pixel]
layout(std430, binding = 8) buffer TurnedBlock { uint is_back[]; }; // the same of what faces away
layout(std430, binding = 11) buffer CutBlock { uint cut[]; };       // [channel][word][pixel], then a flag for each block

struct Light { uint headlight; float toward[3], color[3]; };
struct Level { uint width, height, first, pad; };

layout(std430, binding = 12) readonly buffer ResolveBlock {
    float unit_coverage_inverse, alpha_scale, covering, front_scale;
    float color_unit, material_units[5];
    float opacity, depth_unit, depth_per_share, texels_per_radian;
    float material[5];
    float environment_from_camera[9];
    float background[4];
    float ray_x[2], ray_y[2];
    float to_world[9];
    uint flags, shading, light_count, level_count;
    Light lights[MAX_LIGHTS];
    Level levels[MAX_LEVELS];
    float materials[MAX_MATERIALS * 5];
} to;

uint pixel = 0u, pixel_count = 0u;
