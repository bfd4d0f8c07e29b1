// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How splats at contours move: away from them, by as much in the pipeline as in the reference.
#include "surface/contour.h"
#include "surface/packets.h"
#include "surface/semantics.h"
#include "tests/splat/picture.h"

#include <math.h>

enum { SIDE_PX = 96 };

/// The way of a splat follows from where alpha is a half; without a threshold there is none.
TEST(test_shift) {
    WITH_DEFAULTS(ewa_render_options, options);
    const double both = ewa_contour_shift(&options, false);
    options.kernel = EWA_KERNEL_RAYCAST;
    assert_true(ewa_contour_shift(&options, false) == 0 && ewa_contour_shift(&options, true) == both);
    options.kernel = EWA_KERNEL_PERSPECTIVE;
    options.cull = EWA_CULL_BACK;
    const double alone = ewa_contour_shift(&options, false);
    assert_true(fabs(both / EWA_CONTOUR_SHIFT - 1.117) < 0.001 && fabs(alone / EWA_CONTOUR_SHIFT - 0.7554) < 0.001);
    options.edge_threshold = 1;
    assert_true(ewa_contour_shift(&options, false) < 1e-3);
    options.edge_threshold = 4;
    assert_true(ewa_contour_shift(&options, false) == 0);
    options.edge_threshold = 0.45;
    options.edge_antialiasing = false;
    assert_true(ewa_contour_shift(&options, false) == 0);
    options.edge_antialiasing = true;
    options.passes = 1;
    assert_true(ewa_contour_shift(&options, false) == 0);
}

static ewa_cloud *make_object(ewa_context *context, ewa_object object) {
    WITH_DEFAULTS(ewa_generate_options, options);
    options.object = object;
    options.size_world = 2;
    options.point_count = 3000;
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_generate(context, &options, &cloud), EWA_OK);
    float *curvature = check_add(cloud, EWA_CURVATURE, EWA_F32, 1);
    const float *p = ewa_cloud_find(cloud, EWA_POSITION)->data;
    for (int i = 0; i < 3000; i++, p += 3) { // of radius 1; of a tube of 2/7 around a ring of 5/7
        const double ring = hypot((double)p[0], (double)p[1]), k = 7 / 2.0, m = (ring * 7 - 5) / 2 / ring;
        curvature[i] = object == EWA_OBJECT_SPHERE ? 1 : (float)fmin(sqrt((k * k + m * m) / 2), k + m);
    }
    return cloud;
}

/// Mean alpha of a picture.
static double cover(const picture *drawn) {
    double sum = 0;
    for (int i = 0; i < SIDE_PX * SIDE_PX; i++) sum += (double)drawn->frame.rgba[4 * i + 3];
    return sum / (SIDE_PX * SIDE_PX);
}

/// Spheres and tori, and the same with normals inside out, for each kernel and both projections: pipeline and reference
/// draw the same, and less than without the rule.
TEST_ON(test_pipelines, 0) {
    for (int variant = 0; variant < 20; variant++) {
        const int kernel = variant % 5;
        OWNED(ewa_cloud_destroy)
        ewa_cloud *cloud = make_object(context, variant % 4 < 2 ? EWA_OBJECT_SPHERE : EWA_OBJECT_TORUS);
        float *normal = ewa_cloud_find(cloud, EWA_NORMAL)->data;
        float *curvature = ewa_cloud_find(cloud, EWA_CURVATURE)->data;
        for (uint64_t i = 0; variant % 3 == 1 && i < 3 * ewa_cloud_point_count(cloud); i++) normal[i] *= -1;
        for (uint64_t i = 0; variant % 3 == 1 && i < ewa_cloud_point_count(cloud); i++) curvature[i] *= -1;
        ewa_camera camera = check_camera(SIDE_PX, SIDE_PX);
        static const double eye[3] = {1.2, -2.6, 1.7}, target[3] = {0}, up[3] = {0, 0, 1};
        assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
        if (variant < 10)
            assert_int_equal(ewa_camera_set_fov(&camera, 45), EWA_OK);
        else
            assert_int_equal(ewa_camera_set_ortho(&camera, 2.6), EWA_OK);
        WITH_DEFAULTS(ewa_render_options, options);
        options.kernel = (ewa_kernel)kernel;
        options.cull = variant % 7 == 0 ? EWA_CULL_BACK : EWA_CULL_NONE;
        const scene of = {.cloud = cloud, .camera = camera, .unit_coverage = 0};
        ewa_surfels_info info;
        ewa_surfels *surfels = check_surfels(cloud, NULL);
        ewa_surfels_describe(surfels, &info);
        ewa_surfels_destroy(&surfels);
        scene with_coverage = of;
        with_coverage.unit_coverage = info.unit_coverage;
        OWNED(picture_free) picture exact = picture_of_scene(&with_coverage, NULL, &options);
        OWNED(picture_free) picture fast = picture_draw(context, cloud, &camera, NULL, &options);
        double largest = 0;
        for (int i = 0; i < SIDE_PX * SIDE_PX; i++)
            largest = fmax(largest, fabs((double)exact.frame.rgba[4 * i + 3] - (double)fast.frame.rgba[4 * i + 3]));
        print_message("variant %d, kernel %d: alpha %.3g off at most, mean %.4f\n", variant, kernel, largest, cover(&fast));
        assert_true(largest < 0.02);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
