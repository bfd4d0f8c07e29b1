// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Eye-dome lighting of a picture whose depths and colours are in `result`: src/surface/pipeline_eye_dome.h. A pixel by each
// invocation, which reads the depths around it and changes its own colour alone.

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 14) buffer ResultBlock { uint result[]; };
layout(location = 0) uniform vec4 background; // premultiplied
layout(location = 1) uniform float inverse_height;
layout(location = 2) uniform float exponent;
layout(location = 3) uniform uint orthographic;
layout(location = 4) uniform uint with_bytes; // at the start of `result`

// Sets what is linear on planes in the picture; false: there is nothing.
bool find_key(ivec2 at, out float key) {
    key = 0.0;
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(picture_px)))) return false;
    float z = uintBitsToFloat(result[uint(depth_at) + uint(at.y) * picture_px.x + uint(at.x)]);
    if (!(z < INF)) return false;
    key = orthographic != 0u ? wf_negate(z) : wf_div(1.0, z);
    return true;
}

// The share of light that is left.
float light_at(ivec2 at) {
    float key, sum = 0.0;
    if (!find_key(at, key)) return wf_exp2(wf_mul(sum, exponent));
    float unit = orthographic != 0u ? inverse_height : wf_div(1.0, key);
    for (int r = 1; r <= EYE_DOME_REACH; r *= 2) {
        const ivec2 steps[4] = ivec2[4](ivec2(r, 0), ivec2(0, r), ivec2(r, r), ivec2(-r, r));
        for (int i = 0; i < 4; i++) {
            float one, other;
            if (!find_key(at + steps[i], one) || !find_key(at - steps[i], other)) continue;
            float mean = wf_mul(wf_add(one, other), 0.5);
            sum = wf_add(sum, wf_max(wf_mul(wf_sub(mean, key), unit), 0.0));
        }
    }
    return wf_exp2(wf_mul(sum, exponent));
}

void main() {
    uint columns = (picture_px.x + 7u) / 8u, group = group_number();
    uvec2 here = uvec2(group % columns, group / columns) * 8u + gl_LocalInvocationID.xy;
    if (any(greaterThanEqual(here, picture_px))) return;
    uint at = here.y * picture_px.x + here.x, colors = uint(rgba_at) + at * 4u;
    float light = light_at(ivec2(here)), alpha = uintBitsToFloat(result[colors + 3u]), through = wf_sub(1.0, alpha);
    vec4 shown;
    for (int c = 0; c < 4; c++) {
        float front = c < 3 ? wf_mul(uintBitsToFloat(result[colors + uint(c)]), light) : alpha;
        shown[c] = wf_fma(background[c], through, front);
        result[colors + uint(c)] = floatBitsToUint(shown[c]);
    }
    if (with_bytes != 0u) result[at] = color_code(shown);
}
