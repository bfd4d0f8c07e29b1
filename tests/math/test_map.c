// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Maps and their action, conics, perspective and the planes of a view volume: properties on random input.
#include <fenv.h>
#include <string.h>

#include "homogeneous/perspective.h"
#include "math/check_math.h"

enum { ROUNDS = 2000 };

static const double identity4[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

static double largest_of(const double *numbers, int count) {
    double largest = 0;
    for (int i = 0; i < count; i++) largest = fmax(largest, fabs(numbers[i]));
    return largest;
}

TEST(test_composition_is_product) {
    check_random random = {1};
    for (int i = 0; i < ROUNDS; i++) {
        ewa_mat3 a = check_random_mat3(&random), b = check_random_mat3(&random),
                 ab = ewa_mat3_concatenate(&a, &b);
        ewa_vec3 p = check_random_vec3(&random), one = ewa_point2_transform(p, &a),
                 q = ewa_point2_transform(p, &ab);
        one = ewa_point2_transform(one, &b);
        check_numbers(&q, &one, 3, 1e-14);
        ewa_mat4 c = check_random_mat4(&random), d = check_random_mat4(&random),
                 cd = ewa_mat4_concatenate(&c, &d);
        ewa_vec4 r = check_random_vec4(&random), two = ewa_point3_transform(ewa_point3_transform(r, &c), &d);
        r = ewa_point3_transform(r, &cd);
        check_numbers(&r, &two, 4, 1e-14);
    }
}

TEST(test_inverse) {
    check_random random = {2};
    for (int i = 0; i < ROUNDS; i++) {
        ewa_mat4 a = check_random_mat4(&random), inverse, product;
        if (i % 4 == 1) // badly scaled, not badly conditioned
            for (int r = 0; r < 4; r++)
                for (int c = 0; c < 4; c++) a.m[r][c] *= pow(10, 30 * r - 25 * c);
        assert_int_equal(ewa_mat4_invert(&a, &inverse), EWA_OK);
        product = ewa_mat4_concatenate(&inverse, &a);
        if (i % 4 == 1) {
            for (int r = 0; r < 4; r++) check_near(product.m[r][r], 1, 1e-9);
        } else {
            double condition = largest_of(&a.m[0][0], 16) * largest_of(&inverse.m[0][0], 16);
            check_numbers(product.m, identity4, 16, 1e-14 * condition);
        }
        ewa_mat3 b = check_random_mat3(&random), inverse3, product3, identity3 = mat3_identity();
        assert_int_equal(ewa_mat3_invert(&b, &inverse3), EWA_OK);
        product3 = ewa_mat3_concatenate(&b, &inverse3);
        check_numbers(product3.m, identity3.m, 9, 1e-14 * largest_of(&inverse3.m[0][0], 9));
        ewa_mat3 adjugate = mat3_adjugate(&b);
        check_same(&adjugate, &inverse3, 9, 1e-12);
        check_near(mat3_determinant(&b) * inverse3.m[1][2], adjugate.m[1][2],
                   1e-13 * largest_of(&inverse3.m[0][0], 9));
    }
    // The camera of georeferenced data: far from the origin, thin depth range.
    const double window[4] = {-0.1, 0.1, -0.1, 0.1};
    ewa_mat4 view = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {-4e6, -5e6, 3e6, 1}}}, projection, inverse;
    assert_int_equal(check_window_map(window, 0.1, 1e6, false, &projection), EWA_OK);
    view = ewa_mat4_concatenate(&view, &projection);
    assert_int_equal(ewa_mat4_invert(&view, &inverse), EWA_OK);
}

TEST(test_singular) {
    check_random random = {3};
    for (int i = 0; i < ROUNDS; i++) {
        ewa_mat4 a = check_random_mat4(&random), inverse;
        memcpy(inverse.m, identity4, sizeof inverse.m);
        double k[3] = {check_uniform(&random, -2, 2), check_uniform(&random, -2, 2),
                       check_uniform(&random, -2, 2)};
        int row = i % 4;
        for (int c = 0; c < 4; c++) // one row is a sum of the others
            a.m[row][c] =
                k[0] * a.m[(row + 1) % 4][c] + k[1] * a.m[(row + 2) % 4][c] + k[2] * a.m[(row + 3) % 4][c];
        assert_int_equal(ewa_mat4_invert(&a, &inverse), EWA_ERROR_NUMERIC);
        check_numbers(inverse.m, identity4, 16, 0); // left alone
        ewa_vec4 plane;
        assert_int_equal(ewa_plane_transform(check_random_vec4(&random), &a, &plane), EWA_ERROR_NUMERIC);
        ewa_mat3 b = check_random_mat3(&random), inverse3;
        for (int c = 0; c < 3; c++) b.m[2][c] = k[0] * b.m[0][c] + k[1] * b.m[1][c];
        assert_int_equal(ewa_mat3_invert(&b, &inverse3), EWA_ERROR_NUMERIC);
        ewa_vec3 line;
        assert_int_equal(ewa_line2_transform(check_random_vec3(&random), &b, &line), EWA_ERROR_NUMERIC);
        ewa_conic conic = {1, 0, 0, 1, 0, -1};
        assert_int_equal(ewa_conic_transform(&conic, &b, &conic), EWA_ERROR_NUMERIC);
    }
    ewa_mat4 zero = {{{0}}}, bad = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, NAN, 1, 0}, {0, 0, 0, 1}}}, out;
    assert_int_equal(ewa_mat4_invert(&zero, &out), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_mat4_invert(&bad, &out), EWA_ERROR_NUMERIC);
}

TEST(test_action_on_lines_and_planes) {
    check_random random = {5};
    for (int i = 0; i < ROUNDS; i++) {
        ewa_mat3 map = check_random_mat3(&random), inverse;
        ewa_vec3 p = check_random_vec3(&random), q = check_random_vec3(&random), line, image, expected;
        assert_int_equal(ewa_mat3_invert(&map, &inverse), EWA_OK);
        double condition = largest_of(&inverse.m[0][0], 9);
        assert_int_equal(ewa_line2_join(p, q, &line), EWA_OK);
        assert_int_equal(ewa_line2_transform(line, &map, &image), EWA_OK);
        assert_int_equal(
            ewa_line2_join(ewa_point2_transform(p, &map), ewa_point2_transform(q, &map), &expected), EWA_OK);
        check_same(&image, &expected, 3, 1e-12 * condition);
        ewa_vec3 other = check_random_vec3(&random); // incidence products are kept as numbers
        check_near(ewa_incidence2(ewa_point2_transform(other, &map), image), ewa_incidence2(other, line),
                   1e-13 * condition);
        ewa_vec3 back = ewa_line2_pull(image, &map);
        check_numbers(&back, &line, 3, 1e-13 * condition);

        ewa_mat4 map4 = check_random_mat4(&random), inverse4;
        ewa_vec4 plane = check_random_vec4(&random), image4, r = check_random_vec4(&random);
        assert_int_equal(ewa_mat4_invert(&map4, &inverse4), EWA_OK);
        assert_int_equal(ewa_plane_transform(plane, &map4, &image4), EWA_OK);
        check_near(ewa_incidence3(ewa_point3_transform(r, &map4), image4), ewa_incidence3(r, plane),
                   1e-13 * largest_of(&inverse4.m[0][0], 16));
        ewa_vec4 back4 = ewa_plane_pull(image4, &map4);
        check_numbers(&back4, &plane, 4, 1e-13 * largest_of(&inverse4.m[0][0], 16));
    }
}

static ewa_vec3 on_circle(double angle) { return vec3_make(cos(angle), sin(angle), 1); }

TEST(test_conics) {
    check_random random = {6};
    const ewa_conic circle = {1, 0, 0, 1, 0, -1};
    for (int i = 0; i < ROUNDS; i++) {
        ewa_mat3 map = check_random_mat3(&random), inverse;
        assert_int_equal(ewa_mat3_invert(&map, &inverse), EWA_OK);
        double condition = pow(largest_of(&inverse.m[0][0], 9), 2);
        if (condition > 1e6) continue;
        ewa_conic image, dual = ewa_conic_dual(&circle), pulled;
        assert_int_equal(ewa_conic_transform(&circle, &map, &image), EWA_OK);
        ewa_conic dual_image = ewa_dual_conic_transform(&dual, &map), dual_of_image = ewa_conic_dual(&image);
        check_same(&dual_image, &dual_of_image, 6, 1e-11 * condition);
        double angle = check_uniform(&random, 0, 7);
        ewa_vec3 p = ewa_point2_transform(on_circle(angle), &map);
        check_near(ewa_conic_value(&image, p), 0, 1e-13 * condition); // points go to points
        ewa_vec3 tangent = ewa_conic_polar(&circle, on_circle(angle)), image_tangent;
        check_near(ewa_conic_value(&dual, tangent), 0, 1e-14);
        assert_int_equal(ewa_line2_transform(tangent, &map, &image_tangent), EWA_OK);
        check_near(ewa_conic_value(&dual_image, image_tangent), 0, 1e-13 * condition); // tangents to tangents
        ewa_vec3 polar = ewa_conic_polar(&image, p);
        check_same(&polar, &image_tangent, 3, 1e-12 * condition);
        pulled = ewa_conic_pull(&image, &map);
        check_numbers(&pulled, &circle, 6, 1e-12 * condition);
    }
}

/// The ellipse of a dual conic against the points of a mapped circle.
TEST(test_ellipse) {
    check_random random = {7};
    for (int i = 0; i < 200; i++) {
        const double a[2][2] = {{check_uniform(&random, -2, 2), check_uniform(&random, -2, 2)},
                                {check_uniform(&random, -2, 2), check_uniform(&random, -2, 2)}};
        const double c[2] = {check_uniform(&random, -5, 5), check_uniform(&random, -5, 5)};
        ewa_mat3 map = {{{a[0][0], a[0][1], 0}, {a[1][0], a[1][1], 0}, {c[0], c[1], 1}}};
        ewa_conic circle = {1, 0, 0, 1, 0, -1}, dual = ewa_conic_dual(&circle);
        dual = ewa_dual_conic_transform(&dual, &map);
        double center[2], shape[3], high_x = -INFINITY, high_y = -INFINITY;
        assert_int_equal(ewa_dual_conic_ellipse(&dual, center, shape), EWA_OK);
        check_near(center[0], c[0], 1e-14);
        check_near(center[1], c[1], 1e-14);
        for (int k = 0; k < 1000; k++) {
            ewa_vec3 p = ewa_point2_transform(on_circle(k * acos(-1) / 500), &map);
            double x = p.x - c[0], y = p.y - c[1], det = shape[0] * shape[2] - shape[1] * shape[1];
            check_near((shape[2] * x * x - 2 * shape[1] * x * y + shape[0] * y * y) / det, 1, 1e-9 / det);
            high_x = fmax(high_x, x);
            high_y = fmax(high_y, y);
        }
        check_near(high_x, sqrt(shape[0]), 1e-4 * sqrt(shape[0]));
        check_near(high_y, sqrt(shape[2]), 1e-4 * sqrt(shape[2]));
    }
    double center[2], shape[3];
    ewa_conic hyperbola = {1, 0, 0, -1, 0, 1}, parabola = {1, 0, 0, 0, 1, 0}, imaginary = {1, 0, 0, 1, 0, 1};
    ewa_conic leaning = {-1, -2, 0, -1, 0, 1}, upright = {0, 0, 0, 1, 0, 1}, lying = {1, 0, 0, 0, 0, 1};
    assert_int_equal(ewa_dual_conic_ellipse(&leaning, center, shape), EWA_ERROR_NUMERIC); // a hyperbola too
    assert_int_equal(ewa_dual_conic_ellipse(&upright, center, shape),
                     EWA_ERROR_NUMERIC); // imaginary segments
    assert_int_equal(ewa_dual_conic_ellipse(&lying, center, shape), EWA_ERROR_NUMERIC);
    ewa_conic segment = {4, 0, 0, 0, 0, -1}, bad = {NAN, 0, 0, 1, 0, -1}, bad_w = {1, 0, 0, 1, 0, NAN};
    assert_int_equal(ewa_dual_conic_ellipse(&hyperbola, center, shape), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_dual_conic_ellipse(&parabola, center, shape), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_dual_conic_ellipse(&imaginary, center, shape), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_dual_conic_ellipse(&bad, center, shape), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_dual_conic_ellipse(&bad_w, center, shape), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_dual_conic_ellipse(&segment, center, shape), EWA_OK); // a disc seen edge-on
    assert_true(shape[0] == 4 && shape[2] == 0);
}

static double depth_of(const ewa_mat4 *map, double z) {
    double xyz[3];
    assert_int_equal(ewa_point3_divide(ewa_point3_transform(vec4_make(0.3, -0.2, z, 1), map), xyz), EWA_OK);
    return xyz[2];
}

TEST(test_window_maps) {
    const double window[4] = {-1, 3, -2, 0.5};
    ewa_mat4 map;
    for (int variant = 0; variant < 3; variant++) { // perspective, infinite far, box
        const bool box = variant == 2;
        const double far_z = variant == 1 ? INFINITY : 80;
        assert_int_equal(check_window_map(window, 0.25, far_z, box, &map), EWA_OK);
        check_near(depth_of(&map, 0.25), 0, 1e-14);
        if (isfinite(far_z)) check_near(depth_of(&map, 80), 1, 1e-13);
        double before = 0;
        for (double z = 0.3; z < 70; z *= 1.5) { // monotone in between
            double depth = depth_of(&map, z);
            assert_true(depth > before && depth < 1);
            before = depth;
        }
        for (int corner = 0; corner < 8; corner++) { // off-axis window, at near and at far (or anywhere)
            double x = corner & 1 ? 1 : -1, y = corner & 2 ? 1 : -1, z = corner & 4 ? 80 : 0.25, xyz[3];
            double grow = box ? 1 : z / 0.25;
            ewa_vec4 p = vec4_make((x > 0 ? 3 : -1) * grow, (y > 0 ? 0.5 : -2) * grow, z, 1);
            assert_int_equal(ewa_point3_divide(ewa_point3_transform(p, &map), xyz), EWA_OK);
            check_near(xyz[0], x, 1e-14);
            check_near(xyz[1], y, 1e-14);
        }
    }
    const struct {
        double window[4], near_z, far_z;
    } wrong[] = {{{1, -1, -1, 1}, 1, 2},   {{-1, 1, 1, 1}, 1, 2},        {{-1, 1, -1, 1}, 0, 2},
                 {{-1, 1, -1, 1}, 2, 1},   {{-1, NAN, -1, 1}, 1, 2},     {{-1, 1, -1, 1}, NAN, 2},
                 {{-1, 1, -1, 1}, 1, NAN}, {{-INFINITY, 1, -1, 1}, 1, 2}};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        for (int box = 0; box < 2; box++)
            if (!box || wrong[i].near_z != 0) // a box may begin at the eye
                assert_int_equal(
                    check_window_map(wrong[i].window, wrong[i].near_z, wrong[i].far_z, box, &map),
                    EWA_ERROR_NUMERIC);
    assert_int_equal(check_window_map(window, 0.25, INFINITY, true, &map),
                     EWA_ERROR_NUMERIC); // no infinite box
}

/// A camera's clip map against its pixels, and the planes against the clip conditions they come from.
TEST(test_camera_and_planes) {
    check_random random = {8};
    for (int i = 0; i < 400; i++) {
        ewa_camera camera;
        ewa_camera_init(&camera);
        const double eye[3] = {check_uniform(&random, -9, 9), check_uniform(&random, -9, 9), 12},
                     target[3] = {0};
        const double up[3] = {0, 1, 0};
        if (i % 2) assert_int_equal(ewa_camera_set_ortho(&camera, 10), EWA_OK);
        assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
        camera.cx_px += 100;
        ewa_mat4 map;
        ewa_vec4 planes[6];
        double far_z = i % 4 == 2 ? INFINITY : 40;
        assert_int_equal(ewa_camera_clip_map(&camera, 0.5, far_z, &map), EWA_OK);
        assert_int_equal(ewa_frustum_planes(&map, planes), EWA_OK);
        double place[3];
        check_uniform3(&random, -20, 20, place);
        ewa_vec4 world = vec4_make(place[0], place[1], place[2], 1);
        const double *m = camera.world_to_camera;
        double camera_space[3], xyz[3], smallest = INFINITY;
        for (int r = 0; r < 3; r++)
            camera_space[r] =
                m[4 * r] * world.x + m[4 * r + 1] * world.y + m[4 * r + 2] * world.z + m[4 * r + 3];
        double divisor = i % 2 ? 1 : camera_space[2];
        double x_px = camera.fx_px * camera_space[0] / divisor + camera.cx_px;
        double y_px = camera.fy_px * camera_space[1] / divisor + camera.cy_px;
        ewa_vec4 clip = ewa_point3_transform(world, &map);
        assert_int_equal(ewa_point3_divide(clip, xyz), EWA_OK);
        check_near((xyz[0] + 1) / 2 * camera.width_px, x_px, 1e-9 * (1 + fabs(x_px)));
        check_near((xyz[1] + 1) / 2 * camera.height_px, y_px, 1e-9 * (1 + fabs(y_px)));
        bool seen = x_px >= 0 && x_px <= camera.width_px && y_px >= 0 && y_px <= camera.height_px &&
                    camera_space[2] >= 0.5 && camera_space[2] <= far_z;
        for (int k = 0; k < 6; k++) {
            double distance = 1;
            if (vec3_length(vec3_from_vec4(planes[k])) > 0)
                assert_int_equal(ewa_plane_distance(planes[k], world, &distance), EWA_OK);
            check_near(ewa_incidence3(world, planes[k]), distance, 1e-12 * (1 + fabs(distance)));
            smallest = fmin(smallest, distance);
        }
        assert_true(seen == (smallest >= 0));
    }
    ewa_camera camera;
    ewa_camera_init(&camera);
    ewa_mat4 map;
    camera.world_to_camera[3] = NAN;
    assert_int_equal(ewa_camera_clip_map(&camera, 0.5, 40, &map), EWA_ERROR_NUMERIC);
    camera.world_to_camera[3] = 0;
    assert_int_equal(ewa_camera_clip_map(&camera, 0, 40, &map), EWA_ERROR_NUMERIC);
    camera.fx_px = 0;
    assert_int_equal(ewa_camera_clip_map(&camera, 0.5, 40, &map), EWA_ERROR_NUMERIC);
}

/// The plane at infinity as far plane, and maps that have no frustum.
TEST(test_planes_at_infinity) {
    const double window[4] = {-1, 1, -1, 1};
    ewa_mat4 map, view = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {3, 4, 1e5, 1}}};
    ewa_vec4 planes[6];
    assert_int_equal(check_window_map(window, 0.5, INFINITY, false, &map), EWA_OK);
    map = ewa_mat4_concatenate(&view, &map);
    assert_int_equal(ewa_frustum_planes(&map, planes), EWA_OK);
    check_numbers(&planes[EWA_CLIP_FAR], (&(ewa_vec4){0, 0, 0, 1}), 4, 0);
    for (int k = 0; k < 6; k++) assert_true(ewa_incidence3(vec4_make(0, 0, 1e300, 1), planes[k]) > 0);
    ewa_mat4 behind = ewa_mat4_concatenate(
        &map, (&(ewa_mat4){{{-1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, -1, 0}, {0, 0, 0, -1}}}));
    assert_int_equal(ewa_frustum_planes(&behind, planes),
                     EWA_OK); // the cone of negative w: nothing of it is visible
    check_numbers(&planes[EWA_CLIP_FAR], (&(ewa_vec4){0, 0, 0, -1}), 4, 0);
    ewa_mat4 nothing = {{{0}}};
    assert_int_equal(ewa_frustum_planes(&nothing, planes), EWA_ERROR_NUMERIC);
    map.m[1][1] = NAN;
    assert_int_equal(ewa_frustum_planes(&map, planes), EWA_ERROR_NUMERIC);
}

TEST(test_no_division_by_zero) {
    feclearexcept(FE_ALL_EXCEPT);
    ewa_mat4 zero = {{{0}}}, map;
    ewa_vec4 planes[6];
    ewa_conic none = {0, 0, 0, 0, 0, 0};
    double center[2], shape[3];
    const double window[4] = {-1, 1, -1, 1};
    assert_int_equal(ewa_mat4_invert(&zero, &map), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_frustum_planes(&zero, planes), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_dual_conic_ellipse(&none, center, shape), EWA_ERROR_NUMERIC);
    for (int box = 0; box < 2; box++)
        assert_int_equal(check_window_map(window, 2, 2, box, &map), EWA_ERROR_NUMERIC);
    assert_int_equal(fetestexcept(FE_DIVBYZERO | FE_INVALID), 0);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
