// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The fragment program: a splat at a pixel (docs/math.md sections 4 to 6). PASS 1 draws the key of z + eps, PASS 2 what it
// adds to the pixel where its own key reaches the largest of those, PASS 3 what it adds to the numbers of
// materials. SINGLE: PASS 2 where the test of depths keeps the nearest splat, and PASS 1 is not drawn.

flat in vec4 shape, key_at, range, extra;
#if PASS != 1
flat in vec4 color, normal;
#endif
#if WITH_CLIPS
flat in vec3 lines[MAX_LINES];
flat in uint line_bits;
#endif

uniform sampler2D passed_map;
#if PASS == 1
layout(location = 0) out float bound;
#else
uniform sampler2D nearest_map;
uniform int whole; // all that is left is one surface
#if SINGLE
uniform float depth_unit; // a power of two: it keeps all digits of a key
#endif
#endif
#if PASS == 2
layout(location = 0) out vec4 color_sum;
layout(location = 1) out vec4 normal_sum;
layout(location = 2) out vec4 cut_sum;
layout(location = 3) out float opacity_sum;
#elif PASS == 3
flat in vec4 material;
flat in float reflection;
layout(location = 0) out vec4 material_sum;
layout(location = 1) out float reflection_sum;
#endif

float exponent, key, gain = 1.0;

#if NEAR
float linear(vec3 terms, vec2 at) { return dot(terms.xy, at) + terms.z; }

bool sample_splat(vec2 at) {
    vec3 ray_u = shape.xyz, ray_v = key_at.xyz, ray_w = extra.xyz, ray_z = vec3(shape.w, key_at.w, extra.w);
    float h2 = kernel.z, inverse_ = 1.0 / linear(ray_w, at);
    vec2 uv = vec2(linear(ray_u, at), linear(ray_v, at)) * inverse_;
    float z = linear(ray_z, at) * inverse_;
    vec2 u_slope = (ray_u.xy - uv.x * ray_w.xy) * inverse_, v_slope = (ray_v.xy - uv.y * ray_w.xy) * inverse_;
    float w11 = 1.0 + h2 * dot(u_slope, u_slope), w22 = 1.0 + h2 * dot(v_slope, v_slope), w12 = h2 * dot(u_slope, v_slope);
    float crossed = h2 * (u_slope.x * v_slope.y - u_slope.y * v_slope.x), det = crossed * crossed + w11 + w22 - 1.0;
    float r2 = (w22 * uv.x * uv.x + w11 * uv.y * uv.y - 2.0 * w12 * uv.x * uv.y) / det;
    exponent = max(r2, 0.0);
    gain = inversesqrt(det);
    float depth_here = clamp(z, range.x, range.y);
    key = has(ORTHOGRAPHIC) ? -depth_here : 1.0 / depth_here;
    return exponent < kernel.y && dot(uv, uv) < 4.0 * kernel.y && (has(ORTHOGRAPHIC) || 0.0 < z);
}
#elif RAYS
bool sample_splat(vec2 at) {
    vec2 d = at - shape.xy;
    float h2 = kernel.z, plane = key_at.y + dot(key_at.zw, d);
    float w = clamp(plane * range.w, extra.y, extra.z), w2 = w * w;
    vec3 v = w2 * vec3(shape.zw, key_at.x) + vec3(h2, 0.0, h2);
    float area = w2 * extra.x, det = area * area + h2 * (w2 * (shape.z + key_at.x) + h2);
    exponent = max((v.z * d.x * d.x + v.x * d.y * d.y - 2.0 * v.y * d.x * d.y) / det, 0.0);
    gain = w2 * inversesqrt(det);
    key = clamp(plane, range.x, range.y);
    return exponent < kernel.y;
}
#else
bool sample_splat(vec2 at) {
    vec2 d = at - shape.xy;
    exponent = shape.z * d.x * d.x + d.y * (shape.w * d.x + key_at.x * d.y);
    key = clamp(key_at.y + dot(key_at.zw, d), range.x, range.y);
    return exponent < kernel.y;
}
#endif

#if WITH_CLIPS
float share = 1.0, first_share = 1.0, line_share[MAX_LINES];

// The area of the pixel's square on the inner side of a line.
float half_plane_share(vec3 line, vec2 at) {
    vec2 size = abs(line.xy);
    float wide = max(size.x, size.y), narrow = min(size.x, size.y);
    float inside = dot(line.xy, at) + line.z;
    if (!(0.0 < wide)) return 0.0 < inside ? 1.0 : 0.0;
    float left = 0.5 * (wide + narrow) - abs(inside), corner = clamp(left, 0.0, narrow);
    float triangle = narrow > 0.0 ? corner * corner / narrow : 0.0;
    float smaller = (2.0 * max(left - narrow, 0.0) + triangle) / (2.0 * wide);
    return 0.0 < inside ? 1.0 - smaller : smaller;
}

bool either() { return (line_bits & 256u) != 0u; }
int line_count() { return int(line_bits & 15u); }

void clip_at(vec2 at) {
    for (int i = 0; i < MAX_LINES; i++) line_share[i] = half_plane_share(lines[i], at);
    first_share = either() ? max(line_share[0], line_share[1]) : min(line_share[0], line_share[1]);
    share = first_share;
    for (int i = 2; i < MAX_LINES; i++) share = min(share, line_share[i]);
}

#if PASS == 2
// Kept and whole weight of what is cut, and the direction in which the lines keep.
vec4 cut_of(float weight) {
    float cut_weight = min((1.0 - share) * PER_CUT, 1.0) * weight;
    if (!(0.0 < cut_weight)) return vec4(0.0);
    vec2 decides = vec2(line_share[0], line_share[1]);
    if (!either()) decides = 1.0 - decides;
    float sum = decides.x + decides.y;
    vec2 inward = decides.x * lines[0].xy + decides.y * lines[1].xy;
    if (line_count() > 2 && either()) {
        float off_first = 1.0 - first_share;
        inward *= off_first / (0.0 < sum ? sum : 1.0);
        sum = off_first;
    }
    for (int i = 2; i < line_count(); i++) {
        float decides_too = 1.0 - line_share[i];
        inward += decides_too * lines[i].xy;
        sum += decides_too;
    }
    return cut_weight * vec4(share, 1.0, inward / (0.0 < sum ? sum : 1.0));
}
#endif
#endif

void main() {
    if (!sample_splat(gl_FragCoord.xy)) discard;
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (behind != 0 && !(key < texelFetch(passed_map, pixel, 0).r)) discard;
#if WITH_CLIPS
    clip_at(gl_FragCoord.xy);
    if (!(0.0 < share)) discard;
#endif
#if PASS == 1
    bound = has(ORTHOGRAPHIC) ? key - range.z : key / (1.0 + range.z * key);
#else
#if SINGLE
    gl_FragDepth = (has(ORTHOGRAPHIC) ? 1.0 : 0.0) + key * depth_unit;
#else
    if (whole == 0) {
        float nearest = texelFetch(nearest_map, pixel, 0).r;
        if (nearest == NEVER || key < nearest - depth.w * abs(nearest)) discard;
    }
#endif
    float weight = exp(-0.5 * exponent) * gain;
#if PASS == 3
#if WITH_CLIPS
    weight *= share;
#endif
    material_sum = weight * material;
    reflection_sum = weight * reflection;
#else
#if WITH_CLIPS
    cut_sum = cut_of(weight * color.w);
    weight *= share;
#else
    cut_sum = vec4(0.0);
#endif
    color_sum = weight * color;
    normal_sum = weight * vec4(normal.xyz, color.w * (has(ORTHOGRAPHIC) ? -key : 1.0 / key));
    opacity_sum = weight * normal.w;
#endif
#endif
}
