// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the camera that frames a cloud shows: all discs, the room around them, nothing of what lies far off.
#include "check.h"
#include "framing/framing.h"

#include <math.h>
#include <stdbool.h>

static ewa_context *context;

static int begin(void **state) {
    context = check_context(1, NULL);
    return 0;
}

static int finish(void **state) {
    ewa_context_destroy(&context);
    return 0;
}

/// A point, its radius and the way that its disc faces.
typedef struct disc {
    double place[3], radius, normal[3];
} disc;

static ewa_cloud *make_cloud(const disc *discs, uint32_t count) {
    ewa_cloud *cloud = check_cloud_of(context, count);
    double *position = check_add(cloud, EWA_POSITION, EWA_F64, 3);
    float *radius = check_add(cloud, EWA_RADIUS, EWA_F32, 1);
    float *normal = check_add(cloud, EWA_NORMAL, EWA_F32, 3);
    for (uint32_t i = 0; i < count; i++) {
        radius[i] = (float)discs[i].radius;
        for (int c = 0; c < 3; c++) {
            position[3 * i + (uint32_t)c] = discs[i].place[c];
            normal[3 * i + (uint32_t)c] = (float)discs[i].normal[c];
        }
    }
    return cloud;
}

static ewa_camera make_lens(void) {
    ewa_camera camera = check_camera(800, 600);
    assert_int_equal(ewa_camera_set_fov(&camera, 30), EWA_OK);
    return camera;
}

/// The camera that frames a cloud from a direction, y or z up.
static ewa_camera fit(const ewa_cloud *cloud, double radius_scale, const double direction[3]) {
    const double up[3] = {0, direction[1] == 0, direction[1] != 0};
    ewa_camera camera = make_lens();
    OWNED(ewa_framing_destroy) ewa_framing *framing = NULL;
    assert_int_equal(ewa_framing_create(cloud, radius_scale, &framing), EWA_OK);
    assert_int_equal(ewa_framing_fit(framing, direction, up, &camera), EWA_OK);
    return camera;
}

/// The outermost pixels that a disc's rim meets: least x, least y, greatest x, greatest y.
static void add_rim(const ewa_camera *camera, const disc *d, double box[4]) {
    const double *n = d->normal, *m = camera->world_to_camera;
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    double u[3] = {0}, v[3];
    const int minimum =
        fabs(n[0]) < fabs(n[1]) ? (fabs(n[0]) < fabs(n[2]) ? 0 : 2) : (fabs(n[1]) < fabs(n[2]) ? 1 : 2);
    for (int c = 0; c < 3; c++) u[c] = (c == minimum) - n[minimum] * n[c] / (length * length);
    const double scale = 1 / sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    for (int c = 0; c < 3; c++) u[c] *= scale;
    for (int c = 0; c < 3; c++)
        v[c] = (n[(c + 1) % 3] * u[(c + 2) % 3] - n[(c + 2) % 3] * u[(c + 1) % 3]) / length;
    for (int k = 0; k < 64; k++) {
        const double x = d->radius * cos(k * 0.0981747704246810), y = d->radius * sin(k * 0.0981747704246810);
        double p[3];
        for (int r = 0; r < 3; r++) {
            p[r] = m[4 * r + 3];
            for (int c = 0; c < 3; c++) p[r] += m[4 * r + c] * (d->place[c] + x * u[c] + y * v[c]);
        }
        assert_true(p[2] > 0);
        const double pixel[2] = {camera->fx_px * p[0] / p[2] + camera->cx_px,
                                 camera->fy_px * p[1] / p[2] + camera->cy_px};
        for (int c = 0; c < 2; c++) {
            box[c] = fmin(box[c], pixel[c]);
            box[2 + c] = fmax(box[2 + c], pixel[c]);
        }
    }
}

static void rims_box(const ewa_camera *camera, const disc *discs, uint32_t count, double box[4]) {
    box[0] = box[1] = INFINITY;
    box[2] = box[3] = -INFINITY;
    for (uint32_t i = 0; i < count; i++) add_rim(camera, &discs[i], box);
}

static const double AHEAD[3] = {0, 0, -1};

/// Discs that face the camera end at 0.04 of the width from either side.
TEST(test_room) {
    const disc discs[] = {
        {{-1, 0, 0}, 0.02, {0, 0, 1}}, {{0, 0.1, 0}, 0.02, {0, 0, 1}}, {{1, 0, 0}, 0.05, {0, 0, 1}}};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(discs, 3);
    const ewa_camera camera = fit(cloud, 1, AHEAD);
    double box[4];
    rims_box(&camera, discs, 3, box);
    assert_true(fabs(box[0] - 32) < 3 && fabs(box[2] - 768) < 3);
}

/// No disc of a few unequal ones reaches over the frame, whichever way it faces and from wherever it is seen;
/// nor is the frame much larger than they are.
TEST(test_unequal_discs) {
    static const double directions[][3] = {{0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {-1, -1, -1}, {-0.3, 0.2, 0.5}};
    check_random random = {5};
    for (int round = 0; round < 40; round++) {
        disc discs[12];
        const uint32_t count = 3 + (uint32_t)round % 10;
        for (uint32_t i = 0; i < count; i++) {
            check_uniform3(&random, -1, 1, discs[i].place);
            check_uniform3(&random, -1, 1, discs[i].normal);
            // At most 2.9 times as large as another.
            discs[i].radius = check_uniform(&random, 0.2, 0.58);
        }
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(discs, count);
        for (size_t k = 0; k < sizeof directions / sizeof *directions; k++) {
            const ewa_camera camera = fit(cloud, 1, directions[k]);
            double box[4];
            rims_box(&camera, discs, count, box);
            if (!(box[0] > 0 && box[1] > 0 && box[2] < 800 && box[3] < 600))
                fail_msg("round %d, direction %zu: %g to %g, %g to %g", round, k, box[0], box[2], box[1],
                         box[3]);
            assert_true(box[2] - box[0] > 0.6 * 800 || box[3] - box[1] > 0.6 * 600);
        }
        // Larger ones by --radius-scale.
        const ewa_camera camera = fit(cloud, 2, AHEAD);
        double box[4];
        for (uint32_t i = 0; i < count; i++) discs[i].radius *= 2;
        rims_box(&camera, discs, count, box);
        assert_true(box[0] > 0 && box[1] > 0 && box[2] < 800 && box[3] < 600);
    }
}

/// How far the camera is from the middle of what it frames.
static double distance_of(const ewa_camera *camera) {
    double eye[3];
    ewa_camera_eye(camera, eye);
    return eye[2];
}

/// A disc of 2.9 times the median is framed as any other; of a giant one as much as of one of three times.
TEST(test_giant_disc) {
    enum { COUNT = 100 };
    static const double radii[] = {0.1, 0.29, 0.3, 100, 1e30};
    disc discs[COUNT];
    double distances[5];
    check_random random = {6};
    for (int i = 0; i < COUNT; i++) {
        discs[i] = (disc){{check_uniform(&random, -1, 1), 0, 0}, 0.1, {0, 0, 1}};
        discs[i].place[1] = check_uniform(&random, -0.1, 0.1);
    }
    for (int k = 0; k < 5; k++) {
        discs[0] = (disc){{1, 0, 0}, radii[k], {0, 0, 1}};
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(discs, COUNT);
        const ewa_camera camera = fit(cloud, 1, AHEAD);
        double box[4];
        rims_box(&camera, discs, COUNT, box);
        if (k < 3) assert_true(box[0] > 0 && box[2] < 800 && box[2] > 760);
        distances[k] = distance_of(&camera);
    }
    assert_true(distances[1] > 1.07 * distances[0] && distances[2] > 1.003 * distances[1]);
    assert_float_equal(distances[3], distances[2], 1e-6 * distances[2]);
    assert_float_equal(distances[4], distances[2], 1e-6 * distances[2]);
}

/// Axes of surfels count by the longer axis of their ellipse, which need not be one of them.
TEST(test_axes) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, 2);
    double *position = check_add(cloud, EWA_POSITION, EWA_F64, 3);
    float *u = check_add(cloud, EWA_TANGENT_U, EWA_F32, 3);
    float *v = check_add(cloud, EWA_TANGENT_V, EWA_F32, 3);
    memcpy(position, (double[6]){-1, 0, 0, 1, 0, 0}, 6 * sizeof *position);
    // Support 3 sigma: 0.6 along v; the sum of two that are almost the same is as long as their root of two.
    memcpy(u, (float[6]){0, 0.05f, 0, 0.1f, 0.01f, 0}, 6 * sizeof *u);
    memcpy(v, (float[6]){0.2f, 0, 0, 0.1f, -0.01f, 0}, 6 * sizeof *v);
    OWNED(ewa_framing_destroy) ewa_framing *framing = NULL;
    assert_int_equal(ewa_framing_create(cloud, 1, &framing), EWA_OK);
    assert_int_equal(framing->count, 2);
    assert_float_equal(framing->rims_world[0], 0.6, 1e-6);
    assert_float_equal(framing->rims_world[1], 0.3 * sqrt(2), 1e-6);
}

/// Points without a radius that is drawn have no rim, and do not count for the median.
TEST(test_no_radius) {
    const disc discs[] = {{{0, 0, 0}, NAN, {0, 0, 1}},
                          {{1, 0, 0}, 0, {0, 0, 1}},
                          {{0, 1, 0}, -1, {0, 0, 1}},
                          {{1, 1, 0}, 0.1, {0, 0, 1}}};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(discs, 4);
    OWNED(ewa_framing_destroy) ewa_framing *framing = NULL;
    assert_int_equal(ewa_framing_create(cloud, 2, &framing), EWA_OK);
    double sum = 0;
    for (size_t i = 0; i < framing->count; i++) sum += framing->rims_world[i];
    assert_float_equal(sum, 0.2, 1e-7);
}

/// The lens of an eye at the origin shows all discs, as large as it goes.
TEST(test_zoom) {
    static const double origin[3] = {0, 0, 0}, up[3] = {0, 1, 0};
    const disc discs[] = {{{-1, 0.2, -4}, 0.2, {0, 0, 1}},
                          {{0, 0, -5}, 0.3, {0, 0, 1}},
                          {{1.5, 0, -6}, 0.55, {0, 0, 1}},
                          {{0, -0.5, -4}, 0.2, {0, 0, 1}}};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(discs, 4);
    OWNED(ewa_framing_destroy) ewa_framing *framing = NULL;
    ewa_camera camera = make_lens();
    assert_int_equal(ewa_framing_create(cloud, 1, &framing), EWA_OK);
    assert_int_equal(ewa_framing_zoom(framing, origin, up, &camera), EWA_OK);
    double box[4];
    rims_box(&camera, discs, 4, box);
    // The aim is good to a hundredth of the width; the other side is exact.
    assert_true(fabs(box[0] - 32) < 8 && fabs(box[2] - 768) < 3 && box[1] > 24 && box[3] < 576);
}

/// A share of less than 0.005 of the points that makes the box three times as large is left outside.
TEST(test_far_points) {
    enum { COUNT = 10000 };
    static disc discs[COUNT];
    static const struct {
        int far;
        double place;
        bool trimmed;
    } cases[] = {{45, 12, true}, {55, 12, false}, {45, 11.6, true}, {45, 9.2, false}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        check_random random = {8};
        for (int i = 0; i < COUNT; i++) {
            discs[i] = (disc){.radius = 0.01, .normal = {0, 0, 1}};
            check_uniform3(&random, -1, 1, discs[i].place);
            if (i < cases[k].far) discs[i] = (disc){{cases[k].place, 0, 0}, 0.02, {0, 0, 1}};
        }
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(discs, COUNT);
        OWNED(ewa_framing_destroy) ewa_framing *framing = NULL;
        assert_int_equal(ewa_framing_create(cloud, 1, &framing), EWA_OK);
        assert_int_equal(framing->trimmed, cases[k].trimmed);
        // What is left outside is not the object's own rim, and takes its discs along.
        if (framing->trimmed) {
            assert_int_equal(framing->count, COUNT - cases[k].far);
            assert_true(framing->box.high_world[0] > 1.04 && framing->box.high_world[0] < 1.14);
            for (size_t i = 0; i < framing->count; i++)
                assert_float_equal(framing->rims_world[i], 0.01, 1e-8);
        }
    }
}

/// A sphere without its cap about an axis, `sign` times +z or +y, and what is chosen of it.
static ewa_named_view view_of_shell(int axis, double sign, double cap, double outward, ewa_up_convention convention) {
    enum { COUNT = 40000 };
    OWNED(check_free) disc *discs = calloc(COUNT, sizeof *discs);
    assert_non_null(discs);
    check_random random = {3};
    for (uint32_t i = 0; i < COUNT;) {
        disc *own = &discs[i];
        double length2 = 0;
        for (int c = 0; c < 3; c++) {
            own->place[c] = check_uniform(&random, -1, 1);
            length2 += own->place[c] * own->place[c];
        }
        if (length2 > 1 || length2 < 0.01 || sign * own->place[axis] > cap * sqrt(length2)) continue;
        for (int c = 0; c < 3; c++) {
            own->place[c] /= sqrt(length2);
            own->normal[c] = outward * own->place[c];
        }
        own->radius = 0.01;
        i++;
    }
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(discs, COUNT);
    OWNED(ewa_framing_destroy) ewa_framing *framing = NULL;
    ewa_upright upright;
    assert_int_equal(ewa_framing_create(cloud, 1, &framing), EWA_OK);
    ewa_framing_choose(framing, convention, &upright);
    return upright.view;
}

/// A shell that is open to the front, so that 0.3 of what shows is its inside, is seen from the back, which is outside; one
/// whose normals point inward, and a sheet, are not.
TEST(test_shells) {
    const double wide = sqrt(1 - 0.36), narrow = sqrt(1 - 0.24);
    assert_int_equal(view_of_shell(2, 1, wide, 1, EWA_UP_Y_REQUIRED), EWA_VIEW_BACK);
    assert_int_equal(view_of_shell(2, 1, narrow, 1, EWA_UP_Y_REQUIRED), EWA_VIEW_FRONT);
    assert_int_equal(view_of_shell(2, -1, wide, 1, EWA_UP_Y_REQUIRED), EWA_VIEW_FRONT);
    assert_int_equal(view_of_shell(2, 1, wide, -1, EWA_UP_Y_REQUIRED), EWA_VIEW_FRONT);
    assert_int_equal(view_of_shell(2, 1, -0.1, 1, EWA_UP_Y_REQUIRED), EWA_VIEW_FRONT);
    // With z up the front is -y.
    assert_int_equal(view_of_shell(1, -1, wide, 1, EWA_UP_Z_SURVEYED), EWA_VIEW_BACK);
    assert_int_equal(view_of_shell(1, 1, wide, 1, EWA_UP_Z_SURVEYED), EWA_VIEW_FRONT);
}

/// Of one place only the convention of its format says what is up.
TEST(test_one_place) {
    const disc one = {{1, 2, 3}, 0.1, {0, 0, 1}};
    static const struct {
        ewa_up_convention convention;
        int axis;
    } rows[] = {{EWA_UP_Y_REQUIRED, 1}, {EWA_UP_Z_SURVEYED, 2}};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(&one, 1);
    OWNED(ewa_framing_destroy) ewa_framing *framing = NULL;
    assert_int_equal(ewa_framing_create(cloud, 1, &framing), EWA_OK);
    for (int i = 0; i < 2; i++) {
        ewa_upright upright;
        ewa_framing_choose(framing, rows[i].convention, &upright);
        assert_int_equal(upright.axis, rows[i].axis);
        assert_string_equal(upright.why, "there is one place only");
    }
}

/// In a wide lens, too, what is framed are balls, each as large as its disc: the outermost ones meet the sides of the room.
TEST(test_balls_in_a_wide_lens) {
    static const double direction[3] = {0.3, 1, -0.2}, up[3] = {0, 0, 1};
    const disc discs[] = {{{0, 0, 0}, 0.3, {0, 0, 1}}, {{1, 0.2, 0}, 0.3, {0, 1, 0}}, {{-1, 0, 0.4}, 0.3, {1, 0, 0}}, {{0, 1, 1}, 0.3, {1, 1, 1}}};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(discs, 4);
    OWNED(ewa_framing_destroy) ewa_framing *framing = NULL;
    ewa_camera camera = check_camera(800, 600);
    assert_int_equal(ewa_camera_set_fov(&camera, 100), EWA_OK);
    assert_int_equal(ewa_framing_create(cloud, 1, &framing), EWA_OK);
    assert_int_equal(ewa_framing_fit(framing, direction, up, &camera), EWA_OK);
    const double *m = camera.world_to_camera;
    double nearest = INFINITY;
    for (size_t i = 0; i < framing->count; i++) {
        double p[3];
        for (int r = 0; r < 3; r++) {
            p[r] = m[4 * r + 3];
            for (int c = 0; c < 3; c++) p[r] += m[4 * r + c] * (framing->offsets[i][c] + framing->middle_world[c]);
        }
        for (int c = 0; c < 2; c++) {
            const double slope = 0.92 * (c ? camera.height_px : camera.width_px) / (2 * camera.fx_px);
            nearest = fmin(nearest, (slope * p[2] - fabs(p[c])) / sqrt(1 + slope * slope) - framing->rims_world[i]);
        }
    }
    assert_float_equal(nearest, 0, 1e-9);
}

/// A vector whose axes are named anew, in a circle by `turns`.
static void turn_axes(const double v[3], int turns, double turned[3]) {
    for (int c = 0; c < 3; c++) turned[(c + turns) % 3] = v[c];
}

/// The body of all turns holds every point in every turn, closely, with its disc, whatever the axis.
TEST(test_revolve) {
    static const double up[3] = {0, 0, 2}, directions[][3] = {{0, 1, 0}, {0, 0, -1}, {1, 2, -1}};
    const disc discs[] = {
        {{1, 0, 0}, 0.1, {0, 0, 1}}, {{3, 4, 1}, 0.2, {0, 0, 1}}, {{0, 2, 3}, 0.15, {1, 0, 0}}};
    const double middle[3] = {1, 1, 0.4}, reaches[] = {1, sqrt(13), sqrt(2)};
    for (int turns = 0; turns < 3; turns++) {
        disc turned[3];
        for (int i = 0; i < 3; i++) {
            turned[i] = discs[i];
            turn_axes(discs[i].place, turns, turned[i].place);
            turn_axes(discs[i].normal, turns, turned[i].normal);
        }
        double pivot[3], axis[3], direction[3];
        turn_axes(middle, turns, pivot);
        turn_axes(up, turns, axis);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(turned, 3);
        OWNED(ewa_framing_destroy) ewa_framing *framing = NULL;
        assert_int_equal(ewa_framing_create(cloud, 1, &framing), EWA_OK);
        for (size_t d = 0; d < 3; d++) {
            OWNED(ewa_framing_destroy) ewa_framing *solid = NULL;
            turn_axes(directions[d], turns, direction);
            assert_int_equal(ewa_framing_revolve(framing, pivot, axis, direction, &solid), EWA_OK);
            for (int i = 0; i < 3; i++) {
                // Of the corners about as high: how far they reach each way, and with which rim.
                double minimum = INFINITY, greatest = 0, rim = INFINITY, below = INFINITY, above = INFINITY;
                for (int k = 0; k < 1000; k++) {
                    const double x = cos(k * 0.00628318530717959), y = sin(k * 0.00628318530717959);
                    double reach = 0;
                    for (size_t p = 0; p < solid->count; p++) {
                        double o[3];
                        turn_axes(solid->offsets[p], 3 - turns, o);
                        const double height = o[2] + middle[2] - discs[i].place[2];
                        if (fabs(height) > 0.02) continue;
                        reach = fmax(reach, x * o[0] + y * o[1]);
                        rim = fmin(rim, solid->rims_world[p]);
                        below = fmin(below, height <= 1e-12 ? -height : INFINITY);
                        above = fmin(above, height >= -1e-12 ? height : INFINITY);
                    }
                    minimum = fmin(minimum, reach);
                    greatest = fmax(greatest, reach);
                }
                assert_float_equal(rim, discs[i].radius, 1e-6);
                assert_true(minimum > reaches[i] * (1 - 1e-9) && greatest < 1.0013 * reaches[i]);
                // The slice begins below the point and ends above it.
                assert_true(below < 0.0118 && above < 0.0118);
            }
        }
    }
}

/// What a caller may know of a framing, which outlives its cloud.
TEST(test_info) {
    const disc discs[] = {
        {{-1, 0, 2}, 0.1, {0, 0, 1}}, {{3, 4, 1}, 0.1, {0, 0, 1}}, {{0, 2, 3}, 0.1, {1, 0, 0}}};
    ewa_cloud *cloud = make_cloud(discs, 3);
    ewa_framing *framing = NULL;
    ewa_framing_info info;
    assert_int_equal(ewa_framing_create(cloud, 1, &framing), EWA_OK);
    ewa_cloud_destroy(&cloud);
    ewa_framing_describe(framing, &info);
    static const double low[3] = {-1, 0, 1}, high[3] = {3, 4, 3}, middle[3] = {1, 2, 2};
    assert_memory_equal(info.box.low_world, low, sizeof low);
    assert_memory_equal(info.box.high_world, high, sizeof high);
    assert_memory_equal(info.middle_world, middle, sizeof middle);
    assert_int_equal(info.box.finite_count, 3);
    assert_int_equal(info.sample_count, 3);
    assert_false(info.trimmed);
    ewa_framing_destroy(&framing);
    assert_null(framing);
    ewa_framing_destroy(&framing);
    ewa_framing_destroy(NULL);
}

static void expect_failure(ewa_status status, ewa_status expected, check_log *log, const char *part,
                           int line) {
    if (status != expected || !strstr(log->text, part))
        fail_msg("line %d: %d, %s", line, (int)status, log->text);
    log->text[0] = 0;
}

/// What cannot be framed says why, and leaves cameras as they were.
TEST(test_failures) {
    static const double zero[3] = {0, 0, 0}, up[3] = {0, 1, 0};
    check_log log = {.count = 0};
    ewa_context *own = check_context(1, &log), *others = context;
    context = own;
    const disc none[] = {{{NAN, 0, 0}, 0.1, {0, 0, 1}}},
               huge[] = {{{-1e300, 0, 0}, 0.1, {0, 0, 1}}, {{1e300, 1, 0}, 0.1, {0, 0, 1}}},
               some[] = {{{0, 0, -4}, 0.1, {0, 0, 1}}, {{1, 1, -5}, 0.1, {0, 0, 1}}};
    ewa_cloud *empty = NULL, *lost = make_cloud(none, 1), *far = make_cloud(huge, 2),
              *cloud = make_cloud(some, 2);
    assert_int_equal(ewa_cloud_create(own, 5, &empty), EWA_OK);
    ewa_framing *framing = NULL, *solid = NULL;
    expect_failure(ewa_framing_create(empty, 1, &framing), EWA_ERROR_ARGUMENT, &log, "position", __LINE__);
    expect_failure(ewa_framing_create(lost, 1, &framing), EWA_ERROR_NUMERIC, &log, "no point has finite",
                   __LINE__);
    expect_failure(ewa_framing_create(cloud, -1, &framing), EWA_ERROR_ARGUMENT, &log, "radius_scale is -1",
                   __LINE__);
    expect_failure(ewa_framing_create(cloud, INFINITY, &framing), EWA_ERROR_ARGUMENT, &log,
                   "radius_scale is inf", __LINE__);
    assert_int_equal(ewa_framing_create(cloud, 1, NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_framing_create(NULL, 1, &framing), EWA_ERROR_ARGUMENT);
    assert_null(framing);
    ewa_camera camera = make_lens();
    const ewa_camera before = camera;
    assert_int_equal(ewa_framing_create(far, 1, &framing), EWA_OK);
    expect_failure(ewa_framing_fit(framing, AHEAD, up, &camera), EWA_ERROR_NUMERIC, &log,
                   "no camera can be placed: the coordinates, from -1e+300,0,0 to 1e+300,1,0", __LINE__);
    ewa_framing_destroy(&framing);
    assert_int_equal(ewa_framing_create(cloud, 1, &framing), EWA_OK);
    expect_failure(ewa_framing_fit(framing, zero, up, &camera), EWA_ERROR_NUMERIC, &log, "direction 0,0,0",
                   __LINE__);
    static const double behind[3] = {0, 0, -1e9};
    static const double within[3] = {0.5, 0.5, -4.5}; // in the middle of it
    expect_failure(ewa_framing_zoom(framing, within, up, &camera), EWA_ERROR_NUMERIC, &log,
                   "no camera can be placed", __LINE__);
    solid = framing;
    expect_failure(ewa_framing_revolve(framing, zero, zero, behind, &solid), EWA_ERROR_ARGUMENT, &log,
                   "axis 0,0,0", __LINE__);
    assert_null(solid);
    assert_int_equal(ewa_framing_fit(NULL, AHEAD, up, &camera), EWA_ERROR_ARGUMENT);
    assert_memory_equal(&camera, &before, sizeof camera);
    camera.projection = EWA_ORTHOGRAPHIC;
    assert_int_equal(ewa_framing_zoom(framing, zero, up, &camera), EWA_ERROR_ARGUMENT);
    ewa_framing_destroy(&framing);
    ewa_cloud *const clouds[] = {empty, lost, far, cloud};
    for (size_t i = 0; i < sizeof clouds / sizeof clouds[0]; i++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *one = clouds[i];
    }
    context = others;
    ewa_context_destroy(&own);
}

/// Whichever allocation fails, all memory is given back.
TEST(test_memory) {
    check_memory memory = {.calls_left = -1};
    WITH_DEFAULTS(ewa_context_options, options);
    options.thread_count = 1;
    options.allocator = check_allocator(&memory);
    ewa_context *own = NULL, *others = context;
    assert_int_equal(ewa_context_create(&options, &own), EWA_OK);
    context = own;
    static const double axis[3] = {0, 0, 1};
    const disc some[] = {{{0, 0, -4}, 0.1, {0, 0, 1}}, {{1, 1, -5}, 0.1, {0, 0, 1}}};
    ewa_cloud *cloud = make_cloud(some, 2);
    const int64_t held_bytes = memory.held_bytes;
    int failed = 0;
    for (long calls = 0;; calls++) {
        ewa_framing *framing = NULL, *solid = NULL;
        memory.calls_left = calls;
        ewa_status status = ewa_framing_create(cloud, 1, &framing);
        if (status == EWA_OK) status = ewa_framing_revolve(framing, axis, axis, AHEAD, &solid);
        if (status != EWA_OK) assert_true(status == EWA_ERROR_MEMORY && !solid);
        ewa_framing_destroy(&solid);
        ewa_framing_destroy(&framing);
        assert_int_equal(memory.held_bytes, held_bytes);
        if (status == EWA_OK) break;
        failed++;
    }
    assert_true(failed >= 9);
    memory.calls_left = -1;
    ewa_cloud_destroy(&cloud);
    context = others;
    ewa_context_destroy(&own);
    assert_int_equal(memory.held_bytes, 0);
}

int main(void) { return RUN_TESTS(begin, finish); }
