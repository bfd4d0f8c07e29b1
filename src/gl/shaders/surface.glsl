// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From sums to surfaces, surfaces to pixels: src/surface/pipeline_side_sums.h (finalize), pipeline_shade.h,
// pipeline_resolve.h. PASS is 3 for the first surface, 4 for those behind (edges.glsl), 5 for the picture. A pixel by each
// invocation.

#if PASS != 4
layout(local_size_x = TILE_PX, local_size_y = TILE_PX) in;
layout(std430, binding = 3) buffer TileBlock { Tile tiles[]; };
#endif
#if PASS == 3
layout(std430, binding = 1) buffer NearestBlock { uint nearest[]; };
#endif
#if PASS == 5
layout(std430, binding = 14) writeonly buffer ResultBlock { uint result[]; }; // bytes, then planes: those that are wanted
#endif
layout(std430, binding = 15) readonly buffer EnvironmentBlock { float texels[]; };

// Of the first surface its channels; of those behind red, green, blue, alpha; the first one's cut: cover, x, y, flag; the key
// that what is behind lies beyond; the nearest that was found there, while more of it is to come.
layout(std430, binding = 2) buffer SurfaceBlock { float surfaces[]; };
#define FINALIZED(channel) surfaces[(channel) * pixel_count + pixel]
#define BEHIND(plane) surfaces[(uint(CHANNELS) + (plane)) * pixel_count + pixel]
#define PASSED BEHIND(8u)
#define FOUND BEHIND(9u)

const uint EDGE_ANTIALIASING = 1u, TRANSPARENT = 2u, ONE_PASS = 4u, ORTHOGRAPHIC_VIEW = 8u;
const uint UNSHADED = 0u, LAMBERT = 1u, LIGHTS = 2u, PHONG = 3u;

struct Surface { float sums[CHANNELS]; float cover, cut_x, cut_y; };

uvec2 in_picture;

float inverse_weight(float weight) {
    bool covered = 0.0 < weight;
    return wf_keep(covered, wf_div(1.0, covered ? weight : 1.0));
}

float rounded(uint low, uint high) {
    int upper = int(high) + int(low >> 16);
    return wf_fma(float(upper), 65536.0, float(low & 0xffffu));
}

float read_sum(uint channel, uint word) {
    uint at = (channel * WORDS + word) * pixel_count + pixel;
    return rounded(sums[at], sums[at + pixel_count]);
}

float read_back_facing(uint channel, uint word) {
    uint at = (channel * WORDS + word) * pixel_count + pixel;
    return rounded(is_back[at], is_back[at + pixel_count]);
}

#if PASS == 3 || PASS == 4
shared uint still_open;

float sum_units(uint channel, bool finely, bool of_back_facing) {
    float units = of_back_facing ? read_back_facing(channel, 0u) : read_sum(channel, 0u);
#if WITH_FINE || WITH_DEPTH || WITH_CLIPS
    if (finely)
        return wf_fma(of_back_facing ? read_back_facing(channel, 2u) : read_sum(channel, 2u), FINE_UNIT, units);
#endif
    return units;
}

#if WITH_DEPTH
float mean_depth(bool of_back_facing, float key) {
    float weight = sum_units(0u, true, of_back_facing);
    bool some = 0.0 < weight;
    float share = wf_keep(some, wf_div(sum_units(DEPTH_CHANNEL, true, of_back_facing), some ? weight : 1.0));
    if (has(to.flags, ORTHOGRAPHIC_VIEW)) return wf_mul(share, to.depth_per_share);
    bool seen = 0.0 < key;
    return wf_keep(seen, wf_div(share, seen ? key : 1.0));
}
#endif

// Reads the sums of the pixel (finalize_block), whose first surface has a key, and sets them back; `merged`: of all that is left.
Surface finalize(bool block_is_cut, bool first, bool merged, float key) {
    Surface s;
    bool finely = WITH_FINE != 0 || block_is_cut;
    float other[CHANNELS];
    for (uint c = 0u; c < uint(CHANNELS); c++) {
        s.sums[c] = sum_units(c, finely, false);
        other[c] = sum_units(c, finely, true);
    }
#if WITH_DEPTH
    if (first) {
        s.sums[DEPTH_CHANNEL] = wf_mul(mean_depth(false, key), s.sums[0]);
        other[DEPTH_CHANNEL] = wf_mul(mean_depth(true, key), other[0]);
    }
#endif
    float of_front = 1.0, of_back = 1.0, front = s.sums[0], back = other[0];
    if (!merged) {
        bool some_front = 0.0 < front, some_back = 0.0 < back;
        float share = wf_min(wf_mul(front, to.front_scale), 1.0), all_weight = wf_add(front, back);
        float behind = wf_keep(some_back, wf_sub(1.0, share));
        of_front = wf_keep(some_front, wf_div(wf_mul(all_weight, wf_sub(1.0, behind)), some_front ? front : 1.0));
        of_back = wf_div(wf_mul(all_weight, behind), some_back ? back : 1.0);
    }
    for (uint c = 0u; c < uint(CHANNELS); c++) s.sums[c] = wf_fma(of_back, other[c], wf_mul(of_front, s.sums[c]));
    s.cover = s.cut_x = s.cut_y = 0.0;
#if WITH_CLIPS
    if (block_is_cut && !merged) {
        float noted[4];
        for (uint c = 0u; c < 4u; c++) {
            uint at = c * 2u * pixel_count + pixel;
            noted[c] = rounded(cut[at], cut[at + pixel_count]);
        }
        float q = s.sums[0], whole_weight = noted[1], x = noted[2], y = noted[3];
        float uncut = wf_max(wf_sub(q, noted[0]), 0.0);
        bool some = 0.0 < whole_weight;
        float along = wf_div(wf_sqrt(wf_fma(x, x, wf_mul(y, y))), some ? whole_weight : 1.0);
        float alone = wf_clamp(wf_mul(wf_sub(along, EDGES_OPPOSE), EDGES_SLOPE), 0.0, 1.0);
        float expected = wf_max(wf_fma(alone, whole_weight, uncut), to.covering);
        float covered = wf_max(wf_mul(uncut, to.alpha_scale), wf_div(q, expected));
        s.cover = wf_min(covered, 1.0);
        float per = wf_keep(some, wf_div(1.0, wf_add(uncut, some ? whole_weight : 1.0)));
        s.cut_x = wf_mul(x, per);
        s.cut_y = wf_mul(y, per);
    }
    for (uint i = 0u; i < 8u; i++) cut[i * pixel_count + pixel] = 0u;
#endif
    for (uint i = 0u; i < uint(CHANNELS) * WORDS; i++) {
        sums[i * pixel_count + pixel] = 0u;
        is_back[i * pixel_count + pixel] = 0u;
    }
    return s;
}
#endif

float surface_alpha(float weight, float opacity_sum, bool with_cover, float cover) {
    float coverage = wf_keep(0.0 < weight, 1.0);
    if (has(to.flags, EDGE_ANTIALIASING)) coverage = with_cover ? cover : wf_min(1.0, wf_mul(weight, to.alpha_scale));
    if (!has(to.flags, TRANSPARENT)) return coverage;
    float opacity = to.opacity;
#if WITH_OPACITY
    opacity = wf_mul(opacity, wf_mul(opacity_sum, inverse_weight(weight)));
#endif
    return wf_mul(coverage, opacity);
}

#if PASS == 4 || PASS == 5
vec3 toward_eye() {
    if (has(to.flags, ORTHOGRAPHIC_VIEW)) return vec3(0.0, 0.0, -1.0);
    float px = float(in_picture.x) + 0.5, py = float(in_picture.y) + 0.5;
    return vec3(wf_fma(px, -to.ray_x[0], -to.ray_x[1]), wf_fma(py, -to.ray_y[0], -to.ray_y[1]), -1.0);
}

float shaded_length2(vec3 normal, float weight) {
    float minimum = wf_mul(weight, SHADED_NORMAL);
    return wf_max(dot3(normal, normal), wf_mul(minimum, minimum));
}

shared vec3 directions[TILE_PX * TILE_PX];
shared uint shown_pixels[TILE_PX * TILE_PX];

float footprint2(vec3 d, bool shown) {
    uint here = gl_LocalInvocationID.y * uint(TILE_PX) + gl_LocalInvocationID.x;
    barrier();
    directions[here] = d;
    shown_pixels[here] = shown ? 1u : 0u;
    barrier();
    float largest = 0.0;
    for (int k = 0; k < 2; k++) {
        uint other = k == 0 ? here ^ 1u : here ^ uint(TILE_PX);
        if (shown_pixels[other] == 0u) continue;
        float x = wf_sub(d.x, directions[other].x), y = wf_sub(d.y, directions[other].y),
              z = wf_sub(d.z, directions[other].z);
        float distance2 = wf_add(wf_add(wf_mul(x, x), wf_mul(y, y)), wf_mul(z, z));
        largest = distance2 > largest ? distance2 : largest;
    }
    return largest;
}

void add_level(uint index, float u, float v, float weight, inout vec3 light) {
    Level level = to.levels[index];
    float x = wf_sub(wf_mul(u, float(level.width)), 0.5), y = wf_sub(wf_mul(v, float(level.height)), 0.5);
    float x_floor = floor(x), y_floor = floor(y), share_x = wf_sub(x, x_floor), share_y = wf_sub(y, y_floor);
    for (int row = 0; row < 2; row++) {
        int texel_y = int(y_floor) + row, turn = 0;
        if (texel_y < 0 || texel_y >= int(level.height)) {
            texel_y = texel_y < 0 ? 0 : int(level.height) - 1;
            turn = int(level.width) / 2;
        }
        for (int column = 0; column < 2; column++) {
            int texel_x = int(x_floor) + column + turn;
            if (texel_x < 0) texel_x += int(level.width);
            if (texel_x >= int(level.width)) texel_x -= int(level.width);
            uint at = level.first + 3u * uint(texel_y * int(level.width) + texel_x);
            float share = wf_mul(wf_mul(weight, row != 0 ? share_y : wf_sub(1.0, share_y)),
                                 column != 0 ? share_x : wf_sub(1.0, share_x));
            for (uint c = 0u; c < 3u; c++) light[c] = wf_add(light[c], wf_mul(share, texels[at + c]));
        }
    }
}

vec3 reflected(vec3 normal, vec3 view, bool shown) {
    float twice = wf_mul(dot3(normal, view), 2.0);
    vec3 mirrored;
    for (int i = 0; i < 3; i++) mirrored[i] = wf_fma(twice, normal[i], wf_negate(view[i]));
    float turn[9] = to.environment_from_camera;
    vec3 d = rotate(turn, mirrored);
    float horizontal = wf_sqrt(wf_fma(d.x, d.x, wf_mul(d.z, d.z)));
    float longitude = wf_atan2(d.x, d.z), latitude = wf_atan2(d.y, horizontal);
    float u = wf_clamp(wf_fma(longitude, -0.159154943, 0.5), 0.0, 1.0);
    float v = wf_clamp(wf_fma(latitude, -0.318309886, 0.5), 0.0, 1.0);
    float footprint = wf_mul(footprint2(d, shown), to.texels_per_radian);
    vec3 light = vec3(0.0);
    if (!shown) return light;
    float level = wf_mul(0.5, wf_log2(wf_max(footprint, 1.0)));
    level = wf_min(level, float(to.level_count - 1u));
    uint fine = uint(level);
    float share = wf_sub(level, float(fine));
    add_level(fine, u, v, wf_sub(1.0, share), light);
    if (share > 0.0) add_level(fine + 1u, u, v, share, light);
    return light;
}

// Straight colour of the surface (shade_block, gathered_surface). All invocations of a group call it.
vec3 shade(float s[CHANNELS]) {
    float weight = s[0];
#if WITH_OPACITY
    float color_weight = s[CHANNELS - 1];
#else
    float color_weight = s[0];
#endif
    float factor = wf_mul(inverse_weight(color_weight), to.color_unit);
    vec3 color = vec3(s[1], s[2], s[3]);
    if (to.shading == UNSHADED) return scale3(color, factor);
#if WITH_NORMAL
    vec3 normal = vec3(s[4], s[5], s[6]);
    float length2 = shaded_length2(normal, weight);
    if (to.shading == LAMBERT) {
        vec3 light;
        bool defined = 0.0 < length2;
        if (to.lights[0].headlight != 0u && !has(to.flags, ORTHOGRAPHIC_VIEW)) {
            light = toward_eye();
            length2 = wf_mul(length2, dot3(light, light));
        } else {
            light = vec3(to.lights[0].toward[0], to.lights[0].toward[1], to.lights[0].toward[2]);
        }
        float inverse_ = wf_keep(defined, wf_inverse_root(length2));
        float facing = wf_max(wf_mul(dot3(normal, light), inverse_), 0.0);
        return scale3(color, wf_mul(factor, wf_fma(to.material[1], facing, to.material[0])));
    }
    bool shown = 0.0 < weight;
    float inverse_ = inverse_weight(weight);
    normal = scale3(normal, wf_keep(0.0 < length2, wf_inverse_root(length2)));
    vec3 view = toward_eye();
    if (!has(to.flags, ORTHOGRAPHIC_VIEW)) view = scale3(view, wf_inverse_root(dot3(view, view)));
    float material[5];
    for (uint i = 0u; i < 5u; i++) {
#if WITH_MATERIAL
        material[i] = wf_mul(wf_mul(s[8u + i], inverse_), to.material_units[i]);
#else
        material[i] = to.material[i];
#endif
    }
    vec3 diffuse = vec3(0.0), specular = vec3(0.0);
    float sight = dot3(normal, view);
    for (uint k = 0u; k < to.light_count; k++) {
        Light from = to.lights[k];
        vec3 toward = from.headlight != 0u ? view : vec3(from.toward[0], from.toward[1], from.toward[2]);
        float facing = wf_max(dot3(normal, toward), 0.0), power = facing;
        for (int i = 0; i < 3; i++) diffuse[i] = wf_fma(from.color[i], facing, diffuse[i]);
        if (to.shading != PHONG) continue;
        if (from.headlight == 0u) {
            float across2 = wf_max(wf_fma(2.0, dot3(toward, view), 2.0), 0.0);
            power = wf_mul(wf_add(facing, sight), wf_inverse_root(across2));
        }
        power = wf_power(power, material[3]);
        float highlight = wf_keep(0.0 < facing && MIN_POWER < power, power);
        for (int i = 0; i < 3; i++) specular[i] = wf_fma(from.color[i], highlight, specular[i]);
    }
    vec3 mirrored = vec3(0.0);
    bool mirrors = to.shading == PHONG && to.level_count != 0u;
    if (mirrors) mirrored = reflected(normal, view, shown);
    float inverse_color = factor;
    vec3 seen_color;
    for (int i = 0; i < 3; i++) {
        float straight = wf_mul(color[i], inverse_color);
        float seen = wf_mul(straight, wf_fma(material[1], diffuse[i], material[0]));
        if (to.shading == PHONG) seen = wf_fma(material[2], specular[i], seen);
        if (mirrors) seen = wf_fma(material[4], mirrored[i], seen);
        seen_color[i] = shown ? seen : 0.0;
    }
    return seen_color;
#else
    return scale3(color, factor);
#endif
}
#endif

#if PASS == 3
void main() {
    uint tile = group_number();
    if (tile >= tile_count) return;
    uvec2 in_band = uvec2(tile % tiles_per_row, tile / tiles_per_row) * uint(TILE_PX) + gl_LocalInvocationID.xy;
    bool inside = all(lessThan(in_band, band_px));
    pixel_count = band_px.x * band_px.y;
    pixel = in_band.y * band_px.x + in_band.x;
    if (gl_LocalInvocationIndex == 0u) still_open = 0u;
    bool block_is_cut = false;
#if WITH_CLIPS
    uint flag = 8u * pixel_count + in_band.y / 4u * ((band_px.x + 3u) / 4u) + in_band.x / 4u;
    if (inside) block_is_cut = cut[flag] != 0u;
#endif
    barrier();
    if (inside) {
        float key = float_of(nearest[pixel]);
        nearest[pixel] = NEVER;
        Surface s = finalize(block_is_cut, true, false, key);
        for (uint c = 0u; c < uint(CHANNELS); c++) FINALIZED(c) = s.sums[c];
        BEHIND(4u) = s.cover;
        BEHIND(5u) = s.cut_x;
        BEHIND(6u) = s.cut_y;
        BEHIND(7u) = block_is_cut ? 1.0 : 0.0;
        if (layers > 1u) {
            float alpha = surface_alpha(s.sums[0], s.sums[CHANNELS - 1], block_is_cut, s.cover);
            for (uint c = 0u; c < 4u; c++) BEHIND(c) = 0.0;
            bool wanted = -INF < key && alpha < 1.0;
            PASSED = wanted ? key : -INF;
            if (wanted) still_open = 1u;
        }
#if WITH_CLIPS
        cut[flag] = 0u;
#endif
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        tiles[tile].open = still_open;
        tiles[tile].step = 0u;
    }
}
#endif

#if PASS == 5
void main() {
    uint tile = group_number();
    if (tile >= tile_count || unfinished_count != 0u) return;
    uvec2 in_band = uvec2(tile % tiles_per_row, tile / tiles_per_row) * uint(TILE_PX) + gl_LocalInvocationID.xy;
    bool inside = all(lessThan(in_band, band_px));
    pixel_count = band_px.x * band_px.y;
    pixel = inside ? in_band.y * band_px.x + in_band.x : 0u;
    in_picture = first_px + in_band;
    float s[CHANNELS];
    for (uint c = 0u; c < uint(CHANNELS); c++) s[c] = inside ? FINALIZED(c) : 0.0;
    vec3 color = shade(s);
    if (gl_LocalInvocationIndex == 0u) tiles[tile].count = 0u;
    if (!inside || any(greaterThanEqual(in_picture, picture_px))) return;
    float alpha = surface_alpha(s[0], s[CHANNELS - 1], BEHIND(7u) != 0.0, BEHIND(4u));
    vec4 shown = vec4(color, alpha);
    if (alpha < 1.0) {
        float through = wf_sub(1.0, alpha);
        for (int i = 0; i < 3; i++) shown[i] = wf_mul(shown[i], alpha);
        if (layers > 1u) {
            for (uint c = 0u; c < 4u; c++) shown[c] = wf_fma(BEHIND(c), through, shown[c]);
            through = wf_sub(1.0, shown.a);
        }
        for (int i = 0; i < 4; i++) shown[i] = wf_fma(to.background[i], through, shown[i]);
    }
    uint at = in_band.y * picture_px.x + in_picture.x;
    bool broken = false;
    for (int i = 0; i < 4; i++) broken = broken || !(wf_abs(shown[i]) <= LARGEST);
    if (broken) atomicAdd(broken_count, 1u);
    if (with_codes != 0u) result[at] = color_code(shown);
    if (rgba_at >= 0)
        for (int i = 0; i < 4; i++) result[uint(rgba_at) + at * 4u + uint(i)] = floatBitsToUint(shown[i]);
    bool covered = 0.0 < s[0];
#if WITH_DEPTH
    if (depth_at >= 0)
        result[uint(depth_at) + at] = floatBitsToUint(
            covered ? wf_mul(wf_mul(s[DEPTH_CHANNEL], inverse_weight(s[0])), to.depth_unit) : INF);
#endif
    if (coverage_at >= 0)
        result[uint(coverage_at) + at] = floatBitsToUint(
            has(to.flags, ONE_PASS) ? wf_keep(covered, 1.0) : wf_mul(s[0], to.unit_coverage_inverse));
#if WITH_NORMAL
    if (normal_at >= 0) {
        vec3 unit = vec3(s[4], s[5], s[6]);
        float length2 = dot3(unit, unit);
        unit = scale3(unit, wf_keep(0.0 < length2, wf_inverse_root(length2)));
        float turn[9] = to.to_world;
        unit = rotate(turn, unit);
        for (int i = 0; i < 3; i++) result[uint(normal_at) + at * 3u + uint(i)] = floatBitsToUint(unit[i]);
    }
#endif
}
#endif
