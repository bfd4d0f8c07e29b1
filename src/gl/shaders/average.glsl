// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Averages of the parts of pixels, in the order of src/surface/supersampling.c: of colours and coverages the mean, of depths the
// nearest, of normals the sum. A pixel by each invocation. After wide.glsl and band.glsl.

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 14) buffer ResultBlock { uint result[]; };
layout(location = 0) uniform uint finer;      // parts along each side, a power of two
layout(location = 1) uniform ivec4 means_at;  // in `result`, of colours, depths, normals, coverages; or -1

float part(int plane_at, uint words, uvec2 at, uint word) {
    return uintBitsToFloat(result[uint(plane_at) + (at.y * picture_px.x + at.x) * words + word]);
}

float sum_parts(int plane_at, uint words, uvec2 first, uint word) {
    float sum = 0.0;
    for (uint j = 0u; j < finer; j++)
        for (uint i = 0u; i < finer; i++) sum = wf_add(sum, part(plane_at, words, first + uvec2(i, j), word));
    return sum;
}

void main() {
    uvec2 size = uvec2(picture_px.x, picture_px.y - first_px.y) / finer;
    uint columns = (size.x + 7u) / 8u, group = group_number();
    uvec2 here = uvec2(group % columns, group / columns) * 8u + gl_LocalInvocationID.xy, first = here * finer;
    if (any(greaterThanEqual(here, size))) return;
    uint pixel = here.y * size.x + here.x;
    float share = wf_div(1.0, float(finer * finer));
    if (means_at.x >= 0)
        for (uint c = 0u; c < 4u; c++)
            result[uint(means_at.x) + pixel * 4u + c] = floatBitsToUint(wf_mul(sum_parts(rgba_at, 4u, first, c), share));
    if (means_at.y >= 0) {
        float nearest = INF;
        for (uint j = 0u; j < finer; j++)
            for (uint i = 0u; i < finer; i++) nearest = wf_min(part(depth_at, 1u, first + uvec2(i, j), 0u), nearest);
        result[uint(means_at.y) + pixel] = floatBitsToUint(nearest);
    }
    if (means_at.z >= 0)
        for (uint c = 0u; c < 3u; c++)
            result[uint(means_at.z) + pixel * 3u + c] = floatBitsToUint(sum_parts(normal_at, 3u, first, c));
    if (means_at.w >= 0)
        result[uint(means_at.w) + pixel] = floatBitsToUint(wf_mul(sum_parts(coverage_at, 1u, first, 0u), share));
}
