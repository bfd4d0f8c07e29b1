// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Silhouettes of a sphere in a torus, 100,000 surfels, 512 x 512, against ray-cast coverage: no background
// more than 2 pixels inside, nothing of ours more than 2 pixels outside, edges antialiased.
#include "base/base.h"
#include "check.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { SIDE = 512, PART_POINTS = 50000, FINE = 8 };

/// A sphere of diameter 0.9 floats above the middle of a torus of outer diameter 2.
#define SPHERE_SIZE   0.9
#define SPHERE_HEIGHT 0.35

typedef struct scene {
    ewa_camera camera;
    double eye[3];
    float coverage[SIDE][SIDE]; ///< truth: share of the pixel's square that the objects cover
} scene;

static double distance_to_objects(const double p[3]) {
    const double ring = sqrt(p[0] * p[0] + p[1] * p[1]) - 5.0 / 7, dz = p[2] - SPHERE_HEIGHT;
    const double torus = sqrt(ring * ring + p[2] * p[2]) - 2.0 / 7;
    const double sphere = sqrt(p[0] * p[0] + p[1] * p[1] + dz * dz) - SPHERE_SIZE / 2;
    return fmin(torus, sphere);
}

/// Marches along the ray by the distance that is certainly free.
static bool hits(const scene *s, double x_px, double y_px) {
    const ewa_camera *camera = &s->camera;
    const double x = (x_px - camera->cx_px) / camera->fx_px, y = (y_px - camera->cy_px) / camera->fy_px;
    const double *m = camera->world_to_camera;
    double ray[3], length = 0;
    for (int c = 0; c < 3; c++) {
        ray[c] = m[c] * x + m[4 + c] * y + m[8 + c];
        length += ray[c] * ray[c];
    }
    length = sqrt(length);
    double t = 1;
    for (int step = 0; step < 300 && t < 10; step++) {
        double p[3];
        for (int c = 0; c < 3; c++) p[c] = s->eye[c] + t * ray[c] / length;
        const double free = distance_to_objects(p);
        if (free < 1e-6) return true;
        t += free;
    }
    return false;
}

static void trace_row(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    scene *s = data;
    for (uint32_t x = 0; x < SIDE; x++) {
        const int corners =
            hits(s, x, index) + hits(s, x + 1, index) + hits(s, x, index + 1) + hits(s, x + 1, index + 1);
        int count = 0;
        for (int k = 0; k < FINE * FINE && corners % 4; k++)
            count += hits(s, x + (k % FINE + 0.5) / FINE, index + (k / FINE + 0.5) / FINE);
        s->coverage[index][x] = corners % 4 ? (float)count / (FINE * FINE) : (float)corners / 4;
    }
}

/// Appends points [first, first + count) from a generated part, moved up by `height`.
static void copy_part(ewa_context *context, ewa_object object, double size, double height, ewa_cloud *cloud,
                      uint64_t first) {
    WITH_DEFAULTS(ewa_generate_options, options);
    options.object = object;
    options.size_world = size;
    options.radius_scale = EWA_DEFAULT_RADIUS_SCALE;
    options.point_count = PART_POINTS;
    ewa_cloud *part = NULL;
    assert_int_equal(ewa_cloud_generate(context, &options, &part), EWA_OK);
    static const char *const names[] = {EWA_POSITION, EWA_NORMAL, EWA_RADIUS};
    for (int a = 0; a < 3; a++) {
        const ewa_attribute *from = ewa_cloud_find(part, names[a]), *to = ewa_cloud_find(cloud, names[a]);
        float *target = (float *)to->data + first * to->component_count;
        memcpy(target, from->data, PART_POINTS * from->stride_bytes);
        for (uint64_t i = 0; a == 0 && i < PART_POINTS; i++) target[3 * i + 2] += (float)height;
    }
    ewa_cloud_destroy(&part);
}

/// Whether every (all) or any (not all) pixel within 2 pixels of (x, y) has the given truth: wholly covered
/// or not at all.
static bool surrounded_by(const scene *s, int x, int y, float truth) {
    for (int dy = -2; dy <= 2; dy++) {
        for (int dx = -2; dx <= 2; dx++) {
            const int nx = x + dx, ny = y + dy;
            if (dx * dx + dy * dy > 4 || nx < 0 || ny < 0 || nx >= SIDE || ny >= SIDE) continue;
            if (s->coverage[ny][nx] != truth) return false;
        }
    }
    return true;
}

TEST_ON(test_silhouettes, 0) {
    OWNED(check_free) scene *s = calloc(1, sizeof *s);
    assert_non_null(s);
    const double eye[3] = {1.2, -2.6, 1.7}, target[3] = {0, 0, 0.05}, up[3] = {0, 0, 1};
    ewa_camera_init(&s->camera);
    s->camera.width_px = s->camera.height_px = SIDE;
    assert_int_equal(ewa_camera_set_fov(&s->camera, 42), EWA_OK);
    assert_int_equal(ewa_camera_look_at(&s->camera, eye, target, up), EWA_OK);
    ewa_camera_eye(&s->camera, s->eye);
    ewa_parallel(context, trace_row, s, SIDE);

    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, 2 * PART_POINTS);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, NULL), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_NORMAL, EWA_F32, 3, NULL), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, NULL), EWA_OK);
    copy_part(context, EWA_OBJECT_TORUS, 2, 0, cloud, 0);
    copy_part(context, EWA_OBJECT_SPHERE, SPHERE_SIZE, SPHERE_HEIGHT, cloud, PART_POINTS);
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(cloud, NULL);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    static float rgba[SIDE * SIDE][4];
    const ewa_frame frame = {.rgba = &rgba[0][0]};
    assert_int_equal(ewa_render(renderer, surfels, &s->camera, NULL, &frame, NULL), EWA_OK);

    uint64_t holes = 0, translucent = 0, outside = 0, edge = 0, partial = 0;
    double bias = 0, error = 0;
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            const float alpha = rgba[y * SIDE + x][3], truth = s->coverage[y][x];
            if (alpha == 0 && surrounded_by(s, x, y, 1)) holes++;
            if (alpha < 0.999f && surrounded_by(s, x, y, 1)) translucent++;
            if (alpha > 0 && surrounded_by(s, x, y, 0)) outside++;
            if (truth == 0 || truth == 1) continue;
            edge++;
            partial += alpha > 0 && alpha < 1;
            bias += alpha - truth;
            error += fabs(alpha - truth);
        }
    }
    print_message(
        "edge pixels %llu: alpha - truth %+.3f on average, |alpha - truth| %.3f, %llu partly covered; "
        "2 pixels inside %llu holes, %llu translucent; 2 pixels outside %llu\n",
        (unsigned long long)edge, bias / (double)edge, error / (double)edge, (unsigned long long)partial,
        (unsigned long long)holes, (unsigned long long)translucent, (unsigned long long)outside);
    assert_int_equal(holes, 0);
    assert_int_equal(translucent, 0);
    assert_int_equal(outside, 0);
    assert_true(edge > 1000 && 10 * partial > 3 * edge);
    assert_true(fabs(bias / (double)edge) < 0.4 && error / (double)edge < 0.4);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
