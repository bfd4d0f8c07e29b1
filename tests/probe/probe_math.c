// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Homogeneous coordinates, clipping, cameras.
#include "homogeneous/perspective.h"
#include "tests/probe/probe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct numbers {
    uint64_t state;
} numbers;

static double number(numbers *from) { return 4 * probe_random(&from->state) - 2; }
static ewa_vec3 vec3(numbers *from) { return (ewa_vec3){number(from), number(from), number(from)}; }
static ewa_vec4 vec4(numbers *from) {
    return (ewa_vec4){number(from), number(from), number(from), number(from)};
}

static ewa_mat3 mat3(numbers *from) {
    ewa_mat3 made;
    for (int i = 0; i < 9; i++) made.m[i / 3][i % 3] = number(from);
    return made;
}

static ewa_mat4 mat4(numbers *from) {
    ewa_mat4 made;
    for (int i = 0; i < 16; i++) made.m[i / 4][i % 4] = number(from);
    return made;
}

static ewa_conic conic(numbers *from) {
    return (ewa_conic){number(from), number(from), number(from), number(from), number(from), number(from)};
}

/// Records the bytes of a struct of doubles.
#define PUT(name, value)                                                                                     \
    probe_doubles(to, name, PROBE_NUMBERS, (const double *)&(value), sizeof(value) / (sizeof(double)))
#define CALL(name, call) probe_status(to, name, call)

static void probe_points(probe *to, numbers *from) {
    const ewa_vec3 p = vec3(from), q = vec3(from),
                   triangle[3] = {{0.1, 0.2, 1}, {3, 0.3, 1.5}, {0.7, 2, 0.8}};
    const ewa_vec4 a = vec4(from), b = vec4(from), c = vec4(from);
    ewa_vec3 out3;
    ewa_vec4 out4;
    ewa_line3 line, other;
    double xyz[3] = {0, 0, 0}, distance = 0, weights[3] = {0.2, 0.3, 0.5};
    CALL("divide 2", ewa_point2_divide(p, xyz)), PUT("xy", xyz);
    CALL("divide 3", ewa_point3_divide(a, xyz)), PUT("xyz", xyz);
    CALL("join", ewa_line2_join(p, q, &out3)), PUT("line", out3);
    CALL("meet", ewa_line2_meet(p, q, &out3)), PUT("point", out3);
    probe_number(to, "incidence 2", ewa_incidence2(p, q));
    probe_number(to, "incidence 3", ewa_incidence3(a, b));
    CALL("distance 2", ewa_line2_distance(p, q, &distance)), PUT("distance", distance);
    CALL("plane join", ewa_plane_join(a, b, c, &out4)), PUT("plane", out4);
    CALL("plane meet", ewa_plane_meet(a, b, c, &out4)), PUT("point 3", out4);
    CALL("distance 3", ewa_plane_distance(a, b, &distance)), PUT("distance plane", distance);
    CALL("barycentric", ewa_triangle_barycentric(triangle, p, xyz)), PUT("weights", xyz);
    CALL("from weights", ewa_triangle_point(triangle, weights, &out3)), PUT("of weights", out3);
    CALL("trilinear", ewa_triangle_distances(triangle, p, xyz)), PUT("distances", xyz);
    CALL("from distances", ewa_triangle_point_from_distances(triangle, weights, &out3)),
        PUT("of distances", out3);
    CALL("line join", ewa_line3_join(a, b, &line)), PUT("line 3", line);
    CALL("line meet", ewa_line3_meet(b, c, &other)), PUT("line 3 of planes", other);
    probe_number(to, "line incidence", ewa_line3_incidence(line, other));
    CALL("line and plane", ewa_line3_meet_plane(line, c, &out4)), PUT("piercing", out4);
    CALL("line and point", ewa_line3_join_point(line, c, &out4)), PUT("spanned", out4);
    const ewa_mat4 map = mat4(from);
    const ewa_line3 moved = ewa_line3_transform(line, &map);
    PUT("line moved", moved);
}

static void probe_maps(probe *to, numbers *from) {
    const ewa_mat3 m = mat3(from), n = mat3(from), product = ewa_mat3_concatenate(&m, &n);
    const ewa_mat4 s = mat4(from), t = mat4(from), product4 = ewa_mat4_concatenate(&s, &t);
    const ewa_vec3 p = vec3(from);
    const ewa_vec4 q = vec4(from);
    ewa_mat3 inverse = m;
    ewa_mat4 inverse4 = s;
    PUT("product 3", product), PUT("product 4", product4);
    CALL("invert 3", ewa_mat3_invert(&m, &inverse)), PUT("inverse 3", inverse);
    CALL("invert 4", ewa_mat4_invert(&s, &inverse4)), PUT("inverse 4", inverse4);
    const ewa_vec3 point = ewa_point2_transform(p, &m), pulled = ewa_line2_pull(p, &m);
    const ewa_vec4 point4 = ewa_point3_transform(q, &s), pulled4 = ewa_plane_pull(q, &s);
    PUT("transformed 2", point), PUT("pulled 2", pulled), PUT("transformed 3", point4),
        PUT("pulled 3", pulled4);
    ewa_vec3 line = {0, 0, 0};
    ewa_vec4 plane = {0, 0, 0, 0};
    CALL("line 2", ewa_line2_transform(p, &m, &line)), PUT("line 2 moved", line);
    CALL("plane", ewa_plane_transform(q, &s, &plane)), PUT("plane moved", plane);
    const ewa_conic Q = conic(from), dual = ewa_conic_dual(&Q), back = ewa_conic_pull(&Q, &m),
                    forward = ewa_dual_conic_transform(&Q, &m);
    ewa_conic image = Q;
    PUT("dual", dual), PUT("conic pulled", back), PUT("dual moved", forward);
    probe_number(to, "conic value", ewa_conic_value(&Q, p));
    const ewa_vec3 polar = ewa_conic_polar(&Q, p);
    PUT("polar", polar);
    CALL("conic", ewa_conic_transform(&Q, &m, &image)), PUT("conic moved", image);
    const ewa_conic ellipse = {2.1 * 2.1 * -1, 0.3, 1.1, -3, 0.7, -1};
    double center[2] = {0, 0}, shape[3] = {0, 0, 0};
    const ewa_conic disc = {0.25 - 4, 0.1 - 6, -2, 0.5 - 9, -3, -1};
    CALL("ellipse", ewa_dual_conic_ellipse(&disc, center, shape)), PUT("center", center), PUT("shape", shape);
    CALL("no ellipse", ewa_dual_conic_ellipse(&ellipse, center, shape)), PUT("shape 2", shape);
    ewa_vec4 planes[6];
    memset(planes, 0, sizeof planes);
    CALL("planes", ewa_frustum_planes(&inverse4, planes)), PUT("frustum planes", planes);
}

static void probe_clipping(probe *to, numbers *from) {
    enum { SEGMENTS = 67 };
    ewa_vec4 corners[5];
    double attributes[10], alpha[6];
    uint32_t crossed = 0, visible = 0, count[2] = {0, 0};
    ewa_segment_part parts[2];
    float ends[2][4][SEGMENTS], alphas[2][2][SEGMENTS], clipped[2][2][4][SEGMENTS];
    uint8_t flags[SEGMENTS] = {0};
    ewa_segment_batch batch = {.count = SEGMENTS};
    ewa_segment_clips clips = {.visible = flags};
    for (int i = 0; i < SEGMENTS; i++) {
        const ewa_vec4 p = vec4(from), q = vec4(from);
        memset(parts, 0, sizeof parts);
        CALL("alphas", ewa_clip_alphas(p, q, alpha, &crossed)), PUT("clip alphas", alpha);
        probe_number(to, "crossed", crossed);
        CALL("segment", ewa_clip_segment(p, q, parts, &visible)), PUT("parts", parts);
        probe_number(to, "visible", visible);
        const double coordinates[2][4] = {{p.x, p.y, p.z, p.w}, {q.x, q.y, q.z, q.w}};
        for (int e = 0; e < 2; e++)
            for (int c = 0; c < 4; c++) ends[e][c][i] = (float)coordinates[e][c];
    }
    for (int e = 0; e < 2; e++)
        for (int c = 0; c < 4; c++) batch.end[e][c] = ends[e][c];
    for (int k = 0; k < 4; k++) {
        clips.alpha[k / 2][k % 2] = alphas[k / 2][k % 2];
        for (int c = 0; c < 4; c++) clips.end[k / 2][k % 2][c] = clipped[k / 2][k % 2][c];
    }
    CALL("segments", ewa_clip_segments(to->context, &batch, &clips));
    probe_floats(to, "batch alphas", PROBE_NUMBERS, &alphas[0][0][0], sizeof alphas / sizeof(float));
    probe_floats(to, "batch ends", PROBE_NUMBERS, &clipped[0][0][0][0], sizeof clipped / sizeof(float));
    for (int i = 0; i < SEGMENTS; i++) probe_number(to, "batch visible", flags[i]);
    for (int k = 0; k < 10; k++) {
        // Convex before the division: a pentagon of one plane, with w of both signs.
        const ewa_vec4 middle = vec4(from), u = vec4(from), v = vec4(from);
        ewa_vec4 out[3 * 11];
        double out_attributes[3 * 11 * 2];
        memset(out, 0, sizeof out), memset(out_attributes, 0, sizeof out_attributes);
        for (int i = 0; i < 5; i++) {
            const double c = cos(1.2566 * i), s = sin(1.2566 * i);
            corners[i] = (ewa_vec4){middle.x + c * u.x + s * v.x, middle.y + c * u.y + s * v.y,
                                    middle.z + c * u.z + s * v.z, middle.w + c * u.w + s * v.w};
            attributes[2 * i] = c, attributes[2 * i + 1] = s;
        }
        CALL("polygon", ewa_clip_polygon(corners, attributes, 5, 2, out, out_attributes, count));
        for (uint32_t part = 0; part < 2; part++) {
            probe_number(to, "corners", count[part]);
            probe_doubles(to, "clipped", PROBE_NUMBERS, &out[part * 11].x, (size_t)4 * count[part]);
            probe_doubles(to, "attributes", PROBE_NUMBERS, out_attributes + part * 22,
                          (size_t)2 * count[part]);
        }
        ewa_vec3 numerators[2] = {{0, 0, 0}, {0, 0, 0}}, denominator = {0, 0, 0};
        double value = 0;
        CALL("hyperbolic", ewa_hyperbolic_fit(corners, attributes, 2, numerators, &denominator));
        PUT("numerators", numerators), PUT("denominator", denominator);
        CALL("hyperbolic at", ewa_hyperbolic_at(numerators[0], denominator, 0.3, 0.1, &value)),
            PUT("value", value);
        CALL("hyperbolic alpha", ewa_hyperbolic_alpha(1.5, 4, 0.3, &value)), PUT("alpha", value);
    }
}

static void probe_cameras(probe *to) {
    ewa_camera keys[4], camera;
    const double up[3] = {0.1, 0.2, 1}, target[3] = {0.5, -0.2, 0.3}, axis[3] = {0.2, 0.1, 1};
    const ewa_bounds bounds = {{-1, -2, -0.5}, {2, 1, 0.7}, 10};
    double eye[3];
    for (int i = 0; i < 4; i++) {
        ewa_camera_init(&keys[i]);
        const double from[3] = {3 + i, 2 - 2.0 * i, 1 + 0.5 * i};
        CALL("fov", ewa_camera_set_fov(&keys[i], 40 + 15 * i));
        CALL("look", ewa_camera_look_at(&keys[i], from, target, up));
        camera = keys[i];
        if (i & 1) CALL("ortho", ewa_camera_set_ortho(&camera, 2.5));
        camera.cx_px += 100 * i;
        CALL("frame", ewa_camera_frame(&camera, &bounds, target, up, 0.05 * i));
        probe_camera(to, "framed", &camera);
        CALL("orbit", ewa_camera_orbit(&camera, target, axis, 33.0 * i));
        probe_camera(to, "orbited", &camera);
        ewa_camera_eye(&camera, eye), PUT("eye", eye);
        ewa_mat4 map = {{{0}}};
        CALL("clip map", ewa_camera_clip_map(&camera, 0.5, 20, &map)), PUT("world to clip", map);
        camera.world_to_camera[5] *= 1.01;
        CALL("check", ewa_camera_check(to->context, &camera));
    }
    for (int closed = 0; closed < 2; closed++) {
        OWNED(ewa_camera_path_destroy) ewa_camera_path *path = NULL;
        CALL("path", ewa_camera_path_create(to->context, keys, 4, closed, &path));
        for (int i = 0; path && i < 9; i++) {
            CALL("path at", ewa_camera_path_at(path, 0.55 * i - 0.3, &camera));
            probe_camera(to, "on the path", &camera);
        }
    }
}

void probe_math(probe *to) {
    numbers from = {0x123456789abcdefu};
    for (int i = 0; i < 8; i++) {
        probe_points(to, &from);
        probe_maps(to, &from);
    }
    probe_clipping(to, &from);
    probe_cameras(to);
}
