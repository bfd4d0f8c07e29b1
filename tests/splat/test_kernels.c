// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of the reference's kernels beside the perspective one: source against affine, circles against
// ellipses, the exact projective kernel against points of the disc and against its limits.
#include "surface/semantics.h"
#include "tests/splat/surfels.h"

static const ewa_kernel all_kernels[] = {EWA_KERNEL_PERSPECTIVE, EWA_KERNEL_AFFINE, EWA_KERNEL_SOURCE,
                                         EWA_KERNEL_CIRCULAR, EWA_KERNEL_RAYCAST};

/// The splat at a pixel `reach` standard deviations of the affine, filtered kernel away from `center`.
static void random_pixel(check_random *random, const double center[2], double reach_px, double x[2]) {
    for (int axis = 0; axis < 2; axis++) x[axis] = center[axis] + check_uniform(random, -reach_px, reach_px);
}

/// SS equations 7 and 8: the same kernel in screen and in source space.
TEST(test_source_equals_affine) {
    ewa_camera camera = odd_camera();
    check_random random = {1};
    double worst = 0;
    int compared = 0;
    for (int i = 0; i < 4000; i++) {
        camera.projection = i % 4 == 3 ? EWA_ORTHOGRAPHIC : EWA_PERSPECTIVE;
        const double h = i % 3 * 0.5;
        const ewa_reference_view affine = make_view(&camera, 2, h, EWA_KERNEL_AFFINE);
        const ewa_reference_view source = make_view(&camera, 2, h, EWA_KERNEL_SOURCE);
        const ewa_surfel surfel = random_surfel(&random, &camera, check_uniform(&random, 0.001, 0.5));
        ewa_reference_splat a, b;
        ewa_reference_project(&affine, &surfel, &a);
        ewa_reference_project(&source, &surfel, &b);
        if (!a.drawn || !b.drawn) continue;
        assert_true(a.x_begin == b.x_begin && a.x_end == b.x_end && a.y_begin == b.y_begin &&
                    a.y_end == b.y_end);
        double x[2];
        random_pixel(&random, a.center_px, 2 * sqrt(a.variance_px2[0] + a.variance_px2[2] + h * h), x);
        ewa_reference_sample left, right;
        ewa_reference_sample_at(&affine, &a, x[0], x[1], &left);
        ewa_reference_sample_at(&source, &b, x[0], x[1], &right);
        // Splats from the edge lose digits in their inverse.
        const double thin = sqrt(a.variance_px2[0] + a.variance_px2[2]) / (a.peak > 0 ? a.peak : 1);
        if (thin > 1e4 || left.distance2 > 100) continue;
        worst = fmax(worst, fabs(left.distance2 - right.distance2) / (1 + left.distance2));
        if (left.weight > 1e-12) worst = fmax(worst, fabs(right.weight / left.weight - 1));
        assert_near(left.z, right.z, 1e-12);
        compared++;
    }
    print_message("%d splats, largest difference %.2g\n", compared, worst);
    assert_true(compared > 3000 && worst < 1e-8);
}

/// Backward mapping by itself: the kernel's coordinates of a point that the affine map has put on the screen.
TEST(test_source_maps_backward) {
    const ewa_camera camera = odd_camera();
    const ewa_reference_view view = make_view(&camera, 2, 0, EWA_KERNEL_SOURCE);
    check_random random = {2};
    for (int i = 0; i < 500; i++) {
        const ewa_surfel surfel = random_surfel(&random, &camera, 0.3);
        ewa_reference_splat splat;
        ewa_reference_project(&view, &surfel, &splat);
        if (!splat.drawn || fabs(vec3_dot(splat.normal, splat.center)) < 0.1 * vec3_length(splat.center))
            continue;
        const double u = check_uniform(&random, -2, 2), v = check_uniform(&random, -2, 2), step = 1e-5;
        double c[2], along[2], aside[2];
        to_pixel(&view, splat.center, c);
        to_pixel(&view, on_disc(&splat, step, 0), along);
        to_pixel(&view, on_disc(&splat, 0, step), aside);
        ewa_reference_sample sample;
        ewa_reference_sample_at(&view, &splat, c[0] + (u * (along[0] - c[0]) + v * (aside[0] - c[0])) / step,
                                c[1] + (u * (along[1] - c[1]) + v * (aside[1] - c[1])) / step, &sample);
        assert_near(sample.distance2, u * u + v * v, 1e-3);
        assert_near(sample.weight, exp(-0.5 * (u * u + v * v)) / (2 * PI), 1e-3);
    }
}

/// The circle reaches as far as the ellipse does where it is longest, and holds as much.
TEST(test_circle_around_ellipse) {
    ewa_camera camera = odd_camera();
    check_random random = {3};
    for (int i = 0; i < 300; i++) {
        camera.projection = i % 4 == 3 ? EWA_ORTHOGRAPHIC : EWA_PERSPECTIVE;
        const double F = 2, h = i % 3 * 0.5;
        const ewa_reference_view affine = make_view(&camera, F, h, EWA_KERNEL_AFFINE);
        const ewa_reference_view circular = make_view(&camera, F, h, EWA_KERNEL_CIRCULAR);
        const ewa_surfel surfel = random_surfel(&random, &camera, check_uniform(&random, 0.01, 0.5));
        ewa_reference_splat ellipse, circle;
        ewa_reference_project(&affine, &surfel, &ellipse);
        ewa_reference_project(&circular, &surfel, &circle);
        if (!ellipse.drawn) continue;
        assert_true(circle.drawn);
        // Sampled directions miss the end of a needle.
        const double trace = ellipse.inverse[0] + ellipse.inverse[2];
        const double determinant = ellipse.inverse[0] * ellipse.inverse[2] - pow(ellipse.inverse[1], 2);
        if (determinant < 1e-3 * trace * trace) continue;
        double farthest = 0;
        for (int step = 0; step < 2000; step++) {
            const double x = cos(PI * step / 2000), y = sin(PI * step / 2000), *q = ellipse.inverse;
            farthest = fmax(farthest, F / sqrt(q[0] * x * x + 2 * q[1] * x * y + q[2] * y * y));
        }
        for (int step = 0; step < 8; step++) {
            ewa_reference_sample sample;
            ewa_reference_sample_at(&circular, &circle, circle.center_px[0] + farthest * cos(PI * step / 4),
                                    circle.center_px[1] + farthest * sin(PI * step / 4), &sample);
            assert_near(sample.distance2, F * F, 2e-3 * F * F);
        }
        const double held = ellipse.peak / sqrt(determinant);
        assert_near(circle.peak / circle.inverse[0], held, 1e-6 * held);
    }
}

/// Raycast without a prefilter: the kernel's own coordinates come back from anywhere on the disc, however
/// large.
TEST(test_raycast_is_exact) {
    const ewa_camera camera = odd_camera();
    const double F = 2;
    const ewa_reference_view view = make_view(&camera, F, 0, EWA_KERNEL_RAYCAST);
    check_random random = {4};
    int compared = 0;
    for (int i = 0; i < 2000; i++) {
        const ewa_surfel surfel = random_surfel(&random, &camera, check_uniform(&random, 0.01, 2));
        ewa_reference_splat splat;
        ewa_reference_project(&view, &surfel, &splat);
        if (!splat.drawn || splat.by_rays) continue;
        const double angle = check_uniform(&random, 0, 2 * PI), r = F * check_uniform(&random, 0, 1.2);
        const ewa_vec3 q = on_disc(&splat, r * cos(angle), r * sin(angle));
        if (fabs(vec3_dot(splat.normal, q)) < 0.05 * vec3_length(q) || q.z < 0.01) continue;
        double x[2];
        to_pixel(&view, q, x);
        ewa_reference_sample sample;
        assert_true(ewa_reference_sample_at(&view, &splat, x[0], x[1], &sample));
        if (r < F) {
            assert_near(sample.distance2, r * r, 1e-8);
            assert_near(sample.weight, exp(-0.5 * r * r) / (2 * PI), 1e-9);
            assert_near(sample.z, q.z, 1e-8 * q.z);
        } else {
            assert_true(sample.distance2 >= F * F);
        }
        compared++;
    }
    assert_true(compared > 1500);
}

/// For small discs raycast is the affine kernel, from the edge and beyond the plane's horizon too.
TEST(test_raycast_limit) {
    const ewa_camera camera = odd_camera();
    const ewa_reference_view exact = make_view(&camera, 2, 0.5, EWA_KERNEL_RAYCAST);
    const ewa_reference_view affine = make_view(&camera, 2, 0.5, EWA_KERNEL_AFFINE);
    check_random random = {5};
    double worst[4] = {0, 0, 0, 0};
    for (int i = 0; i < 1000; i++) {
        ewa_surfel surfel = random_surfel(&random, &camera, 1);
        for (int size = 0; size < 4; size++) {
            for (int c = 0; c < 3; c++) {
                surfel.axis_u_world[c] *= 0.1;
                surfel.axis_v_world[c] *= 0.1;
            }
            ewa_reference_splat a, b;
            ewa_reference_project(&exact, &surfel, &a);
            ewa_reference_project(&affine, &surfel, &b);
            if (!a.drawn) continue;
            for (int k = 0; k < 8; k++) {
                double x[2];
                random_pixel(&random, b.center_px, 2 / sqrt(fmin(b.inverse[0], b.inverse[2])), x);
                ewa_reference_sample left, right;
                ewa_reference_sample_at(&exact, &a, x[0], x[1], &left);
                ewa_reference_sample_at(&affine, &b, x[0], x[1], &right);
                if (right.distance2 < 4)
                    worst[size] = fmax(worst[size], fabs(left.distance2 - right.distance2));
            }
        }
    }
    print_message("largest difference of r^2 by size: %.2g %.2g %.2g %.2g\n", worst[0], worst[1], worst[2],
                  worst[3]);
    assert_true(worst[0] > 0.01);
    assert_true(worst[2] < 0.2 * worst[1] && worst[3] < 0.2 * worst[2]);
}

/// Parallel to the picture there is no perspective within a disc: all kernels but the circular one's shape
/// agree.
TEST(test_frontal) {
    ewa_camera camera = odd_camera();
    camera.fx_px = camera.fy_px = 300;
    const ewa_surfel surfel =
        make_surfel(vec3_make(0.4, -0.3, 10), vec3_make(0.5, 0, 0), vec3_make(0, 0.5, 0));
    for (size_t k = 0; k < sizeof all_kernels / sizeof all_kernels[0]; k++) {
        const ewa_reference_view view = make_view(&camera, 2, 0.5, all_kernels[k]);
        ewa_reference_splat splat;
        ewa_reference_sample sample;
        ewa_reference_project(&view, &surfel, &splat);
        assert_true(splat.drawn);
        ewa_reference_sample_at(&view, &splat, camera.cx_px + 12 + 9, camera.cy_px - 9 - 12, &sample);
        assert_near(sample.distance2, 225 / 225.25, 1e-12);
        assert_near(sample.weight, 225 / 225.25 * exp(-0.5 * 225 / 225.25) / (2 * PI), 1e-12);
    }
}

/// Discs that orthographic cameras see from their edge, but for rounding: weights stay what weights may be.
TEST(test_edges_seen_by_source) {
    ewa_camera camera = odd_camera();
    camera.projection = EWA_ORTHOGRAPHIC;
    check_random random = {14};
    const ewa_reference_view view = make_view(&camera, 3, 1, EWA_KERNEL_SOURCE);
    int drawn = 0;
    for (int i = 0; i < 4000; i++) {
        const double lean = pow(10, check_uniform(&random, -17, -13)),
                     turn = pow(10, check_uniform(&random, -17, -14));
        const ewa_surfel surfel = make_surfel(vec3_make(0, 0, 2), vec3_make(0.05, 0.05 * turn, 0),
                                              vec3_make(0.05 * turn, 0.05 * lean, 0.05));
        ewa_reference_splat splat;
        ewa_reference_project(&view, &surfel, &splat);
        if (!splat.drawn) continue;
        drawn++;
        double x[2];
        random_pixel(&random, splat.center_px, 3, x);
        ewa_reference_sample sample;
        if (!ewa_reference_sample_at(&view, &splat, x[0], x[1], &sample)) continue;
        assert_true(sample.distance2 >= 0 && sample.weight >= 0 && sample.weight <= 1 / (2 * PI));
    }
    assert_true(drawn > 1000);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
