// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What packets promise whatever the range of the numbers: places far from the origin, from each other and
// from the eye, sizes, colours and shapes of surfels far apart from each other (docs/conventions.md).
#include "cloud/cloud.h"
#include "image/srgb.h"
#include "surface/packets.h"
#include "tests/splat/picture.h"

#include <math.h>

enum { SIDE_PX = 128 };

static const double GOLDEN_ANGLE = 2.39996322972865332; // radians between neighbours on a Fibonacci spiral

/// A cloud of doubles that tests fill.
typedef struct points {
    ewa_cloud *cloud;
    double *position, *normal, *radius;
    float *color;
} points;

static points make_points(ewa_context *context, uint64_t count) {
    points made;
    assert_int_equal(ewa_cloud_create(context, count, &made.cloud), EWA_OK);
    ewa_cloud *cloud = made.cloud;
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, (void **)&made.position), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_NORMAL, EWA_F64, 3, (void **)&made.normal), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_RADIUS, EWA_F64, 1, (void **)&made.radius), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_COLOR, EWA_F32, 3, (void **)&made.color), EWA_OK);
    return made;
}

/// Points [first, first + count) become a sphere with bands of colours.
static void put_sphere(const points *to, uint64_t first, uint64_t count, const double center[3],
                       double radius) {
    for (uint64_t i = 0; i < count; i++) {
        const double z = 1 - (2 * (double)i + 1) / (double)count, r = sqrt(1 - z * z);
        const double turn = GOLDEN_ANGLE * (double)i;
        const double n[3] = {r * cos(turn), r * sin(turn), z};
        for (int c = 0; c < 3; c++) {
            to->position[3 * (first + i) + (uint64_t)c] = center[c] + radius * n[c];
            to->normal[3 * (first + i) + (uint64_t)c] = n[c];
            to->color[3 * (first + i) + (uint64_t)c] = (float)(0.5 + 0.4 * sin(5 * n[c] + c));
        }
        to->radius[first + i] = 4 * radius / sqrt((double)count);
    }
}

static ewa_camera camera_to(const double eye[3], const double target[3], double fov_deg) {
    ewa_camera camera;
    const double up[3] = {0.1, 0.2, 1};
    ewa_camera_init(&camera);
    camera.width_px = camera.height_px = SIDE_PX;
    assert_int_equal(ewa_camera_set_fov(&camera, fov_deg), EWA_OK);
    assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
    return camera;
}

static double unit_coverage_of(const ewa_cloud *cloud) {
    ewa_surfels_info info;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(cloud, NULL);
    ewa_surfels_describe(surfels, &info);
    assert_int_equal(info.left_out_count, 0);
    return info.unit_coverage;
}

/// Draws a cloud both ways; returns how close the colours of the pixels are whose reference is at most
/// `brightest`, for a peak of 1. At least a tenth of the picture must show something.
static double closeness_db(ewa_cloud *cloud, const ewa_camera *camera, const ewa_render_options *options,
                           double brightest) {
    const scene of = {cloud, *camera, unit_coverage_of(cloud)};
    picture reference = picture_of_scene(&of, NULL, options);
    picture fast = picture_draw(ewa_cloud_context(cloud), cloud, camera, NULL, options);
    double sum = 0;
    size_t counted = 0, shown = 0;
    const size_t pixels = (size_t)camera->width_px * camera->height_px;
    for (size_t i = 0; i < pixels; i++) {
        const float *a = &reference.frame.rgba[4 * i], *b = &fast.frame.rgba[4 * i];
        shown += a[3] > 0.05f;
        for (int c = 0; c < 4; c++) assert_true(isfinite(b[c]));
        if (fmax((double)a[0], fmax((double)a[1], (double)a[2])) > brightest) continue;
        counted++;
        for (int c = 0; c < 4; c++) sum += pow((double)a[c] - (double)b[c], 2) / 4;
    }
    assert_true(10 * shown > pixels && 10 * counted > pixels);
    picture_free(&reference);
    picture_free(&fast);
    return -10 * log10(fmax(sum / (double)counted, 1e-20));
}

static void assert_close(const char *what, double db, double min_db) {
    print_message("%s: %.1f dB\n", what, db);
    if (!(db >= min_db)) fail_msg("%s: %.1f dB, less than %.1f", what, db, min_db);
}

/// One light of 10,000, one of -300 and one that is infinite cost their neighbours nothing.
TEST_ON(test_one_bright_colour, 0) {
    const uint64_t count = 20000;
    points made = make_points(context, count);
    const double center[3] = {0, 0, 0}, eye[3] = {3, -2, 1};
    put_sphere(&made, 0, count, center, 1);
    for (uint64_t i = 0; i < 3 * count; i++) made.color[i] *= 0.3f;
    for (uint64_t i = 0; i < count; i += 1999) made.color[3 * i + i % 3] = 1e4f;
    made.color[3 * 777] = -300, made.color[3 * 5555 + 1] = INFINITY;
    const ewa_camera camera = camera_to(eye, center, 40);
    WITH_DEFAULTS(ewa_render_options, options);
    assert_close("one bright colour", closeness_db(made.cloud, &camera, &options, 1), 60);
    ewa_cloud_destroy(&made.cloud);
}

/// Ellipses of aspects from 8,000 to 800,000 of which the length alone is seen, and how much there is of
/// them.
TEST_ON(test_needles, 0) {
    enum { NEEDLES = 400 };
    check_random random = {3};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, NEEDLES);
    double *position = check_add(cloud, EWA_POSITION, EWA_F64, 3);
    double *u = check_add(cloud, EWA_TANGENT_U, EWA_F64, 3);
    double *v = check_add(cloud, EWA_TANGENT_V, EWA_F64, 3);
    float *color = check_add(cloud, EWA_COLOR, EWA_F32, 3);
    for (uint64_t i = 0; i < NEEDLES; i++) {
        // Nearly in the plane of the picture, wherever that is cut.
        const double turn = check_uniform(&random, 0, 6.28), length = check_uniform(&random, 0.05, 0.3);
        const double minor = length / pow(10, check_uniform(&random, 3.9, 5.9));
        for (uint64_t c = 0; c < 3; c++) {
            position[3 * i + c] = check_uniform(&random, -0.8, 0.8);
            color[3 * i + c] = (float)check_uniform(&random, 0, 1);
        }
        const double tilt = check_uniform(&random, -0.5, 0.5);
        const double along[3] = {cos(turn), tilt, sin(turn)}, aside[3] = {-sin(turn), 0, cos(turn)};
        for (uint64_t c = 0; c < 3; c++) u[3 * i + c] = length * along[c], v[3 * i + c] = minor * aside[c];
    }
    const double center[3] = {0, 0, 0}, eye[3] = {0.2, -4, 0.3};
    const ewa_camera camera = camera_to(eye, center, 30);
    WITH_DEFAULTS(ewa_render_options, options);
    options.edge_threshold = 0.1; // they cover little
    options.shading = EWA_SHADING_NONE;
    assert_close("needles", closeness_db(cloud, &camera, &options, 1), 50);
}

/// Two spheres of a centimetre, far apart, each as good as if it were alone; and so from the other's origin.
TEST_ON(test_spheres_far_apart, 0) {
    static const double apart_m[] = {1e3, 1e5};
    const uint64_t count = 8000;
    for (size_t k = 0; k < sizeof apart_m / sizeof apart_m[0]; k++) {
        const double centers[2][3] = {{0.001, 0.002, -0.003},
                                      {apart_m[k] * 0.6 + 0.1, apart_m[k] * 0.64 + 0.01, apart_m[k] * 0.48}};
        points made = make_points(context, 2 * count);
        for (uint64_t s = 0; s < 2; s++) put_sphere(&made, s * count, count, centers[s], 0.005);
        for (int s = 0; s < 2; s++) {
            char what[64];
            const double *c = centers[s], eye[3] = {c[0] + 0.012, c[1] - 0.02, c[2] + 0.006};
            const ewa_camera camera = camera_to(eye, c, 30);
            snprintf(what, sizeof what, "sphere %d of two, %g m apart", s + 1, apart_m[k]);
            WITH_DEFAULTS(ewa_render_options, options);
            assert_close(what, closeness_db(made.cloud, &camera, &options, 1), 55);
        }
        ewa_cloud_destroy(&made.cloud);
    }
}

/// From 10 to 10^15 radii away, and from 10^-15 of a unit: always the same sphere.
TEST_ON(test_distances, 0) {
    const uint64_t count = 20000;
    const double center[3] = {0, 0, 0}, toward[3] = {0.48, -0.8, 0.36};
    for (int power = 1; power <= 15; power += 2) {
        points made = make_points(context, count);
        put_sphere(&made, 0, count, center, 1);
        const double away = pow(10, power), fov_deg = 2 * atan(1.2 / away) * 57.29577951308232;
        const double eye[3] = {away * toward[0], away * toward[1], away * toward[2]};
        const ewa_camera camera = camera_to(eye, center, fov_deg);
        WITH_DEFAULTS(ewa_render_options, options);
        options.cull = EWA_CULL_BACK; // which side is nearer, floats do not say from so far
        char what[64];
        snprintf(what, sizeof what, "from 1e%d radii", power);
        assert_close(what, closeness_db(made.cloud, &camera, &options, 1), 50);
        ewa_cloud_destroy(&made.cloud);
    }
}

static picture draw_torus(ewa_context *context, const double shift[3], double scale, bool by_origin,
                          bool orthographic) {
    scene of;
    assert_int_equal(scene_make(context, SCENE_TORUS, 3000, SIDE_PX, SIDE_PX, &of), EWA_OK);
    const uint64_t count = ewa_cloud_point_count(of.cloud);
    points made = make_points(context, count);
    ewa_attribute_read_f64(ewa_cloud_find(of.cloud, EWA_POSITION), 0, count, made.position);
    ewa_attribute_read_f64(ewa_cloud_find(of.cloud, EWA_NORMAL), 0, count, made.normal);
    ewa_attribute_read_f64(ewa_cloud_find(of.cloud, EWA_RADIUS), 0, count, made.radius);
    for (uint64_t i = 0; i < 3 * count; i++) {
        // On a grid, so that sums with the shift are exact.
        const double at = nearbyint(ldexp(made.position[i], 20));
        made.position[i] = scale * (ldexp(at, -20) + (by_origin ? 0 : shift[i % 3]));
        made.color[i] = 0.125f * (float)(i % 7);
    }
    for (uint64_t i = 0; i < count; i++) made.radius[i] *= scale;
    const double origin[3] = {scale * shift[0], scale * shift[1], scale * shift[2]};
    if (by_origin) ewa_cloud_set_origin(made.cloud, origin);
    // A camera whose matrix is exact: x right, z up, from -y.
    const double eye[3] = {0.25 + shift[0], -3.5 + shift[1], 0.5 + shift[2]};
    const double rows[16] = {1, 0, 0, -eye[0] * scale, 0, 0, -1, eye[2] * scale,
                             0, 1, 0, -eye[1] * scale, 0, 0, 0,  1};
    ewa_camera camera = check_camera(SIDE_PX, SIDE_PX);
    assert_int_equal(
        orthographic ? ewa_camera_set_ortho(&camera, 2.5 * scale) : ewa_camera_set_fov(&camera, 45), EWA_OK);
    memcpy(camera.world_to_camera, rows, sizeof rows);
    picture drawn = picture_draw(context, made.cloud, &camera, NULL, NULL);
    ewa_cloud_destroy(&made.cloud);
    scene_free(&of);
    return drawn;
}

/// The same bytes, but for depths that are larger by `scale`.
static void assert_same_picture(const picture *a, const picture *b, double scale) {
    const size_t pixels = (size_t)SIDE_PX * SIDE_PX;
    size_t covered = 0;
    assert_memory_equal(a->frame.rgba8, b->frame.rgba8, 4 * pixels);
    assert_memory_equal(a->frame.rgba, b->frame.rgba, 16 * pixels);
    assert_memory_equal(a->frame.normal, b->frame.normal, 12 * pixels);
    assert_memory_equal(a->frame.coverage, b->frame.coverage, 4 * pixels);
    for (size_t i = 0; i < pixels; i++) {
        assert_true((double)b->frame.depth[i] == scale * (double)a->frame.depth[i]);
        covered += isfinite(a->frame.depth[i]);
    }
    assert_true(covered > pixels / 10);
}

static const double HERE[3] = {0, 0, 0};

/// A scene that is shifted by powers of two, in its positions or by its origin, is the same picture.
TEST_ON(test_shifts_by_powers_of_two, 0) {
    static const double shifts[][3] = {
        {1024, 0, 0}, {0x1p22, -0x1p23, 0x1p20}, {-0x1p30, 0x1p30, 0}, {0, 0x1p29, -0x1p31}};
    for (int orthographic = 0; orthographic < 2; orthographic++) {
        OWNED(picture_free) picture here = draw_torus(context, HERE, 1, false, orthographic);
        for (size_t i = 0; i < sizeof shifts / sizeof shifts[0]; i++)
            for (int by_origin = 0; by_origin < 2; by_origin++) {
                OWNED(picture_free) picture there = draw_torus(context, shifts[i], 1, by_origin, orthographic);
                assert_same_picture(&here, &there, 1);
            }
    }
}

/// A world whose unit is larger or smaller by a power of two is the same picture.
TEST_ON(test_units_by_powers_of_two, 0) {
    static const int powers[] = {1, -7, 20, -46, 60, -95, 98};
    for (int orthographic = 0; orthographic < 2; orthographic++) {
        OWNED(picture_free) picture one = draw_torus(context, HERE, 1, false, orthographic);
        for (size_t i = 0; i < sizeof powers / sizeof powers[0]; i++) {
            const double scale = ldexp(1, powers[i]);
            OWNED(picture_free) picture other = draw_torus(context, HERE, scale, false, orthographic);
            assert_same_picture(&one, &other, scale);
        }
    }
}

/// Colours that floats do not hold are told of: 8-bit pixels would hide them.
TEST_LOGGED(test_broken_pixels_are_told, 0) {
    OWNED(scene_free) scene of;
    assert_int_equal(scene_make(context, SCENE_SPHERE, 2000, SIDE_PX, SIDE_PX, &of), EWA_OK);
    OWNED(picture_free) picture made = picture_make(SIDE_PX, SIDE_PX);
    ewa_frame bytes_only = {.rgba8 = made.frame.rgba8};
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(of.cloud, NULL);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    assert_int_equal(ewa_render(renderer, surfels, &of.camera, NULL, &made.frame, NULL), EWA_OK);
    assert_int_equal(log->count, 0);
    // No cloud makes such a form: 5 exponent bits and the largest unit.
    for (uint32_t p = 0; p < surfels->packet_count; p++) surfels->bounds.colors[p] = 5 << 8 | 255;
    ewa_packets_sum_up(surfels);
    assert_int_equal(ewa_render(renderer, surfels, &of.camera, NULL, &made.frame, NULL), EWA_OK);
    size_t broken = 0;
    for (size_t i = 0; i < (size_t)SIDE_PX * SIDE_PX; i++) {
        bool finite = true;
        for (size_t c = 0; c < 4; c++) finite &= isfinite(made.frame.rgba[4 * i + c]) != 0;
        broken += !finite;
    }
    char expected[128];
    snprintf(expected, sizeof expected, "%zu of 16384 pixels have a colour that is infinite or not a number",
             broken);
    assert_true(broken > 0);
    assert_int_equal(log->count, 1);
    assert_string_equal(log->text, expected);
    assert_int_equal(ewa_render(renderer, surfels, &of.camera, NULL, &bytes_only, NULL), EWA_OK);
    assert_int_equal(log->count, 2);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
