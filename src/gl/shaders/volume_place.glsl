// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From the voxels of a block to records in a tile: src/volume/kernels_append.h, kernels_shade.h and kernels_splats.h. A group for each
// block in each tile. The records are put in the order of the block's units; places come from counts, so that in a unit they are in
// the order of the voxels. After volume_scene.glsl.

layout(local_size_x = 64) in;

// Place within the block and red; green and blue; extinction; packed normal.
layout(std430, binding = 3) readonly buffer VoxelBlock { uvec4 voxels[]; };
layout(std430, binding = 4) writeonly buffer RecordBlock { uint records[]; };
layout(std430, binding = 5) writeonly buffer RunBlock { uint runs[]; }; // of each unit of the block: its first record; then their end
layout(location = 0) uniform uint first_pair;
layout(location = 1) uniform uint end_pair;

shared uint begins[MAX_SPAN + 1];
shared uint masks[2 * MAX_SPAN];

// A voxel in a tile.
struct Placed {
    bool shows, is_splat;
    int slice;
    float x_px, y_px;          // in the tile
    float factor, last;        // of the colour; the fourth number of the record
    vec3 slopes;               // perspective: x, y, 1
    float z, length_;
    uint window;
};

// How far from its centre the ellipse of a splat may reach.
float splat_reach(float length_, float inverse_) {
    if (orthographic != 0u) return wf_add(wf_mul(focal_px, reach), splat_margin_px);
    float length2 = wf_mul(length_, length_);
    float sine = wf_div(wf_mul(reach, inverse_), length_);
    float cosine = wf_sqrt(wf_max(wf_fnma(sine, sine, 1.0), 0.0));
    float slope = wf_sqrt(wf_max(wf_sub(length2, 1.0), 0.0));
    float room = wf_fnma(slope, sine, cosine);
    float far = wf_div(wf_mul(sine, length2), wf_max(room, 1e-6));
    return wf_fma(wf_min(far, 1e6), focal_px, splat_margin_px);
}

// Where the 4x4 pixels of a point begin, from 4 before the tile on, and the phases of its filter.
uint point_window(Tile tile, float x, float y, out bool touches) {
    float u = wf_max(wf_min(wf_sub(x, 0.5), 1e6), -1e6), v = wf_max(wf_min(wf_sub(y, 0.5), 1e6), -1e6);
    float whole_u = floor(u), whole_v = floor(v);
    uint phase_u = uint(wf_min(wf_mul(wf_sub(u, whole_u), 32.0), 31.0));
    uint phase_v = uint(wf_min(wf_mul(wf_sub(v, whole_v), 32.0), 31.0));
    float left = wf_sub(whole_u, 1.0), top = wf_sub(whole_v, 1.0);
    touches = -3.0 <= left && left < float(tile.width_px) && -3.0 <= top && top < float(tile.height_px);
    uint column = uint(int(left) + 4) & 127u, row = uint(int(top) + 4) & 127u;
    return column | row << 7 | phase_u << 14 | phase_v << 20;
}

Placed place(Pair pair, Tile tile, uvec4 voxel) {
    Placed p;
    uint at = voxel.x & 0xffffu;
    vec3 steps = vec3(float(at & 7u), float(at >> 3 & 7u), float(at >> 6)), c;
    for (int i = 0; i < 3; i++)
        c[i] = wf_fma(steps.x, axes[i], wf_fma(steps.y, axes[3 + i], wf_fma(steps.z, axes[6 + i], pair.origin[i])));
    float unit = floor(wf_fma(c.z, unit_inverse, unit_offset)), inverse_ = 1.0;
    p.slopes = vec3(c.xy, 1.0);
    p.z = c.z;
    p.length_ = 1.0;
    if (orthographic == 0u) {
        inverse_ = wf_div(1.0, c.z);
        p.slopes.x = wf_mul(c.x, inverse_);
        p.slopes.y = wf_mul(c.y, inverse_);
        p.length_ = wf_sqrt(wf_fma(p.slopes.x, p.slopes.x, wf_fma(p.slopes.y, p.slopes.y, 1.0)));
    }
    p.x_px = wf_fma(p.slopes.x, fx_px, wf_sub(cx_px, float(tile.x_px)));
    p.y_px = wf_fma(p.slopes.y, fy_px, wf_sub(cy_px, float(tile.y_px)));
    p.slice = clamp(int(wf_max(wf_min(unit, 1e9), -1e9)), pair.slice_first, pair.slice_last);
    p.window = point_window(tile, p.x_px, p.y_px, p.shows);
    float thick = wf_mul(uintBitsToFloat(voxel.z), density), mass = wf_mul(thick, point_mass);
    if (orthographic == 0u) mass = wf_mul(mass, wf_mul(p.length_, wf_mul(inverse_, inverse_)));
    mass = wf_min(mass, 1e12);
    p.factor = p.last = mass;
    p.is_splat = p.slice < point_slice;
    if (p.is_splat) {
        float far = splat_reach(p.length_, inverse_);
        p.shows = wf_sub(0.0, far) < p.x_px && wf_sub(p.x_px, far) < float(tile.width_px) && wf_sub(0.0, far) < p.y_px &&
                  wf_sub(p.y_px, far) < float(tile.height_px);
        p.factor = 1.0;
        p.last = wf_min(thick, 1e18);
    }
    p.shows = p.shows && 0.0 < p.last && (has_near == 0u || 0.0 <= unit);
    return p;
}

vec3 shade(vec3 color, int packed_normal, vec3 slopes, float length_) {
    vec3 normal, toward;
    for (int i = 0; i < 3; i++) normal[i] = wf_mul(float(packed_normal << 22 - 10 * i >> 22), 0.00195694715);
    if (orthographic != 0u) {
        toward = vec3(toward_viewer[0], toward_viewer[1], toward_viewer[2]);
    } else {
        float shrink = wf_div(-1.0, length_);
        for (int i = 0; i < 3; i++)
            toward[i] = wf_mul(shrink, row_dot(to_world[3 * i], to_world[3 * i + 1], to_world[3 * i + 2], slopes));
    }
    if (dot3(normal, toward) < 0.0)
        for (int i = 0; i < 3; i++) normal[i] = wf_sub(0.0, normal[i]);
    vec3 matt = vec3(0.0), shine = vec3(0.0);
    float sight = dot3(normal, toward);
    for (uint k = 0u; k < light_count; k++) {
        VolumeLight from = lights[k];
        vec3 to_light = from.headlight != 0u ? toward : vec3(from.toward[0], from.toward[1], from.toward[2]);
        float facing = wf_max(dot3(normal, to_light), 0.0), power = facing;
        for (int i = 0; i < 3; i++) matt[i] = wf_fma(from.color[i], facing, matt[i]);
        if (highlights == 0u) continue;
        if (from.headlight == 0u) {
            float across2 = wf_max(wf_fma(2.0, dot3(to_light, toward), 2.0), 0.0);
            power = wf_mul(wf_add(facing, sight), wf_inverse_root(across2));
        }
        power = wf_power(power, shininess);
        float highlight = wf_keep(0.0 < facing && MIN_POWER < power, power);
        for (int i = 0; i < 3; i++) shine[i] = wf_fma(from.color[i], highlight, shine[i]);
    }
    bool flat_ = dot3(normal, normal) <= 0.25;
    vec3 shown;
    for (int i = 0; i < 3; i++) {
        float share = wf_fma(diffuse, matt[i], ambient);
        shown[i] = flat_ ? wf_mul(color[i], flat_share) : wf_fma(color[i], share, wf_mul(specular, shine[i]));
    }
    return shown;
}

void store(uint at, float value) { records[at] = floatBitsToUint(value); }

// The true ellipse of a splat, over the normalised image plane (orthographic: camera units).
void true_ellipse(float x, float y, float z, out vec3 v, out vec2 shift) {
    if (orthographic != 0u) {
        v = vec3(covariance[0], covariance[1], covariance[3]);
        shift = vec2(0.0);
        return;
    }
    float s33 = covariance[5], s13 = wf_fnma(x, s33, covariance[2]), s23 = wf_fnma(y, s33, covariance[4]);
    float s11 = wf_fnma(x, wf_add(s13, covariance[2]), covariance[0]);
    float s12 = wf_fnma(x, s23, wf_fnma(y, covariance[2], covariance[1]));
    float s22 = wf_fnma(y, wf_add(s23, covariance[4]), covariance[3]);
    float k = wf_div(1.0, wf_fnma(cutoff2, s33, wf_mul(z, z)));
    float far = wf_mul(cutoff2, k), across = wf_mul(far, s13), down = wf_mul(far, s23);
    shift = vec2(wf_sub(0.0, across), wf_sub(0.0, down));
    v = vec3(wf_mul(k, wf_fma(across, s13, s11)), wf_mul(k, wf_fma(across, s23, s12)), wf_mul(k, wf_fma(down, s23, s22)));
}

// What pixels need of a splat (volume_draw.glsl), and what it is sorted by.
void store_splat(uint at, Tile tile, Placed p, vec3 color) {
    float inv[6] = inverse_covariance;
    float x = wf_div(wf_sub(p.x_px, wf_sub(cx_px, float(tile.x_px))), fx_px);
    float y = wf_div(wf_sub(p.y_px, wf_sub(cy_px, float(tile.y_px))), fy_px);
    vec3 v, m;
    vec2 shift;
    true_ellipse(x, y, p.z, v, shift);
    float v11 = wf_mul(v.x, wf_mul(fx_px, fx_px)), v12 = wf_mul(v.y, wf_mul(fx_px, fy_px));
    float v22 = wf_mul(v.z, wf_mul(fy_px, fy_px));
    float w11 = wf_add(v11, prefilter2_px2), w22 = wf_add(v22, prefilter2_px2);
    float area = wf_max(wf_fnma(v12, v12, wf_mul(v11, v22)), 1e-30);
    float filtered = wf_max(wf_fnma(v12, v12, wf_mul(w11, w22)), 1e-30);
    float l0 = wf_sqrt(v11), m0 = wf_sqrt(w11), l2 = wf_sqrt(wf_div(area, v11)), m2 = wf_sqrt(wf_div(filtered, w11));
    float l1 = wf_div(v12, l0), m1 = wf_div(v12, m0), ratio = wf_div(l2, m2);
    m = vec3(wf_div(wf_div(l0, m0), fx_px), wf_div(wf_div(wf_fnma(ratio, m1, l1), m0), fy_px), wf_div(ratio, fy_px));
    float place2 = inv[5], length_ = 1.0;
    float rho[6] = float[6](1.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    if (orthographic == 0u) {
        float doubled2 = wf_mul(2.0, inv[2]), doubled4 = wf_mul(2.0, inv[4]);
        float gx = wf_fma(inv[0], x, wf_fma(inv[1], y, doubled2)), gy = wf_fma(inv[3], y, doubled4);
        place2 = wf_fma(gx, x, wf_fma(wf_mul(inv[1], x), y, wf_fma(gy, y, place2)));
        length_ = wf_sqrt(wf_fma(x, x, wf_fma(y, y, 1.0)));
        float z2 = wf_mul(p.z, p.z);
        float k = wf_div(wf_fnma(cutoff2, covariance[5], z2), wf_fnma(cutoff2, 1.0, wf_mul(place2, z2)));
        float hx = wf_fma(inv[0], x, wf_fma(inv[1], y, inv[2])), hy = wf_fma(inv[1], x, wf_fma(inv[3], y, inv[4]));
        float ax = wf_fma(inv[0], shift.x, wf_mul(inv[1], shift.y)), ay = wf_fma(inv[1], shift.x, wf_mul(inv[3], shift.y));
        float along = wf_fma(shift.x, wf_fma(2.0, hx, ax), wf_mul(shift.y, wf_fma(2.0, hy, ay)));
        float twice = wf_mul(2.0, k), ex = wf_mul(twice, wf_add(hx, ax)), ey = wf_mul(twice, wf_add(hy, ay));
        float bx = wf_fma(inv[0], m.x, wf_mul(inv[1], m.y)), by = wf_fma(inv[1], m.x, wf_mul(inv[3], m.y));
        rho = float[6](wf_mul(k, wf_add(place2, along)), wf_fma(ex, m.x, wf_mul(ey, m.y)), wf_mul(ey, m.z),
                       wf_mul(k, wf_fma(bx, m.x, wf_mul(by, m.y))), wf_mul(twice, wf_mul(by, m.z)),
                       wf_mul(k, wf_mul(inv[3], wf_mul(m.z, m.z))));
    }
    float attenuation = wf_sqrt(wf_div(area, filtered));
    float cx = wf_fma(shift.x, fx_px, p.x_px), cy = wf_fma(shift.y, fy_px, p.y_px);
    float reach_x = wf_mul(cutoff, m0), reach_y = wf_mul(cutoff, wf_sqrt(w22));
    float scale = wf_div(1.0, wf_mul(filtered, cutoff2));
    store(at, cx);
    store(at + 1u, cy);
    store(at + 2u, wf_mul(w22, scale));
    store(at + 3u, wf_mul(wf_mul(v12, -2.0), scale));
    store(at + 4u, wf_mul(w11, scale));
    for (uint i = 0u; i < 6u; i++) store(at + 5u + i, rho[i]);
    store(at + 11u, wf_mul(wf_mul(p.last, splat_peak), wf_mul(attenuation, wf_div(length_, wf_sqrt(place2)))));
    for (uint i = 0u; i < 3u; i++) store(at + 12u + i, color[i]);
    store(at + 15u, p.z);
    store(at + 16u, wf_sub(cx, reach_x));
    store(at + 17u, wf_add(cx, reach_x));
    store(at + 18u, wf_sub(cy, reach_y));
    store(at + 19u, wf_add(cy, reach_y));
    float bent = wf_fma(p.slopes.x, p.slopes.x, wf_mul(p.slopes.y, p.slopes.y));
    store(at + 20u, orthographic != 0u ? wf_fma(bent, bend, p.z) : wf_mul(p.z, p.length_));
}

void store_record(uint number, Tile tile, Placed p, uvec4 voxel) {
    vec3 color = vec3(float(voxel.x >> 16), float(voxel.y & 0xffffu), float(voxel.y >> 16));
    for (int i = 0; i < 3; i++) color[i] = wf_mul(color[i], color_scale);
    if (p.is_splat && mark_splats != 0u) color = vec3(marked_color[0], marked_color[1], marked_color[2]);
    if (lit != 0u) color = shade(color, int(voxel.w), p.slopes, p.length_);
    for (int i = 0; i < 3; i++) color[i] = wf_mul(color[i], p.factor);
    uint at = number * record_words;
    if (p.is_splat) {
        store_splat(at, tile, p, color);
        return;
    }
    for (uint i = 0u; i < 3u; i++) store(at + i, color[i]);
    store(at + 3u, p.last);
    records[at + 4u] = p.window;
}

void main() {
    uint number = first_pair + group_number(), lane = gl_LocalInvocationIndex;
    if (number >= end_pair) return;
    Pair pair = pairs[number];
    Tile tile = tiles[pair.tile];
    uint span = uint(pair.slice_last - pair.slice_first) + 1u;
    for (uint s = lane; s <= span; s += 64u) begins[s] = 0u;
    barrier();
    for (uint i = lane; i < pair.count; i += 64u) {
        Placed p = place(pair, tile, voxels[pair.first_voxel + i]);
        if (p.shows) atomicAdd(begins[uint(p.slice - pair.slice_first)], 1u);
    }
    barrier();
    if (lane == 0u) {
        uint sum = pair.first_record, splats = 0u;
        for (uint s = 0u; s <= span; s++) {
            uint here = begins[s];
            if (pair.slice_first + int(s) < point_slice) splats += here;
            begins[s] = sum;
            sum += here;
        }
        atomicAdd(splat_count, splats);
        atomicAdd(point_count, sum - pair.first_record - splats);
    }
    barrier();
    for (uint s = lane; s <= span; s += 64u) runs[pair.first_run + s] = begins[s];
    for (uint first = 0u; first < pair.count; first += 64u) {
        for (uint s = lane; s < 2u * span; s += 64u) masks[s] = 0u;
        barrier();
        uint i = first + lane, word = 0u;
        uvec4 voxel = voxels[pair.first_voxel + min(i, pair.count - 1u)];
        Placed p = place(pair, tile, voxel);
        p.shows = p.shows && i < pair.count;
        uint at = 2u * uint(p.slice - pair.slice_first);
        if (p.shows) atomicOr(masks[at + lane / 32u], 1u << lane % 32u);
        barrier();
        if (p.shows) {
            uint before = bitCount(masks[at + lane / 32u] & (1u << lane % 32u) - 1u);
            if (lane >= 32u) before += bitCount(masks[at]);
            store_record(begins[at / 2u] + before, tile, p, voxel);
        }
        barrier();
        for (uint s = lane; s < span; s += 64u) begins[s] += bitCount(masks[2u * s]) + bitCount(masks[2u * s + 1u]);
        barrier();
    }
}
