// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A surfel to its ellipse and its depths (docs/math.md sections 3 to 5; src/surface/pipeline_project.h). An
// instance is a surfel; packets are attributes of sixteen instances.

layout(location = 0) in vec4 local;       // position in its packet, sigma
layout(location = 1) in ivec2 oct;        // normal
layout(location = 2) in uvec2 axis_code;  // angle, ratio
layout(location = 3) in uvec4 color_code; // red, green, blue, opacity
layout(location = 4) in float curvature;
layout(location = 5) in vec4 packet_at;   // of the packet: pixels of its slope, slope
layout(location = 6) in vec4 packet_rest; // rest x, y, depth
layout(location = 7) in uvec4 packet_bits; // form of colours; lanes | cut << 16; own lines; the first of them
layout(location = 8) in uint material_code;

flat out vec4 shape;   // centre, xx, xy
flat out vec4 key_at;  // yy; key at the centre, its gradient
flat out vec4 range;   // smallest, largest key; tolerance; z
flat out vec4 extra;   // raycast: sqrt|V|, range of z over that at the centre
#if WITH_CLIPS
flat out vec3 lines[MAX_LINES]; // inward, offset: from the corner of the band
flat out uint line_bits;         // how many | either << 8
#endif

bool alive, by_rays;
float z, inverse_z, sigma, ratio, facing, half_range, part, k, root_k;
vec2 base, offset, slope;  // offset: from base, over the focal lengths
vec3 n, axis;
float major, minor;
vec3 s_xy;                 // covariance 11, 12, 22
vec2 s_z;                  // 13, 23
vec2 shift;                // of the centre, over the focal lengths times zoom
float peak, root_det;
vec2 half_px;
vec2 key_slope;

vec3 turn(vec3 v) { return vec3(dot(rotation[0].xyz, v), dot(rotation[1].xyz, v), dot(rotation[2].xyz, v)); }

void place_surfel() {
    vec3 to = turn(local.xyz) * zoomed.w;
    base = packet_at.xy;
    z = packet_rest.z + to.z;
    if (has(ORTHOGRAPHIC)) {
        inverse_z = 1.0;
        slope = vec2(0.0);
        offset = packet_rest.xy + to.xy;
        return;
    }
    inverse_z = 1.0 / z;
    offset = (packet_rest.xy + (to.xy - packet_at.zw * to.z)) * inverse_z;
    slope = packet_at.zw + offset;
}

void turn_surfel() {
    vec2 uv = vec2(oct) / 32767.0;
    vec3 n_world = vec3(uv, 1.0 - abs(uv.x) - abs(uv.y));
    float fold = max(-n_world.z, 0.0);
    n_world.x -= uv.x < 0.0 ? -fold : fold;
    n_world.y -= uv.y < 0.0 ? -fold : fold;
    n_world = normalize(n_world);
    n = turn(n_world);
    if (float(oct.x) == BILLBOARD) n = vec3(0.0, 0.0, -1.0);
    float root = float(axis_code.y) / 65535.0;
    ratio = root * root * root * root;
    float c = 1.0 - float(axis_code.x) / 32768.0, s = 1.0 - abs(c);
    vec2 cs = normalize(vec2(c, s));
    float side = n_world.z < 0.0 ? -1.0 : 1.0, a = -1.0 / (side + n_world.z), b = n_world.x * n_world.y * a;
    vec3 u = vec3(1.0 + side * n_world.x * n_world.x * a, side * b, -side * n_world.x);
    vec3 v = vec3(b, side + n_world.y * n_world.y * a, -n_world.y);
    axis = turn(cs.x * u + cs.y * v);
}

void find_range() {
    float part33 = dot(n.xy, n.xy), ratio2 = ratio * ratio;
    part33 = (1.0 - ratio2) * axis.z * axis.z + ratio2 * part33;
    half_range = sigma * kernel.x * sqrt(max(part33, 0.0));
    if (has(ORTHOGRAPHIC)) {
        alive = alive && 0.0 < z;
        facing = n.z;
        by_rays = depth.z < sigma;
        part = 0.0;
        root_k = 1.0;
    } else {
        alive = alive && -half_range < z;
        facing = n.z + dot(n.xy, slope);
        by_rays = z <= max(half_range * NEAR_RATIO, sigma * depth.z);
        part = half_range * inverse_z;
        root_k = inversesqrt(1.0 - part * part);
    }
}

void find_covariance() {
    major = sigma * inverse_z * zoomed.z;
    minor = major * ratio;
    float minor2 = minor * minor;
    vec2 m = n.xy - slope * n.z;
    s_xy.x = minor2 * (1.0 + slope.x * slope.x - m.x * m.x);
    s_xy.z = minor2 * (1.0 + slope.y * slope.y - m.y * m.y);
    s_xy.y = minor2 * (slope.x * slope.y - m.x * m.y);
    s_z = -minor2 * (m * n.z + slope);
    float more = major * major - minor2;
    vec2 b = axis.xy - slope * axis.z, e = more * b;
    s_xy += vec3(e.x * b.x, e.x * b.y, e.y * b.y);
    s_z += e * axis.z;
}

// A disc that is parallel to the picture.
void make_point() {
    major = point.z;
    minor = point.w;
    sigma = sums.z * (has(ORTHOGRAPHIC) ? 1.0 : z);
    s_xy = vec3(point.x * point.x, 0.0, point.y * point.y);
    s_z = vec2(0.0);
    n = vec3(0.0, 0.0, -1.0);
    facing = -1.0;
    half_range = part = 0.0;
    root_k = 1.0;
    by_rays = false;
    alive = alive && 0.0 < z;
}

void source_shape(vec3 v) {
    alive = alive && SINGULAR * v.x * v.z <= root_det * root_det && MIN_AREA <= root_det;
    float inverse_det = 1.0 / root_det, scale = inversesqrt(v.x + v.z + 2.0 * root_det) * inverse_det;
    vec3 a = vec3(v.z + root_det, -v.y, v.x + root_det) * scale;
    float along_x = a.x * a.x + a.y * a.y, along_y = a.z * a.z + a.y * a.y, crossed = a.y * (a.x + a.z);
    float filtered = kernel.z * inverse_det * inverse_det;
    float determinant_ = 1.0 + kernel.z * (along_x + along_y + filtered);
    peak = inversesqrt(determinant_);
    shape.z = (along_x + filtered) / determinant_;
    shape.w = 2.0 * crossed / determinant_;
    key_at.x = (along_y + filtered) / determinant_;
}

void circular_shape(vec3 w) {
    float mean = 0.5 * (w.x + w.z), difference = mean - w.z;
    float variance = mean + sqrt(difference * difference + w.y * w.y);
    peak = root_det / variance;
    shape.z = key_at.x = 1.0 / variance;
    shape.w = 0.0;
    half_px = vec2(kernel.x * sqrt(variance));
}

// The shape is V; what the fragment program makes of it depends on the depth there.
void raycast_shape(vec3 v) {
    float largest = (1.0 + part) * root_k * root_k;
    shape.zw = v.xy;
    key_at.x = v.z;
    peak = root_det;
    half_px = kernel.x * sqrt(largest * largest * v.xz + kernel.z);
    extra.x = root_det;
}

// The range of w = z / z(x) on the disc: it is linear on the picture.
void find_ray() {
    vec2 g = key_slope * z;
    float variance = g.x * g.x * shape.z + 2.0 * g.x * g.y * shape.w + g.y * g.y * key_at.x;
    float steepness = min(kernel.x * sqrt(max(variance, 0.0)), 1.0 / NEAR_RATIO);
    extra.yz = vec2(1.0 / (1.0 + steepness), 1.0 / (1.0 - steepness));
}

void find_shape() {
    vec2 f = zoomed.xy;
    bool projective = !has(AFFINE | ORTHOGRAPHIC);
    float root = has(AFFINE) ? 1.0 : root_k;
    k = root * root;
    shift = projective ? -kernel.y * sums.w * k * s_z : vec2(0.0);
    vec2 c = shift / kernel.x;
    vec3 v = vec3(f.x * f.x * (c.x * c.x + s_xy.x * k), f.x * f.y * (c.x * c.y + s_xy.y * k),
                  f.y * f.y * (c.y * c.y + s_xy.z * k));
    root_det = abs(minor * major * f.x * f.y * facing) * k * root;
    vec3 w = v + vec3(kernel.z, 0.0, kernel.z);
    float det = root_det * root_det + kernel.z * (v.x + v.z + kernel.z);
    alive = alive && FLAT * w.x * w.z < det && MIN_SPLAT <= root_det;
    peak = root_det * inversesqrt(det);
    shape.zw = vec2(w.z, -2.0 * w.y) / det;
    key_at.x = w.x / det;
    half_px = kernel.x * sqrt(w.xz);
    if (has(SOURCE)) source_shape(v);
    if (has(CIRCULAR)) circular_shape(w);
    float edge_on = EDGE_ON * sqrt(1.0 + dot(slope, slope));
    if (has(RAYCAST)) {
        raycast_shape(v);
        alive = alive && edge_on <= abs(facing);
    }
    float tilt = inverse_z / max(abs(facing), edge_on);
    key_slope = n.xy * (facing < 0.0 ? -tilt : tilt) * focal.zw;
}

// How far the splat moves away from its contour, in pixels (semantics.h, section 5).
vec2 contour_way(bool clipped, out bool concave) {
    concave = false;
    float steepness = length(key_slope), sine2 = facing * facing, size = CONTOUR_WIDTH * major * zoomed.x;
    float across = sqrt(size * size * sine2 + kernel.z);
    float bend = min(max(curvature, 0.0) * contour.z * (has(ORTHOGRAPHIC) ? 1.0 : z), 1e30);
    float reach = min(across * CONTOUR_REACH * bend, contour.y);
    if (clipped || !(sine2 < reach) || !(0.0 < steepness)) return vec2(0.0);
    float share = 1.0 - sine2 / reach, way = across * contour.x * share / steepness;
    bool turns_away = facing < 0.0;
    concave = !turns_away && CONTOUR_CONCAVE < share;
    return key_slope * (turns_away ? way : -way);
}

// The key at the centre, its range, and the tolerance; `moved` is the centre from the projected one, in pixels.
void find_depths(vec2 moved) {
    float steepness = length(key_slope), support = kernel.x * sigma, reach = kernel.w * steepness, reach_depth = reach;
    float limit = min(FREE_RADII * support, FREE_DEPTH * z), key, low, high;
    float per_depth = has(ORTHOGRAPHIC) ? 1.0 : inverse_z * inverse_z;
    if (has(ORTHOGRAPHIC)) {
        key = -z + dot(key_slope, moved);
        low = -(z + half_range);
        high = half_range - z;
    } else {
        float whole = root_k * root_k * inverse_z;
        key = inverse_z + dot(key_slope, moved);
        low = (1.0 - part) * whole;
        high = (1.0 + part) * whole;
        reach_depth *= z * z;
    }
    float margin = max(limit * per_depth - reach, 0.0);
    if (has(CIRCULAR)) margin += min(half_px.x * steepness, GRAZING_TOLERANCE * support * per_depth);
    low -= margin;
    if (has(CIRCULAR) && !has(ORTHOGRAPHIC)) low = max(low, MIN_KEY * inverse_z);
    float tolerance = depth.x * sigma + min(depth.y * reach_depth, GRAZING_TOLERANCE * support);
    key_at.yzw = vec3(key, key_slope);
    range = vec4(low, high + margin, tolerance, z);
}
