// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/splat/reference.c: what must not change a picture, what it must show, known answers.
#include "math/vec.h"
#include "splat/surfel.h"
#include "tests/splat/picture.h"

#include <string.h>

static const double PI = 3.14159265358979323846;

enum { SIZE = 96 };

/// Makes the scenes small enough for tests.
static scene make_scene(ewa_context *context, scene_kind kind) {
    scene made;
    const uint64_t count = kind == SCENE_ELLIPSES || kind == SCENE_NEAR ? 500 : 3000;
    assert_int_equal(scene_make(context, kind, count, SIZE, SIZE, &made), EWA_OK);
    return made;
}

static ewa_render_options default_options(void) {
    ewa_render_options options;
    ewa_render_options_init(&options, sizeof options);
    return options;
}

/// A cloud of doubles with the surfels of another: p -> rotation (scale p) + shift, tangent axes likewise, in
/// the order first, first + step, ... around the count; `color` replaces the colours when it is not NULL.
static ewa_cloud *copy_surfels(const ewa_cloud *cloud, const ewa_mat3 *rotation, double scale,
                               const double shift[3], uint64_t step, const float *color) {
    ewa_surfels_options options;
    ewa_surfels_options_init(&options, sizeof options);
    ewa_surfel_reader reader;
    assert_int_equal(ewa_surfel_reader_open(cloud, &options, &reader), EWA_OK);
    const uint64_t count = ewa_cloud_point_count(cloud);
    ewa_cloud *made = NULL;
    assert_int_equal(ewa_cloud_create(ewa_cloud_context(cloud), count, &made), EWA_OK);
    static const char *const names[5] = {EWA_POSITION, EWA_TANGENT_U, EWA_TANGENT_V, EWA_NORMAL, EWA_COLOR};
    double(*to[5])[3];
    for (int i = 0; i < 5; i++) {
        void *data;
        assert_int_equal(ewa_cloud_add(made, names[i], EWA_F64, 3, &data), EWA_OK);
        to[i] = data;
    }
    for (uint64_t i = 0; i < count; i++) {
        ewa_surfel surfel;
        bool drawable;
        ewa_surfel_read(&reader, i * step % count, 1, &surfel, &drawable);
        assert_true(drawable);
        const double *from[4] = {surfel.center_world, surfel.axis_u_world, surfel.axis_v_world,
                                 surfel.normal_world};
        for (int a = 0; a < 4; a++) {
            const ewa_vec3 v = vec3_scale(mat3_mul_vec3(rotation, vec3_load(from[a])), scale);
            const double moved[3] = {v.x, v.y, v.z};
            for (int c = 0; c < 3; c++) to[a][i][c] = moved[c] + (a == 0 ? shift[c] : 0);
        }
        for (int c = 0; c < 3; c++) to[4][i][c] = color ? (double)color[c] : surfel.color_linear[c];
    }
    return made;
}

static const ewa_mat3 IDENTITY = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
static const double NOWHERE[3] = {0, 0, 0};

/// A rotation by `angle` around the direction (1, 2, -1) (Rodrigues).
static ewa_mat3 some_rotation(double angle) {
    const double s = 1 / sqrt(6), k[3] = {s, 2 * s, -s}, c = cos(angle), t = 1 - c, n = sin(angle);
    return (ewa_mat3){{{c + t * k[0] * k[0], t * k[0] * k[1] - n * k[2], t * k[0] * k[2] + n * k[1]},
                       {t * k[1] * k[0] + n * k[2], c + t * k[1] * k[1], t * k[1] * k[2] - n * k[0]},
                       {t * k[2] * k[0] - n * k[1], t * k[2] * k[1] + n * k[0], c + t * k[2] * k[2]}}};
}

/// The camera after the world has moved: p = A w + t with w = (R' (w' - shift)) / scale.
static void move_camera(ewa_camera *camera, const ewa_mat3 *rotation, double scale, const double shift[3]) {
    double moved[16];
    memcpy(moved, camera->world_to_camera, sizeof moved);
    for (int row = 0; row < 3; row++) {
        const double *from = &camera->world_to_camera[4 * row];
        for (int c = 0; c < 3; c++) {
            moved[4 * row + c] = 0;
            for (int k = 0; k < 3; k++) moved[4 * row + c] += from[k] * rotation->m[c][k] / scale;
        }
        for (int c = 0; c < 3; c++) moved[4 * row + 3] -= moved[4 * row + c] * shift[c];
    }
    memcpy(camera->world_to_camera, moved, sizeof moved);
}

/// Fails unless the pictures agree to `tolerance` but for `allowed` pixels.
static void assert_same(const char *name, const picture *a, const picture *b, double tolerance,
                        uint64_t allowed) {
    const picture_report report = picture_compare(a, b, tolerance, NULL);
    if (report.over_count > allowed) {
        picture_print(name, &report);
        fail();
    }
}

/// Colours are weighted means: one colour in, the same colour out, wherever there is something.
static void test_constant_color(void **state) {
    (void)state;
    ewa_context *context = check_context(0, NULL);
    const float color[3] = {0.25f, 0.5f, 0.75f};
    for (int kind = 0; kind < 2 * SCENE_COUNT; kind++) {
        scene made = make_scene(context, (scene_kind)(kind / 2));
        ewa_cloud *plain = copy_surfels(made.cloud, &IDENTITY, 1, NOWHERE, 1, color);
        ewa_cloud_destroy(&made.cloud);
        made.cloud = plain;
        ewa_render_options options = default_options();
        options.shading = EWA_SHADING_NONE;
        options.edge_antialiasing = false;
        options.passes = kind % 2 ? 1 : 3;
        picture shown = picture_of_scene(&made, NULL, &options);
        uint64_t covered = 0;
        for (size_t i = 0; i < SIZE * SIZE; i++) {
            const bool there = shown.frame.coverage[i] > 0;
            covered += there;
            for (size_t c = 0; c < 3; c++)
                assert_true(fabsf(shown.frame.rgba[4 * i + c] - (there ? color[c] : 0)) < 1e-6f);
            assert_true(shown.frame.rgba[4 * i + 3] == (there ? 1 : 0));
            assert_true(isfinite(shown.frame.depth[i]) == there);
            const float *n = &shown.frame.normal[3 * i];
            assert_true(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - (there ? 1 : 0)) < 1e-5f);
        }
        assert_true(covered > SIZE * SIZE / 8);
        picture_free(&shown);
        scene_free(&made);
    }
    ewa_context_destroy(&context);
}

/// Moving the principal point by whole pixels moves the picture.
static void test_shift(void **state) {
    (void)state;
    ewa_context *context = check_context(0, NULL);
    for (int kind = 0; kind < SCENE_COUNT; kind++) {
        scene made = make_scene(context, (scene_kind)kind);
        picture before = picture_of_scene(&made, NULL, NULL);
        made.camera.cx_px += 7;
        made.camera.cy_px -= 5;
        picture after = picture_of_scene(&made, NULL, NULL);
        uint64_t different = 0;
        for (int y = 5; y < SIZE; y++)
            for (int x = 0; x < SIZE - 7; x++) {
                const size_t a = (size_t)(y * SIZE + x), b = (size_t)((y - 5) * SIZE + x + 7);
                for (size_t c = 0; c < 4; c++)
                    different += !(fabsf(before.frame.rgba[4 * a + c] - after.frame.rgba[4 * b + c]) < 1e-6f);
                different += !(fabsf(before.frame.coverage[a] - after.frame.coverage[b]) < 1e-6f);
            }
        assert_int_equal(different, 0);
        picture_free(&before);
        picture_free(&after);
        scene_free(&made);
    }
    ewa_context_destroy(&context);
}

/// Order of the points, number of threads, rotation and place of the world, scale of the camera: the same
/// picture.
static void test_invariance(void **state) {
    (void)state;
    ewa_context *context = check_context(0, NULL), *lonely = check_context(1, NULL);
    for (int kind = 0; kind < 2 * SCENE_COUNT; kind++) {
        scene made = make_scene(context, (scene_kind)(kind / 2)), other = made;
        ewa_render_options options = default_options();
        options.passes = kind % 2 ? 1 : 3;
        picture_set_light(&options, 0, -1, 0);
        picture wanted = picture_of_scene(&made, NULL, &options);
        const uint64_t count = ewa_cloud_point_count(made.cloud);

        // 7 has no common factor with any of the counts.
        assert_true(count % 7 != 0);
        other.cloud = copy_surfels(made.cloud, &IDENTITY, 1, NOWHERE, 7, NULL);
        picture shown = picture_of_scene(&other, NULL, &options);
        assert_same("order", &wanted, &shown, 1e-6, 0);
        picture_free(&shown);
        ewa_cloud_destroy(&other.cloud);

        // Across a georeferenced offset. A nanometre of rounding may tip a surfel over a cutoff or a bound;
        // with one pass it decides who wins among coplanar discs, so that colours are not compared.
        const ewa_mat3 turn = some_rotation(1);
        const double far_away[3] = {5e5, 5e6, 100};
        other.cloud = copy_surfels(made.cloud, &turn, 1, far_away, 1, NULL);
        move_camera(&other.camera, &turn, 1, far_away);
        ewa_render_options turned = options;
        const ewa_vec3 light = mat3_mul_vec3(&turn, vec3_make(0, -1, 0));
        picture_set_light(&turned, light.x, light.y, light.z);
        shown = picture_of_scene(&other, NULL, &turned);
        for (size_t i = 0; i < SIZE * SIZE; i++) { // the normal turns with the world
            float *n = &shown.frame.normal[3 * i];
            const ewa_mat3 back = mat3_transpose(&turn);
            const ewa_vec3 v = mat3_mul_vec3(&back, vec3_make((double)n[0], (double)n[1], (double)n[2]));
            n[0] = (float)v.x;
            n[1] = (float)v.y;
            n[2] = (float)v.z;
        }
        const picture_report report = picture_compare(&wanted, &shown, 1e-6, NULL);
        assert_true(report.over_count <= 2 ||
                    (options.passes == 1 && report.depth < 1e-6 && report.coverage < 1e-6));
        if (report.over_count == 0) assert_true(report.normal < 1e-5);
        picture_free(&shown);
        ewa_cloud_destroy(&other.cloud);

        // A map to the camera in other units: the same but for the depth's unit.
        other = made;
        for (int i = 0; i < 12; i++) other.camera.world_to_camera[i] *= 4;
        shown = picture_of_scene(&other, NULL, &options);
        for (size_t i = 0; i < SIZE * SIZE; i++) shown.frame.depth[i] /= 4;
        assert_same("scale", &wanted, &shown, 1e-6, 0);
        picture_free(&shown);

        scene alone = {.camera = made.camera, .unit_coverage = made.unit_coverage};
        assert_int_equal(scene_make(lonely, (scene_kind)(kind / 2), count, SIZE, SIZE, &alone), EWA_OK);
        shown = picture_of_scene(&alone, NULL, &options);
        assert_memory_equal(wanted.frame.rgba8, shown.frame.rgba8, SIZE * SIZE * 4);
        assert_memory_equal(wanted.frame.rgba, shown.frame.rgba, SIZE * SIZE * 4 * sizeof(float));
        assert_memory_equal(wanted.frame.depth, shown.frame.depth, SIZE * SIZE * sizeof(float));
        assert_memory_equal(wanted.frame.normal, shown.frame.normal, SIZE * SIZE * 3 * sizeof(float));
        picture_free(&shown);
        scene_free(&alone);
        picture_free(&wanted);
        scene_free(&made);
    }
    ewa_context_destroy(&lonely);
    ewa_context_destroy(&context);
}

/// A quarter turn of the camera around its view turns the picture.
static void test_quarter_turn(void **state) {
    (void)state;
    ewa_context *context = check_context(0, NULL);
    for (int kind = 0; kind < SCENE_COUNT; kind++) {
        scene made = make_scene(context, (scene_kind)kind);
        made.camera.cx_px = made.camera.cy_px = SIZE / 2.0;
        picture before = picture_of_scene(&made, NULL, NULL);
        double *m = made.camera.world_to_camera;
        for (int c = 0; c < 4; c++) { // (x, y) -> (-y, x)
            const double x = m[c];
            m[c] = -m[4 + c];
            m[4 + c] = x;
        }
        picture after = picture_of_scene(&made, NULL, NULL);
        uint64_t different = 0;
        for (int y = 0; y < SIZE; y++)
            for (int x = 0; x < SIZE; x++)
                for (int c = 0; c < 4; c++)
                    different += !(fabsf(before.frame.rgba[4 * (y * SIZE + x) + c] -
                                         after.frame.rgba[4 * (x * SIZE + SIZE - 1 - y) + c]) < 1e-6f);
        assert_int_equal(different, 0);
        picture_free(&before);
        picture_free(&after);
        scene_free(&made);
    }
    ewa_context_destroy(&context);
}

/// Points that coincide but for their colour: one pass has a rule for who wins that is not the order.
static void test_coincident_points(void **state) {
    (void)state;
    ewa_context *context = check_context(1, NULL);
    float shown[2][4];
    for (int order = 0; order < 2; order++) {
        const float position[6] = {0, 0, 1, 0, 0, 1}, normal[6] = {0, 0, -1, 0, 0, -1}, radius[2] = {1, 1};
        const float colors[2][3] = {{1, 0, 0}, {0, 1, 0}};
        float color[2][3];
        memcpy(color[0], colors[order], sizeof color[0]);
        memcpy(color[1], colors[!order], sizeof color[1]);
        scene made = {.unit_coverage = 1};
        assert_int_equal(ewa_cloud_create(context, 2, &made.cloud), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_POSITION, EWA_F32, 3, position, 0), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_NORMAL, EWA_F32, 3, normal, 0), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_RADIUS, EWA_F32, 1, radius, 0), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_COLOR, EWA_F32, 3, color, 0), EWA_OK);
        ewa_camera_init(&made.camera, sizeof made.camera);
        made.camera.width_px = made.camera.height_px = 8;
        made.camera.cx_px = made.camera.cy_px = 4;
        ewa_render_options options = default_options();
        options.passes = 1;
        picture drawn = picture_of_scene(&made, NULL, &options);
        memcpy(shown[order], &drawn.frame.rgba[0], sizeof shown[order]);
        assert_true(drawn.frame.coverage[0] == 1);
        picture_free(&drawn);
        scene_free(&made);
    }
    assert_memory_equal(shown[0], shown[1], sizeof shown[0]);
    assert_true(shown[0][3] == 1 && shown[0][0] + shown[0][1] > 0.9f);
    ewa_context_destroy(&context);
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
static void test_sphere(void **state) {
    (void)state;
    enum { WIDTH = 256 };
    ewa_context *context = check_context(0, NULL);
    scene made;
    assert_int_equal(scene_make(context, SCENE_SPHERE, 20000, WIDTH, WIDTH, &made), EWA_OK);
    ewa_surfels_options surfels;
    ewa_surfels_options_init(&surfels, sizeof surfels);
    surfels.radius_scale = 1.2; // no gap of the jittered points is below tau
    made.unit_coverage *= 1.2 * 1.2;
    picture shown = picture_of_scene(&made, &surfels, NULL);
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
    picture_free(&shown);
    scene_free(&made);
    ewa_context_destroy(&context);
}

/// A plane of coplanar discs, oblique to the view: its depth is exact, its normal too, in both projections
/// and kernels.
static void test_plane_depth(void **state) {
    (void)state;
    ewa_context *context = check_context(0, NULL);
    scene made = make_scene(context, SCENE_PLANE);
    const double eye[3] = {0.3, -1.1, 0.8}, target[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    assert_int_equal(ewa_camera_look_at(&made.camera, eye, target, up), EWA_OK);
    for (int i = 0; i < 4; i++) {
        if (i == 2) assert_int_equal(ewa_camera_set_ortho(&made.camera, 1.5), EWA_OK);
        ewa_render_options options = default_options();
        options.kernel = i % 2 ? EWA_KERNEL_AFFINE : EWA_KERNEL_PERSPECTIVE;
        options.prefilter_px = 0;
        picture shown = picture_of_scene(&made, NULL, &options);
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
        picture_free(&shown);
    }
    scene_free(&made);
    ewa_context_destroy(&context);
}

/// A floor of large discs through the eye plane covers everything below the horizon, with its depth. F, h and
/// tau are those of math.md: an ellipse's bell sits nearer to the eye than its disc's middle, which discs as
/// large as here (0.6 of their distance) do not even out at F = 3, where two rows have alpha 0.81.
static void test_floor_through_the_eye(void **state) {
    (void)state;
    enum { ROWS = 40, COUNT = ROWS * ROWS };
    ewa_context *context = check_context(0, NULL);
    scene made = {.unit_coverage = 0.3};
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
    ewa_camera_init(&made.camera, sizeof made.camera);
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
        ewa_surfels_options surfels;
        ewa_surfels_options_init(&surfels, sizeof surfels);
        surfels.cutoff = 2;
        picture shown = picture_of_scene(&made, &surfels, &options);
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
        picture_free(&shown);
    }
    scene_free(&made);
    ewa_context_destroy(&context);
}

/// One disc in front of the middle of a picture, radius and colour given; the frame's planes by hand.
static void test_resolve(void **state) {
    (void)state;
    ewa_context *context = check_context(1, NULL);
    const float position[3] = {0, 0, 2}, normal[3] = {0, 0.6f, -0.8f}, radius = 4,
                color[4] = {0.5f, 0.25f, 1, 1};
    scene made = {.unit_coverage = 0.5};
    assert_int_equal(ewa_cloud_create(context, 1, &made.cloud), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_POSITION, EWA_F32, 3, position, 0), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_NORMAL, EWA_F32, 3, normal, 0), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_RADIUS, EWA_F32, 1, &radius, 0), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_COLOR, EWA_F32, 4, color, 0), EWA_OK);
    ewa_camera_init(&made.camera, sizeof made.camera);
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
        picture shown = picture_of_scene(&made, NULL, &chosen);
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
        picture_free(&shown);
    }
    options.shading = EWA_SHADING_NONE;
    options.passes = 1;
    options.edge_threshold = 2; // means nothing here
    picture shown = picture_of_scene(&made, NULL, &options);
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
    picture_free(&shown);
    scene_free(&made);
    ewa_context_destroy(&context);
}

/// A disc in front hides one behind it unless both lie within the tolerance.
static void test_visibility(void **state) {
    (void)state;
    ewa_context *context = check_context(1, NULL);
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
        scene made = {.unit_coverage = 0.1};
        assert_int_equal(ewa_cloud_create(context, 2, &made.cloud), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_POSITION, EWA_F32, 3, position, 0), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_NORMAL, EWA_F32, 3, normal, 0), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_RADIUS, EWA_F32, 1, radius, 0), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_COLOR, EWA_F32, 3, color, 0), EWA_OK);
        ewa_camera_init(&made.camera, sizeof made.camera);
        made.camera.width_px = made.camera.height_px = 1;
        made.camera.cx_px = made.camera.cy_px = 0.5;
        ewa_render_options options = default_options();
        options.tolerance = cases[i].tolerance;
        picture shown = picture_of_scene(&made, NULL, &options);
        assert_true((shown.frame.rgba[2] > 0.4f) == cases[i].shown);
        assert_true(shown.frame.rgba[0] > 0.4f);
        picture_free(&shown);
        scene_free(&made);
    }
    ewa_context_destroy(&context);
}

/// Arguments that are refused, planes that are not wanted, clouds of nothing.
static void test_arguments(void **state) {
    (void)state;
    check_log log = {0};
    ewa_context *context = check_context(0, &log);
    scene made = make_scene(context, SCENE_SPHERE);
    const ewa_frame nothing = {NULL};
    assert_int_equal(ewa_render_reference(NULL, NULL, 1, &made.camera, NULL, &nothing), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_render_reference(made.cloud, NULL, 1, NULL, NULL, &nothing), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_render_reference(made.cloud, NULL, 1, &made.camera, NULL, NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_render_reference(made.cloud, NULL, 0, &made.camera, NULL, &nothing),
                     EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log.text, "unit_coverage"));
    ewa_camera broken = made.camera;
    broken.fx_px = 0;
    assert_int_equal(ewa_render_reference(made.cloud, NULL, 1, &broken, NULL, &nothing), EWA_ERROR_ARGUMENT);
    ewa_cloud_remove(made.cloud, EWA_RADIUS);
    assert_int_equal(ewa_render_reference(made.cloud, NULL, 1, &made.camera, NULL, &nothing),
                     EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log.text, "radius"));
    scene_free(&made);
    made = make_scene(context, SCENE_SPHERE);
    assert_int_equal(ewa_render_reference(made.cloud, NULL, 1, &made.camera, NULL, &nothing), EWA_OK);
    ewa_cloud_destroy(&made.cloud);
    assert_int_equal(ewa_cloud_create(context, 0, &made.cloud), EWA_OK);
    assert_int_equal(ewa_cloud_add(made.cloud, EWA_POSITION, EWA_F32, 3, NULL), EWA_OK);
    assert_int_equal(ewa_cloud_add(made.cloud, EWA_NORMAL, EWA_F32, 3, NULL), EWA_OK);
    assert_int_equal(ewa_cloud_add(made.cloud, EWA_RADIUS, EWA_F32, 1, NULL), EWA_OK);
    picture shown = picture_of_scene(&made, NULL, NULL);
    for (size_t i = 0; i < SIZE * SIZE; i++)
        assert_true(shown.frame.rgba[4 * i + 3] == 0 && isinf(shown.frame.depth[i]));
    picture_free(&shown);
    scene_free(&made);
    ewa_context_destroy(&context);
}

static bool refuse_to_go_on(void *user, const char *stage, double fraction) {
    (void)stage;
    return fraction < *(const double *)user;
}

/// Every allocation that fails and every moment to cancel gives its status and frees what there was.
static void test_failures(void **state) {
    (void)state;
    check_memory memory = {.calls_left = -1};
    double patience = 2;
    ewa_context_options options;
    ewa_context_options_init(&options, sizeof options);
    options.allocator = check_allocator(&memory);
    options.progress = refuse_to_go_on;
    options.progress_user = &patience;
    ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    scene made = make_scene(context, SCENE_NEAR);
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
static void test_comparison(void **state) {
    (void)state;
    ewa_context *context = check_context(0, NULL);
    scene made = make_scene(context, SCENE_TORUS);
    for (uint32_t passes = 1; passes <= 3; passes += 2) {
        ewa_render_options options = default_options();
        options.passes = passes;
        uint8_t mask[SIZE * SIZE];
        picture_mark_edges(&made, NULL, &options, 1e-6, 1e-7, mask);
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
        ewa_surfels_options surfels;
        ewa_surfels_options_init(&surfels, sizeof surfels);
        surfels.cutoff *= 1 + 1e-4;
        surfels.radius_scale = 1 + 1e-4; // the same sigma
        picture_mark_edges(&made, NULL, &options, 1e-3, 1e-4, mask);
        b = picture_of_scene(&made, &surfels, &options);
        report = picture_compare(&a, &b, 5e-3, mask);
        assert_true(report.over_count > 0);
        assert_int_equal(report.edge_over_count, report.over_count);
        assert_true(report.edge_count < SIZE * SIZE / 4);
        picture_free(&a);
        picture_free(&b);
    }
    scene_free(&made);
    ewa_context_destroy(&context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_constant_color),    cmocka_unit_test(test_shift),
        cmocka_unit_test(test_invariance),        cmocka_unit_test(test_quarter_turn),
        cmocka_unit_test(test_coincident_points), cmocka_unit_test(test_sphere),
        cmocka_unit_test(test_plane_depth),       cmocka_unit_test(test_floor_through_the_eye),
        cmocka_unit_test(test_resolve),           cmocka_unit_test(test_visibility),
        cmocka_unit_test(test_arguments),         cmocka_unit_test(test_failures),
        cmocka_unit_test(test_comparison),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
