// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What programs of Gaussians see of a frame (src/gl/gaussian_frame.h is the same in C), what they count, and records of what is
// visible. After wide.glsl and scan.glsl.

layout(std140, binding = 0) uniform FrameBlock {
    uvec2 picture_px;
    uint tiles_per_row, tile_count;
    uint visible_capacity, pair_capacity, orthographic, trained; // `trained`: by the affine map
    uint keep, expected, normals, with_codes;
    int rgba_at, depth_at, coverage_at; // in `result`, or -1
    float minimum_alpha;
    float minimum_transmittance, near_depth;
    uint block_count, pad; // blocks of `visible_capacity` items
    vec4 background; // linear, premultiplied
    uint with_surface, with_coverage, section_count, sections_pad; // `with_coverage`: the surfaces have a plane of it
    double unit_camera, unit_pad;
    dvec4 lens;        // of sections: fx, fy, cx, cy, px
    dvec4 sections[MAX_SECTIONS]; // planes in camera space
};

// 0 when a frame begins but for `slot_count`.
layout(std430, binding = 8) buffer CountBlock {
    uint slot_count;    // splats of all packets
    uint visible_count, pair_count, near_count;
    uint stopped_count; // invocations that the driver has ended
    uint counts_pad[3];
};

// A record: RECORD_PARTS vectors. X, Y, AX, AY; BY, LIMIT, LOG2_ALPHA, REACH; TOUCH, red, green, blue. With depths or rays: nine of G,
// LENGTH, LOW, HIGH. With 2D Gaussians: DOT and its place (src/volume/gaussian_kernels.h).
#if DOTS
#define RECORD_PARTS 7u
#elif DEEP
#define RECORD_PARTS 6u
#else
#define RECORD_PARTS 3u
#endif
