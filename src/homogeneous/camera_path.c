// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cameras in motion: orbits about an axis, and smooth paths through keys. + - * / and sqrt only, so that
// every machine computes the same frames.
//
// Based on: K. Shoemake, "Animating Rotation with Quaternion Curves", SIGGRAPH 1985, sections 3.3 and 3.4
// (slerp), and "Quaternion Calculus and Fast Animation", SIGGRAPH 1987 course 10 (squad).
#include "base/base.h"
#include "ewa/camera.h"
#include "homogeneous/camera.h"
#include "homogeneous/vec.h"
#include "math/angle.h"

#include <math.h>
#include <string.h>

/// Keys that a closed path is continued by at each end before its spline is solved with free ends: what an
/// end does fades by 2 - sqrt(3) per key, to below rounding here.
enum { WRAPPED_KEYS = 32 };

/// Sine of an angle between quaternions under which lines replace arcs.
static const double SMALL_SINE = 1e-8;

typedef struct quaternion {
    double w;
    ewa_vec3 v;
} quaternion;

/// What the path knows of a key.
typedef struct knot {
    quaternion rotation, control; // signs continue along the path
    ewa_vec3 eye_world, slope;    // slope: world units per key
    double scale;                 // of world_to_camera
} knot;

struct ewa_camera_path {
    ewa_context *context;
    ewa_camera *keys; // `count` of them
    knot *knots;      // `count`, and the first once more when closed
    size_t count, knot_count;
};

static quaternion quaternion_scale(quaternion q, double s) {
    return (quaternion){s * q.w, vec3_scale(q.v, s)};
}

static quaternion quaternion_add(quaternion a, quaternion b) {
    return (quaternion){a.w + b.w, vec3_add(a.v, b.v)};
}

static double quaternion_dot(quaternion a, quaternion b) { return a.w * b.w + vec3_dot(a.v, b.v); }

static quaternion quaternion_product(quaternion a, quaternion b) {
    const ewa_vec3 along = vec3_add(vec3_scale(b.v, a.w), vec3_scale(a.v, b.w));
    return (quaternion){a.w * b.w - vec3_dot(a.v, b.v), vec3_add(along, vec3_cross(a.v, b.v))};
}

static quaternion quaternion_conjugate(quaternion q) { return (quaternion){q.w, vec3_scale(q.v, -1)}; }

static quaternion quaternion_unit(quaternion q) {
    return quaternion_scale(q, 1 / sqrt(quaternion_dot(q, q)));
}

/// The one of q and -q that is nearer to `other`; both are the same rotation.
static quaternion quaternion_near(quaternion q, quaternion other) {
    return quaternion_dot(q, other) < 0 ? quaternion_scale(q, -1) : q;
}

/// Unit quaternion of the rotation in the upper left of a row-major 4x4 matrix times 1 / scale, by way of its
/// largest component.
static quaternion quaternion_from_matrix(const double m[16], double scale) {
    const double s = 1 / scale;
    const double xx = s * m[0], yy = s * m[5], zz = s * m[10];
    quaternion q;
    if (xx + yy + zz > 0)
        q = (quaternion){1 + xx + yy + zz, {s * (m[9] - m[6]), s * (m[2] - m[8]), s * (m[4] - m[1])}};
    else if (xx >= yy && xx >= zz)
        q = (quaternion){s * (m[9] - m[6]), {1 + xx - yy - zz, s * (m[1] + m[4]), s * (m[2] + m[8])}};
    else if (yy >= zz)
        q = (quaternion){s * (m[2] - m[8]), {s * (m[1] + m[4]), 1 - xx + yy - zz, s * (m[6] + m[9])}};
    else
        q = (quaternion){s * (m[4] - m[1]), {s * (m[2] + m[8]), s * (m[6] + m[9]), 1 - xx - yy + zz}};
    return quaternion_unit(q);
}

/// Logarithm of a unit quaternion with w >= 0: axis times half the angle of its rotation.
static ewa_vec3 quaternion_log(quaternion q) {
    const double sine = vec3_length(q.v);
    if (sine < SMALL_SINE) return q.v;
    return vec3_scale(q.v, 2 * ewa_atan(sine / (1 + q.w)) / sine);
}

/// The unit quaternion whose logarithm is `v`, of length up to pi.
static quaternion quaternion_exp(ewa_vec3 v) {
    const double angle = vec3_length(v);
    double sine, cosine;
    ewa_sin_cos(angle, &sine, &cosine);
    return (quaternion){cosine, vec3_scale(v, angle < SMALL_SINE ? 1 : sine / angle)};
}

/// The arc from `a` (0) to `b` (1) at even speed, the way that their signs say.
static quaternion slerp(quaternion a, quaternion b, double share) {
    const quaternion difference = quaternion_add(b, quaternion_scale(a, -1)), sum = quaternion_add(a, b);
    const double angle =
        2 * ewa_atan(sqrt(quaternion_dot(difference, difference) / quaternion_dot(sum, sum)));
    double whole, left, right, unused;
    ewa_sin_cos(angle, &whole, &unused);
    if (!(whole > SMALL_SINE)) // next to each other, or opposite, where no way is the shortest
        return quaternion_dot(a, b) < 0
                   ? a
                   : quaternion_unit(quaternion_add(a, quaternion_scale(difference, share)));
    ewa_sin_cos((1 - share) * angle, &left, &unused);
    ewa_sin_cos(share * angle, &right, &unused);
    return quaternion_unit(
        quaternion_add(quaternion_scale(a, left / whole), quaternion_scale(b, right / whole)));
}

/// Shoemake's inner control point: the rotation's change is continuous through the key.
static quaternion squad_control(quaternion before, quaternion key, quaternion after) {
    const quaternion back = quaternion_conjugate(key);
    const ewa_vec3 steps = vec3_add(quaternion_log(quaternion_product(back, quaternion_near(before, key))),
                                    quaternion_log(quaternion_product(back, quaternion_near(after, key))));
    return quaternion_product(key, quaternion_exp(vec3_scale(steps, -0.25)));
}

/// Sets the rows of world_to_camera from rotation, scale and eye.
static void set_matrix(ewa_camera *camera, quaternion q, double scale, ewa_vec3 eye) {
    const double w = q.w, x = q.v.x, y = q.v.y, z = q.v.z;
    const double rows[3][3] = {
        {1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
        {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
        {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)},
    };
    double *m = camera->world_to_camera;
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) m[4 * r + c] = scale * rows[r][c];
        m[4 * r + 3] = -scale * vec3_dot(vec3_load(rows[r]), eye);
    }
}

/// Slopes of the spline with continuous second derivative through `count` points and free ends, by
/// elimination of m[i-1] + 4 m[i] + m[i+1] = 3 (p[i+1] - p[i-1]). `knots` carry the points; `ratios` has room
/// for `count`.
static void solve_slopes(knot *knots, size_t count, double *ratios) {
    for (size_t i = 0; i < count; i++) {
        const bool first = i == 0, last = i + 1 == count;
        const ewa_vec3 ahead = knots[last ? i : i + 1].eye_world, behind = knots[first ? i : i - 1].eye_world;
        ewa_vec3 right = vec3_scale(vec3_sub(ahead, behind), 3);
        const double diagonal = (first || last ? 2 : 4) - (first ? 0 : ratios[i - 1]);
        if (!first) right = vec3_sub(right, knots[i - 1].slope);
        ratios[i] = 1 / diagonal;
        knots[i].slope = vec3_scale(right, ratios[i]);
    }
    for (size_t i = count - 1; i-- > 0;)
        knots[i].slope = vec3_sub(knots[i].slope, vec3_scale(knots[i + 1].slope, ratios[i]));
}

static ewa_status make_slopes(ewa_camera_path *path) {
    const bool closed = path->knot_count > path->count;
    const size_t wrapped = closed ? WRAPPED_KEYS : 0, count = path->count + 2 * wrapped;
    knot *knots = ewa_allocate_zeroed(path->context, count, sizeof *knots);
    double *ratios = ewa_allocate(path->context, count, sizeof *ratios);
    const bool complete = knots && ratios;
    if (complete) {
        // Differences from the first key, which are small where coordinates are those of a map.
        const ewa_vec3 first = path->knots[0].eye_world;
        for (size_t i = 0; i < count; i++) {
            const size_t key = (i + wrapped * (path->count - 1)) % path->count;
            knots[i].eye_world = vec3_sub(path->knots[key].eye_world, first);
        }
        solve_slopes(knots, count, ratios);
        for (size_t i = 0; i < path->knot_count; i++) path->knots[i].slope = knots[wrapped + i].slope;
    }
    ewa_release(path->context, ratios, count, sizeof *ratios);
    ewa_release(path->context, knots, count, sizeof *knots);
    return complete ? EWA_OK : EWA_ERROR_MEMORY;
}

static double matrix_scale(const double m[16]) {
    double square = 0;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) square += m[4 * r + c] * m[4 * r + c] / 3;
    return sqrt(square);
}

static void make_knots(ewa_camera_path *path) {
    knot *knots = path->knots;
    for (size_t i = 0; i < path->knot_count; i++) {
        const ewa_camera *key = &path->keys[i % path->count];
        double eye_world[3];
        ewa_camera_eye(key, eye_world);
        knots[i].eye_world = vec3_load(eye_world);
        knots[i].scale = matrix_scale(key->world_to_camera);
        knots[i].rotation = quaternion_from_matrix(key->world_to_camera, knots[i].scale);
        if (i > 0) knots[i].rotation = quaternion_near(knots[i].rotation, knots[i - 1].rotation);
    }
    const size_t last = path->knot_count - 1;
    const bool closed = path->knot_count > path->count;
    for (size_t i = 0; i <= last; i++) {
        // At a free end the turn goes on as it comes.
        knots[i].control = knots[i].rotation;
        if (!closed && (i == 0 || i == last)) continue;
        const size_t before = i > 0 ? i - 1 : last - 1, after = i < last ? i + 1 : last > 1 ? 1 : 0;
        knots[i].control = squad_control(knots[before].rotation, knots[i].rotation, knots[after].rotation);
    }
}

static ewa_status check_keys(ewa_context *context, const ewa_camera *keys, size_t count) {
    char problem[EWA_CAMERA_PROBLEM_BYTES];
    for (size_t i = 0; i < count; i++) {
        const ewa_camera *key = &keys[i];
        if (ewa_camera_find_problem(key, problem))
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "camera path: key %zu: %s", i, problem);
        if (key->width_px != keys->width_px || key->height_px != keys->height_px)
            return ewa_fail(context, EWA_ERROR_ARGUMENT,
                            "camera path: key %zu has %u x %u pixels, key 0 has %u x %u", i, key->width_px,
                            key->height_px, keys->width_px, keys->height_px);
        if (key->projection != keys->projection)
            return ewa_fail(context, EWA_ERROR_ARGUMENT,
                            "camera path: key %zu and key 0 differ in their projection", i);
    }
    return EWA_OK;
}

ewa_status ewa_camera_path_create(ewa_context *context, const ewa_camera *keys, size_t count, bool closed,
                                  ewa_camera_path **path) {
    if (path) *path = NULL;
    if (!context || !keys || count == 0 || !path) return EWA_ERROR_ARGUMENT;
    EWA_TRY(check_keys(context, keys, count));
    ewa_camera_path *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->count = count;
    made->knot_count = count + closed;
    made->keys = ewa_allocate(context, made->count, sizeof *made->keys);
    made->knots = ewa_allocate_zeroed(context, made->knot_count, sizeof *made->knots);
    ewa_status status = EWA_OK;
    if (made->keys && made->knots) {
        memcpy(made->keys, keys, count * sizeof *keys);
        make_knots(made);
        status = make_slopes(made);
    } else {
        status = EWA_ERROR_MEMORY;
    }
    if (status != EWA_OK) ewa_camera_path_destroy(&made);
    *path = made;
    return status;
}

void ewa_camera_path_destroy(ewa_camera_path **path) {
    if (!path || !*path) return;
    ewa_camera_path *old = *path;
    ewa_release(old->context, old->keys, old->count, sizeof *old->keys);
    ewa_release(old->context, old->knots, old->knot_count, sizeof *old->knots);
    ewa_release(old->context, old, 1, sizeof *old);
    *path = NULL;
}

static double mix(double a, double b, double share) { return (1 - share) * a + share * b; }

ewa_status ewa_camera_path_at(const ewa_camera_path *path, double place, ewa_camera *camera) {
    if (!path || !camera || !(place == place)) return EWA_ERROR_ARGUMENT;
    const double last = (double)(path->knot_count - 1);
    const double inside = place < 0 ? 0 : place > last ? last : place;
    const size_t before = (size_t)inside;
    const double t = inside - (double)before;
    *camera = path->keys[before % path->count];
    if (t == 0) return EWA_OK;
    const knot *a = &path->knots[before], *b = a + 1;
    const ewa_camera *next = &path->keys[(before + 1) % path->count];
    camera->fx_px = mix(camera->fx_px, next->fx_px, t);
    camera->fy_px = mix(camera->fy_px, next->fy_px, t);
    camera->cx_px = mix(camera->cx_px, next->cx_px, t);
    camera->cy_px = mix(camera->cy_px, next->cy_px, t);
    // Hermite's cubic, from `a`.
    const double rest = 1 - t;
    ewa_vec3 way = vec3_scale(vec3_sub(b->eye_world, a->eye_world), t * t * (3 - 2 * t));
    way = vec3_add(way, vec3_scale(a->slope, t * rest * rest));
    way = vec3_sub(way, vec3_scale(b->slope, t * t * rest));
    const quaternion q =
        slerp(slerp(a->rotation, b->rotation, t), slerp(a->control, b->control, t), 2 * t * rest);
    set_matrix(camera, q, mix(a->scale, b->scale, t), vec3_add(a->eye_world, way));
    return EWA_OK;
}

/// Sine and cosine of degrees, exact for multiples of 90.
static void sin_cos_degrees(double angle_deg, double *sine, double *cosine) {
    const double turn = fmod(fabs(angle_deg), 360);
    const int quarter = (int)(turn / 90);
    double s, c;
    ewa_sin_cos((turn - 90 * quarter) * (EWA_PI / 180), &s, &c);
    const double sines[4] = {s, c, -s, -c}, cosines[4] = {c, -s, -c, s};
    *sine = angle_deg < 0 ? -sines[quarter] : sines[quarter];
    *cosine = cosines[quarter];
}

ewa_status ewa_camera_orbit(ewa_camera *camera, const double pivot_world[3], const double axis_world[3],
                            double angle_deg) {
    if (!camera || !pivot_world || !axis_world) return EWA_ERROR_ARGUMENT;
    ewa_vec3 axis = vec3_load(axis_world);
    const ewa_vec3 pivot = vec3_load(pivot_world);
    if (!vec3_normalize(&axis) || !vec3_is_finite(pivot) || !isfinite(angle_deg)) return EWA_ERROR_NUMERIC;
    double sine, cosine;
    sin_cos_degrees(angle_deg, &sine, &cosine);
    double *m = camera->world_to_camera;
    for (int r = 0; r < 3; r++) {
        // Rodrigues' formula on the rows, which are directions of the world; the pivot keeps its place in
        // camera space.
        const ewa_vec3 row = vec3_load(&m[4 * r]);
        const double pivot_camera = vec3_dot(row, pivot) + m[4 * r + 3];
        ewa_vec3 turned = vec3_add(vec3_scale(row, cosine), vec3_scale(vec3_cross(axis, row), sine));
        turned = vec3_add(turned, vec3_scale(axis, vec3_dot(axis, row) * (1 - cosine)));
        vec3_store(turned, &m[4 * r]);
        m[4 * r + 3] = pivot_camera - vec3_dot(turned, pivot);
    }
    return EWA_OK;
}
