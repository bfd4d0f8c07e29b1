// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From sums to pixels (docs/math.md sections 6 to 8; src/surface/pipeline_side_sums.h, pipeline_shade.h,
// pipeline_resolve.h): a fragment by each pixel of the band. STAGE says what is made.

#define COMPOSE 0
#define PLANES  1
#define CUT     2
#define PEEL    3
#define BROKEN  4
#define PICTURE 5
#define AVERAGE 6

layout(std140) uniform ResolveBlock {
    vec4 scales;   // 1 / q0, 1 / (tau q0), tau q0, 1 / (EWA_FRONT q0)
    vec4 units;    // of colours; opacity; of depths
    vec4 material; // ambient, diffuse, specular, shininess
    vec4 background;
    vec4 rays;     // slope = x rays.x + rays.y, y rays.z + rays.w
    vec4 to_world[3];
    vec4 toward[MAX_LIGHTS]; // w: it is at the eye
    vec4 light[MAX_LIGHTS];
    vec4 material_units; // of the sums of ambient, ...
    vec4 mirror;   // reflection; unit of its sums; texels of the environment per squared radian
    vec4 environment_from_camera[3];
    uvec4 flags;   // EDGE_ANTIALIASING, ...; shading; how many lights, levels
    uvec4 levels[MAX_LEVELS]; // of the environment: size, first texel
};

const uint EDGE_ANTIALIASING = 1u, TRANSPARENT = 2u, ONE_PASS = 4u, ORTHOGRAPHIC_VIEW = 8u, WITH_OPACITY = 16u, BOTH_SIDES = 32u,
           WITH_MATERIAL = 64u;
const uint UNSHADED = 0u, LAMBERT = 1u, PHONG = 3u;

uniform sampler2D nearest_map, color_map, normal_map, cut_map, opacity_map, color_back_map, normal_back_map, opacity_back_map,
    composed_map, first_cut_map, material_map, reflection_map, material_back_map, reflection_back_map, environment_map;
uniform int behind, whole;

layout(location = 0) out vec4 first_out;
#if STAGE == PICTURE || STAGE == PLANES || STAGE == AVERAGE
layout(location = 1) out vec4 second_out;
#endif
#if STAGE == AVERAGE
layout(location = 2) out vec4 third_out;
uniform sampler2D floats_map, planes_map, coverage_map;
uniform int finer; // parts of a pixel along each side
#endif

bool has(uint flag) { return (flags.x & flag) != 0u; }

ivec2 pixel;
vec4 color, normal; // sums; w: weight, depth
vec4 numbers;       // the material; its reflection
float reflection;
float opacity, cover;
vec2 cut;
bool is_cut = false;

// What the sums are of what is seen.
void settle() {
    numbers = material;
    reflection = mirror.x;
    vec4 material_sum = vec4(0.0);
    float reflection_sum = 0.0;
    if (has(WITH_MATERIAL)) {
        material_sum = texelFetch(material_map, pixel, 0);
        reflection_sum = texelFetch(reflection_map, pixel, 0).r;
    }
    color = texelFetch(color_map, pixel, 0);
    normal = texelFetch(normal_map, pixel, 0);
    opacity = has(WITH_OPACITY) ? texelFetch(opacity_map, pixel, 0).r : color.w;
    if (has(BOTH_SIDES)) {
        vec4 is_back = texelFetch(color_back_map, pixel, 0);
        float all_weight = color.w + is_back.w, share = 0.0 < is_back.w ? min(color.w * scales.w, 1.0) : 1.0;
        float front = whole != 0 ? 1.0 : 0.0 < color.w ? all_weight * share / color.w : 0.0;
        float behind = whole != 0 ? 1.0 : 0.0 < is_back.w ? all_weight * (1.0 - share) / is_back.w : 0.0;
        float back_opacity = has(WITH_OPACITY) ? texelFetch(opacity_back_map, pixel, 0).r : is_back.w;
        color = front * color + behind * is_back;
        normal = front * normal + behind * texelFetch(normal_back_map, pixel, 0);
        opacity = front * opacity + behind * back_opacity;
        if (has(WITH_MATERIAL)) {
            material_sum = front * material_sum + behind * texelFetch(material_back_map, pixel, 0);
            reflection_sum = front * reflection_sum + behind * texelFetch(reflection_back_map, pixel, 0).r;
        }
    }
    if (has(WITH_MATERIAL)) {
        float inverse_ = 0.0 < color.w ? 1.0 / color.w : 0.0;
        numbers = material_sum * inverse_ * material_units;
        reflection = reflection_sum * inverse_ * mirror.y;
    }
    cover = 0.0;
    cut = vec2(0.0);
#if WITH_CLIPS
    vec4 noted = texelFetch(cut_map, pixel, 0);
    is_cut = 0.0 < noted.y && whole == 0;
    if (is_cut) {
        float uncut = max(color.w - noted.x, 0.0), along = length(noted.zw) / noted.y;
        float alone = clamp((along - EDGES_OPPOSE) * EDGES_SLOPE, 0.0, 1.0);
        cover = min(max(uncut * scales.y, color.w / max(alone * noted.y + uncut, scales.z)), 1.0);
        cut = noted.zw / (uncut + noted.y);
    }
#endif
}

float alpha_of(bool with_cover) {
    float alpha = 0.0 < color.w ? 1.0 : 0.0;
    if (has(EDGE_ANTIALIASING)) alpha = with_cover ? cover : min(1.0, color.w * scales.y);
    if (!has(TRANSPARENT)) return alpha;
    return alpha * units.y * (0.0 < color.w ? opacity / color.w : 0.0);
}

vec3 toward_eye() {
    if (has(ORTHOGRAPHIC_VIEW)) return vec3(0.0, 0.0, -1.0);
    return -normalize(vec3(gl_FragCoord.x * rays.x + rays.y, gl_FragCoord.y * rays.z + rays.w, 1.0));
}

vec3 environment_texel(uvec4 level, ivec2 at) {
    ivec2 size = ivec2(level.xy);
    if (at.y < 0 || at.y >= size.y) at = ivec2(at.x + size.x / 2, clamp(at.y, 0, size.y - 1)); // across the pole
    at.x = at.x < 0 ? at.x + size.x : at.x >= size.x ? at.x - size.x : at.x;
    int index = int(level.z) + at.y * size.x + at.x, width = textureSize(environment_map, 0).x;
    return texelFetch(environment_map, ivec2(index % width, index / width), 0).rgb;
}

vec3 environment_level(int index, vec2 uv) {
    uvec4 level = levels[index];
    vec2 at = uv * vec2(level.xy) - 0.5, share = fract(at);
    ivec2 first = ivec2(floor(at));
    vec3 upper = mix(environment_texel(level, first), environment_texel(level, first + ivec2(1, 0)), share.x);
    vec3 lower = mix(environment_texel(level, first + ivec2(0, 1)), environment_texel(level, first + ivec2(1, 1)), share.x);
    return mix(upper, lower, share.y);
}

// What the environment shows in a direction; neighbours in the same 2x2 pixels tell how much of it a pixel sees. Of all pixels
// at once.
vec3 reflected(vec3 n, vec3 view, bool shown) {
    vec3 mirrored = shown ? 2.0 * dot(n, view) * n - view : vec3(0.0);
    vec3 d = vec3(dot(environment_from_camera[0].xyz, mirrored), dot(environment_from_camera[1].xyz, mirrored),
                  dot(environment_from_camera[2].xyz, mirrored));
    vec3 along_x = dFdx(d), along_y = dFdy(d);
    float is_shown = shown ? 1.0 : 0.0;
    float x2 = dFdx(is_shown) == 0.0 ? dot(along_x, along_x) : 0.0, y2 = dFdy(is_shown) == 0.0 ? dot(along_y, along_y) : 0.0;
    if (!shown) return vec3(0.0);
    float u = 0.5 - atan(d.x, d.z) * INVERSE_TWO_PI, v = 0.5 - 2.0 * atan(d.y, length(d.xz)) * INVERSE_TWO_PI;
    float level = min(0.5 * log2(max(max(x2, y2) * mirror.z, 1.0)), float(flags.w - 1u));
    int fine = int(level);
    vec3 seen = environment_level(fine, vec2(u, v));
    float share = level - float(fine);
    return share > 0.0 ? mix(seen, environment_level(fine + 1, vec2(u, v)), share) : seen;
}

// Straight colour of the surface.
vec3 shade() {
    bool shown = 0.0 < color.w;
    vec3 straight = color.rgb * units.x / (0.0 < opacity ? opacity : 1.0);
    if (flags.y == UNSHADED) return shown ? straight : vec3(0.0);
    float size = max(length(normal.xyz), color.w * SHADED_NORMAL);
    vec3 n = shown ? normal.xyz / size : vec3(0.0), view = toward_eye(), diffuse = vec3(0.0), specular = vec3(0.0);
    for (int i = 0; i < int(flags.z); i++) {
        vec3 to = toward[i].w != 0.0 ? view : toward[i].xyz;
        float facing = max(dot(n, to), 0.0), power = facing;
        diffuse += light[i].rgb * facing;
        if (flags.y != PHONG) continue;
        if (toward[i].w == 0.0) power = (facing + dot(n, view)) * inversesqrt(max(2.0 * dot(to, view) + 2.0, 1e-20));
        power = pow(clamp(power, 1e-30, 1.0), numbers.w);
        if (0.0 < facing) specular += light[i].rgb * power;
    }
    vec3 seen = straight * (numbers.x + numbers.y * diffuse);
    if (flags.y == PHONG) seen += numbers.z * specular;
    if (flags.y == PHONG && flags.w != 0u) seen += reflection * reflected(n, view, shown);
    return shown ? seen : vec3(0.0);
}

// The alpha of as many surfaces as a coverage is.
float merged(float alpha, float coverage) {
    float through = 1.0 - alpha;
    for (int i = 1; i < 64; i++) {
        float share = clamp(4.0 * (coverage - float(i)) - 2.0, 0.0, 1.0);
        if (!(0.0 < share)) break;
        through *= 1.0 - alpha * share;
    }
    return 1.0 - through;
}

// What a surface behind the first covers of what that leaves, where both are cut.
float alpha_behind(float alpha) {
    vec4 first = texelFetch(first_cut_map, pixel, 0); // alpha, cut, whether it is
    if (first.w == 0.0) return alpha;
    float left = 1.0 - first.x, along = dot(first.yz, cut);
    float hidden = max(cover - first.x, 0.0) / (0.0 < left ? left : 1.0);
    return cover + min(2.0 * abs(along), 1.0) * ((0.0 < along ? hidden : alpha_of(false)) - cover);
}

float curve(float x) {
    return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
}

bool is_broken(vec4 v) {
    bool broken = false;
    for (int i = 0; i < 4; i++) broken = broken || !(abs(v[i]) <= 3e38);
    return broken;
}

void main() {
    pixel = ivec2(gl_FragCoord.xy);
#if STAGE == AVERAGE
    vec4 color_sum = vec4(0.0);
    vec3 normal_sum = vec3(0.0);
    float nearest = uintBitsToFloat(0x7f800000u), coverage_sum = 0.0, share = 1.0 / float(finer * finer);
    for (int j = 0; j < finer; j++)
        for (int i = 0; i < finer; i++) {
            ivec2 part = pixel * finer + ivec2(i, j);
            vec4 plane = texelFetch(planes_map, part, 0);
            color_sum += texelFetch(floats_map, part, 0);
            normal_sum += plane.xyz;
            nearest = min(nearest, plane.w);
            coverage_sum += texelFetch(coverage_map, part, 0).r;
        }
    first_out = color_sum * share;
    second_out = vec4(normal_sum, nearest);
    third_out = vec4(coverage_sum * share);
#elif STAGE == COMPOSE
    settle();
    float alpha = alpha_of(is_cut);
    if (behind != 0 && is_cut && !has(TRANSPARENT)) alpha = alpha_behind(alpha);
    if (whole != 0) alpha = merged(alpha, color.w * scales.x);
    first_out = vec4(shade() * alpha, alpha);
#elif STAGE == CUT
    settle();
    first_out = vec4(alpha_of(is_cut), cut, is_cut ? 1.0 : 0.0);
#elif STAGE == PLANES
    settle();
    bool covered = 0.0 < color.w;
    float size = length(normal.xyz);
    vec3 unit = 0.0 < size ? normal.xyz / size : vec3(0.0);
    first_out = vec4(dot(to_world[0].xyz, unit), dot(to_world[1].xyz, unit), dot(to_world[2].xyz, unit),
                     covered ? normal.w / color.w * units.z : uintBitsToFloat(0x7f800000u));
    second_out = vec4(has(ONE_PASS) ? (covered ? 1.0 : 0.0) : color.w * scales.x);
#elif STAGE == PEEL
    float nearest = texelFetch(nearest_map, pixel, 0).r;
    if (nearest == NEVER || !(texelFetch(composed_map, pixel, 0).a < 1.0)) discard;
    first_out = vec4(nearest);
#else
    vec4 composed = texelFetch(composed_map, pixel, 0), result = composed + (1.0 - composed.a) * background;
#if STAGE == BROKEN
    if (!is_broken(result)) discard;
    first_out = result;
#else
    float a = clamp(result.a, 0.0, 1.0);
    vec3 straight = 0.0 < result.a ? clamp(result.rgb / a, 0.0, 1.0) : vec3(0.0);
    first_out = vec4(curve(straight.r), curve(straight.g), curve(straight.b), a);
    second_out = result;
#endif
#endif
}
