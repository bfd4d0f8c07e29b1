// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a surfel adds to pixels, and a corner of the box that holds them.

#if PASS != 1
flat out vec4 color;  // times opacity and peak; peak
flat out vec4 normal; // times peak; opacity times peak
#endif
#if PASS == 3
layout(std140) uniform MaterialBlock { vec4 materials[2 * MAX_MATERIALS]; }; // ambient, diffuse, specular, shininess; reflection
flat out vec4 material; // times peak
flat out float reflection;
#endif

uniform int back_facing_only; // 0: those that face the viewer, 1: that do not, -1: all

// By n.p, or what has its sign.
bool is_wanted(float facing) {
    if (has(CULL_BACK)) return facing < 0.0;
    return back_facing_only < 0 || (0.0 < facing) == (back_facing_only == 1);
}

#if PASS == 1
void find_payload() {}
#else
float decode_color(uint form, uint code) {
    bool with_sign = (form & 0x8000u) != 0u;
    int octave_bits = int(form >> 8 & 15u);
    float unit = exp2(float(int(form & 255u) - 128));
    if (!with_sign && octave_bits == 0) return float(code) / 65535.0 * unit;
    uint digits = with_sign ? 0x7fffu : 0xffffu;
    int left = 7 + octave_bits + (with_sign ? 1 : 0);
    float size = (uintBitsToFloat(((code & digits) << left) + 0x3f800000u) - 1.0) * unit;
    return (code & (0xffffu - digits)) != 0u ? -size : size;
}

void find_payload() {
    bool is_back_facing = 0.0 < facing;
    float opacity = has(TRANSLUCENT) ? float(color_code.w) / 65535.0 : 1.0, weight = peak * INVERSE_TWO_PI;
    for (int i = 0; i < 3; i++)
        color[i] = weight * opacity * sums.y * decode_color(packet_bits.x, color_code[i]);
    color.w = weight * sums.x;
    normal = vec4(n * (is_back_facing ? -color.w : color.w), color.w * opacity);
#if PASS == 3
    material = color.w * materials[2u * material_code];
    reflection = color.w * materials[2u * material_code + 1u].x;
#endif
}
#endif

// Corners are rounded to parts of a pixel.
const float MARGIN_PX = 1.0 / 64.0;

// One corner of a box of pixels, cut to the band, so that huge ones are drawn as exactly.
void emit_box(vec2 low, vec2 high) {
    vec2 first = max(low, vec2(-1.0)), last = min(high, place.xy + 1.0);
    vec2 at = vec2((gl_VertexID & 1) != 0 ? last.x : first.x, (gl_VertexID & 2) != 0 ? last.y : first.y);
    gl_Position = vec4(2.0 * at / place.xy - 1.0, 0.0, 1.0);
}
