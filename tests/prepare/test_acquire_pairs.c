// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Products of two kernels and the pictures under them: closed forms against quadrature, in the plane and in
// space, and pictures whose mean under a Gaussian is known.
#include "check.h"
#include "colors/acquire.h"
#include "math/gaussian.h"

#include <math.h>
#include <string.h>

static ewa_vec3 load(const float v[3]) { return vec3_make((double)v[0], (double)v[1], (double)v[2]); }

static void set_vector(float to[3], double x, double y, double z) {
    to[0] = (float)x, to[1] = (float)y, to[2] = (float)z;
}

/// A kernel of the plane z = 0 by the elements of its axes.
static ewa_acquire_point flat_point(double x, double y, double ux, double uy, double vx, double vy) {
    ewa_acquire_point point = {.place = {x, y, 0}, .tint = {1, 1, 1, 1}};
    set_vector(point.normal, 0, 0, 1);
    set_vector(point.axis[0], ux, uy, 0);
    set_vector(point.axis[1], vx, vy, 0);
    return point;
}

/// The kernel at a place of the plane, 0 where it is cut.
static double kernel_at(const ewa_acquire_point *point, double x, double y) {
    const ewa_vec3 u = load(point->axis[0]), v = load(point->axis[1]);
    const double dx = x - point->place[0], dy = y - point->place[1], det = u.x * v.y - u.y * v.x;
    const double a = (dx * v.y - dy * v.x) / det, b = (u.x * dy - u.y * dx) / det;
    for (uint32_t i = 0; i < point->side_count; i++)
        if ((double)point->side[i][0] * dx + (double)point->side[i][1] * dy + (double)point->side[i][3] < 0)
            return 0;
    return exp(-0.5 * (a * a + b * b));
}

/// Moments of a product by the midpoint rule: integral, mean (from the first centre), covariance.
static void integrate(const ewa_acquire_point *a, const ewa_acquire_point *b, double moments[6]) {
    enum { STEPS = 1200 };
    const double reach = 6;
    memset(moments, 0, 6 * sizeof *moments);
    for (int j = 0; j < STEPS; j++)
        for (int i = 0; i < STEPS; i++) {
            const double x = reach * (2 * (i + 0.5) / STEPS - 1), y = reach * (2 * (j + 0.5) / STEPS - 1);
            const double product =
                kernel_at(a, x, y) * kernel_at(b, x, y) * 4 * reach * reach / STEPS / STEPS;
            const double dx = x - a->place[0], dy = y - a->place[1];
            const double terms[6] = {1, dx, dy, dx * dx, dx * dy, dy * dy};
            for (int k = 0; k < 6; k++) moments[k] += terms[k] * product;
        }
    for (int k = 1; k < 6; k++) moments[k] /= moments[0];
    moments[3] -= moments[1] * moments[1];
    moments[4] -= moments[1] * moments[2];
    moments[5] -= moments[2] * moments[2];
}

/// Turns a pair's numbers into x and y.
static void unframe(const ewa_acquire_pair *pair, double moments[6]) {
    const double c[2][2] = {{pair->axis[0].x, pair->axis[0].y}, {pair->axis[1].x, pair->axis[1].y}};
    moments[0] = pair->integral;
    for (int k = 0; k < 2; k++) moments[1 + k] = pair->mean[0] * c[0][k] + pair->mean[1] * c[1][k];
    for (int k = 0, n = 3; k < 2; k++)
        for (int l = k; l < 2; l++, n++)
            moments[n] = pair->xx * c[0][k] * c[0][l] + pair->yy * c[1][k] * c[1][l] +
                         pair->xy * (c[0][k] * c[1][l] + c[1][k] * c[0][l]);
}

static void hold_moments(const double got[6], const double expected[6], double tolerance) {
    for (int k = 0; k < 6; k++)
        if (fabs(got[k] - expected[k]) > tolerance * (k ? 1 : expected[0]))
            fail_msg("moment %d is %.9g instead of %.9g", k, got[k], expected[k]);
}

TEST(test_products_are_those_of_quadrature) {
    const ewa_acquire_set set = {.usual_sigma_world = 0.4};
    const ewa_acquire_point a = flat_point(0.1, -0.2, 0.6, 0.1, -0.2, 0.5),
                            b = flat_point(0.5, 0.3, 0.4, 0.3, 0, 0.7),
                            other = flat_point(-0.4, 0, 0.5, 0, 0, 0.5);
    const ewa_acquire_point *pairs[3][2] = {{&a, &b}, {&a, &a}, {&b, &other}};
    for (int i = 0; i < 3; i++) {
        ewa_acquire_pair pair, back;
        double expected[6], got[6];
        ewa_acquire_multiply(&set, pairs[i][0], pairs[i][1], &pair);
        ewa_acquire_multiply(&set, pairs[i][1], pairs[i][0], &back);
        integrate(pairs[i][0], pairs[i][1], expected);
        unframe(&pair, got);
        hold_moments(got, expected, 1e-7);
        assert_float_equal(pair.integral, back.integral, 1e-14);
    }
}

/// Both cut by one line, as beside a sharp edge; one alone.
TEST(test_cut_products_are_those_of_quadrature) {
    const ewa_acquire_set set = {.usual_sigma_world = 0.4};
    ewa_acquire_point a = flat_point(0.1, -0.2, 0.6, 0.1, -0.2, 0.5),
                      b = flat_point(0.5, 0.3, 0.4, 0.3, 0, 0.7);
    const double line[3] = {0.6, -0.8, -0.03}; // passes near both
    for (int k = 0; k < 2; k++) {
        ewa_acquire_point *point = k ? &b : &a;
        set_vector(point->side[0], line[0], line[1], 0);
        point->side[0][3] = (float)(line[0] * point->place[0] + line[1] * point->place[1] + line[2]);
        point->side_count = 1;
    }
    ewa_acquire_pair pair;
    double expected[6], got[6];
    ewa_acquire_multiply(&set, &a, &b, &pair);
    integrate(&a, &b, expected);
    unframe(&pair, got);
    got[0] = expected[0];              // the integral is that of the whole kernels
    hold_moments(got, expected, 2e-3); // the quadrature's cells on the line
    ewa_acquire_point flat = flat_point(0, 0, 1000, 0, 0, 1000);
    ewa_acquire_single(&a, &pair);
    integrate(&a, &flat, expected);
    unframe(&pair, got);
    got[0] = expected[0];
    hold_moments(got, expected, 2e-3);
}

TEST(test_normal_distribution) {
    for (double z = -7; z <= 7; z += 0.01) {
        assert_true(fabs(ewa_normal_below(z) - 0.5 * erfc(-z / sqrt(2))) < 2e-9);
        assert_true(fabs(ewa_exp(z * 20) / exp(z * 20) - 1) < 1e-14);
    }
}

/// A kernel on a tilted plane: its normal is (sin, 0, cos) turned about z.
static ewa_acquire_point tilted_point(const double place[3], double tilt, double turn, double long_world,
                                      double short_world) {
    ewa_acquire_point point = {.place = {place[0], place[1], place[2]}, .tint = {1, 1, 1, 1}};
    set_vector(point.normal, sin(tilt) * cos(turn), sin(tilt) * sin(turn), cos(tilt));
    set_vector(point.axis[0], long_world * cos(tilt) * cos(turn), long_world * cos(tilt) * sin(turn),
               -long_world * sin(tilt));
    set_vector(point.axis[1], -short_world * sin(turn), short_world * cos(turn), 0);
    return point;
}

/// A kernel with a thickness at a place of space.
static double thick_kernel_at(const ewa_acquire_point *point, double thickness_world, const double at[3]) {
    const ewa_vec3 d = vec3_sub(vec3_load(at), vec3_load(point->place));
    const ewa_vec3 spread[3] = {load(point->axis[0]), load(point->axis[1]),
                                vec3_scale(load(point->normal), thickness_world)};
    double square = 0; // the three are at right angles
    for (int k = 0; k < 3; k++) {
        const double along = vec3_dot(d, spread[k]) / vec3_dot(spread[k], spread[k]);
        square += along * along;
    }
    return exp(-0.5 * square);
}

/// On a curved surface: the integral over space, over that of the thickness, times ((1 + cos) / 2)^4.
TEST(test_tilted_products_are_those_of_quadrature) {
    enum { STEPS = 110 };
    const ewa_acquire_set set = {.usual_sigma_world = 0.4};
    static const double places[2][3] = {{0.1, -0.2, 0.05}, {0.35, 0.1, -0.15}};
    static const double tilts[3] = {0.2, 1.0, 1.6};
    for (int i = 0; i < 3; i++) {
        const ewa_acquire_point a = tilted_point(places[0], 0.1, 0.4, 0.6, 0.45),
                                b = tilted_point(places[1], tilts[i], -0.9, 0.5, 0.7);
        const double reach = 4, step = 2 * reach / STEPS;
        double sum = 0;
        for (int n = 0; n < STEPS * STEPS * STEPS; n++) {
            const double at[3] = {(n % STEPS + 0.5) * step - reach, (n / STEPS % STEPS + 0.5) * step - reach,
                                  (n / STEPS / STEPS + 0.5) * step - reach};
            sum += thick_kernel_at(&a, 0.4, at) * thick_kernel_at(&b, 0.4, at);
        }
        sum *= step * step * step / (sqrt(acos(-1)) * 0.4);
        const double facing = 0.5 + 0.5 * vec3_dot(load(a.normal), load(b.normal));
        ewa_acquire_pair pair;
        ewa_acquire_multiply(&set, &a, &b, &pair);
        assert_float_equal(pair.integral / (sum * pow(facing, 4)), 1, 1e-5);
    }
}

/// A picture that is a plane in each channel: its mean under a Gaussian is what it is at the Gaussian's
/// centre.
static double ramp_at(int channel, double x_px, double y_px) {
    static const double slope[3][2] = {{0.006, 0.001}, {-0.002, 0.005}, {0.003, -0.004}};
    return 0.4 + slope[channel][0] * (x_px - 32) + slope[channel][1] * (y_px - 32);
}

/// Alone, cut by a line, so that its mean is not its centre; and under products, on one chart and on two.
TEST_ON(test_looks_follow_the_jacobian, 1) {
    OWNED(ewa_image_free) ewa_image image;
    OWNED(ewa_texture_free) ewa_texture texture;
    assert_int_equal(ewa_image_create(context, 64, 64, 3, &image), EWA_OK);
    for (int i = 0; i < 64 * 64; i++)
        for (int c = 0; c < 3; c++) image.pixels[3 * i + c] = (float)ramp_at(c, i % 64 + 0.5, i / 64 + 0.5);
    assert_int_equal(ewa_texture_make(&image, EWA_TEXTURE_CLAMP, EWA_TEXTURE_CLAMP, &texture), EWA_OK);
    const ewa_acquire_set set = {
        .usual_sigma_world = 0.4, .textures = &texture, .texture_count = 1, .pixel_variance_px2 = 0.25};
    // at_px = (30 + 5 x + 3 y, 33 - 2 x + 4 y) in the plane.
    ewa_acquire_point point[2] = {flat_point(0, 0, 0.6, 0.1, -0.2, 0.5),
                                  flat_point(0.5, 0.7, 0.4, 0.3, 0, 0.7)};
    for (int k = 0; k < 2; k++) {
        const double x = point[k].place[0], y = point[k].place[1];
        point[k].at_px[0] = 30 + 5 * x + 3 * y, point[k].at_px[1] = 33 - 2 * x + 4 * y;
        set_vector(point[k].gradient[0], 5, 3, 0);
        set_vector(point[k].gradient[1], -2, 4, 0);
        set_vector(point[k].side[0], 0.6, 0.8, 0);
        point[k].side[0][3] = 0.1f;
        point[k].side_count = 1;
    }
    double color[4];
    ewa_acquire_pair pair;
    for (int k = 0; k < 4; k++) {
        double expected[6] = {0}, x = 0, y = 0;
        if (k == 3) { // elsewhere on the picture: two charts, each of which is a plane
            point[1].at_px[0] -= 9, point[1].at_px[1] += 4;
        }
        if (k < 2) {
            ewa_acquire_single(&point[k], &pair);
            unframe(&pair, expected);
            ewa_acquire_look(&set, &point[k], &pair, color);
            assert_true(hypot(expected[1], expected[2]) > 0.02);
        } else {
            ewa_acquire_multiply(&set, &point[0], &point[1], &pair);
            unframe(&pair, expected);
            const double apart = ewa_acquire_look_between(&set, &point[0], &point[1], &pair, color);
            assert_true((apart > 0) == (k == 3));
        }
        const int from = k == 1;
        x = point[from].place[0] + expected[1], y = point[from].place[1] + expected[2];
        const double x_px = 30 + 5 * x + 3 * y - (k == 3 ? 4.5 : 0),
                     y_px = 33 - 2 * x + 4 * y + (k == 3 ? 2 : 0);
        for (int c = 0; c < 3; c++) assert_float_equal(color[c], ramp_at(c, x_px, y_px), 2e-4);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
