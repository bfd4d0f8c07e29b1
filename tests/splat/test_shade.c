// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Shading against closed forms, by the fast pipeline and by the reference: highlights and mirror images on a
// sphere, environments whose light is known, eye-dome lighting of planes and steps.
#include "tests/splat/shade_scene.h"

#include <math.h>
#include <string.h>

enum { SIDE_PX = 160, POINTS = 40000 };

static const float GREY[3] = {0.5f, 0.4f, 0.3f};
static const double EYE[3] = {1, 0.6, 4};

static ewa_render_options phong_options(const ewa_material *material) {
    WITH_DEFAULTS(ewa_render_options, options);
    options.shading = EWA_SHADING_PHONG;
    options.materials = material;
    options.material_count = material ? 1 : 0;
    options.cull = EWA_CULL_BACK;
    options.edge_antialiasing = false;
    return options;
}

/// Fast pipeline or reference.
static picture draw(ewa_context *context, int way, const ewa_cloud *cloud, const ewa_camera *camera,
                    const ewa_render_options *options) {
    return way ? shade_reference(cloud, camera, options) : shade_draw(context, cloud, camera, options);
}

static ewa_vec3 unit(double x, double y, double z) {
    const ewa_vec3 v = {x, y, z};
    return vec3_scale(v, 1 / vec3_length(v));
}

/// A sphere lit from one direction shows the formula of ewa_material at every pixel that is not at its edge,
/// and its brightest pixel where N is H.
TEST_ON(test_highlight_on_a_sphere, 0) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = shade_sphere(context, POINTS, GREY);
    const ewa_material material = {.ambient = 0.1f, .diffuse = 0.5f, .specular = 0.8f, .shininess = 40};
    const ewa_vec3 L = unit(2, 1, 2);
    for (int run = 0; run < 4; run++) {
        const ewa_camera camera = shade_camera(SIDE_PX, EYE, 32, run % 2 ? 2.2 : 0);
        ewa_render_options options = phong_options(&material);
        picture_set_light(&options, 4, 2, 4);
        OWNED(picture_free) picture shown = draw(context, run / 2, cloud, &camera, &options);
        double worst = 0, brightest = 0, wanted = 0;
        uint32_t at[2] = {0, 0}, wanted_at[2] = {0, 0};
        for (uint32_t y = 0; y < SIDE_PX; y++)
            for (uint32_t x = 0; x < SIDE_PX; x++) {
                ewa_vec3 origin, direction, N;
                shade_ray(&camera, x, y, &origin, &direction);
                if (!shade_hit_sphere(origin, direction, &N)) continue;
                const ewa_vec3 V = vec3_scale(direction, -1), between = vec3_add(L, V);
                if (vec3_dot(N, V) < 0.2) continue; // the discs' depth clamp shows at the edge
                const double facing = fmax(0, vec3_dot(N, L));
                const double highlight =
                    facing > 0 ? pow(fmax(0, vec3_dot(N, between) / vec3_length(between)), 40) : 0;
                const float *rgba = &shown.frame.rgba[4 * ((size_t)y * SIDE_PX + x)];
                for (int c = 0; c < 3; c++) {
                    const double seen = (double)GREY[c] * ((double)material.ambient + 0.5 * facing) +
                                        (double)material.specular * highlight;
                    worst = fmax(worst, fabs((double)rgba[c] - seen));
                }
                if (highlight > wanted) wanted = highlight, wanted_at[0] = x, wanted_at[1] = y;
                if ((double)rgba[0] - 0.25 * facing > brightest)
                    brightest = (double)rgba[0] - 0.25 * facing, at[0] = x, at[1] = y;
            }
        print_message("run %d: largest error %.2g, highlight %.4f at %u, %u, exactly %.4f at %u, %u\n", run,
                      worst, brightest, at[0], at[1], 0.05 + 0.8 * wanted, wanted_at[0], wanted_at[1]);
        // Filtered normals wander by a third of the points' spacing of 0.018.
        assert_true(worst < 0.025);
        assert_true(fabs(brightest - 0.85) < 0.005);
        assert_true(abs((int)at[0] - (int)wanted_at[0]) <= 1 && abs((int)at[1] - (int)wanted_at[1]) <= 1);
    }
}

/// Lights add up, each with its colour, and a zero direction is the eye's.
TEST_ON(test_lights_add_up, 0) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = shade_sphere(context, POINTS, GREY);
    const ewa_camera camera = shade_camera(SIDE_PX, EYE, 32, 0);
    for (int run = 0; run < 4; run++) {
        ewa_render_options options = phong_options(NULL);
        if (run / 2) options.shading = EWA_SHADING_LAMBERT;
        options.ambient = 0;
        const double directions[3][3] = {{0, 0, 0}, {3, 0, 1}, {-1, -2, 0}};
        const float colors[3][3] = {{0.2f, 0.1f, 0}, {0, 0.5f, 3}, {1, 1, 1}};
        picture alone[3];
        for (int i = 0; i < 4; i++) {
            options.light_count = i < 3 ? 1 : 3;
            for (int k = 0; k < 3; k++) {
                const int from = i < 3 ? i : k;
                memcpy(options.lights[k].direction_world, directions[from], sizeof directions[from]);
                memcpy(options.lights[k].color, colors[from], sizeof colors[from]);
            }
            picture shown = draw(context, run % 2, cloud, &camera, &options);
            if (i < 3) {
                alone[i] = shown;
                continue;
            }
            for (size_t p = 0; p < 4 * SIDE_PX * SIDE_PX; p++) {
                if (p % 4 == 3) continue;
                const float sum = alone[0].frame.rgba[p] + alone[1].frame.rgba[p] + alone[2].frame.rgba[p];
                assert_true(fabsf(shown.frame.rgba[p] - sum) < 2e-6f * fmaxf(1, sum));
            }
            picture_free(&shown);
        }
        const size_t middle = 4 * (SIDE_PX / 2 * SIDE_PX + SIDE_PX / 2);
        // The headlight falls straight on the middle: colour, and the default material's highlight.
        const float highlight = run / 2 ? 0 : 0.3f;
        assert_true(fabsf(alone[0].frame.rgba[middle] - 0.2f * (GREY[0] + highlight)) < 2e-3f);
        assert_true(fabsf(alone[0].frame.rgba[middle + 2]) < 1e-6f);
        for (int i = 0; i < 3; i++) picture_free(&alone[i]);
    }
}

/// A mirror sphere shows the light of the direction that it mirrors, for an environment any way up.
TEST_ON(test_mirror_sphere, 0) {
    static const double ups[4][3] = {{0, 1, 0}, {0, 0, 2}, {0, -1, 0}, {1, 2, -1}};
    const ewa_material mirror = {.shininess = 1, .reflection = 1};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = shade_sphere(context, POINTS, GREY);
    OWNED(ewa_environment_destroy) ewa_environment *environment = shade_environment(context, 128, shade_linear_light);
    for (int run = 0; run < 8; run++) {
        const double *up = ups[run / 2];
        const ewa_camera camera = shade_camera(SIDE_PX, EYE, 32, run == 3 ? 2.2 : 0);
        ewa_render_options options = phong_options(&mirror);
        options.environment = environment;
        memcpy(options.environment_up, up, sizeof options.environment_up);
        OWNED(picture_free) picture shown = draw(context, run % 2, cloud, &camera, &options);
        // The environment's axes in the world: y is up, x and z turned with it the shortest way.
        const ewa_vec3 Y = unit(up[0], up[1], up[2]);
        ewa_vec3 X = {1, 0, 0}, Z = {0, 0, 1};
        if (run / 2 == 1) Z = vec3_make(0, -1, 0);
        if (run / 2 == 2) Z = vec3_make(0, 0, -1);
        if (run / 2 == 3) {
            // Half a turn about y, then one about the middle of y and up, is the shortest turn from y to up.
            const ewa_vec3 half = unit(Y.x, Y.y + 1, Y.z);
            const ewa_vec3 x = {-1, 0, 0}, z = {0, 0, -1};
            X = vec3_sub(vec3_scale(half, 2 * vec3_dot(half, x)), x);
            Z = vec3_sub(vec3_scale(half, 2 * vec3_dot(half, z)), z);
        }
        double worst = 0;
        for (uint32_t y = 0; y < SIDE_PX; y++)
            for (uint32_t x = 0; x < SIDE_PX; x++) {
                ewa_vec3 origin, d, N;
                shade_ray(&camera, x, y, &origin, &d);
                if (!shade_hit_sphere(origin, d, &N) || vec3_dot(N, d) > -0.2) continue;
                const ewa_vec3 R = vec3_sub(d, vec3_scale(N, 2 * vec3_dot(N, d)));
                const double light[3] = {0.5 + 0.5 * vec3_dot(R, X), 0.5 + 0.5 * vec3_dot(R, Y),
                                         0.5 + 0.5 * vec3_dot(R, Z)};
                const float *rgba = &shown.frame.rgba[4 * ((size_t)y * SIDE_PX + x)];
                for (int c = 0; c < 3; c++) worst = fmax(worst, fabs((double)rgba[c] - light[c]));
            }
        print_message("run %d: largest error %.2g\n", run, worst);
        assert_true(worst < 0.01);
    }
}

static void constant_light(ewa_vec3 direction, float rgb[3]) {
    (void)direction;
    rgb[0] = 0.25f, rgb[1] = 3, rgb[2] = 0.7f;
}

/// A constant environment is a constant, whatever the footprint.
TEST_ON(test_constant_environment, 0) {
    const ewa_material mirror = {.shininess = 1, .reflection = 1};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = shade_sphere(context, POINTS, GREY);
    OWNED(ewa_environment_destroy) ewa_environment *environment = shade_environment(context, 50, constant_light);
    for (int way = 0; way < 2; way++)
        for (uint32_t side_px = 9; side_px <= 160; side_px *= 4) {
            const ewa_camera camera = shade_camera(side_px, EYE, 32, 0);
            ewa_render_options options = phong_options(&mirror);
            options.environment = environment;
            options.supersampling = 1;
            OWNED(picture_free) picture shown = draw(context, way, cloud, &camera, &options);
            uint32_t covered = 0;
            for (size_t p = 0; p < (size_t)side_px * side_px; p++) {
                const float *rgba = &shown.frame.rgba[4 * p];
                if (rgba[3] == 0) continue;
                covered++;
                assert_true(fabsf(rgba[0] - 0.25f) < 1e-6f && fabsf(rgba[1] - 3) < 1e-5f &&
                            fabsf(rgba[2] - 0.7f) < 2e-6f);
            }
            assert_true(covered > side_px * side_px / 3);
        }
}

/// Squares of two degrees, black and white.
static void checker_light(ewa_vec3 direction, float rgb[3]) {
    const double step = acos(-1) / 90;
    const double u = floor(atan2(direction.x, direction.z) / step), v = floor(asin(direction.y) / step);
    rgb[0] = rgb[1] = rgb[2] = fmod(fabs(u + v), 2) < 0.5;
}

/// Where a pixel mirrors many squares, it shows their mean; a lookup of single texels is black or white.
TEST_ON(test_fine_environment_does_not_alias, 0) {
    const ewa_material mirror = {.shininess = 1, .reflection = 1};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = shade_sphere(context, POINTS, GREY);
    OWNED(ewa_environment_destroy) ewa_environment *environment = shade_environment(context, 720, checker_light);
    for (int way = 0; way < 2; way++) {
        const ewa_camera camera = shade_camera(24, EYE, 32, 0); // 15 degrees from pixel to pixel
        ewa_render_options options = phong_options(&mirror);
        options.environment = environment;
        OWNED(picture_free) picture shown = draw(context, way, cloud, &camera, &options);
        double worst = 0;
        uint32_t covered = 0;
        for (uint32_t p = 0; p < 24 * 24; p++)
            if (shown.frame.rgba[4 * p + 3] == 1) {
                worst = fmax(worst, fabs((double)shown.frame.rgba[4 * p] - 0.5));
                covered++;
            }
        print_message("largest distance from the mean: %.2g\n", worst);
        assert_true(covered > 200 && worst < 0.1);
    }
}

/// A square [-1, 1]^2 in the plane z = height + tilt x, facing +z, with discs that close it.
static void add_square(float *position, float *normal, float *radius, uint32_t side, double height,
                       double tilt, double half) {
    for (uint32_t i = 0; i < side * side; i++, position += 3, normal += 3, radius++) {
        const double x = half * (2.0 * (i % side) + 1 - side) / side,
                     y = half * (2.0 * (i / side) + 1 - side) / side;
        position[0] = (float)x, position[1] = (float)y, position[2] = (float)(height + tilt * x);
        normal[0] = (float)-tilt, normal[1] = 0, normal[2] = 1;
        *radius = (float)(4 * half / side);
    }
}

/// One or two such squares, the second in front of the first with half its side.
static ewa_cloud *make_squares(ewa_context *context, uint32_t count, double tilt) {
    enum { SIDE = 100, EACH = SIDE * SIDE };
    void *position, *normal, *radius;
    ewa_cloud *cloud = check_cloud_of(context, count * EACH);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, &position), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_NORMAL, EWA_F32, 3, &normal), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, &radius), EWA_OK);
    for (uint32_t k = 0; k < count; k++)
        add_square((float *)position + 3 * k * EACH, (float *)normal + 3 * k * EACH,
                   (float *)radius + k * EACH, SIDE, 0.4 * k, tilt, k ? 0.5 : 1);
    return cloud;
}

/// Whether an uncovered pixel is as near as eye-dome lighting looks, and the filter reaches.
static bool near_rim(const picture *of, size_t pixel) {
    enum { REACH = 8 };
    const int32_t x = (int32_t)(pixel % SIDE_PX), y = (int32_t)(pixel / SIDE_PX);
    for (int32_t v = y - REACH; v <= y + REACH; v++)
        for (int32_t u = x - REACH; u <= x + REACH; u++)
            if (u >= 0 && v >= 0 && u < SIDE_PX && v < SIDE_PX && of->frame.coverage[v * SIDE_PX + u] < 0.5f)
                return true;
    return false;
}

/// A plane, seen from the front or at an angle, keeps all of its light, and so does the background. At its
/// rim it may lose a little where it is seen at a grazing angle: there the depths of discs end with the
/// discs.
TEST_ON(test_eye_dome_leaves_planes_alone, 0) {
    static const double eyes[3][3] = {{0, 0, 4}, {2.5, -1, 2.5}, {-2, 2, 1.2}};
    for (int run = 0; run < 12; run++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_squares(context, 1, run % 3 ? 0 : 0.3);
        const ewa_camera camera = shade_camera(SIDE_PX, eyes[run % 3], 40, run / 3 % 2 ? 2.5 : 0);
        WITH_DEFAULTS(ewa_render_options, options);
        options.shading = EWA_SHADING_NONE;
        options.background[2] = 0.5f, options.background[3] = 1;
        picture plain = draw(context, run / 6, cloud, &camera, &options);
        options.eye_dome = 1;
        OWNED(picture_free) picture shown = draw(context, run / 6, cloud, &camera, &options);
        double worst = 0, worst_rim = 0;
        for (size_t p = 0; p < 4 * SIDE_PX * SIDE_PX; p++) {
            const double lost = fabs((double)shown.frame.rgba[p] - (double)plain.frame.rgba[p]);
            if (near_rim(&shown, p / 4))
                worst_rim = fmax(worst_rim, lost);
            else
                worst = fmax(worst, lost);
        }
        print_message("run %d: most light lost %.2g, at the rim %.2g\n", run, worst, worst_rim);
        assert_true(worst < 1e-3 && worst_rim < 0.06);
        picture_free(&plain);
    }
}

/// A square in front of another: the one behind gets darker beside it and nowhere else, the one in front
/// keeps its light.
TEST_ON(test_eye_dome_darkens_behind_steps, 0) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_squares(context, 2, 0);
    for (int run = 0; run < 4; run++) {
        const double eye[3] = {0, 0, 4};
        const ewa_camera camera = shade_camera(SIDE_PX, eye, 32, run % 2 ? 2.3 : 0);
        WITH_DEFAULTS(ewa_render_options, options);
        options.shading = EWA_SHADING_NONE;
        options.eye_dome = 1;
        OWNED(picture_free) picture shown = draw(context, run / 2, cloud, &camera, &options);
        const double step_px = 0.5 * camera.fx_px / (run % 2 ? 1 : 3.6), middle = SIDE_PX / 2.0;
        for (uint32_t y = 0; y < SIDE_PX; y++)
            for (uint32_t x = 0; x < SIDE_PX; x++) {
                const double away = fmax(fabs(x + 0.5 - middle), fabs(y + 0.5 - middle)) - step_px;
                const float *rgba = &shown.frame.rgba[4 * ((size_t)y * SIDE_PX + x)];
                if (rgba[3] < 1) continue;
                if (away < -3 || away > 8) assert_true(fabsf(rgba[0] - 0.6f) < 2e-3f);
                if (away > 2 && away < 3) assert_true(rgba[0] < 0.2f);
            }
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
