// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of points that are no part of a surface (EWA_SURFACENESS): circles parallel to the picture, in all pipelines.
#include "tests/splat/picture.h"

#include <math.h>
#include <string.h>

/// Makes every `step`-th point of a cloud one of no surface.
static void strew(ewa_cloud *cloud, uint64_t step) {
    float *surfaceness = check_add(cloud, EWA_SURFACENESS, EWA_F32, 1);
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) surfaceness[i] = i % step ? 0.5F : 0.49F;
}

/// q0 of a cloud, which the reference is told.
static double measure_coverage(const ewa_cloud *cloud) {
    ewa_surfels_info info;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(cloud, NULL);
    ewa_surfels_describe(surfels, &info);
    return info.unit_coverage;
}

/// The fast pipeline agrees with the reference, for every kernel, with back faces left out and cut by planes.
TEST(test_reference) {
    (void)state;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, NULL);
    static const scene_kind kinds[] = {SCENE_SPHERE, SCENE_ELLIPSES, SCENE_NEAR};
    for (int kind = 0; kind < 3; kind++) {
        OWNED(scene_free) scene made = picture_measured_scene(context, kinds[kind], 1600, NULL);
        strew(made.cloud, 3);
        made.unit_coverage = measure_coverage(made.cloud);
        ewa_render_options options;
        for (int variant = 0; variant < 6; variant++) {
            ewa_render_options_init(&options, sizeof options);
            if (variant < 4) options.kernel = (ewa_kernel)variant;
            if (variant == 4) options.cull = EWA_CULL_BACK;
            if (variant == 5) {
                const double plane[4] = {0.6, -0.3, 0.74, 0.1};
                options.section_count = 1;
                memcpy(options.section_planes[0], plane, sizeof plane);
            }
            picture_hold(&made, &options, false, "billboards");
        }
        ewa_render_options_init(&options, sizeof options);
        picture_hold(&made, &options, true, "billboards, orthographic");
    }
}

enum { SIDE = 64, POINTS = 300 };

/// Points with normals that either face the camera or point anywhere.
static ewa_cloud *make_points(ewa_context *context, const double forward[3], bool facing, uint64_t step) {
    ewa_cloud *cloud = check_cloud_of(context, POINTS);
    float *position = check_add(cloud, EWA_POSITION, EWA_F32, 3);
    float *normal = check_add(cloud, EWA_NORMAL, EWA_F32, 3);
    float *radius = check_add(cloud, EWA_RADIUS, EWA_F32, 1);
    uint8_t *color = check_add(cloud, EWA_COLOR, EWA_U8, 3);
    check_random random = {5};
    for (int i = 0; i < POINTS; i++) {
        for (int c = 0; c < 3; c++) {
            position[3 * i + c] = (float)check_uniform(&random, -1, 1);
            const double any = check_uniform(&random, -1, 1);
            normal[3 * i + c] = (float)(facing ? -forward[c] : any);
            color[3 * i + c] = (uint8_t)(c == 0 ? 40 + i % 200 : 90);
        }
        // As large as what discs of all directions cover on average.
        radius[i] = (float)(check_uniform(&random, 0.05, 0.2) * (facing ? sqrt(0.5) : 1));
    }
    if (step) strew(cloud, step);
    return cloud;
}

/// From wherever they are seen, points of no surface are the discs that face the picture; so they are from afar, by
/// their levels, and back faces they have none.
TEST(test_face_the_picture) {
    (void)state;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, NULL);
    static const double forwards[3][3] = {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    for (int i = 0; i < 12; i++) {
        const double *forward = forwards[i % 3], distance = i < 6 ? 3 : 40, up[3] = {i % 3 == 2, 0, i % 3 != 2};
        const double eye[3] = {-distance * forward[0], -distance * forward[1], -distance * forward[2]}, middle[3] = {0};
        ewa_camera camera = check_camera(SIDE, SIDE);
        camera.cx_px = camera.cy_px = SIDE / 2;
        camera.fx_px = camera.fy_px = SIDE;
        assert_int_equal(ewa_camera_look_at(&camera, eye, middle, up), EWA_OK);
        if (i % 6 > 2) assert_int_equal(ewa_camera_set_ortho(&camera, distance), EWA_OK);
        WITH_DEFAULTS(ewa_surfels_options, surfels);
        WITH_DEFAULTS(ewa_render_options, options);
        options.cull = i % 2 ? EWA_CULL_BACK : EWA_CULL_NONE;
        options.supersampling = 1;
        OWNED(ewa_cloud_destroy)
        ewa_cloud *facing = make_points(context, forward, true, 0), *strewn = make_points(context, forward, false, 1);
        picture wanted = picture_draw(context, facing, &camera, &surfels, &options);
        OWNED(picture_free) picture shown = picture_draw(context, strewn, &camera, &surfels, &options);
        for (int k = 0; k < 4 * SIDE * SIDE; k++)
            assert_true(fabsf(wanted.frame.rgba[k] - shown.frame.rgba[k]) < 1e-4F);
        double covered = 0;
        for (int k = 0; k < SIDE * SIDE; k++) covered += (double)wanted.frame.rgba[4 * k + 3];
        assert_true(covered > 10);
        picture_free(&wanted);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
