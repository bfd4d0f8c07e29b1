// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Packets of a page (src/surface/packet.h), and packets in fields.

layout(std430, binding = 1) readonly buffer PacketBlock { uint packets[]; };

// Packets of one source that lie side by side in the page, and what their surfels have; src/gl/scene.h is the same in C.
struct Segment { uint first_group, at, count, source, first, streams, pad0, pad1; };
layout(std430, binding = 6) readonly buffer SegmentBlock { Segment segments[]; };

const uint OPACITIES = 4u, CURVATURES = 8u, MATERIALS = 16u, CLIP_MASKS = 32u;

// A packet in one field of the band: its number in its page; field, column | row << 16; form of colours | material << 16; lanes that
// section planes leave | those with clip lines << 16; its segment; and its place (ewa_packet_places).
struct Pair { uint packet, field, form, lanes, segment; float slope_x, slope_y, rest_x, rest_y, depth; };
layout(std430, binding = 8) buffer PairBlock { Pair pairs[]; };

const int PACKET_WORDS = 120;
const float FIELD_PX = 128.0;

uint half_word(uint base, uint index) {
    uint word = packets[base + index / 2u];
    return (index & 1u) != 0u ? word >> 16 : word & 0xffffu;
}

int signed_half(uint base, uint index) { return int(half_word(base, index) << 16) >> 16; }

vec3 unfold_flat(float u, float v) {
    vec3 n;
    n.z = wf_sub(wf_sub(1.0, wf_abs(u)), wf_abs(v));
    float fold = wf_max(wf_negate(n.z), 0.0);
    n.x = wf_sub(u, u < 0.0 ? wf_negate(fold) : fold);
    n.y = wf_sub(v, v < 0.0 ? wf_negate(fold) : fold);
    return n;
}

vec3 make_unit(vec3 n) {
    return scale3(n, wf_inverse_root(wf_fma(n.x, n.x, wf_fma(n.y, n.y, wf_mul(n.z, n.z)))));
}

bool is_billboard(uint base, uint lane) { return float(signed_half(base + 64u, lane)) == BILLBOARD; }

vec3 decode_normal(uint base, uint lane) {
    return unfold_flat(wf_mul(float(signed_half(base + 64u, lane)), UNIT_OCT),
                       wf_mul(float(signed_half(base + 72u, lane)), UNIT_OCT));
}
