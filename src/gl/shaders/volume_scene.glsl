// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What all programs see of a frame of a volume (src/gl/volume_frame.h is the same in C), and the light that voxels let through:
// src/volume/kernels_points.h and kernels_over.h. After wide.glsl.

struct VolumeLight {
    float toward[3], color[3];
    uint headlight;
};

layout(std430, binding = 0) readonly buffer ViewBlock {
    uint orthographic, lit, highlights, with_depth, has_near, mark_splats, with_sections;
    int point_slice;               // units from there on are of points
    uint longest_span;             // units of a block, at most
    uint group_limit;              // groups of a dispatch along x
    float fx_px, fy_px, cx_px, cy_px, focal_px;
    float axes[9], to_deviations[9];
    float unit_inverse, unit_offset, color_scale;
    float marked_color[3];
    float point_mass, splat_peak, density, bend;
    float covariance[6], inverse_covariance[6];
    float cutoff, cutoff2, prefilter2_px2, reach, splat_margin_px, minimum_transmittance, depth_deviation;
    float to_world[9], toward_viewer[3];
    float ambient, diffuse, specular, shininess, flat_share;
    uint light_count;
    VolumeLight lights[MAX_LIGHTS];
    float background[4];           // premultiplied
    uint unit_camera[2];           // the words of a double
    uint picture_px[2];
    int rgba8_at, rgba_at, depth_at, coverage_at; // in `result`, or -1
    uint record_words;             // of a voxel of a tile
    uint bounds_at;                // in `units`
    uint turns;                    // of loops, after which a part of the picture waits for the next dispatch
};

// A block of voxels in a tile. Its records are in the order of units, and in each of the voxels.
struct Pair {
    float origin[3];               // its first place in camera space
    int slice_first, slice_last;
    uint first_voxel, count;
    uint first_record, first_run;
    uint tile;
    uint box;                      // pixels of the tile that it may touch, both within: left, top, right, bottom, a byte each
};

// A tile of 64x64 pixels; its blocks by their first units. `buckets`: where units of splats begin in the sorted list.
struct Tile {
    int x_px, y_px, width_px, height_px;
    uint first_pair, end_pair, first_record, first_bucket;
    int first_unit, last_unit;
    uint first_near, end_near;
};

layout(std430, binding = 1) readonly buffer PairBlock { Pair pairs[]; };
layout(std430, binding = 2) readonly buffer TileBlock { Tile tiles[]; };

// How many records there are of splats, and of points; parts of the picture that were not finished.
layout(std430, binding = 10) buffer CountBlock { uint splat_count, point_count, broken_count; };

uint group_number() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

float row_dot(float a, float b, float c, vec3 v) { return wf_fma(a, v.x, wf_fma(b, v.y, wf_mul(c, v.z))); }

// The first of a tile's blocks that may have voxels in a unit, and the end of those.
uint first_pair_at(Tile tile, int first_unit) {
    uint low = tile.first_pair, high = tile.end_pair;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (pairs[middle].slice_first < first_unit) low = middle + 1u;
        else high = middle;
    }
    return low;
}

// 1 - exp(-t).
float absorbed(float t) {
    float bits = wf_min(wf_mul(t, 1.44269504), 100.0);
    float whole = floor(wf_add(bits, 0.5)), f = wf_sub(whole, bits), f2 = wf_mul(f, f);
    float low = wf_fma(f, 2.40226507e-1, 6.93147181e-1);
    float middle = wf_fma(f, 9.61812911e-3, 5.55041087e-2);
    float high = wf_fma(f, 1.54035304e-4, 1.33335581e-3);
    float change = wf_mul(f, wf_fma(f2, wf_fma(f2, high, middle), low));
    float scale = wf_of_bits((127 - int(whole)) << 23);
    return wf_fnma(scale, change, wf_sub(1.0, scale));
}
