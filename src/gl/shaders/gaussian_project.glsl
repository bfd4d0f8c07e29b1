// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Records of the splats that some pixel may show: src/volume/gaussian_project.h, a splat by each invocation. After
// gaussian_frame.glsl. Records may lie anywhere, since only keys and slots decide what comes before what.

// Camera and options of a frame for the splats of a set: ewa_gaussian_view.
struct View {
    uint orthographic, trained, flat_, normals, keep;
    uint sh_degree, harmonic_count;
    uint with_colors, with_lanes; // colours in place of those of packets; some splats are hidden
    float fx_px, fy_px, cx_px, cy_px, width_px, height_px, last_column, last_row;
    float turn[9], origin[3], eye[3], forward[3], slopes[4];
    float near, cutoff2, prefilter_px2, dot_px2, log2_min, minimum_alpha, set_unit;
    float inverse_dot; // one over `dot_px2`, 1 where that is 0
};

// Packets of a set in a page, one after the other: where the first is, and its number among those of this dispatch and of all.
struct Segment { uint first, at, slot, view; };

layout(std430, binding = 0) readonly buffer ViewBlock { View views[]; };
layout(std430, binding = 1) readonly buffer PacketBlock { float packets[]; };      // [packet][number][lane]
layout(std430, binding = 2) readonly buffer HarmonicBlock { uint harmonics[]; };   // [packet][harmonic][lane / 2], 16 bits each
layout(std430, binding = 3) readonly buffer SegmentBlock { Segment segments[]; };
layout(std430, binding = 4) writeonly buffer KeyBlock { uint keys[]; };            // [slot]
layout(std430, binding = 5) writeonly buffer RecordNumberBlock { uint numbers[]; };  // [slot]
layout(std430, binding = 6) writeonly buffer RecordBlock { vec4 records[]; };
layout(std430, binding = 7) writeonly buffer BoxBlock { uvec2 boxes[]; };          // [record] tiles: first, end

layout(std430, binding = 9) readonly buffer ColorBlock { float colors[]; };        // [packet][colour][lane]
layout(std430, binding = 10) readonly buffer LaneBlock { uint lanes[]; };          // [packet / 2], 16 bits each

layout(location = 0) uniform uint first_segment;
layout(location = 1) uniform uint end_segment;
layout(location = 2) uniform uint packet_count; // of the dispatch

const uint LANES = 16u, NUMBERS = 15u, PLACE = 0u, SCALE = 3u, ROTATION = 6u, OPACITY = 10u, COLOR = 11u, HARMONIC_UNIT = 14u;

View view;
uint packet, lane; // in the page

float number_of(uint number) { return packets[(packet * NUMBERS + number) * LANES + lane]; }

// A splat in camera space: splat_lanes.
struct Splat {
    vec3 place, direction, scales;
    vec3 axes[3];
    float cutoff2, depth_reach, x, y, inverse_;
};

struct Record {
    float x, y, ax, ay, by, limit, log2_alpha, reach, touch;
    vec3 color;
    float g[9], length_, low, high;
    float dot_, dot_x, dot_y, dot_z;
};

float turn_row(uint row, vec3 v) {
    return wf_fma(view.turn[3u * row], v.x, wf_fma(view.turn[3u * row + 1u], v.y, wf_mul(view.turn[3u * row + 2u], v.z)));
}

void quaternion_axes(vec4 q, out vec3 axes[3]) {
    float w = q.x, x = q.y, y = q.z, z = q.w;
    axes[0].x = wf_fnma(2.0, wf_fma(y, y, wf_mul(z, z)), 1.0);
    axes[1].y = wf_fnma(2.0, wf_fma(x, x, wf_mul(z, z)), 1.0);
    axes[2].z = wf_fnma(2.0, wf_fma(x, x, wf_mul(y, y)), 1.0);
    float wx = wf_mul(w, x), wy = wf_mul(w, y), wz = wf_mul(w, z);
    axes[0].y = wf_mul(2.0, wf_fma(x, y, wz));
    axes[1].x = wf_mul(2.0, wf_sub(wf_mul(x, y), wz));
    axes[2].x = wf_mul(2.0, wf_fma(x, z, wy));
    axes[0].z = wf_mul(2.0, wf_sub(wf_mul(x, z), wy));
    axes[1].z = wf_mul(2.0, wf_fma(y, z, wx));
    axes[2].y = wf_mul(2.0, wf_sub(wf_mul(y, z), wx));
}

vec4 rotation() {
    return vec4(number_of(ROTATION), number_of(ROTATION + 1u), number_of(ROTATION + 2u), number_of(ROTATION + 3u));
}

// Whether the splat may show by its depth and opacity.
bool place_splat(float opacity, out Splat s) {
    vec3 center, world[3], offset;
    for (int i = 0; i < 3; i++) center[i] = wf_mul(view.set_unit, number_of(PLACE + uint(i)));
    for (int i = 0; i < 3; i++) {
        s.place[i] = wf_add(turn_row(uint(i), center), view.origin[i]);
        s.scales[i] = wf_max(wf_mul(view.set_unit, number_of(SCALE + uint(i))), SHORTEST_SCALE);
        offset[i] = wf_sub(center[i], view.eye[i]);
    }
    quaternion_axes(rotation(), world);
    float depth2 = 0.0;
    for (int i = 0; i < 3; i++) {
        for (int c = 0; c < 3; c++) s.axes[i][c] = turn_row(uint(c), world[i]);
        float t = wf_mul(s.scales[i], s.axes[i].z);
        depth2 = wf_fma(t, t, depth2);
    }
    float seen = wf_sub(wf_log2(wf_max(opacity, FAINTEST)), view.log2_min);
    s.cutoff2 = wf_min(wf_mul(seen, TWO_LN_2), view.cutoff2);
    bool shows = 0.0 < s.cutoff2;
    s.cutoff2 = wf_max(s.cutoff2, 0.0);
    s.depth_reach = wf_sqrt(wf_mul(s.cutoff2, depth2));
    s.x = s.place.x;
    s.y = s.place.y;
    s.inverse_ = 1.0;
    s.direction = vec3(view.forward[0], view.forward[1], view.forward[2]);
    if (view.orthographic != 0u) return shows;
    float shrink = wf_div(1.0, wf_sqrt(wf_max(dot3(offset, offset), SHORTEST_OFFSET2)));
    s.direction = scale3(offset, shrink);
    s.inverse_ = wf_div(1.0, s.place.z);
    s.x = wf_mul(s.place.x, s.inverse_);
    s.y = wf_mul(s.place.y, s.inverse_);
    float depth = view.trained != 0u || view.flat_ != 0u ? s.place.z : wf_add(s.place.z, s.depth_reach);
    return shows && view.near < depth;
}

// wide_ellipse.h.
void project_sums(float sums[5], float k, float cutoff2, out vec3 v, out vec2 shift) {
    float far = wf_mul(cutoff2, k), x = wf_mul(far, sums[3]), y = wf_mul(far, sums[4]);
    shift = vec2(wf_sub(0.0, x), wf_sub(0.0, y));
    v.x = wf_mul(k, wf_fma(x, sums[3], sums[0]));
    v.y = wf_mul(k, wf_fma(x, sums[4], sums[1]));
    v.z = wf_mul(k, wf_fma(y, sums[4], sums[2]));
}

// The ellipse in pixels, and how far its centre lies from the projected one; `dot_` of 2D Gaussians. Returns its determinant.
float true_ellipse(Splat s, out vec3 v, out vec2 shift, out vec3 dot_) {
    float x = s.x, y = s.y, cutoff2 = s.cutoff2;
    bool parallel = view.orthographic != 0u;
    if (view.trained != 0u || parallel) {
        x = wf_min(wf_max(x, view.slopes[0]), view.slopes[1]);
        y = wf_min(wf_max(y, view.slopes[2]), view.slopes[3]);
        cutoff2 = 0.0;
    }
    if (parallel) x = y = 0.0;
    float sums[5] = float[5](0.0, 0.0, 0.0, 0.0, 0.0), depth2 = 0.0, tx[4], ty[4];
    for (int i = 0; i < 3; i++) {
        float tz = wf_mul(s.scales[i], s.axes[i].z);
        tx[i] = wf_mul(s.scales[i], wf_fnma(x, s.axes[i].z, s.axes[i].x));
        ty[i] = wf_mul(s.scales[i], wf_fnma(y, s.axes[i].z, s.axes[i].y));
        sums[0] = wf_fma(tx[i], tx[i], sums[0]);
        sums[1] = wf_fma(tx[i], ty[i], sums[1]);
        sums[2] = wf_fma(ty[i], ty[i], sums[2]);
        sums[3] = wf_fma(tx[i], tz, sums[3]);
        sums[4] = wf_fma(ty[i], tz, sums[4]);
        depth2 = wf_fma(tz, tz, depth2);
    }
    float z2 = wf_mul(s.place.z, s.place.z), k = 1.0;
    if (!parallel) k = wf_div(1.0, wf_fnma(cutoff2, depth2, z2));
    project_sums(sums, k, cutoff2, v, shift);
    dot_ = vec3(0.0);
    if (view.flat_ != 0u) {
        float wide = parallel ? 0.0 : DOT_CUTOFF2, left = wf_fnma(wide, depth2, z2);
        vec3 unused;
        vec2 middle;
        project_sums(sums, parallel ? k : wf_div(1.0, wf_max(left, SHORTEST_OFFSET2)), wide, unused, middle);
        dot_.x = wf_mul(wf_sub(middle.x, shift.x), view.fx_px);
        dot_.y = wf_mul(wf_sub(middle.y, shift.y), view.fy_px);
        dot_.z = wf_keep(parallel || 0.0 < left, 1.0);
    }
    float far = wf_sqrt(wf_max(wf_mul(cutoff2, k), 0.0)), area = 0.0;
    tx[3] = wf_mul(far, sums[3]);
    ty[3] = wf_mul(far, sums[4]);
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < i; j++) {
            float minor = wf_fnma(tx[j], ty[i], wf_mul(tx[i], ty[j]));
            area = wf_fma(minor, minor, area);
        }
    float fx = view.fx_px, fy = view.fy_px;
    v = vec3(wf_mul(v.x, wf_mul(fx, fx)), wf_mul(v.y, wf_mul(fx, fy)), wf_mul(v.z, wf_mul(fy, fy)));
    shift = vec2(wf_mul(shift.x, fx), wf_mul(shift.y, fy));
    float scale = wf_mul(k, wf_mul(fx, fy));
    return wf_mul(area, wf_mul(scale, scale));
}

float thickness(Splat s, vec3 dot_) {
    if (view.flat_ == 0u) return view.prefilter_px2;
    float away = wf_sqrt(wf_fma(dot_.x, dot_.x, wf_mul(dot_.y, dot_.y))), cutoff = wf_max(wf_sqrt(s.cutoff2), MIN_DOT_CUTOFF);
    float reach = wf_fma(dot_.z, wf_div(away, cutoff), wf_sqrt(view.dot_px2));
    return wf_mul(reach, reach);
}

// Returns what the filter leaves of the height.
float set_ellipse(Splat s, vec3 v, float area, float h2, inout Record r, out vec3 lower, out vec3 map) {
    float w11 = wf_max(wf_add(v.x, h2), SHORTEST_SCALE), w22 = wf_max(wf_add(v.z, h2), SHORTEST_SCALE);
    float filtered = wf_max(wf_fma(h2, wf_add(wf_add(v.x, v.z), h2), area), SHORTEST_AREA);
    float root = wf_sqrt(wf_div(w22, filtered)), cutoff = wf_sqrt(s.cutoff2);
    r.ax = root;
    r.ay = wf_mul(root, wf_div(wf_sub(0.0, v.y), w22));
    r.by = wf_div(1.0, wf_sqrt(w22));
    r.limit = s.cutoff2;
    r.reach = wf_mul(cutoff, wf_sqrt(w22));
    lower.x = wf_sqrt(w11);
    lower.y = wf_div(v.y, lower.x);
    lower.z = wf_sqrt(wf_div(filtered, w11));
    r.touch = wf_mul(cutoff, lower.y);
    float fall = wf_div(h2, filtered);
    map = vec3(wf_fnma(fall, w22, 1.0), wf_mul(fall, v.y), wf_fnma(fall, w11, 1.0));
    if (view.flat_ != 0u) {
        map = vec3(1.0, 0.0, 1.0);
    } else if (view.trained == 0u) {
        float v11 = wf_max(v.x, SHORTEST_SCALE), l0 = wf_sqrt(v11), l1 = wf_div(v.y, l0), l2 = wf_sqrt(wf_div(area, v11));
        map.z = wf_div(l2, lower.z);
        map.x = wf_div(l0, lower.x);
        map.y = wf_div(wf_fnma(map.z, lower.y, l1), lower.x);
    }
    return view.keep != 0u ? wf_sqrt(wf_max(wf_div(area, filtered), MIN_KEPT)) : 1.0;
}

#if DEEP
float ray_rows(Splat s, out vec3 rows[3]) {
    vec3 to, inverse_;
    for (int i = 0; i < 3; i++) {
        inverse_[i] = wf_div(1.0, s.scales[i]);
        to[i] = wf_mul(inverse_[i], view.orthographic != 0u ? s.axes[i].z : dot3(s.axes[i], s.place));
    }
    float length_ = wf_max(wf_sqrt(dot3(to, to)), SHORTEST_LENGTH);
    float x = wf_div(to.x, length_), y = wf_div(to.y, length_), z = wf_div(to.z, length_), sign_ = z < 0.0 ? -1.0 : 1.0;
    float a = wf_div(-1.0, wf_add(sign_, z)), b = wf_mul(wf_mul(x, y), a);
    vec3 basis[3];
    basis[0] = vec3(wf_fma(wf_mul(sign_, x), wf_mul(x, a), 1.0), wf_mul(sign_, b), wf_mul(wf_sub(0.0, sign_), x));
    basis[1] = vec3(b, wf_fma(y, wf_mul(y, a), sign_), wf_sub(0.0, y));
    basis[2] = vec3(x, y, z);
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 3; c++) {
            rows[k][c] = 0.0;
            for (int i = 0; i < 3; i++) rows[k][c] = wf_fma(wf_mul(basis[k][i], inverse_[i]), s.axes[i][c], rows[k][c]);
        }
    return length_;
}

void set_rays(Splat s, vec3 rows[3], vec2 shift, vec3 map, inout Record r) {
    float fx = wf_div(1.0, view.fx_px), fy = wf_div(1.0, view.fy_px);
    for (int k = 0; k < 3; k++) {
        float x = wf_mul(rows[k].x, fx), y = wf_mul(rows[k].y, fy), at = 0.0;
        if (view.orthographic != 0u && k == 2) {
            float shrink = wf_div(-1.0, r.length_);
            x = wf_mul(x, shrink);
            y = wf_mul(y, shrink);
            at = s.place.z;
        } else if (k == 2) {
            at = wf_mul(r.length_, s.inverse_);
        }
        r.g[3 * k] = wf_fma(x, map.x, wf_mul(y, map.y));
        r.g[3 * k + 1] = wf_fma(y, map.z, view.trained != 0u ? wf_mul(x, map.y) : 0.0);
        r.g[3 * k + 2] = wf_fma(x, shift.x, wf_fma(y, shift.y, at));
    }
}

float vary(Record r, int at, vec3 lower) {
    float x = r.g[at], y = r.g[at + 1], across = wf_fma(x, lower.x, wf_mul(y, lower.y)), down = wf_mul(y, lower.z);
    return wf_sqrt(wf_mul(r.limit, wf_fma(across, across, wf_mul(down, down))));
}

void set_depths(Splat s, vec3 lower, inout Record r) {
    float z = s.place.z, low = wf_sub(z, s.depth_reach), high = wf_add(z, s.depth_reach);
    float middle = r.g[8], half_ = vary(r, 6, lower), minimum = wf_sub(middle, half_), maximum = wf_add(middle, half_);
    if (view.orthographic != 0u) {
        float safety = wf_mul(LITTLE, wf_add(wf_abs(z), s.depth_reach));
        r.low = wf_sub(wf_max(low, minimum), safety);
        r.high = wf_add(wf_min(high, maximum), safety);
        return;
    }
    float across = 0.0;
    for (int k = 0; k < 2; k++) {
        float reach = wf_add(wf_abs(r.g[3 * k + 2]), vary(r, 3 * k, lower));
        across = wf_fma(reach, reach, across);
    }
    float safe = wf_max(minimum, wf_mul(wf_abs(maximum), LEAST));
    float nearest = wf_div(r.length_, wf_add(wf_max(maximum, safe), wf_div(across, safe))), farthest = wf_div(r.length_, safe);
    r.low = wf_max(wf_max(low, 0.0), wf_fnma(LITTLE, nearest, nearest));
    r.high = wf_max(wf_min(high, wf_fma(LITTLE, farthest, farthest)), r.low);
}

// At the eye: rays over the whole picture.
void set_near(Splat s, vec3 rows[3], inout Record r) {
    r.x = view.cx_px;
    r.y = view.cy_px;
    r.ax = WIDEST;
    r.ay = r.by = r.touch = 0.0;
    r.reach = FARTHEST_PX;
    r.dot_x = NO_DOT_PX;
    for (int k = 0; k < 3; k++) {
        r.g[3 * k] = wf_div(rows[k].x, view.fx_px);
        r.g[3 * k + 1] = wf_div(rows[k].y, view.fy_px);
        r.g[3 * k + 2] = rows[k].z;
    }
    r.low = wf_max(wf_sub(s.place.z, s.depth_reach), 0.0);
    r.high = wf_add(s.place.z, s.depth_reach);
}
#endif

void harmonics_of(vec3 d, uint degree, out float y[24]) {
    float x = d.x, v = d.y, z = d.z;
    y[0] = wf_mul(-0.48860251, v);
    y[1] = wf_mul(0.48860251, z);
    y[2] = wf_mul(-0.48860251, x);
    if (degree < 2u) return;
    float xx = wf_mul(x, x), yy = wf_mul(v, v), zz = wf_mul(z, z), xy = wf_mul(x, v);
    float difference = wf_sub(xx, yy), yz = wf_mul(v, z), xz = wf_mul(x, z);
    y[3] = wf_mul(1.09254843, xy);
    y[4] = wf_mul(-1.09254843, yz);
    y[5] = wf_mul(0.315391565, wf_sub(wf_sub(wf_add(zz, zz), xx), yy));
    y[6] = wf_mul(-1.09254843, xz);
    y[7] = wf_mul(0.546274215, difference);
    if (degree < 3u) return;
    float sky = wf_sub(wf_sub(wf_mul(4.0, zz), xx), yy);
    float lobe_y = wf_fma(3.0, xx, wf_sub(0.0, yy)), lobe_x = wf_fnma(3.0, yy, xx);
    y[8] = wf_mul(wf_mul(-0.590043590, v), lobe_y);
    y[9] = wf_mul(wf_mul(2.89061144, xy), z);
    y[10] = wf_mul(wf_mul(-0.457045799, v), sky);
    y[11] = wf_mul(wf_mul(0.373176333, z), wf_fnma(3.0, wf_add(xx, yy), wf_add(zz, zz)));
    y[12] = wf_mul(wf_mul(-0.457045799, x), sky);
    y[13] = wf_mul(wf_mul(1.44530572, z), difference);
    y[14] = wf_mul(wf_mul(-0.590043590, x), lobe_x);
    if (degree < 4u) return;
    float seven1 = wf_fma(7.0, zz, -1.0), seven3 = wf_fma(7.0, zz, -3.0);
    y[15] = wf_mul(wf_mul(2.50334294, xy), difference);
    y[16] = wf_mul(wf_mul(-1.77013077, yz), lobe_y);
    y[17] = wf_mul(wf_mul(0.946174696, xy), seven1);
    y[18] = wf_mul(wf_mul(-0.669046544, yz), seven3);
    y[19] = wf_mul(0.105785547, wf_fma(zz, wf_fma(35.0, zz, -30.0), 3.0));
    y[20] = wf_mul(wf_mul(-0.669046544, xz), seven3);
    y[21] = wf_mul(wf_mul(0.473087348, difference), seven1);
    y[22] = wf_mul(wf_mul(-1.77013077, xz), lobe_x);
    y[23] = wf_mul(0.625835735, wf_fnma(yy, lobe_y, wf_mul(xx, lobe_x)));
}

float harmonic(uint number) {
    uint word = harmonics[(packet * view.harmonic_count + number) * (LANES / 2u) + lane / 2u];
    return float(int(word << (lane % 2u == 0u ? 16u : 0u)) >> 16);
}

vec3 color_of(Splat s) {
    float y[24];
    vec3 sum = vec3(0.0), color;
    uint used = (view.sh_degree + 1u) * (view.sh_degree + 1u) - 1u;
    if (used > 0u) harmonics_of(s.direction, view.sh_degree, y);
    for (uint k = 0u; k < used; k++)
        for (int c = 0; c < 3; c++) sum[c] = wf_fma(y[k], harmonic(3u * k + uint(c)), sum[c]);
    float unit = number_of(HARMONIC_UNIT);
    for (int c = 0; c < 3; c++) {
        float flat_color = number_of(COLOR + uint(c));
        if (view.with_colors != 0u) flat_color = colors[(packet * 3u + uint(c)) * LANES + lane];
        float base = wf_fma(0.282094792, flat_color, 0.5);
        color[c] = wf_max(wf_fma(unit, sum[c], base), 0.0);
    }
    return color;
}

// The shortest axis, turned to the eye, in place of a colour.
vec3 normal_of(Splat s) {
    vec3 axes[3], color;
    float shortest = s.scales.z;
    quaternion_axes(rotation(), axes);
    for (int k = 1; k >= 0; k--)
        if (s.scales[k] < shortest) {
            shortest = s.scales[k];
            axes[2] = axes[k];
        }
    bool away = 0.0 < dot3(axes[2], s.direction);
    for (int c = 0; c < 3; c++) color[c] = wf_fma(0.5, away ? wf_sub(0.0, axes[2][c]) : axes[2][c], 0.5);
    return color;
}

// Whether some pixel may show the splat; sets its record, its tiles and its key.
bool project(out Record r, out uvec2 box, out uint key, out bool near) {
    float opacity = number_of(OPACITY);
    Splat s;
    near = false;
    if (view.with_lanes != 0u && (lanes[packet / 2u] >> (packet % 2u * 16u + lane) & 1u) == 0u) return false;
    bool shows = place_splat(opacity, s);
#if DEEP
    if (view.trained == 0u && view.orthographic == 0u) near = s.place.z <= wf_mul(NEAR_REACHES, s.depth_reach);
#endif
    if (!shows) return false;
    vec3 v, lower, map, dot_;
    vec2 shift;
    float area = true_ellipse(s, v, shift, dot_);
    float kept = set_ellipse(s, v, area, thickness(s, dot_), r, lower, map);
    r.x = wf_fma(s.x, view.fx_px, wf_add(shift.x, view.cx_px));
    r.y = wf_fma(s.y, view.fy_px, wf_add(shift.y, view.cy_px));
    float across = wf_mul(wf_sqrt(s.cutoff2), lower.x), down = r.reach;
    float left = wf_sub(r.x, across), right = wf_add(r.x, across), top = wf_sub(r.y, down), bottom = wf_add(r.y, down);
    if (!(near || (left < view.width_px && 0.0 < right && top < view.height_px && 0.0 < bottom))) return false;
    vec4 sides = vec4(left, top, right, bottom), tiles;
    for (int i = 0; i < 4; i++) {
        float last = i % 2 != 0 ? view.last_row : view.last_column;
        tiles[i] = floor(wf_min(wf_max(wf_mul(sides[i], 0.03125), 0.0), last));
        if (near) tiles[i] = i < 2 ? 0.0 : last;
        if (i >= 2) tiles[i] = wf_add(tiles[i], 1.0);
    }
    box = uvec2(uint(tiles.x) | uint(tiles.y) << 16, uint(tiles.z) | uint(tiles.w) << 16);
    float alpha = wf_mul(wf_max(opacity, FAINTEST), near ? 1.0 : kept);
    if (!(view.minimum_alpha <= alpha)) return false;
    r.log2_alpha = wf_log2(alpha);
    r.color = view.normals != 0u ? normal_of(s) : color_of(s);
    r.dot_x = dot_.x;
    r.dot_y = dot_.y;
    r.dot_z = s.place.z;
    r.dot_ = -1.0;
    if (view.flat_ != 0u) {
        r.dot_ = view.inverse_dot;
        r.dot_x = 0.0 < wf_keep(0.0 < view.dot_px2, dot_.z) ? dot_.x : NO_DOT_PX;
    }
#if DEEP
    vec3 rows[3];
    r.length_ = ray_rows(s, rows);
    set_rays(s, rows, shift, map, r);
    set_depths(s, lower, r);
    if (near) set_near(s, rows, r);
#endif
    uint bits = floatBitsToUint(wf_add(s.place.z, 0.0));
    key = bits ^ ((bits & 0x80000000u) != 0u ? 0xffffffffu : 0x80000000u);
    return true;
}

void write_record(uint at, Record r, uvec2 box) {
    uint first = at * RECORD_PARTS;
    records[first] = vec4(r.x, r.y, r.ax, r.ay);
    records[first + 1u] = vec4(r.by, r.limit, r.log2_alpha, r.reach);
    records[first + 2u] = vec4(r.touch, r.color);
#if DEEP
    records[first + 3u] = vec4(r.g[0], r.g[1], r.g[2], r.g[3]);
    records[first + 4u] = vec4(r.g[4], r.g[5], r.g[6], r.g[7]);
    records[first + 5u] = vec4(r.g[8], r.length_, r.low, r.high);
#endif
#if DOTS
    records[first + 6u] = vec4(r.dot_, r.dot_x, r.dot_y, r.dot_z);
#endif
    boxes[at] = box;
}

shared uint group_visible, group_near, first_visible;

void main() {
    uint number = group_number() * 256u + gl_LocalInvocationIndex, at = number / LANES;
    bool shows = false, near = false;
    Record r;
    uvec2 box = uvec2(0u);
    uint key = NO_KEY, slot = 0u, place = 0u;
    if (gl_LocalInvocationIndex == 0u) group_visible = group_near = 0u;
    barrier();
    if (at < packet_count) {
        uint low = first_segment, high = end_segment; // the last that begins there or before
        while (high - low > 1u) {
            uint middle = (low + high) / 2u;
            if (segments[middle].first <= at) low = middle;
            else high = middle;
        }
        Segment segment = segments[low];
        lane = number % LANES;
        packet = segment.at + at - segment.first;
        slot = (segment.slot + at - segment.first) * LANES + lane;
        view = views[segment.view];
        shows = project(r, box, key, near);
        if (shows) place = atomicAdd(group_visible, 1u);
        if (shows && near) atomicAdd(group_near, 1u);
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u && group_visible > 0u) {
        first_visible = atomicAdd(visible_count, group_visible);
        atomicAdd(near_count, group_near);
    }
    barrier();
    if (at >= packet_count) return;
    keys[slot] = shows ? key : NO_KEY;
    numbers[slot] = first_visible + place;
    if (shows && first_visible + place < visible_capacity) write_record(first_visible + place, r, box);
}
