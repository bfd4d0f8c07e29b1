// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of ewa_render_options.point_size_px: discs of one size on the screen, wherever the points are.
#include "check.h"
#include "reference/surface.h"

#include <math.h>

#define PI 3.141592653589793

enum { SIDE = 256 };

/// A cloud of surfels with normals and radii that points must not depend on.
static ewa_cloud *make_cloud(ewa_context *context, uint32_t count, float **xyz, float **normal,
                             float **radius) {
    ewa_cloud *cloud = check_cloud_of(context, count);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, (void **)xyz), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_NORMAL, EWA_F32, 3, (void **)normal), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, (void **)radius), EWA_OK);
    uint8_t *color = check_add(cloud, EWA_COLOR, EWA_U8, 3);
    for (uint32_t i = 0; i < 3 * count; i++) color[i] = (uint8_t)(37 * i);
    return cloud;
}

static void draw(ewa_context *context, const ewa_cloud *cloud, const ewa_camera *camera,
                 const ewa_render_options *options, float *rgba) {
    ewa_surfels *surfels = check_surfels(cloud, NULL);
    ewa_renderer *renderer = check_renderer(context);
    const ewa_frame frame = {.rgba = rgba};
    assert_int_equal(ewa_render(renderer, surfels, camera, options, &frame, NULL), EWA_OK);
    ewa_renderer_destroy(&renderer);
    ewa_surfels_destroy(&surfels);
}

/// A camera far off the axis, with pixels that are not square, that sees the place of camera space at a
/// pixel.
static ewa_camera make_camera(bool orthographic, double zoom) {
    ewa_camera camera = check_camera(SIDE, SIDE);
    camera.projection = orthographic ? EWA_ORTHOGRAPHIC : EWA_PERSPECTIVE;
    camera.fx_px = 150 * zoom, camera.fy_px = 230 * zoom;
    camera.cx_px = -90, camera.cy_px = 400;
    return camera;
}

typedef struct disc {
    double sum;        ///< of alpha
    double min_inside; ///< alpha of pixels well inside of the rim
    double max_outside;
    int clear; ///< pixels with alpha over 0 and below 1
} disc;

static disc measure(const float *rgba, const double at[2], double radius_px, double rim_px) {
    disc d = {.min_inside = 1};
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const double alpha = (double)rgba[4 * (y * SIDE + x) + 3];
            const double distance = hypot(x + 0.5 - at[0], y + 0.5 - at[1]);
            d.sum += alpha;
            d.clear += alpha > 0 && alpha < 1;
            if (distance < radius_px - rim_px) d.min_inside = fmin(d.min_inside, alpha);
            if (distance > radius_px + rim_px) d.max_outside = fmax(d.max_outside, alpha);
        }
    return d;
}

/// Draws one point at a pixel and a depth.
static void draw_one(ewa_context *context, const ewa_camera *camera, const double at[2], double depth,
                     float size_world, const ewa_render_options *options, float *rgba) {
    float *xyz, *normal, *radius;
    ewa_cloud *cloud = make_cloud(context, 1, &xyz, &normal, &radius);
    const double scale = camera->projection == EWA_ORTHOGRAPHIC ? 1 : depth;
    xyz[0] = (float)((at[0] - camera->cx_px) / camera->fx_px * scale);
    xyz[1] = (float)((at[1] - camera->cy_px) / camera->fy_px * scale);
    xyz[2] = (float)depth;
    normal[0] = 0.8f, normal[1] = -0.2f, normal[2] = 0.6f;
    radius[0] = size_world;
    draw(context, cloud, camera, options, rgba);
    ewa_cloud_destroy(&cloud);
}

/// Alpha adds up to the area of the disc, whatever the depth, the lens, the radius and the normal; the rim is
/// where it should be.
TEST_ON(test_size, 1) {
    static const double sizes_px[] = {1, 1.4, 2, 3, 5, 10, 24, 100};
    static const double depths[] = {1e-4, 0.7, 3, 1e5}, zooms[] = {0.3, 1, 40};
    static float rgba[4 * SIDE * SIDE];
    check_random random = {5};
    for (size_t s = 0; s < sizeof sizes_px / sizeof *sizes_px; s++)
        for (int i = 0; i < 24; i++) {
            const double radius_px = sizes_px[s] / 2, area = PI * radius_px * radius_px;
            const double at[2] = {128 + check_uniform(&random, -40, 40),
                                  128 + check_uniform(&random, -40, 40)};
            const ewa_camera camera = make_camera(i % 2, zooms[i % 3]);
            WITH_DEFAULTS(ewa_render_options, options);
            options.point_size_px = sizes_px[s];
            options.cull = i % 5 ? EWA_CULL_NONE : EWA_CULL_BACK;
            options.kernel = (ewa_kernel)(i % 5);
            options.edge_threshold = i % 7 ? 0.45 : 2;
            draw_one(context, &camera, at, depths[i % 4], i % 3 ? 1e-3f : 30.0f, &options, rgba);
            const double rim_px = fmax(1.5, radius_px / 6) + 0.5;
            const disc soft = measure(rgba, at, radius_px, rim_px);
            // A grid of pixels sees less of a small disc.
            assert_true(fabs(soft.sum / area - 1) < (sizes_px[s] < 1.3 ? 0.35
                                                     : sizes_px[s] < 2 ? 0.05
                                                                       : 0.02));
            assert_true(soft.min_inside > 0.99 && soft.max_outside < 0.03);
            // A hard rim covers the pixels whose centres it holds.
            if (i % 2)
                options.edge_antialiasing = false;
            else
                options.passes = 1;
            draw_one(context, &camera, at, depths[i % 4], 1, &options, rgba);
            const disc hard = measure(rgba, at, radius_px, 1e-3 + 1e-5 * radius_px);
            assert_int_equal(hard.clear, 0);
            assert_true(hard.min_inside == 1 && hard.max_outside == 0);
        }
}

/// The pipeline against the reference: many points, hidden ones and half hidden ones, with axes and clip
/// lines that must not count.
TEST_ON(test_against_reference, 2) {
    enum { COUNT = 700 };
    static float fast[4 * SIDE * SIDE], depth[SIDE * SIDE], normal_out[3 * SIDE * SIDE];
    static float plain[4 * SIDE * SIDE], plain_depth[SIDE * SIDE], plain_normal[3 * SIDE * SIDE];
    for (int i = 0; i < 8; i++) {
        float *xyz, *normal, *radius, *u, *v, *clip;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(context, COUNT, &xyz, &normal, &radius);
        check_random random = {(uint64_t)i + 1};
        const ewa_camera camera = make_camera(i % 2, 1);
        if (i >= 4) {
            assert_int_equal(ewa_cloud_add(cloud, EWA_TANGENT_U, EWA_F32, 3, (void **)&u), EWA_OK);
            assert_int_equal(ewa_cloud_add(cloud, EWA_TANGENT_V, EWA_F32, 3, (void **)&v), EWA_OK);
            assert_int_equal(ewa_cloud_add(cloud, EWA_CLIP0, EWA_F32, 3, (void **)&clip), EWA_OK);
        }
        for (uint32_t k = 0; k < COUNT; k++) {
            const double z = check_uniform(&random, -0.5, 6), scale = i % 2 ? 1 : z;
            xyz[3 * k] =
                (float)((check_uniform(&random, -20, SIDE + 20) - camera.cx_px) / camera.fx_px * scale);
            xyz[3 * k + 1] =
                (float)((check_uniform(&random, -20, SIDE + 20) - camera.cy_px) / camera.fy_px * scale);
            xyz[3 * k + 2] = (float)z;
            radius[k] = (float)check_uniform(&random, 1e-3, 1);
            for (uint32_t c = 0; c < 3; c++) {
                normal[3 * k + c] = (float)check_uniform(&random, -1, 1);
                if (i >= 4) {
                    u[3 * k + c] = (float)check_uniform(&random, -0.1, 0.1);
                    v[3 * k + c] = (float)check_uniform(&random, -0.1, 0.1);
                    clip[3 * k + c] = c == 2 ? 0 : 1;
                }
            }
        }
        WITH_DEFAULTS(ewa_render_options, options);
        options.point_size_px = i < 2 ? 3.3 : 21;
        options.opacity = i % 3 ? 1 : 0.6;
        options.layers = i % 3 ? 0 : 3;
        OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(cloud, NULL);
        OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
        const ewa_frame frame = {.rgba = fast, .depth = depth, .normal = normal_out};
        const ewa_frame wanted = {.rgba = plain, .depth = plain_depth, .normal = plain_normal};
        assert_int_equal(ewa_render(renderer, surfels, &camera, &options, &frame, NULL), EWA_OK);
        assert_int_equal(ewa_render_reference(cloud, NULL, 1, &camera, &options, &wanted), EWA_OK);
        int off = 0, seen = 0;
        double worst_normal = 0;
        for (int p = 0; p < SIDE * SIDE; p++) {
            double difference = 0;
            for (int c = 0; c < 4; c++)
                difference = fmax(difference, fabs((double)fast[4 * p + c] - (double)plain[4 * p + c]));
            off += difference > 5e-3;
            seen += plain[4 * p + 3] > 0;
            // Every normal faces the viewer.
            for (int c = 0; c < 3 && plain[4 * p + 3] > 0.1f; c++)
                worst_normal = fmax(worst_normal, fabs((double)normal_out[3 * p + c] - (c == 2 ? -1 : 0)));
        }
        print_message("%d: %d of %d pixels differ by over 5e-3\n", i, off, seen);
        assert_true(seen > 2000 && off <= seen / 200);
        assert_true(worst_normal < 1e-4);
    }
}

TEST(test_options) {
    static const double wrong_px[] = {-1, 0.5, 0.999, 256.5, INFINITY, NAN};
    static float rgba[4 * SIDE * SIDE];
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    float *xyz, *normal, *radius;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(context, 1, &xyz, &normal, &radius);
    xyz[0] = xyz[1] = xyz[2] = normal[0] = normal[1] = normal[2] = radius[0] = 1;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(cloud, NULL);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    const ewa_camera camera = make_camera(false, 1);
    const ewa_frame frame = {.rgba = rgba};
    WITH_DEFAULTS(ewa_render_options, options);
    assert_true(options.point_size_px == 0);
    for (size_t i = 0; i < sizeof wrong_px / sizeof *wrong_px; i++) {
        options.point_size_px = wrong_px[i];
        assert_int_equal(ewa_render(renderer, surfels, &camera, &options, &frame, NULL), EWA_ERROR_ARGUMENT);
        assert_non_null(strstr(log.text, "point_size_px"));
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
