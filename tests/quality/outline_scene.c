// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Analytic shapes by rays, and what a picture's alpha is beside them (outline_scene.h).
#include "quality/outline_scene.h"
#include "base/base.h"

#include <math.h>

enum { SIDE = OUTLINE_SIDE_PX, FINE = 12 };

#define PI          3.141592653589793
#define TUBE        0.3
#define RING_RADIUS 0.7

void outline_camera(const double eye_world[3], double fov_deg, ewa_camera *camera) {
    static const double target[3] = {0, 0, 0}, up[3] = {0.1, 0.2, 1};
    ewa_camera_init(camera);
    camera->width_px = camera->height_px = SIDE;
    assert_int_equal(ewa_camera_set_fov(camera, fov_deg), EWA_OK);
    assert_int_equal(ewa_camera_look_at(camera, eye_world, target, up), EWA_OK);
}

typedef struct tracer {
    outline_shape shape;
    const ewa_camera *camera;
    double eye[3];
    outline_truth *truth;
} tracer;

static bool hits_sphere(const double eye[3], const double ray[3]) {
    const double along = eye[0] * ray[0] + eye[1] * ray[1] + eye[2] * ray[2];
    const double eye2 = eye[0] * eye[0] + eye[1] * eye[1] + eye[2] * eye[2];
    return along < 0 && along * along > eye2 - 1;
}

/// Marches by the distance that is certainly free.
static bool hits_torus(const double eye[3], const double ray[3]) {
    for (double t = 0, step = 1; t < 20; t += step) {
        const double x = eye[0] + t * ray[0], y = eye[1] + t * ray[1], z = eye[2] + t * ray[2];
        step = hypot(hypot(x, y) - RING_RADIUS, z) - TUBE;
        if (step < 1e-6) return true;
    }
    return false;
}

static bool hits_plane(const tracer *t, const double ray[3]) {
    const double along = -t->eye[2] / ray[2], x = t->eye[0] + along * ray[0], y = t->eye[1] + along * ray[1];
    if (!(along > 0)) return false;
    return t->shape == OUTLINE_DISC ? x * x + y * y < 1 : fmax(fabs(x), fabs(y)) < 1;
}

static double hill_height(double x, double y) { return sin(4 * x) * cos(3 * y) / 4; }

/// Steps through the box of the hills; what a step passes by is 0.02 px high.
static bool hits_hills(const double eye[3], const double ray[3]) {
    static const double half[3] = {1, 1, 0.26}, step = 0.02;
    double from = 0, to = INFINITY;
    for (int c = 0; c < 3; c++) {
        const double a = (-half[c] - eye[c]) / ray[c], b = (half[c] - eye[c]) / ray[c];
        from = fmax(from, fmin(a, b)), to = fmin(to, fmax(a, b));
    }
    double before = 0;
    for (double t = from; from < to; t = fmin(t + step, to)) {
        const double x = eye[0] + t * ray[0], y = eye[1] + t * ray[1];
        const double above = eye[2] + t * ray[2] - hill_height(x, y);
        if (above * before < 0) return true;
        if (t >= to) return false;
        before = above;
    }
    return false;
}

static bool hits(const tracer *t, double x_px, double y_px) {
    const ewa_camera *camera = t->camera;
    const double x = (x_px - camera->cx_px) / camera->fx_px, y = (y_px - camera->cy_px) / camera->fy_px;
    const double *m = camera->world_to_camera, length = sqrt(x * x + y * y + 1);
    double ray[3];
    for (int c = 0; c < 3; c++) ray[c] = (m[c] * x + m[4 + c] * y + m[8 + c]) / length;
    if (t->shape == OUTLINE_SPHERE) return hits_sphere(t->eye, ray);
    if (t->shape == OUTLINE_HILLS) return hits_hills(t->eye, ray);
    return t->shape == OUTLINE_TORUS ? hits_torus(t->eye, ray) : hits_plane(t, ray);
}

static void trace_row(void *data, uint32_t row, uint32_t worker) {
    (void)worker;
    const tracer *t = data;
    for (uint32_t x = 0; x < SIDE; x++) {
        int corners = 0, count = 0;
        for (int k = 0; k < 9; k++) corners += hits(t, x + k % 3 * 0.5, row + k / 3 * 0.5);
        for (int k = 0; k < FINE * FINE && corners % 9; k++)
            count += hits(t, x + (k % FINE + 0.5) / FINE, row + (k / FINE + 0.5) / FINE);
        t->truth->coverage[row][x] = corners % 9 ? (float)count / (FINE * FINE) : (float)corners / 9;
    }
}

void outline_trace(ewa_context *context, outline_shape shape, const ewa_camera *camera,
                   outline_truth *truth) {
    tracer t = {.shape = shape, .camera = camera, .truth = truth};
    ewa_camera_eye(camera, t.eye);
    ewa_parallel(context, trace_row, &t, SIDE);
    // The integral of the gradient's length is that of the edge, however the edge is filtered.
    truth->length_px = 0;
    for (int y = 1; y < SIDE - 1; y++)
        for (int x = 1; x < SIDE - 1; x++)
            truth->length_px +=
                hypot((double)truth->coverage[y][x + 1] - (double)truth->coverage[y][x - 1],
                      (double)truth->coverage[y + 1][x] - (double)truth->coverage[y - 1][x]) /
                2;
}

/// Whether all pixels within `reach` have this truth.
static bool surrounded(const outline_truth *truth, int x, int y, int reach, float value) {
    for (int dy = -reach; dy <= reach; dy++)
        for (int dx = -reach; dx <= reach; dx++)
            if (x + dx >= 0 && y + dy >= 0 && x + dx < SIDE && y + dy < SIDE &&
                truth->coverage[y + dy][x + dx] != value)
                return false;
    return true;
}

outline_errors outline_compare(const outline_truth *truth, const float *alpha, int stride) {
    outline_errors found = {0};
    double sum = 0, square = 0;
    uint64_t edge = 0, inside = 0, open = 0, outside = 0, strewn = 0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const double a = (double)alpha[(y * SIDE + x) * stride], t = (double)truth->coverage[y][x];
            sum += a - t;
            if (t > 0 && t < 1) {
                square += (a - t) * (a - t);
                edge++;
            } else if (t == 1 && surrounded(truth, x, y, 2, 1)) {
                inside++;
                open += a < 0.999;
                found.deepest = fmax(found.deepest, 1 - a);
            } else if (t == 0 && surrounded(truth, x, y, 3, 0)) {
                outside++;
                strewn += a > 0.001;
            }
        }
    found.fat_px = sum / fmax(truth->length_px, 1);
    found.rms = sqrt(square / fmax((double)edge, 1));
    found.open = (double)open / fmax((double)inside, 1);
    found.strewn = (double)strewn / fmax((double)outside, 1);
    return found;
}

/// The numbers of the plastic ratio strew evenly.
static void place_on_hills(uint64_t index, float p[3]) {
    const double x = 2 * fmod(0.7548776662466927 * (double)index, 1) - 1, y = 2 * fmod(0.5698402909980532 * (double)index, 1) - 1;
    p[0] = (float)x, p[1] = (float)y, p[2] = (float)hill_height(x, y);
}

static void random_place(check_random *random, outline_shape shape, float p[3]) {
    const double a = check_uniform(random, -1, 1), b = check_uniform(random, 0, 2 * PI);
    if (shape == OUTLINE_SPHERE) {
        const double ring = sqrt(1 - a * a);
        p[0] = (float)(ring * cos(b)), p[1] = (float)(ring * sin(b)), p[2] = (float)a;
    } else if (shape == OUTLINE_DISC) {
        const double ring = sqrt((a + 1) / 2);
        p[0] = (float)(ring * cos(b)), p[1] = (float)(ring * sin(b)), p[2] = 0;
    } else if (shape == OUTLINE_SQUARE) {
        p[0] = (float)a, p[1] = (float)(b / PI - 1), p[2] = 0;
    } else {
        double around = PI * a, ring = RING_RADIUS + TUBE * cos(around);
        // Area goes with the distance from the axis.
        while (check_uniform(random, 0, RING_RADIUS + TUBE) > ring) {
            around = check_uniform(random, -PI, PI);
            ring = RING_RADIUS + TUBE * cos(around);
        }
        p[0] = (float)(ring * cos(b)), p[1] = (float)(ring * sin(b)), p[2] = (float)(TUBE * sin(around));
    }
}

ewa_cloud *outline_points(ewa_context *context, outline_shape shape, uint64_t point_count) {
    ewa_cloud *cloud = check_cloud_of(context, point_count);
    float *position = check_add(cloud, EWA_POSITION, EWA_F32, 3);
    check_random random = {17};
    for (uint64_t i = 0; i < point_count; i++)
        if (shape == OUTLINE_HILLS)
            place_on_hills(i, position + 3 * i);
        else
            random_place(&random, shape, position + 3 * i);
    return cloud;
}
