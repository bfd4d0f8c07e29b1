// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/reference/surface.c: what a picture must show, known answers, failures.
#include "homogeneous/vec.h"
#include "reference/surface.h"
#include "surface/surfel.h"
#include "tests/splat/picture.h"

#include <string.h>

static const double PI = 3.14159265358979323846;

enum { SIZE = PICTURE_SMALL_PX };

static ewa_render_options default_options(void) {
    WITH_DEFAULTS(ewa_render_options, options);
    return options;
}

/// Depth and distance along the ray to the unit sphere around the origin, or INFINITY.
static double sphere_depth(const ewa_camera *camera, double x_px, double y_px, double normal_world[3]) {
    const double *m = camera->world_to_camera;
    double eye[3],
        ray[3] = {(x_px - camera->cx_px) / camera->fx_px, (y_px - camera->cy_px) / camera->fy_px, 1};
    double d[3] = {0, 0, 0};
    ewa_camera_eye(camera, eye);
    for (int row = 0; row < 3; row++)
        for (int c = 0; c < 3; c++) d[c] += m[4 * row + c] * ray[row];
    const double a = d[0] * d[0] + d[1] * d[1] + d[2] * d[2],
                 b = eye[0] * d[0] + eye[1] * d[1] + eye[2] * d[2];
    const double c = eye[0] * eye[0] + eye[1] * eye[1] + eye[2] * eye[2] - 1, root = b * b - a * c;
    if (root < 0) return INFINITY;
    const double z = (-b - sqrt(root)) / a;
    for (int k = 0; k < 3; k++) normal_world[k] = eye[k] + z * d[k];
    return z;
}

/// A sphere against its ray-traced truth: no holes, nothing outside, depth and normals right, edges
/// antialiased.
TEST_ON(test_sphere, 0) {
    enum { WIDTH = 256 };
    OWNED(scene_free) scene made;
    assert_int_equal(scene_make(context, SCENE_SPHERE, 20000, WIDTH, WIDTH, &made), EWA_OK);
    WITH_DEFAULTS(ewa_surfels_options, surfels);
    surfels.radius_scale = 1.2; // no gap of the jittered points is below tau
    made.unit_coverage *= 1.2 * 1.2;
    OWNED(picture_free) picture shown = picture_of_scene(&made, &surfels, NULL);
    const double spacing = sqrt(4 * PI / 20000), sigma = 1.2 * 0.6 * spacing;
    int inside_count = 0, partial = 0;
    double depth_error = 0, normal_error = 0, mean_coverage = 0;
    for (int y = 0; y < WIDTH; y++)
        for (int x = 0; x < WIDTH; x++) {
            int hits = 0; // of 9 x 9 places within 2 pixels
            double n[3];
            for (int i = 0; i < 81; i++)
                hits += isfinite(
                    sphere_depth(&made.camera, x + 0.5 + (i % 9 - 4) / 2.0, y + 0.5 + (i / 9 - 4) / 2.0, n));
            const size_t at = (size_t)(y * WIDTH + x);
            const float alpha = shown.frame.rgba[4 * at + 3];
            if (hits == 0) assert_true(alpha == 0);
            if (hits == 81) assert_true(alpha == 1);
            partial += alpha > 0 && alpha < 1;
            const double z = sphere_depth(&made.camera, x + 0.5, y + 0.5, n);
            if (hits < 81) continue;
            const double *m = made.camera.world_to_camera;
            double facing = 0; // cosine between view and normal, nearly
            for (int c = 0; c < 3; c++) facing -= m[8 + c] * n[c];
            if (facing < 0.3) continue;
            inside_count++;
            mean_coverage += (double)shown.frame.coverage[at];
            depth_error = fmax(depth_error, fabs((double)shown.frame.depth[at] - z));
            for (int c = 0; c < 3; c++)
                normal_error =
                    fmax(normal_error, fabs((double)shown.frame.normal[3 * at + (size_t)c] - n[c]));
        }
    assert_true(inside_count > 10000);
    assert_true(partial > 100 && partial < 2000); // a rim of one or two pixels
    mean_coverage /= inside_count;
    assert_true(fabs(mean_coverage - 1) < 0.03);
    // Discs stand off the sphere by up to (F sigma)^2 / 2, seen at an angle, and mix within the tolerance.
    assert_true(depth_error < 2 * sigma * sigma / 0.3);
    assert_true(normal_error < 2 * sigma);
}

/// A plane of coplanar discs, oblique to the view: its depth is exact, its normal too, in both projections
/// and kernels.
TEST_ON(test_plane_depth, 0) {
    OWNED(scene_free) scene made = picture_small_scene(context, SCENE_PLANE);
    const double eye[3] = {0.3, -1.1, 0.8}, target[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    assert_int_equal(ewa_camera_look_at(&made.camera, eye, target, up), EWA_OK);
    for (int i = 0; i < 4; i++) {
        if (i == 2) assert_int_equal(ewa_camera_set_ortho(&made.camera, 1.5), EWA_OK);
        ewa_render_options options = default_options();
        options.kernel = i % 2 ? EWA_KERNEL_AFFINE : EWA_KERNEL_PERSPECTIVE;
        options.prefilter_px = 0;
        OWNED(picture_free) picture shown = picture_of_scene(&made, NULL, &options);
        const double *m = made.camera.world_to_camera;
        int covered = 0;
        for (int y = 0; y < SIZE; y++)
            for (int x = 0; x < SIZE; x++) {
                const size_t at = (size_t)(y * SIZE + x);
                if (!isfinite(shown.frame.depth[at])) continue;
                // World z of the shown point: row 2 of A' (p - t).
                const double depth = (double)shown.frame.depth[at], s = i < 2 ? depth : 1;
                const double p[3] = {(x + 0.5 - made.camera.cx_px) / made.camera.fx_px * s,
                                     (y + 0.5 - made.camera.cy_px) / made.camera.fy_px * s, depth};
                double w[3] = {0, 0, 0};
                for (int row = 0; row < 3; row++)
                    for (int c = 0; c < 3; c++) w[c] += m[4 * row + c] * (p[row] - m[4 * row + 3]);
                // Beyond the rim of the plane, depths are clamped to the discs' ranges.
                if (fabs(w[0]) > 0.95 || fabs(w[1]) > 0.95) continue;
                assert_true(fabs(w[2]) < (i == 1 ? 1e-3 : 2e-6)); // affine ellipses are not the discs'
                assert_true(fabsf(shown.frame.normal[3 * at + 2] - 1) < 1e-6f);
                covered++;
            }
        assert_true(covered > SIZE * SIZE / 3);
    }
}

/// A floor of large discs through the eye plane covers everything below the horizon, with its depth. F, h and
/// tau are the first ones of docs/math.md section 14: an ellipse's bell sits nearer to the eye than its
/// disc's middle, which discs as large as here (0.6 of their distance) do not even out at F = 3, where two
/// rows have alpha 0.81.
TEST_ON(test_floor_through_the_eye, 0) {
    enum { ROWS = 40, COUNT = ROWS * ROWS };
    OWNED(scene_free) scene made = {.unit_coverage = 0.3};
    float position[COUNT][3], radius[COUNT];
    static float normal[COUNT][3];
    for (int i = 0; i < COUNT; i++) {
        position[i][0] = 0.5f * (float)(i % ROWS - ROWS / 2);
        position[i][1] = 0.25f;
        position[i][2] = 0.5f * (float)(i / ROWS - 2);
        normal[i][1] = -1;
        radius[i] = 0.6f;
    }
    assert_int_equal(ewa_cloud_create(context, COUNT, &made.cloud), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_POSITION, EWA_F32, 3, position, 0), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_NORMAL, EWA_F32, 3, normal, 0), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_RADIUS, EWA_F32, 1, radius, 0), EWA_OK);
    ewa_camera_init(&made.camera);
    made.camera.width_px = made.camera.height_px = SIZE;
    made.camera.fx_px = made.camera.fy_px = 50;
    made.camera.cx_px = SIZE / 2;
    made.camera.cy_px = 20;
    for (int i = 0; i < 4; i++) {
        const ewa_kernel kernel = (ewa_kernel)(i / 2);
        int holes = 0;
        ewa_render_options options = default_options();
        options.kernel = kernel;
        options.edge_layers = 1; // a tear must not be filled from behind
        options.prefilter_px = i % 2 ? 0 : 0.5;
        options.edge_threshold = 0.6;
        WITH_DEFAULTS(ewa_surfels_options, surfels);
        surfels.cutoff = 2;
        OWNED(picture_free) picture shown = picture_of_scene(&made, &surfels, &options);
        // From 5 pixels below the horizon (2.5 units away, where the grid still is wide enough) to the lower
        // edge, whose rays meet the floor at z = 0.16 below the nearest discs.
        for (int y = 25; y < SIZE; y++)
            for (int x = 0; x < SIZE; x++) {
                const size_t at = (size_t)(y * SIZE + x);
                const double z = 0.25 * 50 / (y + 0.5 - 20);
                holes += shown.frame.rgba[4 * at + 3] < 1;
                if (kernel == EWA_KERNEL_PERSPECTIVE)
                    assert_true(fabs((double)shown.frame.depth[at] - z) < (i % 2 ? 1e-6 : 0.1) * z);
            }
        if (kernel == EWA_KERNEL_PERSPECTIVE) assert_int_equal(holes, 0); // the affine one may tear (PAS 1)
        for (int y = 0; y < 17; y++)
            for (int x = 0; x < SIZE; x++) assert_true(shown.frame.rgba[4 * (y * SIZE + x) + 3] == 0);
    }
}

/// One disc in front of the middle of a picture, radius and colour given; the frame's planes by hand.
TEST_ON(test_resolve, 1) {
    const float position[3] = {0, 0, 2}, normal[3] = {0, 0.6f, -0.8f}, radius = 4,
                color[4] = {0.5f, 0.25f, 1, 1};
    OWNED(scene_free) scene made = {.unit_coverage = 0.5};
    assert_int_equal(ewa_cloud_create(context, 1, &made.cloud), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_POSITION, EWA_F32, 3, position, 0), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_NORMAL, EWA_F32, 3, normal, 0), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_RADIUS, EWA_F32, 1, &radius, 0), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_COLOR, EWA_F32, 4, color, 0), EWA_OK);
    ewa_camera_init(&made.camera);
    made.camera.width_px = made.camera.height_px = 1;
    made.camera.cx_px = made.camera.cy_px = 0.5;
    made.camera.fx_px = made.camera.fy_px = 1000;
    ewa_render_options options = default_options();
    options.kernel = EWA_KERNEL_AFFINE;
    options.background[0] = 0.1f;
    options.background[2] = 1;
    options.background[3] = 0.505f;
    options.ambient = 0.2;
    const double q = 1 / (2 * PI), alpha = q / (options.edge_threshold * 0.5), sight = 0.2 + 0.8 * 0.8;
    for (int i = 0; i < 4; i++) {
        ewa_render_options chosen = options;
        double a = alpha, shade = sight;
        if (i == 1) chosen.edge_antialiasing = false, a = 1;
        if (i == 2) picture_set_light(&chosen, 0, 5, 0), shade = 0.2 + 0.8 * 0.6;
        if (i == 3) picture_set_light(&chosen, 0, 0, 1), shade = 0.2; // from behind
        OWNED(picture_free) picture shown = picture_of_scene(&made, NULL, &chosen);
        const ewa_frame *frame = &shown.frame;
        assert_true(fabs((double)frame->coverage[0] - q / 0.5) < 1e-6);
        assert_true(fabs((double)frame->depth[0] - 2) < 1e-6);
        assert_true(fabs((double)frame->normal[1] - 0.6) < 1e-6 &&
                    fabs((double)frame->normal[2] + 0.8) < 1e-6);
        const double behind = 0.505 * (1 - a), total = a + behind;
        const double rgb[3] = {0.5 * shade * a + 0.1 * behind, 0.25 * shade * a, shade * a + behind};
        for (int c = 0; c < 3; c++) {
            assert_true(fabs((double)frame->rgba[c] - rgb[c]) < 1e-6);
            const double s = rgb[c] / total <= 0.0031308 ? 12.92 * rgb[c] / total
                                                         : 1.055 * pow(rgb[c] / total, 1 / 2.4) - 0.055;
            assert_int_equal(frame->rgba8[c], (int)(255 * s + 0.5));
        }
        assert_true(fabs((double)frame->rgba[3] - total) < 1e-6);
        assert_int_equal(frame->rgba8[3], (int)(255 * total + 0.5));
    }
    options.shading = EWA_SHADING_NONE;
    options.passes = 1;
    options.edge_threshold = 2; // means nothing here
    OWNED(picture_free) picture shown = picture_of_scene(&made, NULL, &options);
    for (int c = 0; c < 3; c++) assert_true(shown.frame.rgba[c] == color[c]);
    assert_true(shown.frame.rgba[3] == 1 && shown.frame.coverage[0] == 1);
    picture_free(&shown);
    // From behind: turned towards the viewer, or culled.
    made.camera.world_to_camera[11] = 4;
    made.camera.world_to_camera[0] = -1;
    made.camera.world_to_camera[10] = -1;
    shown = picture_of_scene(&made, NULL, &options);
    assert_true(fabs((double)shown.frame.normal[2] - 0.8) < 1e-6 && shown.frame.rgba[3] == 1);
    picture_free(&shown);
    options.cull = EWA_CULL_BACK;
    shown = picture_of_scene(&made, NULL, &options);
    assert_true(shown.frame.rgba[3] == 0.505f && shown.frame.rgba[2] == 0.505f &&
                isinf(shown.frame.depth[0]));
    assert_true(shown.frame.coverage[0] == 0 && shown.frame.normal[2] == 0);
}

/// A disc in front hides one behind it unless both lie within the tolerance.
TEST_ON(test_visibility, 1) {
    const float normal[6] = {0, 0, -1, 0, 0, -1}, radius[2] = {0.5f, 0.5f};
    const float color[6] = {1, 0, 0, 0, 0, 1};
    // Depth of the second disc, kappa, and whether it takes part: eps = kappa * 0.5.
    const struct {
        float z;
        double tolerance;
        bool shown;
    } cases[] = {{10.4f, 1, true}, {10.6f, 1, false}, {10.6f, 2, true}, {10.1f, 0, false}, {10, 0, true}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const float position[6] = {0, 0, 10, 0, 0, cases[i].z};
        OWNED(scene_free) scene made = {.unit_coverage = 0.1};
        assert_int_equal(ewa_cloud_create(context, 2, &made.cloud), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_POSITION, EWA_F32, 3, position, 0), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_NORMAL, EWA_F32, 3, normal, 0), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_RADIUS, EWA_F32, 1, radius, 0), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_COLOR, EWA_F32, 3, color, 0), EWA_OK);
        ewa_camera_init(&made.camera);
        made.camera.width_px = made.camera.height_px = 1;
        made.camera.cx_px = made.camera.cy_px = 0.5;
        ewa_render_options options = default_options();
        options.tolerance = cases[i].tolerance;
        OWNED(picture_free) picture shown = picture_of_scene(&made, NULL, &options);
        assert_true((shown.frame.rgba[2] > 0.4f) == cases[i].shown);
        assert_true(shown.frame.rgba[0] > 0.4f);
    }
}

/// Arguments that are refused, planes that are not wanted, clouds of nothing.
TEST_LOGGED(test_arguments, 0) {
    OWNED(scene_free) scene made = picture_small_scene(context, SCENE_SPHERE);
    const ewa_frame nothing = {.rgba = NULL};
    assert_int_equal(ewa_render_reference(NULL, NULL, 1, &made.camera, NULL, &nothing), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_render_reference(made.cloud, NULL, 1, NULL, NULL, &nothing), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_render_reference(made.cloud, NULL, 1, &made.camera, NULL, NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_render_reference(made.cloud, NULL, 0, &made.camera, NULL, &nothing),
                     EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "unit_coverage"));
    ewa_camera broken = made.camera;
    broken.fx_px = 0;
    assert_int_equal(ewa_render_reference(made.cloud, NULL, 1, &broken, NULL, &nothing), EWA_ERROR_ARGUMENT);
    ewa_cloud_remove(made.cloud, EWA_RADIUS);
    assert_int_equal(ewa_render_reference(made.cloud, NULL, 1, &made.camera, NULL, &nothing),
                     EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "radius"));
    scene_free(&made);
    made = picture_small_scene(context, SCENE_SPHERE);
    assert_int_equal(ewa_render_reference(made.cloud, NULL, 1, &made.camera, NULL, &nothing), EWA_OK);
    ewa_cloud_destroy(&made.cloud);
    assert_int_equal(ewa_cloud_create(context, 0, &made.cloud), EWA_OK);
    assert_int_equal(ewa_cloud_add(made.cloud, EWA_POSITION, EWA_F32, 3, NULL), EWA_OK);
    assert_int_equal(ewa_cloud_add(made.cloud, EWA_NORMAL, EWA_F32, 3, NULL), EWA_OK);
    assert_int_equal(ewa_cloud_add(made.cloud, EWA_RADIUS, EWA_F32, 1, NULL), EWA_OK);
    OWNED(picture_free) picture shown = picture_of_scene(&made, NULL, NULL);
    for (size_t i = 0; i < SIZE * SIZE; i++)
        assert_true(shown.frame.rgba[4 * i + 3] == 0 && isinf(shown.frame.depth[i]));
}

static bool refuse_to_go_on(void *user, const char *stage, double fraction) {
    (void)stage;
    return fraction < *(const double *)user;
}

/// Every allocation that fails and every moment to cancel gives its status and frees what there was.
TEST(test_failures) {
    check_memory memory = {.calls_left = -1};
    double patience = 2;
    WITH_DEFAULTS(ewa_context_options, options);
    options.allocator = check_allocator(&memory);
    options.progress = refuse_to_go_on;
    options.progress_user = &patience;
    ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    scene made = picture_small_scene(context, SCENE_NEAR);
    float *tangents = ewa_cloud_find(made.cloud, EWA_TANGENT_U)->data;
    for (int i = 0; i < 30; i++) tangents[3 * i] = NAN; // points that cannot be drawn
    picture shown = picture_make(SIZE, SIZE);
    const int64_t held_bytes = memory.held_bytes;
    ewa_status status = EWA_ERROR_MEMORY;
    for (int allowed = 0; status == EWA_ERROR_MEMORY; allowed++) {
        memory.calls_left = allowed;
        status = ewa_render_reference(made.cloud, NULL, 1, &made.camera, NULL, &shown.frame);
        assert_true(memory.held_bytes == held_bytes && allowed < 10);
    }
    assert_int_equal(status, EWA_OK);
    memory.calls_left = -1;
    for (patience = 0; patience <= 1; patience += 0.25)
        assert_int_equal(ewa_render_reference(made.cloud, NULL, 1, &made.camera, NULL, &shown.frame),
                         EWA_CANCELLED);
    assert_true(memory.held_bytes == held_bytes);
    picture_free(&shown);
    scene_free(&made);
    ewa_context_destroy(&context);
    assert_true(memory.held_bytes == 0);
}

/// The comparison finds what differs and the mask where it may.
TEST_ON(test_comparison, 0) {
    OWNED(scene_free) scene made = picture_small_scene(context, SCENE_TORUS);
    ewa_cloud_remove(made.cloud, EWA_CURVATURE); // splats at contours move by their size, not at its edges alone
    for (uint32_t passes = 1; passes <= 3; passes += 2) {
        ewa_render_options options = default_options();
        options.passes = passes;
        uint8_t mask[SIZE * SIZE];
        picture_mark_edges(&made, NULL, &options, 1e-6, 1e-7, mask);
        OWNED(picture_free)
        picture a = picture_of_scene(&made, NULL, &options), b = picture_of_scene(&made, NULL, &options);
        picture_report report = picture_compare(&a, &b, 1e-3, mask);
        assert_int_equal(report.over_count, 0);
        assert_true(report.color == 0 && report.depth == 0 && report.coverage == 0 && report.normal == 0);
        assert_true(report.edge_count < 20);
        b.frame.rgba[4 * (40 * SIZE + 30) + 1] += 0.5f;
        report = picture_compare(&a, &b, 1e-3, mask);
        assert_int_equal(report.over_count, 1);
        assert_true(report.worst_px[0] == 30 && report.worst_px[1] == 40 && fabs(report.color - 0.5) < 1e-6);
        picture_free(&b);
        // What a slightly different cutoff changes by much is on the cutoff's edge (weights change there by
        // the share of the kernel's height at its rim).
        WITH_DEFAULTS(ewa_surfels_options, surfels);
        surfels.cutoff *= 1 + 1e-4;
        surfels.radius_scale = 1 + 1e-4; // the same sigma
        picture_mark_edges(&made, NULL, &options, 1e-3, 1e-4, mask);
        b = picture_of_scene(&made, &surfels, &options);
        report = picture_compare(&a, &b, 5e-3, mask);
        assert_true(report.over_count > 0);
        assert_int_equal(report.edge_over_count, report.over_count);
        assert_true(report.edge_count < SIZE * SIZE / 4);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
