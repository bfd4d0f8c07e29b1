// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Zero holes: a plane whose discs just touch (support radius to the corners of a square grid's cells) shows
// no background inside, from random cameras down to 1 degree above it.
//
// EWA_QUALITY_CAMERAS sets the number of cameras (default 60; the documented run takes 1000).
#include "check.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

enum { SIDE = 192, GRID = 48 };

#define PI 3.141592653589793

typedef struct hole_counts {
    uint64_t inside, holes, cameras_with_holes;
} hole_counts;

static uint32_t camera_count(void) {
    const char *text = getenv("EWA_QUALITY_CAMERAS");
    const long wanted = text ? strtol(text, NULL, 10) : 0;
    return wanted > 0 && wanted <= 1000000 ? (uint32_t)wanted : 60;
}

static void random_camera(check_random *random, ewa_camera *camera) {
    // Elevations evenly in their logarithm from 1 to 90 degrees, distances likewise from 3 spacings to 1.5
    // edges.
    const double elevation = PI / 180 * exp(check_uniform(random, 0, log(90)));
    const double azimuth = check_uniform(random, 0, 2 * PI);
    const double distance = exp(check_uniform(random, log(3 * 2.0 / GRID), log(3)));
    const double target[3] = {check_uniform(random, -0.8, 0.8), check_uniform(random, -0.8, 0.8), 0};
    const double eye[3] = {target[0] + distance * cos(elevation) * cos(azimuth),
                           target[1] + distance * cos(elevation) * sin(azimuth), distance * sin(elevation)};
    const double roll = check_uniform(random, 0, 2 * PI), up[3] = {cos(roll), sin(roll), 0.5};
    ewa_camera_init(camera);
    camera->width_px = camera->height_px = SIDE;
    assert_int_equal(ewa_camera_set_fov(camera, check_uniform(random, 20, 90)), EWA_OK);
    assert_int_equal(ewa_camera_look_at(camera, eye, target, up), EWA_OK);
}

/// Whether the ray through a point of the picture meets the square of edge 2 in front of the eye.
static bool meets_square(const ewa_camera *camera, const double eye[3], double x_px, double y_px) {
    const double x = (x_px - camera->cx_px) / camera->fx_px, y = (y_px - camera->cy_px) / camera->fy_px;
    const double *m = camera->world_to_camera;
    double ray[3];
    for (int c = 0; c < 3; c++) ray[c] = m[c] * x + m[4 + c] * y + m[8 + c];
    const double t = -eye[2] / ray[2];
    return t > 0 && fabs(eye[0] + t * ray[0]) <= 1 && fabs(eye[1] + t * ray[1]) <= 1;
}

/// Counts pixels that lie wholly inside of the square, and those of them that nothing covers.
static void count_holes(const ewa_camera *camera, const float *coverage, hole_counts *counts) {
    double eye[3];
    ewa_camera_eye(camera, eye);
    bool corner[2][SIDE + 1];
    uint64_t holes = 0;
    for (int y = 0; y <= SIDE; y++) {
        for (int x = 0; x <= SIDE; x++) corner[y & 1][x] = meets_square(camera, eye, x, y);
        for (int x = 0; x < SIDE && y > 0; x++) {
            if (!corner[0][x] || !corner[0][x + 1] || !corner[1][x] || !corner[1][x + 1]) continue;
            counts->inside++;
            holes += !(coverage[(y - 1) * SIDE + x] > 0);
        }
    }
    counts->holes += holes;
    counts->cameras_with_holes += holes > 0;
}

static void render_cameras(ewa_kernel kernel, double prefilter_px, hole_counts *counts) {
    *counts = (hole_counts){0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, NULL);
    WITH_DEFAULTS(ewa_generate_options, plane);
    plane.point_count = GRID * GRID;
    plane.jitter = 0;
    plane.radius_scale = sqrt(0.5) * 1.0001; // to the corner, and what single precision may lose
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_generate(context, &plane, &cloud), EWA_OK);
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(cloud, NULL);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    WITH_DEFAULTS(ewa_render_options, options);
    options.kernel = kernel;
    options.prefilter_px = prefilter_px;
    static float coverage[SIDE * SIDE];
    const ewa_frame frame = {.coverage = coverage};
    check_random random = {2026};
    const uint32_t cameras = camera_count();
    for (uint32_t i = 0; i < cameras; i++) {
        ewa_camera camera;
        random_camera(&random, &camera);
        assert_int_equal(ewa_render(renderer, surfels, &camera, &options, &frame, NULL), EWA_OK);
        count_holes(&camera, coverage, counts);
    }
    print_message("%s, h %g: %llu of %llu pixels inside are holes, %llu of %u cameras see one\n",
                  kernel == EWA_KERNEL_AFFINE ? "affine" : "perspective", prefilter_px,
                  (unsigned long long)counts->holes, (unsigned long long)counts->inside,
                  (unsigned long long)counts->cameras_with_holes, cameras);
}

TEST(test_perspective_has_no_holes) {
    WITH_DEFAULTS(ewa_render_options, options);
    hole_counts counts;
    render_cameras(EWA_KERNEL_PERSPECTIVE, options.prefilter_px, &counts);
    assert_true(counts.inside > 100000);
    assert_int_equal(counts.holes, 0);
    render_cameras(EWA_KERNEL_PERSPECTIVE, 0, &counts);
    assert_int_equal(counts.holes, 0);
}

/// The affine kernel does leave holes: so the test above can see them.
TEST(test_affine_has_holes) {
    WITH_DEFAULTS(ewa_render_options, options);
    hole_counts counts;
    render_cameras(EWA_KERNEL_AFFINE, options.prefilter_px, &counts);
    render_cameras(EWA_KERNEL_AFFINE, 0, &counts);
    assert_true(counts.holes > 0);
}

/// Objects with the radii that ewa_cloud_generate() chooses are opaque up to a few pixels from the outline.
TEST_ON(test_generated_discs_close, 0) {
    enum { VIEW_PX = 400, RIM_PX = 8 };
    static float rgba[VIEW_PX * VIEW_PX * 4];
    static const double jitters[] = {0, 0.25, 0.5, 1};
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    for (size_t i = 0; i < sizeof jitters / sizeof jitters[0]; i++) {
        WITH_DEFAULTS(ewa_generate_options, ball);
        ball.object = EWA_OBJECT_SPHERE;
        ball.point_count = 20000;
        ball.jitter = jitters[i];
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
        assert_int_equal(ewa_cloud_generate(context, &ball, &cloud), EWA_OK);
        OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(cloud, NULL);
        ewa_camera camera = check_camera(VIEW_PX, VIEW_PX);
        assert_int_equal(ewa_camera_set_fov(&camera, 40), EWA_OK);
        static const double eye[3] = {2, 1.5, 2.2}, target[3] = {0, 0, 0}, up[3] = {0, 0, 1};
        assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
        WITH_DEFAULTS(ewa_render_options, options);
        options.cull = EWA_CULL_BACK;
        const ewa_frame frame = {.rgba = rgba};
        assert_int_equal(ewa_render(renderer, surfels, &camera, &options, &frame, NULL), EWA_OK);
        const double distance = sqrt(eye[0] * eye[0] + eye[1] * eye[1] + eye[2] * eye[2]);
        const double radius_px = camera.fx_px / sqrt(distance * distance - 1) - RIM_PX;
        int translucent = 0;
        for (int y = 0; y < VIEW_PX; y++)
            for (int x = 0; x < VIEW_PX; x++) {
                const double dx = x + 0.5 - 0.5 * VIEW_PX, dy = y + 0.5 - 0.5 * VIEW_PX;
                const bool inside = dx * dx + dy * dy < radius_px * radius_px;
                translucent += inside && rgba[4 * (y * VIEW_PX + x) + 3] < 0.999f;
            }
        print_message("sphere, jitter %g: %d translucent pixels\n", jitters[i], translucent);
        assert_int_equal(translucent, 0);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
