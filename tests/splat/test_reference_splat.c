// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/reference/splat.c: one splat against other derivations of the same thing, sampled
// outlines, closed forms and limits.
#include "surface/semantics.h"
#include "tests/splat/surfels.h"

/// PAS equations 4 and 7 to 11: the conic Q' = M^-1 Q M^-T, its centre and its central form.
TEST(test_conic_by_inverse_map) {
    const ewa_camera camera = odd_camera();
    const double F = 1.7;
    const ewa_reference_view view = make_view(&camera, F, 0.5, EWA_KERNEL_PERSPECTIVE);
    check_random random = {1};
    int compared = 0;
    for (int i = 0; i < 2000; i++) {
        const ewa_surfel surfel = random_surfel(&random, &camera, check_uniform(&random, 0.01, 0.7));
        ewa_reference_splat splat;
        ewa_reference_project(&view, &surfel, &splat);
        if (!splat.drawn || fabs(vec3_dot(splat.normal, splat.center)) < 0.1 * vec3_length(splat.center))
            continue;
        assert_false(splat.by_rays);
        const ewa_mat3 map = mat3_from_rows(splat.axis_u, splat.axis_v, splat.center);
        const ewa_mat3 adjugate = mat3_adjugate(&map), transposed = mat3_transpose(&adjugate);
        const ewa_mat3 inner = {{{1, 0, 0}, {0, 1, 0}, {0, 0, -F * F}}};
        ewa_mat3 conic = mat3_multiply(&adjugate, &inner);
        conic = mat3_multiply(&conic, &transposed);
        const double a = conic.m[0][0], b = conic.m[0][1], c = conic.m[1][1], d = conic.m[0][2],
                     e = conic.m[1][2];
        const double f = -conic.m[2][2], discriminant = a * c - b * b;
        const double x = (b * e - c * d) / discriminant, y = (b * d - a * e) / discriminant;
        const double rest = f - d * x - e * y; // (x - xt) Q (x - xt)' = rest
        assert_near(splat.center_px[0], view.fx_px * x + view.cx_px, 1e-6);
        assert_near(splat.center_px[1], view.fy_px * y + view.cy_px, 1e-6);
        // V = rest Q^-1 / F^2
        const double scale = rest / discriminant / (F * F), *variance = splat.variance_px2;
        const double size = variance[0] + variance[2];
        assert_near(variance[0], scale * c * view.fx_px * view.fx_px, 1e-6 * size);
        assert_near(variance[1], -scale * b * view.fx_px * view.fy_px, 1e-6 * size);
        assert_near(variance[2], scale * a * view.fy_px * view.fy_px, 1e-6 * size);
        compared++;
    }
    assert_true(compared > 1600);
}

/// The rim of a disc, point by point, lies on the ellipse; the ellipse's box is as large as the rim's; the
/// weight's determinant is that of V; the inverse is one.
TEST(test_rim) {
    const ewa_camera camera = odd_camera();
    const double F = 2;
    check_random random = {2};
    for (int i = 0; i < 400; i++) {
        const double h = i % 3 * 0.5;
        const ewa_reference_view view = make_view(&camera, F, h, EWA_KERNEL_PERSPECTIVE);
        const ewa_surfel surfel = random_surfel(&random, &camera, check_uniform(&random, 0.001, 0.7));
        ewa_reference_splat splat;
        ewa_reference_project(&view, &surfel, &splat);
        if (!splat.drawn) continue;
        const double *v = splat.variance_px2, determinant = v[0] * v[2] - v[1] * v[1];
        enum { STEPS = 2000 };
        double x_high = -INFINITY, y_low = INFINITY;
        for (int step = 0; step < STEPS; step++) {
            const double angle = 2 * PI * step / STEPS;
            double x[2];
            to_pixel(&view, on_disc(&splat, F * cos(angle), F * sin(angle)), x);
            const double dx = x[0] - splat.center_px[0], dy = x[1] - splat.center_px[1];
            if (determinant > 1e-4 * v[0] * v[2])
                assert_near((v[2] * dx * dx - 2 * v[1] * dx * dy + v[0] * dy * dy) / determinant, F * F,
                            1e-9);
            x_high = fmax(x_high, x[0]);
            y_low = fmin(y_low, x[1]);
        }
        assert_near(x_high, splat.center_px[0] + F * sqrt(v[0]), 4e-6 * sqrt(v[0]) + 1e-10);
        assert_near(y_low, splat.center_px[1] - F * sqrt(v[2]), 4e-6 * sqrt(v[2]) + 1e-10);
        const double h2 = h * h, filtered = (v[0] + h2) * (v[2] + h2) - v[1] * v[1];
        const double peak = sqrt(determinant / filtered) / (2 * PI);
        if (determinant > 1e-4 * v[0] * v[2]) assert_near(splat.peak, peak, 1e-9 * peak);
        assert_near(splat.inverse[0] * (v[0] + h2) + splat.inverse[1] * v[1], 1, 1e-6);
        assert_near(splat.inverse[0] * v[1] + splat.inverse[1] * (v[2] + h2), 0, 1e-6);
    }
}

/// Whatever the kernel, every pixel that counts is in the box; and where that is the ellipse's own, no row or
/// column of it that lies within the picture is wasted.
TEST(test_boxes) {
    ewa_camera camera = odd_camera();
    camera.width_px = 120;
    camera.height_px = 90;
    camera.cx_px = 61;
    camera.cy_px = 40;
    const double F = 2;
    check_random random = {3};
    int drawn = 0;
    for (int i = 0; i < 1000; i++) {
        camera.projection = i % 4 == 3 ? EWA_ORTHOGRAPHIC : EWA_PERSPECTIVE;
        camera.fx_px = i % 4 == 3 ? 20 : 100;
        camera.fy_px = i % 4 == 3 ? 25 : 110;
        const ewa_kernel kernel = (ewa_kernel)(i % (EWA_KERNEL_RAYCAST + 1));
        const ewa_reference_view view = make_view(&camera, F, 0.5, kernel);
        ewa_surfel surfel = random_surfel(&random, &camera, check_uniform(&random, 0.01, 1));
        if (i % 2) surfel.center[2] = check_uniform(&random, 0.05, 1); // some near ones
        ewa_reference_splat splat;
        ewa_reference_project(&view, &surfel, &splat);
        if (!splat.drawn) continue;
        int x_begin = 120, x_end = 0, y_begin = 90, y_end = 0;
        for (int y = 0; y < 90; y++)
            for (int x = 0; x < 120; x++) {
                ewa_reference_sample sample;
                if (!ewa_reference_sample_at(&view, &splat, x + 0.5, y + 0.5, &sample) ||
                    sample.distance2 >= F * F)
                    continue;
                x_begin = x < x_begin ? x : x_begin;
                x_end = x >= x_end ? x + 1 : x_end;
                y_begin = y < y_begin ? y : y_begin;
                y_end = y >= y_end ? y + 1 : y_end;
            }
        if (x_end == 0) continue;
        drawn++;
        assert_true(splat.x_begin <= x_begin && splat.x_end >= x_end);
        assert_true(splat.y_begin <= y_begin && splat.y_end >= y_end);
        // Where an ellipse touches its box, pixel centres just miss it: by much where it is pointed, so only
        // round ones.
        const double *q = splat.inverse;
        if (kernel > EWA_KERNEL_AFFINE || splat.by_rays || q[0] * q[2] - q[1] * q[1] < 0.6 * q[0] * q[2])
            continue;
        if (splat.x_begin == 0 || splat.x_end == 120 || splat.y_begin == 0 || splat.y_end == 90) continue;
        const int slack = 1;
        assert_true(splat.x_begin >= x_begin - slack && splat.x_end <= x_end + slack);
        assert_true(splat.y_begin >= y_begin - slack && splat.y_end <= y_end + slack);
    }
    assert_true(drawn > 100);
}

/// A disc that faces the eye is the section of a round cone: half angle a around an axis at angle t from the
/// view, its picture reaches from tan(t - a) to tan(t + a).
TEST(test_round_cone) {
    ewa_camera camera = odd_camera();
    camera.fx_px = camera.fy_px = 300;
    const double F = 1.5;
    const ewa_reference_view view = make_view(&camera, F, 0, EWA_KERNEL_PERSPECTIVE);
    for (int i = 0; i < 12; i++) {
        const double t = 0.08 * i, a = 0.01 + 0.03 * i, distance = 7;
        const double sigma = distance * tan(a) / F;
        const ewa_surfel surfel =
            make_surfel(vec3_make(distance * sin(t), 0, distance * cos(t)),
                        vec3_make(sigma * cos(t), 0, -sigma * sin(t)), vec3_make(0, sigma, 0));
        ewa_reference_splat splat;
        ewa_reference_project(&view, &surfel, &splat);
        assert_true(splat.drawn && !splat.by_rays);
        assert_near(splat.center_px[0], view.cx_px + 300 * (tan(t + a) + tan(t - a)) / 2, 1e-9);
        assert_near(splat.center_px[1], view.cy_px, 1e-9);
        assert_near(F * sqrt(splat.variance_px2[0]), 300 * (tan(t + a) - tan(t - a)) / 2, 1e-9);
        assert_near(splat.variance_px2[1], 0, 1e-9);
    }
}

/// From very far away through a long lens a perspective camera is an orthographic one.
TEST(test_orthographic_limit) {
    const double F = 2, scale = 40;
    ewa_camera camera = odd_camera();
    check_random random = {4};
    for (int i = 0; i < 200; i++) {
        const ewa_surfel surfel = random_surfel(&random, &camera, 0.3);
        ewa_reference_splat flat;
        ewa_camera near_camera = camera;
        near_camera.projection = EWA_ORTHOGRAPHIC;
        near_camera.fx_px = near_camera.fy_px = scale;
        const ewa_reference_view flat_view = make_view(&near_camera, F, 0.5, EWA_KERNEL_PERSPECTIVE);
        ewa_reference_project(&flat_view, &surfel, &flat);
        double last_error = INFINITY;
        for (double distance = 1e3; distance < 1e7; distance *= 100) {
            ewa_camera far_camera = camera;
            far_camera.fx_px = far_camera.fy_px = scale * distance;
            far_camera.world_to_camera[11] = distance;
            const ewa_reference_view view = make_view(&far_camera, F, 0.5, EWA_KERNEL_PERSPECTIVE);
            ewa_reference_splat splat;
            ewa_reference_project(&view, &surfel, &splat);
            if (fabs(flat.normal.z) < 0.05) break;
            assert_true(splat.drawn && flat.drawn && !splat.by_rays);
            // A point at depth z and r pixels off the axis moves by r z / distance.
            const double error = fmax(fabs(splat.center_px[0] - flat.center_px[0]),
                                      fabs(splat.variance_px2[0] - flat.variance_px2[0]));
            assert_true(error < 20 * 1000 / distance);
            assert_true(error < 0.02 * last_error);
            assert_near(splat.peak, flat.peak, 0.3 * flat.peak * 1000 / distance);
            assert_near(splat.epsilon, flat.epsilon, 200 * flat.epsilon / distance);
            assert_near(splat.half_range, flat.half_range, 1e-8);
            ewa_reference_sample a, b;
            const double *at = flat.center_px;
            assert_true(ewa_reference_sample_at(&view, &splat, at[0] + 1, at[1], &a));
            assert_true(ewa_reference_sample_at(&flat_view, &flat, at[0] + 1, at[1], &b));
            assert_near(a.z - distance, b.z, 5000 / distance);
            last_error = error;
        }
    }
}

/// The affine kernel is what the perspective one becomes for small discs; the difference falls with their
/// square.
TEST(test_affine_limit) {
    const ewa_camera camera = odd_camera();
    const ewa_reference_view exact = make_view(&camera, 2, 0, EWA_KERNEL_PERSPECTIVE);
    const ewa_reference_view affine = make_view(&camera, 2, 0, EWA_KERNEL_AFFINE);
    check_random random = {5};
    double worst[3] = {0, 0, 0};
    for (int i = 0; i < 300; i++) {
        ewa_surfel surfel = random_surfel(&random, &camera, 1);
        for (int size = 0; size < 3; size++) {
            for (int c = 0; c < 3; c++) {
                surfel.axis_u_world[c] *= 0.1;
                surfel.axis_v_world[c] *= 0.1;
            }
            ewa_reference_splat a, b;
            ewa_reference_project(&exact, &surfel, &a);
            ewa_reference_project(&affine, &surfel, &b);
            double x[2];
            to_pixel(&affine, b.center, x);
            assert_near(b.center_px[0], x[0], 1e-9);
            const double spread = a.variance_px2[0] + a.variance_px2[2];
            for (int c = 0; c < 3; c++)
                worst[size] = fmax(worst[size], fabs(a.variance_px2[c] - b.variance_px2[c]) / spread);
        }
    }
    assert_true(worst[0] > 1e-4); // they do differ
    assert_true(worst[1] < 0.02 * worst[0] && worst[2] < 0.02 * worst[1]);
}

/// The Jacobian of the projection by differences of projected points (SS 3; docs/math.md section 3, affine).
TEST(test_affine_jacobian) {
    const ewa_camera camera = odd_camera();
    const ewa_reference_view view = make_view(&camera, 2, 0.5, EWA_KERNEL_AFFINE);
    check_random random = {6};
    for (int i = 0; i < 300; i++) {
        const ewa_surfel surfel = random_surfel(&random, &camera, 0.3);
        ewa_reference_splat splat;
        ewa_reference_project(&view, &surfel, &splat);
        if (!splat.drawn) continue;
        double plus[2], minus[2], variance[3] = {0, 0, 0};
        for (int axis = 0; axis < 2; axis++) {
            to_pixel(&view, on_disc(&splat, axis == 0 ? 1e-4 : 0, axis == 1 ? 1e-4 : 0), plus);
            to_pixel(&view, on_disc(&splat, axis == 0 ? -1e-4 : 0, axis == 1 ? -1e-4 : 0), minus);
            const double dx = (plus[0] - minus[0]) / 2e-4, dy = (plus[1] - minus[1]) / 2e-4;
            variance[0] += dx * dx;
            variance[1] += dx * dy;
            variance[2] += dy * dy;
        }
        for (int c = 0; c < 3; c++)
            assert_near(splat.variance_px2[c], variance[c], 1e-6 * (variance[0] + variance[2]));
    }
}

/// Pixel rays against points of the disc: without a prefilter the kernel's own coordinates come back exactly,
/// with one the variance in the tangent frame is I + h^2 times the derivatives found by differences.
TEST(test_rays) {
    ewa_camera camera = odd_camera();
    check_random random = {7};
    int compared = 0;
    for (int i = 0; i < 3000; i++) {
        const double h = i % 2;
        camera.fx_px = h == 0 ? 310 : 3; // with few pixels per unit the prefilter matters
        camera.fy_px = h == 0 ? 270 : 5;
        camera.cx_px = camera.width_px / 2.0;
        camera.cy_px = camera.height_px / 2.0;
        const ewa_reference_view view = make_view(&camera, 2, h, EWA_KERNEL_PERSPECTIVE);
        ewa_surfel surfel = random_surfel(&random, &camera, check_uniform(&random, 0.5, 2));
        surfel.center[2] = check_uniform(&random, -0.3, 0.6);
        ewa_reference_splat splat;
        ewa_reference_project(&view, &surfel, &splat);
        if (!splat.drawn || !splat.by_rays) continue;
        const double u = check_uniform(&random, -1, 1), v = check_uniform(&random, -1, 1);
        const ewa_vec3 q = on_disc(&splat, u, v);
        if (q.z < -0.01) { // what is behind the eye is not seen through it
            double behind[2];
            ewa_reference_sample none;
            to_pixel(&view, q, behind);
            assert_false(ewa_reference_sample_at(&view, &splat, behind[0], behind[1], &none));
        }
        if (q.z < 0.2 || fabs(vec3_dot(splat.normal, q)) < 0.1 * vec3_length(q)) continue;
        double x[2];
        to_pixel(&view, q, x);
        ewa_reference_sample sample;
        assert_true(ewa_reference_sample_at(&view, &splat, x[0], x[1], &sample));
        assert_near(sample.z, q.z, 1e-9);
        if (h == 0) {
            assert_near(sample.distance2, u * u + v * v, 1e-9);
            assert_near(sample.weight, exp(-0.5 * (u * u + v * v)) / (2 * PI), 1e-9);
        } else {
            // Where the tangent frame is hit one step to the right and one step down, by plain ray and plane.
            double by[2][2];
            const double step = 1e-4;
            for (int axis = 0; axis < 2; axis++) {
                const ewa_vec3 d =
                    ewa_reference_ray(&view, x[0] + (axis == 0 ? step : 0), x[1] + (axis == 1 ? step : 0));
                const ewa_vec3 hit =
                    vec3_scale(d, vec3_dot(splat.normal, splat.center) / vec3_dot(splat.normal, d));
                const ewa_vec3 offset = vec3_sub(hit, q);
                by[axis][0] = vec3_dot(offset, splat.axis_u) / vec3_dot(splat.axis_u, splat.axis_u) / step;
                by[axis][1] = vec3_dot(offset, splat.axis_v) / vec3_dot(splat.axis_v, splat.axis_v) / step;
            }
            const double w11 = 1 + by[0][0] * by[0][0] + by[1][0] * by[1][0];
            const double w12 = by[0][0] * by[0][1] + by[1][0] * by[1][1];
            const double w22 = 1 + by[0][1] * by[0][1] + by[1][1] * by[1][1];
            const double determinant = w11 * w22 - w12 * w12;
            const double r2 = (u * u * w22 - 2 * u * v * w12 + v * v * w11) / determinant;
            assert_near(sample.distance2, r2, 1e-4);
            assert_near(sample.weight, exp(-0.5 * r2) / sqrt(determinant) / (2 * PI), 1e-4);
        }
        compared++;
    }
    assert_true(compared > 300);
}

/// For small discs the pixel rays and the ellipse are the same kernel.
TEST(test_rays_meet_ellipse) {
    const ewa_camera camera = odd_camera();
    const ewa_reference_view view = make_view(&camera, 2, 0.5, EWA_KERNEL_PERSPECTIVE);
    check_random random = {8};
    double worst[2] = {0, 0};
    for (int i = 0; i < 300; i++) {
        ewa_surfel surfel = random_surfel(&random, &camera, 0.3);
        for (int size = 0; size < 2; size++) {
            ewa_reference_splat splat;
            ewa_reference_project(&view, &surfel, &splat);
            if (!splat.drawn || fabs(vec3_dot(splat.normal, splat.center)) < 0.2 * vec3_length(splat.center))
                continue;
            // One standard deviation of the filtered kernel along x.
            const double x = splat.center_px[0] + 1 / sqrt(splat.inverse[0]), y = splat.center_px[1];
            ewa_reference_sample ellipse, ray;
            assert_true(ewa_reference_sample_at(&view, &splat, x, y, &ellipse));
            splat.by_rays = true;
            if (!ewa_reference_sample_at(&view, &splat, x, y, &ray)) continue;
            worst[size] = fmax(worst[size], fabs(ray.weight / ellipse.weight - 1));
            assert_near(ray.z, ellipse.z, 1e-9);
            for (int c = 0; c < 3; c++) {
                surfel.axis_u_world[c] *= 1e-3;
                surfel.axis_v_world[c] *= 1e-3;
            }
        }
    }
    assert_true(worst[0] > 0.01);
    // What is left is the pixel's own perspective: derivatives one pixel beside the centre.
    assert_true(worst[1] < 0.05 && worst[1] < worst[0]);
}

/// A disc parallel to the picture: sigma f / z pixels, peak by hand, and all of its kernel on the pixels.
TEST(test_frontal_disc) {
    ewa_camera camera = odd_camera();
    camera.fx_px = camera.fy_px = 300;
    const double F = 2, sigma = 0.5, z = 10, sigma_px = 15;
    for (int i = 0; i < 4; i++) {
        const double h = i % 2 ? 0.5 : 0;
        const ewa_reference_view view = make_view(&camera, F, h, i / 2 ? EWA_KERNEL_AFFINE : 0);
        const ewa_surfel surfel =
            make_surfel(vec3_make(0.4, -0.3, z), vec3_make(sigma, 0, 0), vec3_make(0, sigma, 0));
        ewa_reference_splat splat;
        ewa_reference_project(&view, &surfel, &splat);
        assert_true(splat.drawn);
        assert_near(splat.center_px[0], camera.cx_px + 12, 1e-12);
        assert_near(splat.center_px[1], camera.cy_px - 9, 1e-12);
        assert_near(splat.variance_px2[0], sigma_px * sigma_px, 1e-10);
        ewa_reference_sample sample;
        assert_true(ewa_reference_sample_at(&view, &splat, splat.center_px[0], splat.center_px[1], &sample));
        assert_near(sample.weight, sigma_px * sigma_px / (sigma_px * sigma_px + h * h) / (2 * PI), 1e-12);
        assert_near(sample.z, z, 1e-12);
        double sum = 0;
        for (int y = splat.y_begin; y < splat.y_end; y++)
            for (int x = splat.x_begin; x < splat.x_end; x++) {
                ewa_reference_sample_at(&view, &splat, x + 0.5, y + 0.5, &sample);
                if (sample.distance2 < F * F) sum += sample.weight;
            }
        const double expected = sigma_px * sigma_px * (1 - exp(-0.5 * F * F));
        assert_near(sum, expected, 2e-3 * expected);
        assert_near(splat.epsilon, F * sigma, 1e-12); // no slope, no second term
    }
}

/// Depth is that of ray and plane on the disc, and stays within the disc's range beyond it; the tolerance's
/// slope is that of the depth itself.
TEST(test_depth) {
    ewa_camera camera = odd_camera();
    check_random random = {9};
    for (int i = 0; i < 1000; i++) {
        camera.projection = i % 2 ? EWA_ORTHOGRAPHIC : EWA_PERSPECTIVE;
        const double F = 2, h = 0.1, per_unit = camera.projection == EWA_ORTHOGRAPHIC ? 1 : 1 / camera.fx_px;
        const ewa_reference_view view = make_view(&camera, F, h, EWA_KERNEL_PERSPECTIVE);
        const ewa_surfel surfel = random_surfel(&random, &camera, 0.3);
        ewa_reference_splat splat;
        ewa_reference_project(&view, &surfel, &splat);
        if (!splat.drawn || fabs(splat.normal.z) < 1e-3) continue;
        const double angle = check_uniform(&random, 0, 2 * PI), r = check_uniform(&random, 0, F);
        const ewa_vec3 q = on_disc(&splat, r * cos(angle), r * sin(angle));
        double x[2];
        to_pixel(&view, q, x);
        ewa_reference_sample sample;
        assert_true(ewa_reference_sample_at(&view, &splat, x[0], x[1], &sample));
        assert_near(sample.z, q.z, 1e-7);
        const bool flat = camera.projection == EWA_ORTHOGRAPHIC;
        const double range = F * sqrt(pow(splat.axis_u.z, 2) + pow(splat.axis_v.z, 2));
        assert_near(splat.half_range, range, 1e-12);
        for (int far = -1000; far <= 1000; far += 500) {
            ewa_reference_sample_at(&view, &splat, x[0] + far, x[1] - 2 * far, &sample);
            const double key = flat ? -sample.z : 1 / sample.z;
            assert_true(key >= splat.key_low - 1e-12 && key <= splat.key_high + 1e-12);
        }
        // The slope of z over one pixel by moving along the plane, taken at the centre.
        ewa_vec3 steps[2];
        double slope2 = 0;
        for (int axis = 0; axis < 2; axis++) {
            double at[2];
            to_pixel(&view, splat.center, at);
            at[axis] += 1e-5;
            const ewa_vec3 d = ewa_reference_ray(&view, at[0], at[1]);
            const ewa_vec3 eye = view.orthographic ? vec3_make((at[0] - view.cx_px) / view.fx_px,
                                                               (at[1] - view.cy_px) / view.fy_px, 0)
                                                   : vec3_make(0, 0, 0);
            const double z = vec3_dot(splat.normal, vec3_sub(splat.center, eye)) / vec3_dot(splat.normal, d);
            steps[axis] = vec3_scale(d, z);
            slope2 += pow((steps[axis].z - splat.center.z) / 1e-5, 2);
        }
        const double reach = F * h * sqrt(slope2), z = splat.center.z;
        const double margin = fmax(0, fmin(EWA_FREE_RADII * F * 0.3, EWA_FREE_DEPTH * z) - reach);
        assert_near(splat.key_low, flat ? -(z + range) - margin : 1 / (z + range) - margin / (z * z), 1e-5);
        assert_near(splat.key_high, flat ? range - z + margin : 1 / (z - range) + margin / (z * z), 1e-5);
        const double grazing = fmin(reach, EWA_GRAZING_TOLERANCE * F * 0.3);
        assert_near(splat.epsilon, F * 0.3 + grazing, 1e-3 * splat.epsilon + per_unit * 1e-6);
    }
}

/// What is dropped, what is turned, what goes by rays.
TEST(test_sides) {
    ewa_camera camera = odd_camera();
    WITH_DEFAULTS(ewa_render_options, options);
    for (int i = 0; i < 4; i++) {
        camera.projection = i & 1 ? EWA_ORTHOGRAPHIC : EWA_PERSPECTIVE;
        options.cull = i & 2 ? EWA_CULL_BACK : EWA_CULL_NONE;
        ewa_reference_view view;
        ewa_reference_view_make(&camera, 2, &options, &view);
        const ewa_vec3 x = {0.1, 0, 0}, y = {0, 0.1, 0}, z = {0, 0, 0.1};
        ewa_reference_splat splat;
        // The normal x cross y = z points away from the eye.
        ewa_surfel surfel = make_surfel(vec3_make(0, 0, 5), x, y);
        ewa_reference_project(&view, &surfel, &splat);
        assert_int_equal(splat.drawn, options.cull == EWA_CULL_NONE);
        if (splat.drawn) assert_true(splat.normal.z == -1 && splat.normal_world.z == -1);
        surfel = make_surfel(vec3_make(0, 0, 5), y, x);
        ewa_reference_project(&view, &surfel, &splat);
        assert_true(splat.drawn && splat.normal.z == -1 && splat.normal_world.z == -1);
        // Exactly from the edge, and less than can be seen.
        surfel = make_surfel(vec3_make(0, 0, 5), x, z);
        ewa_reference_project(&view, &surfel, &splat);
        assert_false(splat.drawn);
        const double tiny = 1e-10;
        surfel = make_surfel(vec3_make(0, 0, 5), vec3_scale(y, tiny), vec3_scale(x, tiny));
        ewa_reference_project(&view, &surfel, &splat);
        assert_false(splat.drawn);
        view.prefilter_px = 0;
        ewa_reference_project(&view, &surfel, &splat);
        assert_false(splat.drawn);
        // A line but for rounding, across the pixels.
        const double lean = 1e-10;
        surfel = make_surfel(vec3_make(0, 0, 5), vec3_make(0.1, 0.1, 0), vec3_make(lean, -lean, 0.1));
        ewa_reference_project(&view, &surfel, &splat);
        assert_false(splat.drawn);
        // Wholly behind.
        surfel = make_surfel(vec3_make(0, 0.3, -0.21), z, x);
        ewa_reference_project(&view, &surfel, &splat);
        assert_false(splat.drawn);
    }
    ewa_render_options_init(&options, sizeof options);
    camera.projection = EWA_PERSPECTIVE;
    ewa_reference_view view;
    ewa_reference_view_make(&camera, 2, &options, &view);
    // Normals are unit whatever the camera's scale is.
    for (int i = 0; i < 12; i++) camera.world_to_camera[i] *= 7;
    ewa_reference_view scaled;
    ewa_reference_view_make(&camera, 2, &options, &scaled);
    check_random random = {10};
    const ewa_surfel leaning = random_surfel(&random, &camera, 0.1);
    ewa_reference_splat seen;
    ewa_reference_project(&scaled, &leaning, &seen);
    assert_true(seen.drawn);
    assert_near(vec3_length(seen.normal), 1, 1e-12);
    // A floor under the eye reaching from z = -0.19 on: drawn by rays; from 0.2 on: touching; a bit farther:
    // ellipse.
    const double centers[] = {0.01, 0.2, 0.2099, 0.2101};
    for (int i = 0; i < 4; i++) {
        const ewa_surfel surfel =
            make_surfel(vec3_make(0, 0.3, centers[i]), vec3_make(0, 0, 0.1), vec3_make(0.1, 0, 0));
        ewa_reference_splat splat;
        ewa_reference_project(&view, &surfel, &splat);
        assert_true(splat.drawn);
        assert_int_equal(splat.by_rays, i < 3);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
