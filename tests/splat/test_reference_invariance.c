// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/reference/surface.c: what must not change a picture.
#include "cloud/cloud.h"
#include "homogeneous/vec.h"
#include "surface/surfel.h"
#include "tests/splat/picture.h"

#include <string.h>

enum { SIZE = PICTURE_SMALL_PX };

static ewa_render_options default_options(void) {
    WITH_DEFAULTS(ewa_render_options, options);
    return options;
}

/// A cloud of doubles with the surfels of another: p -> rotation (scale p) + shift, tangent axes likewise, in
/// the order first, first + step, ... around the count; `color` replaces the colours when it is not NULL.
static ewa_cloud *copy_surfels(const ewa_cloud *cloud, const ewa_mat3 *rotation, double scale,
                               const double shift[3], uint64_t step, const float *color) {
    WITH_DEFAULTS(ewa_surfels_options, options);
    ewa_surfel_reader reader;
    assert_int_equal(ewa_surfel_reader_open(cloud, &options, &reader), EWA_OK);
    const uint64_t count = ewa_cloud_point_count(cloud);
    ewa_cloud *made = check_cloud_of(ewa_cloud_context(cloud), count);
    static const char *const names[5] = {EWA_POSITION, EWA_TANGENT_U, EWA_TANGENT_V, EWA_NORMAL, EWA_COLOR};
    double(*to[5])[3];
    for (int i = 0; i < 5; i++) {
        void *data;
        assert_int_equal(ewa_cloud_add(made, names[i], EWA_F64, 3, &data), EWA_OK);
        to[i] = data;
    }
    void *curvatures = NULL;
    assert_int_equal(ewa_cloud_add(made, EWA_CURVATURE, EWA_F64, 1, &curvatures), EWA_OK);
    for (uint64_t i = 0; i < count; i++) {
        ewa_surfel surfel;
        bool drawable;
        ewa_surfel_read(&reader, i * step % count, 1, &surfel, &drawable);
        assert_true(drawable);
        const double *from[4] = {surfel.center, surfel.axis_u_world, surfel.axis_v_world,
                                 surfel.normal_world};
        for (int a = 0; a < 4; a++) {
            const ewa_vec3 v = vec3_scale(mat3_mul_vec3(rotation, vec3_load(from[a])), scale);
            const double moved[3] = {v.x, v.y, v.z};
            for (int c = 0; c < 3; c++) to[a][i][c] = moved[c] + (a == 0 ? shift[c] : 0);
        }
        ((double *)curvatures)[i] = surfel.curvature_world / scale;
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
TEST_ON(test_constant_color, 0) {
    const float color[3] = {0.25f, 0.5f, 0.75f};
    for (int kind = 0; kind < 2 * SCENE_COUNT; kind++) {
        OWNED(scene_free) scene made = picture_small_scene(context, (scene_kind)(kind / 2));
        ewa_cloud *plain = copy_surfels(made.cloud, &IDENTITY, 1, NOWHERE, 1, color);
        ewa_cloud_destroy(&made.cloud);
        made.cloud = plain;
        ewa_render_options options = default_options();
        options.shading = EWA_SHADING_NONE;
        options.edge_antialiasing = false;
        options.passes = kind % 2 ? 1 : 3;
        OWNED(picture_free) picture shown = picture_of_scene(&made, NULL, &options);
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
    }
}

/// Moving the principal point by whole pixels moves the picture.
TEST_ON(test_shift, 0) {
    for (int kind = 0; kind < SCENE_COUNT; kind++) {
        OWNED(scene_free) scene made = picture_small_scene(context, (scene_kind)kind);
        OWNED(picture_free) picture before = picture_of_scene(&made, NULL, NULL);
        made.camera.cx_px += 7;
        made.camera.cy_px -= 5;
        OWNED(picture_free) picture after = picture_of_scene(&made, NULL, NULL);
        uint64_t different = 0;
        for (int y = 5; y < SIZE; y++)
            for (int x = 0; x < SIZE - 7; x++) {
                const size_t a = (size_t)(y * SIZE + x), b = (size_t)((y - 5) * SIZE + x + 7);
                for (size_t c = 0; c < 4; c++)
                    different += !(fabsf(before.frame.rgba[4 * a + c] - after.frame.rgba[4 * b + c]) < 1e-6f);
                different += !(fabsf(before.frame.coverage[a] - after.frame.coverage[b]) < 1e-6f);
            }
        assert_int_equal(different, 0);
    }
}

/// Order of the points, number of threads, rotation and place of the world, scale of the camera: the same
/// picture.
TEST(test_invariance) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, NULL), *lonely = check_context(1, NULL);
    for (int kind = 0; kind < 2 * SCENE_COUNT; kind++) {
        scene made = picture_small_scene(context, (scene_kind)(kind / 2)), other = made;
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
}

/// A quarter turn of the camera around its view turns the picture.
TEST_ON(test_quarter_turn, 0) {
    for (int kind = 0; kind < SCENE_COUNT; kind++) {
        OWNED(scene_free) scene made = picture_small_scene(context, (scene_kind)kind);
        made.camera.cx_px = made.camera.cy_px = SIZE / 2.0;
        OWNED(picture_free) picture before = picture_of_scene(&made, NULL, NULL);
        double *m = made.camera.world_to_camera;
        for (int c = 0; c < 4; c++) { // (x, y) -> (-y, x)
            const double x = m[c];
            m[c] = -m[4 + c];
            m[4 + c] = x;
        }
        OWNED(picture_free) picture after = picture_of_scene(&made, NULL, NULL);
        uint64_t different = 0;
        for (int y = 0; y < SIZE; y++)
            for (int x = 0; x < SIZE; x++)
                for (int c = 0; c < 4; c++)
                    different += !(fabsf(before.frame.rgba[4 * (y * SIZE + x) + c] -
                                         after.frame.rgba[4 * (x * SIZE + SIZE - 1 - y) + c]) < 1e-6f);
        assert_int_equal(different, 0);
    }
}

/// Points that coincide but for their colour: one pass has a rule for who wins that is not the order.
TEST_ON(test_coincident_points, 1) {
    float shown[2][4];
    for (int order = 0; order < 2; order++) {
        const float position[6] = {0, 0, 1, 0, 0, 1}, normal[6] = {0, 0, -1, 0, 0, -1}, radius[2] = {1, 1};
        const float colors[2][3] = {{1, 0, 0}, {0, 1, 0}};
        float color[2][3];
        memcpy(color[0], colors[order], sizeof color[0]);
        memcpy(color[1], colors[!order], sizeof color[1]);
        OWNED(scene_free) scene made = {.unit_coverage = 1};
        assert_int_equal(ewa_cloud_create(context, 2, &made.cloud), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_POSITION, EWA_F32, 3, position, 0), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_NORMAL, EWA_F32, 3, normal, 0), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_RADIUS, EWA_F32, 1, radius, 0), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(made.cloud, EWA_COLOR, EWA_F32, 3, color, 0), EWA_OK);
        ewa_camera_init(&made.camera);
        made.camera.width_px = made.camera.height_px = 8;
        made.camera.cx_px = made.camera.cy_px = 4;
        ewa_render_options options = default_options();
        options.passes = 1;
        OWNED(picture_free) picture drawn = picture_of_scene(&made, NULL, &options);
        memcpy(shown[order], &drawn.frame.rgba[0], sizeof shown[order]);
        assert_true(drawn.frame.coverage[0] == 1);
    }
    assert_memory_equal(shown[0], shown[1], sizeof shown[0]);
    assert_true(shown[0][3] == 1 && shown[0][0] + shown[0][1] > 0.9f);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
