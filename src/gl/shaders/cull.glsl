// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Packets to the fields of a band: src/surface/pipeline_cull.h and pipeline_section.h, a packet of a segment by each invocation.

layout(local_size_x = 64) in;

// Where a source's packets are (ewa_view): packets' centres to camera space, sides of the view volume, section planes.
struct Placement {
    double linear[9], anchor[3], offset[3];
    double sections[MAX_SECTIONS][4];
    float side_planes[4][3];
    float cx_px, cy_px, margin_px, section_reach;
    uint section_count, width_px, height_px;
    uint material; // of all surfels, where they have none of their own
};

layout(std430, binding = 12) readonly buffer PlacementBlock { Placement placements[]; };
// Of the page's packets (ewa_packet_bounds): x, y, z of the centre, two words each; cone; radius | form of colours << 16.
struct Bound { uvec2 x, y, z; uint cone, radius; };
layout(std430, binding = 2) readonly buffer BoundBlock { Bound bounds[]; };
layout(std430, binding = 15) readonly buffer ClipMaskBlock { uint clip_masks[]; };

layout(location = 0) uniform uint page;
layout(location = 1) uniform uint first_segment;
layout(location = 2) uniform uint end_segment;

uint source, segment; // of the group
View view;
uint view_flags;

struct Outline { vec3 center; float radius, slope_x, slope_y, x, y, half_x, half_y; bool near; };

float affine_reach(float middle, float half_px, float reach, float f_px, float c_px) {
    return wf_mul(reach, wf_add(f_px, wf_add(wf_abs(wf_sub(middle, c_px)), half_px)));
}

float widened(float half_px, float middle, float c_px) {
    return wf_fma(wf_add(wf_abs(middle), wf_abs(c_px)), ROUNDING, half_px);
}

void outline_packet(float cx_px, float cy_px, float margin_px, inout Outline o) {
    float r = o.radius;
    bool circular = has(view_flags, CIRCULAR);
    if (has(view_flags, ORTHOGRAPHIC)) {
        o.near = false;
        o.slope_x = o.center.x;
        o.slope_y = o.center.y;
        o.x = wf_fma(o.center.x, view.fx_px, cx_px);
        o.y = wf_fma(o.center.y, view.fy_px, cy_px);
        float larger_px = view.fx_px > view.fy_px ? view.fx_px : view.fy_px;
        o.half_x = wf_mul(r, circular ? larger_px : view.fx_px);
        o.half_y = wf_mul(r, circular ? larger_px : view.fy_px);
    } else {
        o.near = o.center.z <= wf_mul(r, NEAR_RATIO);
        float inverse_z = wf_div(1.0, o.center.z), q = wf_mul(r, inverse_z);
        float sx = wf_mul(o.center.x, inverse_z), sy = wf_mul(o.center.y, inverse_z), rest = wf_fnma(q, q, 1.0);
        float inverse_ = wf_div(1.0, rest), half_ = wf_mul(q, inverse_);
        float rx = wf_sqrt(wf_max(wf_fma(sx, sx, rest), 0.0)), ry = wf_sqrt(wf_max(wf_fma(sy, sy, rest), 0.0));
        o.slope_x = sx;
        o.slope_y = sy;
        o.x = wf_fma(wf_mul(sx, inverse_), view.fx_px, cx_px);
        o.y = wf_fma(wf_mul(sy, inverse_), view.fy_px, cy_px);
        o.half_x = wf_mul(wf_mul(rx, half_), view.fx_px);
        o.half_y = wf_mul(wf_mul(ry, half_), view.fy_px);
        if (has(view_flags, AFFINE)) {
            float reach = wf_div(q, wf_sub(1.0, q));
            float reach_x = affine_reach(o.x, o.half_x, reach, view.fx_px, cx_px);
            float reach_y = affine_reach(o.y, o.half_y, reach, view.fy_px, cy_px);
            o.half_x = wf_add(o.half_x, circular ? wf_add(reach_x, reach_y) : reach_x);
            o.half_y = wf_add(o.half_y, circular ? wf_add(reach_x, reach_y) : reach_y);
        }
    }
    o.half_x = widened(wf_add(o.half_x, margin_px), o.x, cx_px);
    o.half_y = widened(wf_add(o.half_y, margin_px), o.y, cy_px);
}

bool within_sides(float planes[4][3], Outline o) {
    vec3 c = o.center;
    bool within = wf_negate(o.radius) < c.z;
    if (has(view_flags, ORTHOGRAPHIC) || has(view_flags, AFFINE)) return within;
    float size = wf_add(wf_add(wf_abs(c.x), wf_abs(c.y)), wf_abs(c.z));
    float outward = wf_negate(wf_fma(size, ROUNDING, o.radius));
    for (int k = 0; k < 4; k++) within = within && outward < dot3(vec3(planes[k][0], planes[k][1], planes[k][2]), c);
    return within;
}

bool back_facing(uint packet, Outline o) {
    const uint axis_mask = (1u << CONE_BITS) - 1u;
    uint code = bounds[packet].cone, sine_code = code >> 2 * CONE_BITS;
    float u = wf_mul(float(int(code & axis_mask) - CONE_AXIS), UNIT_CONE);
    float v = wf_mul(float(int(code >> CONE_BITS & axis_mask) - CONE_AXIS), UNIT_CONE);
    float sine = wf_mul(float(sine_code), UNIT_SINE);
    bool wide = CONE_SINE < sine_code;
    vec3 axis = rotate(view.rotation, make_unit(unfold_flat(u, v))), c = o.center;
    if (has(view_flags, ORTHOGRAPHIC)) return !wide && sine < axis.z;
    float along = dot3(axis, c), length2 = dot3(c, c);
    return !wide && SHORTEST2 < length2 && wf_fma(wf_sqrt(length2), sine, o.radius) < along;
}

// What section planes leave of a packet and cut of that: lanes | cut lanes << 16; 0: nothing is left.
uint section_lanes(uint index, uint packet, dvec3 center) {
    uint count = placements[index].section_count;
    float radius = uintBitsToFloat((bounds[packet].radius & 0xffffu) << RADIUS_SHIFT);
    float distances[MAX_SECTIONS];
    bool crossed = false;
    for (uint k = 0u; k < count; k++) {
        double plane[4] = placements[index].sections[k];
        distances[k] = float(
            wd_fma(plane[0], center.x, wd_fma(plane[1], center.y, wd_fma(plane[2], center.z, plane[3]))));
        if (!(wf_negate(radius) <= distances[k])) return 0u;
        crossed = crossed || distances[k] < radius;
    }
    if (!crossed) return 0xffffu;
    uint base = packet * uint(PACKET_WORDS), lanes = 0u, cuts = 0u;
    for (uint lane = 0u; lane < 16u; lane++) {
        vec3 place = vec3(uintBitsToFloat(packets[base + lane]), uintBitsToFloat(packets[base + 16u + lane]),
                          uintBitsToFloat(packets[base + 32u + lane]));
        float sigma = uintBitsToFloat(packets[base + 48u + lane]), support = wf_mul(sigma, placements[index].section_reach);
        vec3 normal = make_unit(decode_normal(base, lane));
        if (is_billboard(base, lane)) normal = vec3(view.rotation[6], view.rotation[7], view.rotation[8]);
        bool inside = 0.0 < sigma, cut = false;
        for (uint k = 0u; k < count; k++) {
            double plane[4] = placements[index].sections[k];
            vec3 n = vec3(float(plane[0]), float(plane[1]), float(plane[2]));
            float yz = wf_fma(n.y, place.y, wf_fma(n.z, place.z, distances[k])), away = wf_fma(n.x, place.x, yz);
            float along = dot3(n, normal);
            float reach = wf_mul(support, wf_sqrt(wf_max(wf_fnma(along, along, 1.0), 0.0)));
            inside = inside && (0.0 <= away || wf_negate(reach) < away);
            cut = cut || away < reach;
        }
        lanes |= inside ? 1u << lane : 0u;
        cuts |= inside && cut ? 1u << lane : 0u;
    }
    return lanes | cuts << 16;
}

void write_pairs(uint packet, uint lanes, dvec3 center, Outline o, uvec2 first, uvec2 end) {
    bool orthographic = has(view_flags, ORTHOGRAPHIC);
    Pair p;
    p.packet = packet;
    p.form = bounds[packet].radius >> 16 | placements[source].material << 16;
    p.segment = segment;
    p.lanes = lanes;
    if (has(segments[segment].streams, CLIP_MASKS)) p.lanes |= clip_masks[packet] << 16;
    p.slope_x = o.near ? 0.0 : o.slope_x;
    p.slope_y = o.near ? 0.0 : o.slope_y;
    precise double across_x = center.x - double(p.slope_x), across_y = center.y - double(p.slope_y);
    p.rest_x = float(orthographic ? across_x : wd_fma(-double(p.slope_x), center.z, center.x));
    p.rest_y = float(orthographic ? across_y : wd_fma(-double(p.slope_y), center.z, center.y));
    p.depth = o.center.z;
    uint number = (end.x - first.x) * (end.y - first.y), at = atomicAdd(pair_count, number);
    if (at + number < at) atomicAdd(carry, 1u);
    for (uint y = first.y; y < end.y; y++)
        for (uint x = first.x; x < end.x; x++, at++) {
            if (at >= pair_capacity) return;
            p.field = x | y << 16;
            pairs[at] = p;
        }
}

void cull(uint packet) {
    Outline o;
    o.radius = wf_mul(uintBitsToFloat((bounds[packet].radius & 0xffffu) << RADIUS_SHIFT), view.scale);
    dvec3 own = dvec3(packDouble2x32(bounds[packet].x), packDouble2x32(bounds[packet].y), packDouble2x32(bounds[packet].z)), center;
    for (int i = 0; i < 3; i++) {
        precise double x = own.x - placements[source].anchor[0], y = own.y - placements[source].anchor[1],
                       z = own.z - placements[source].anchor[2];
        double with_z = wd_fma(placements[source].linear[3 * i + 2], z, placements[source].offset[i]);
        center[i] = wd_fma(placements[source].linear[3 * i], x, wd_fma(placements[source].linear[3 * i + 1], y, with_z));
        o.center[i] = float(center[i]);
    }
    if (!(0.0 < o.radius) || !within_sides(placements[source].side_planes, o)) return;
    uint lanes = 0xffffu;
    if (placements[source].section_count != 0u) lanes = section_lanes(source, packet, own);
    if (lanes == 0u || has(view_flags, CULL_BACK) && back_facing(packet, o)) return;
    outline_packet(placements[source].cx_px, placements[source].cy_px, placements[source].margin_px, o);
    uvec2 fields = (uvec2(placements[source].width_px, placements[source].height_px) + 127u) / 128u;
    uvec2 first = uvec2(0u), end = fields;
    if (!o.near) {
        vec2 low = vec2(wf_sub(o.x, o.half_x), wf_sub(o.y, o.half_y)), high = vec2(wf_add(o.x, o.half_x), wf_add(o.y, o.half_y));
        for (int i = 0; i < 2; i++) {
            first[i] = uint(wf_clamp(floor(wf_mul(low[i], 1.0 / FIELD_PX)), 0.0, float(fields[i])));
            end[i] = uint(wf_clamp(wf_add(floor(wf_mul(high[i], 1.0 / FIELD_PX)), 1.0), 0.0, float(fields[i])));
        }
    }
    if (any(greaterThanEqual(first, end))) return;
    atomicAdd(kept_count, 1u);
    first.y = max(first.y, first_px.y / 128u);
    end.y = min(end.y, (picture_px.y + 127u) / 128u);
    if (first.y < end.y) write_pairs(packet, lanes, center, o, first, end);
}

void main() {
    // The last segment that begins no later than the group: a group has packets of one source.
    uint group = group_number();
    segment = first_segment;
    for (uint end = end_segment; segment + 1u < end;) {
        uint middle = (segment + end) / 2u;
        if (segments[middle].first_group <= group)
            segment = middle;
        else
            end = middle;
    }
    source = segments[segment].source;
    view = views[source];
    view_flags = view.flags;
    uint in_segment = (group - segments[segment].first_group) * 64u + gl_LocalInvocationID.x;
    if (in_segment < segments[segment].count) cull(segments[segment].at + in_segment);
    // The last group of the page says how much set-up and lists have to do.
    memoryBarrierBuffer();
    barrier();
    if (gl_LocalInvocationIndex != 0u) return;
    if (atomicAdd(culled_groups, 1u) + 1u < gl_NumWorkGroups.x * gl_NumWorkGroups.y) return;
    uint count = atomicAdd(pair_count, 0u), before = page == 0u ? 0u : arguments[OF_PAGES + page - 1u].w;
    bool fits = count <= pair_capacity && atomicAdd(carry, 0u) == 0u;
    uint groups = fits ? (count - before + 3u) / 4u : 0u;
    arguments[OF_PAGES + page] = groups_for((groups + parts - 1u) / parts, count);
    arguments[OF_LISTS] = groups_for(fits ? (count + 3u) / 4u : 0u, count);
    culled_groups = 0u;
}
