// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sampled meshes against the solids they are: from random cameras, far and close to their edges, no pixel
// inside shows the background, and none more than a pixel outside shows the solid, but at its sharpest
// corners.
//
// EWA_QUALITY_CAMERAS sets the number of cameras (default 30; the documented run takes 500).
#include "../prepare/mesh_shapes.h"
#include "cloud/color.h"

#include <stdbool.h>

enum { SIDE = 160 };

/// A solid as one or two boxes.
typedef struct solid {
    void (*make)(ewa_context *context, ewa_mesh *mesh);
    double low[2][3], high[2][3];
} solid;

static const solid cube = {shape_cube, {{-1, -1, -1}, {-1, -1, -1}}, {{1, 1, 1}, {1, 1, 1}}};
static const solid angle = {shape_angle, {{-1, -1, -1}, {-1, -1, -1}}, {{1, 1, 0}, {0, 1, 1}}};

typedef struct edge_counts {
    uint64_t inside, outside, holes, thin, excess;
} edge_counts;

static uint32_t camera_count(void) {
    const char *text = getenv("EWA_QUALITY_CAMERAS");
    const long wanted = text ? strtol(text, NULL, 10) : 0;
    return wanted > 0 && wanted <= 1000000 ? (uint32_t)wanted : 30;
}

static bool hits(const solid *of, const ewa_camera *camera, const double eye[3], double x_px, double y_px) {
    const double x = (x_px - camera->cx_px) / camera->fx_px, y = (y_px - camera->cy_px) / camera->fy_px;
    const double *m = camera->world_to_camera;
    for (int b = 0; b < 2; b++) {
        double enter = 0, leave = INFINITY;
        for (int c = 0; c < 3; c++) {
            const double ray = m[c] * x + m[4 + c] * y + m[8 + c];
            const double t0 = (of->low[b][c] - eye[c]) / ray, t1 = (of->high[b][c] - eye[c]) / ray;
            enter = fmax(enter, fmin(t0, t1));
            leave = fmin(leave, fmax(t0, t1));
        }
        if (enter < leave) return true;
    }
    return false;
}

/// Looks at a place of an edge, a corner or a face, from half a spacing to the whole solid away.
static void random_camera(check_random *random, ewa_camera *camera, double eye[3]) {
    double target[3], direction[3], length2 = 0;
    for (int c = 0; c < 3; c++) {
        const double at = check_uniform(random, -1.5, 1.5);
        target[c] = fmax(-1, fmin(1, at));
        direction[c] = check_uniform(random, 0.05, 1) * (target[c] < 0 ? -1 : 1);
        length2 += direction[c] * direction[c];
    }
    const double distance = exp(check_uniform(random, log(0.1), log(5)));
    for (int c = 0; c < 3; c++) eye[c] = target[c] + direction[c] * distance / sqrt(length2);
    // Outside of both solids: beyond the nearest face at least a little.
    int farthest = 0;
    for (int c = 1; c < 3; c++)
        if (fabs(eye[c]) > fabs(eye[farthest])) farthest = c;
    if (fabs(eye[farthest]) < 1.05) eye[farthest] = eye[farthest] < 0 ? -1.05 : 1.05;
    const double up[3] = {check_uniform(random, -1, 1), 0.3, check_uniform(random, -1, 1)};
    ewa_camera_init(camera);
    camera->width_px = camera->height_px = SIDE;
    assert_int_equal(ewa_camera_set_fov(camera, check_uniform(random, 20, 80)), EWA_OK);
    assert_int_equal(ewa_camera_look_at(camera, eye, target, up), EWA_OK);
}

/// A pixel is inside when it and its neighbours are hit all over, outside when none of them is.
static void count_pixels(const solid *of, const ewa_camera *camera, const double eye[3],
                         const ewa_frame *frame, edge_counts *counts) {
    static bool hit[SIDE + 3][SIDE + 3];
    for (int y = 0; y < SIDE + 3; y++)
        for (int x = 0; x < SIDE + 3; x++) hit[y][x] = hits(of, camera, eye, x - 1, y - 1);
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            int sum = 0;
            for (int k = 0; k < 16; k++) sum += hit[y + k / 4][x + k % 4];
            const float coverage = frame->coverage[y * SIDE + x], alpha = frame->rgba[4 * (y * SIDE + x) + 3];
            counts->inside += sum == 16;
            counts->outside += sum == 0;
            counts->holes += sum == 16 && !(coverage > 0);
            counts->thin += sum == 16 && alpha < 0.99f;
            counts->excess += sum == 0 && coverage > 0;
        }
    }
}

/// About so many points of a mesh.
static ewa_cloud *sample_points(const ewa_mesh *mesh, uint64_t points) {
    WITH_DEFAULTS(ewa_mesh_sample_options, sample);
    sample.point_count = points;
    return shape_sample(mesh, &sample);
}

static void render_cameras(const solid *of, uint64_t points, ewa_cull cull, edge_counts *counts) {
    *counts = (edge_counts){0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, NULL);
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    of->make(context, &mesh);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = sample_points(&mesh, points);
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(cloud, NULL);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    WITH_DEFAULTS(ewa_render_options, options);
    options.cull = cull;
    static float coverage[SIDE * SIDE], rgba[4 * SIDE * SIDE];
    const ewa_frame frame = {.coverage = coverage, .rgba = rgba};
    check_random random = {77};
    for (uint32_t i = 0; i < camera_count(); i++) {
        ewa_camera camera;
        double eye[3];
        random_camera(&random, &camera, eye);
        assert_int_equal(ewa_render(renderer, surfels, &camera, &options, &frame, NULL), EWA_OK);
        count_pixels(of, &camera, eye, &frame, counts);
    }
    print_message("%llu pixels inside: %llu holes, %llu not opaque; %llu outside: %llu drawn\n",
                  (unsigned long long)counts->inside, (unsigned long long)counts->holes,
                  (unsigned long long)counts->thin, (unsigned long long)counts->outside,
                  (unsigned long long)counts->excess);
}

static void hold(const solid *of) {
    edge_counts counts;
    static const ewa_cull culls[] = {EWA_CULL_NONE, EWA_CULL_BACK};
    for (int c = 0; c < 2; c++) {
        render_cameras(of, 3000, culls[c], &counts);
        assert_true(counts.inside > 100000 && counts.outside > 30000);
        assert_int_equal(counts.holes, 0);
        // Where two antialiased lines meet at a sharp angle, their corner is longer than a pixel.
        assert_true(counts.excess * 2000 < counts.outside);
        // The widest gaps between 3,000 points shine a little where no back side is behind them.
        assert_true(counts.thin * (culls[c] == EWA_CULL_NONE ? 1000 : 25) < counts.inside);
    }
}

TEST(test_cube) { hold(&cube); }

TEST(test_angle) { hold(&angle); }

/// Where faces meet the light is between theirs: no line along the edge is brighter than both, nor darker.
TEST_ON(test_light_at_edges, 0) {
    static const double eye[3] = {3.1, 2.9, 2.7}, target[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    static float rgba[4 * SIDE * SIDE];
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    shape_cube(context, &mesh);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = sample_points(&mesh, 100000);
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(cloud, NULL);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    WITH_DEFAULTS(ewa_render_options, options);
    ewa_camera camera = check_camera(SIDE, SIDE);
    assert_int_equal(ewa_camera_set_fov(&camera, 40), EWA_OK);
    assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
    const ewa_frame frame = {.rgba = rgba};
    assert_int_equal(ewa_render(renderer, surfels, &camera, &options, &frame, NULL), EWA_OK);
    double brighter = 0, darker = 0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const double *m = camera.world_to_camera;
            const double px = (x + 0.5 - camera.cx_px) / camera.fx_px, py = (y + 0.5 - camera.cy_px) / camera.fy_px;
            double ray[3], length2 = 0, low = INFINITY, high = 0;
            for (int c = 0; c < 3; c++) {
                ray[c] = m[c] * px + m[4 + c] * py + m[8 + c];
                length2 += ray[c] * ray[c];
            }
            if (!(rgba[4 * (y * SIDE + x) + 3] == 1)) continue;
            for (int c = 0; c < 3; c++) { // the three faces that are seen, under a headlight
                const double light = options.ambient + (1 - options.ambient) * -ray[c] / sqrt(length2);
                low = fmin(low, light), high = fmax(high, light);
            }
            const double light = (double)rgba[4 * (y * SIDE + x)] / EWA_DEFAULT_GREY;
            brighter = fmax(brighter, light / high - 1), darker = fmax(darker, 1 - light / low);
        }
    print_message("pixels of a cube: up to %.3f brighter than its faces, %.3f darker\n", brighter, darker);
    assert_true(brighter < 0.06 && darker < 0.03);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
