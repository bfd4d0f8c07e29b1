// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The clip lines of a surfel on the picture (docs/math.md section 5; ewa_clip_set()): its own, and those of the section planes
// that cut it.

uniform sampler2D line_map; // of a surfel: vector and offset, twice; whether one line is enough

int line_count = 0;
vec3 center; // in camera space

void add_line(vec3 toward, float distance, vec2 projected) {
    vec2 g;
    float at;
    if (has(ORTHOGRAPHIC)) {
        float nz = (n.z < 0.0 ? -1.0 : 1.0) * max(abs(n.z), EDGE_ON);
        g = (toward.xy - toward.z * n.xy / nz) * focal.zw;
        at = distance;
    } else {
        float np = dot(n, center), minimum = EDGE_ON * length(center);
        float share = (dot(toward, center) - distance) / ((np < 0.0 ? -1.0 : 1.0) * max(abs(np), minimum));
        g = (toward.xy - n.xy * share) * focal.zw;
        at = distance * inverse_z;
    }
    float size = length(g);
    lines[line_count] = size > 0.0 ? vec3(g, at - dot(g, projected)) / size : vec3(0.0, 0.0, at < 0.0 ? -1.0 : 1.0);
    line_count++;
}

void add_own_lines(uint index, vec2 projected) {
    int at = int(index) * 3, width = textureSize(line_map, 0).x;
    for (int i = 0; i < 2; i++) {
        vec4 from = texelFetch(line_map, ivec2((at + i) % width, (at + i) / width), 0);
        if (from.xyz != vec3(0.0)) add_line(turn(from.xyz), from.w * zoomed.w, projected);
    }
    if (texelFetch(line_map, ivec2((at + 2) % width, (at + 2) / width), 0).x != 0.0) line_bits |= 256u;
}

// The planes that cut the surfel, those of smallest distance first.
void add_sections(vec2 projected) {
    float support = kernel.x * sigma;
    uint left = (1u << flags.y) - 1u;
    while (left != 0u && line_count < MAX_LINES) {
        int nearest = -1;
        float minimum = 0.0;
        for (int i = 0; i < int(flags.y); i++) {
            if ((left >> uint(i) & 1u) == 0u) continue;
            float distance = dot(sections[i].xyz, center) + sections[i].w, along = dot(sections[i].xyz, n);
            if (!(distance < support * sqrt(max(1.0 - along * along, 0.0)))) {
                left &= ~(1u << uint(i));
            } else if (nearest < 0 || distance < minimum) {
                nearest = i;
                minimum = distance;
            }
        }
        if (nearest < 0) return;
        left &= ~(1u << uint(nearest));
        add_line(sections[nearest].xyz, minimum, projected);
    }
}

void find_lines(uint lane, vec2 projected) {
    uint own = packet_bits.z, before = own & ((1u << lane) - 1u);
    bool is_cut = (packet_bits.y >> (16u + lane) & 1u) != 0u;
    center = has(ORTHOGRAPHIC) ? vec3((projected - place.zw) * focal.zw, z) : vec3(slope * z, z);
    if ((own >> lane & 1u) != 0u) {
        uint index = packet_bits.w;
        for (; before != 0u; before &= before - 1u) index++;
        add_own_lines(index, projected);
    }
    if (is_cut) add_sections(projected);
    if (line_count > 0) line_bits |= uint(max(line_count, 2));
}
