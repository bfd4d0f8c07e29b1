// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Profiles of planes and ramps, whose stations, offsets and heights are closed forms; graphs of ramps, whose slope on the
// picture is.
#include "check.h"
#include "ewa/profile.h"

#include <math.h>

enum { SIDE = 41, POINTS = SIDE * SIDE, WIDTH = 640, HEIGHT = 400 };

/// Quarters of a unit: all sums are exact.
static const double STEP = 0.25;

static ewa_context *context;

static int enter(void **state) {
    (void)state;
    context = check_context(0, NULL);
    return 0;
}

static int leave(void **state) {
    (void)state;
    ewa_context_destroy(&context);
    return 0;
}

/// A ramp over [0, 10] x [-5, 5], of height x / 2 + 3, moved by `at_world`; its points have numbers.
static ewa_cloud *make_ramp(const double at_world[3]) {
    void *places, *numbers;
    ewa_cloud *cloud = check_cloud_of(context, POINTS);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, &places), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, "number", EWA_U32, 1, &numbers), EWA_OK);
    for (int i = 0; i < POINTS; i++) {
        const double x = STEP * (i % SIDE), y = STEP * (i / SIDE) - 5;
        const float place[3] = {(float)x, (float)y, (float)(0.5 * x + 3)};
        memcpy((float *)places + 3 * i, place, sizeof place);
        ((uint32_t *)numbers)[i] = (uint32_t)i;
    }
    ewa_cloud_set_origin(cloud, at_world);
    return cloud;
}

/// Adds a cloud to a scene, which needs it no longer.
static void add(ewa_scene *scene, ewa_cloud **cloud, const ewa_asset_options *options, const ewa_instance *instance) {
    OWNED(ewa_asset_release) ewa_asset *asset = NULL;
    assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.cloud = *cloud}, options, &asset), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, instance), EWA_OK);
}

static ewa_scene *make_scene(void) {
    ewa_scene *scene = NULL;
    WITH_DEFAULTS(ewa_scene_options, options);
    options.up = EWA_UP_Z;
    assert_int_equal(ewa_scene_create(context, &options, &scene), EWA_OK);
    return scene;
}

static ewa_profile take(ewa_scene *scene, const double *line, uint32_t corner_count, double width_world) {
    ewa_profile profile;
    WITH_DEFAULTS(ewa_profile_options, options);
    options.width_world = width_world;
    assert_int_equal(ewa_scene_profile(scene, line, corner_count, &options, &profile), EWA_OK);
    return profile;
}

static const double *numbers_of(const ewa_profile *profile, const char *name) {
    const ewa_attribute *found = ewa_cloud_find(profile->points, name);
    assert_non_null(found);
    assert_int_equal(found->type, EWA_F64);
    return found->data;
}

/// Along x the station is x, the offset -y, the height that of the ramp: 41 stations of 5 points, however far off.
TEST(test_ramp) {
    (void)state;
    static const double places[][3] = {{0, 0, 0}, {500000.25, -4200000.5, 100}};
    for (int k = 0; k < 2; k++) {
        const double *at = places[k], line[2][3] = {{at[0], at[1], 0}, {at[0] + 10, at[1], 0}};
        OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene();
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_ramp(at);
        add(scene, &cloud, NULL, NULL);
        OWNED(ewa_profile_free) ewa_profile profile = take(scene, line[0], 2, 1);
        assert_int_equal(ewa_cloud_point_count(profile.points), SIDE * 5);
        assert_true(profile.length_world == 10);
        const double *stations = numbers_of(&profile, "station"), *offsets = numbers_of(&profile, "offset"),
                     *heights = numbers_of(&profile, "profile_height");
        for (uint64_t i = 0; i < SIDE * 5; i++) {
            assert_true(stations[i] == STEP * (double)(i / 5));
            assert_true(offsets[i] == STEP * ((double)(i % 5) - 2));
            assert_true(heights[i] == at[2] + 3 + 0.5 * stations[i]);
            // All that the file says came along.
            double number;
            ewa_attribute_read_f64(ewa_cloud_find(profile.points, "number"), i, 1, &number);
            assert_true(number == stations[i] / STEP + SIDE * (5 - offsets[i]) / STEP);
        }
    }
}

/// Towards (3, 4) a place's station and offset are its products with (3, 4) / 5 and (4, -3) / 5.
TEST(test_oblique) {
    (void)state;
    static const double line[2][3] = {{0, 0, 7}, {6, 8, -7}};
    OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene();
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_ramp((double[3]){0});
    add(scene, &cloud, NULL, NULL);
    OWNED(ewa_profile_free) ewa_profile profile = take(scene, line[0], 2, 2);
    assert_true(profile.length_world == 10);
    uint64_t wanted = 0;
    for (int i = 0; i < POINTS; i++) {
        const double x = STEP * (i % SIDE), y = STEP * (i / SIDE) - 5;
        const double along = 3 * x + 4 * y, right = 4 * x - 3 * y; // fivefold
        wanted += along >= 0 && along <= 50 && fabs(right) <= 5;
    }
    const uint64_t count = ewa_cloud_point_count(profile.points);
    // Those exactly on an edge may fall to either side by rounding.
    assert_true(count <= wanted && count + 40 > wanted);
    const double *stations = numbers_of(&profile, "station"), *offsets = numbers_of(&profile, "offset");
    for (uint64_t i = 0; i < count; i++) {
        double p[3];
        ewa_attribute_read_f64(ewa_cloud_find(profile.points, EWA_POSITION), i, 1, p);
        assert_true(fabs(stations[i] - (3 * p[0] + 4 * p[1]) / 5) < 1e-12);
        assert_true(fabs(offsets[i] - (4 * p[0] - 3 * p[1]) / 5) < 1e-12);
        assert_true(i == 0 || stations[i - 1] <= stations[i]);
    }
}

/// Around a right bend stations go on: (5, 0) is at 5, (5, 3) at 8.
TEST(test_bend) {
    (void)state;
    static const double line[3][3] = {{0, 0, 0}, {5, 0, 0}, {5, 4, 0}};
    OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene();
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_ramp((double[3]){0});
    add(scene, &cloud, NULL, NULL);
    OWNED(ewa_profile_free) ewa_profile profile = take(scene, line[0], 3, 0.25);
    assert_true(profile.length_world == 9);
    // On the line alone: 21 points of the first piece and 16 more of the second.
    assert_int_equal(ewa_cloud_point_count(profile.points), 37);
    const double *stations = numbers_of(&profile, "station"), *heights = numbers_of(&profile, "profile_height");
    for (uint64_t i = 0; i < 37; i++) {
        assert_true(stations[i] == STEP * (double)i);
        assert_true(heights[i] == 3 + 0.5 * fmin(stations[i], 5));
    }
}

/// What is hidden, and what sections cut away, is in no profile; two scans are, in either order.
TEST(test_what_is_shown) {
    (void)state;
    static const double line[2][3] = {{0, 0, 0}, {20, 0, 0}};
    double sums[2] = {0};
    for (int order = 0; order < 2; order++) {
        ewa_scene *scene = make_scene();
        ewa_cloud *clouds[2] = {make_ramp((double[3]){0}), make_ramp((double[3]){10.125, 0, 0})};
        add(scene, &clouds[order], NULL, NULL);
        add(scene, &clouds[1 - order], NULL, NULL);
        ewa_profile profile = take(scene, line[0], 2, 0.25);
        assert_int_equal(ewa_cloud_point_count(profile.points), 2 * SIDE - 1); // the last one is at 20.125
        const double *stations = numbers_of(&profile, "station");
        for (uint64_t i = 0; i < 2 * SIDE - 1; i++) sums[order] += stations[i] * (double)(i + 1);
        ewa_profile_free(&profile);
        ewa_scene_options options;
        ewa_scene_get_options(scene, &options);
        options.render.section_count = 1;
        memcpy(options.render.section_planes[0], (double[4]){-1, 0, 0, 4}, 4 * sizeof(double)); // x <= 4
        assert_int_equal(ewa_scene_set_options(scene, &options), EWA_OK);
        profile = take(scene, line[0], 2, 0.25);
        assert_int_equal(ewa_cloud_point_count(profile.points), 17);
        ewa_profile_free(&profile);
        WITH_DEFAULTS(ewa_instance, hidden);
        hidden.visible = false;
        assert_int_equal(ewa_scene_set(scene, (uint32_t)order, &hidden), EWA_OK); // the first ramp
        profile = take(scene, line[0], 2, 0.25);
        assert_int_equal(ewa_cloud_point_count(profile.points), 0);
        ewa_profile_free(&profile);
        ewa_scene_destroy(&scene);
        for (int k = 0; k < 2; k++) ewa_cloud_destroy(&clouds[k]);
    }
    assert_true(sums[0] == sums[1]);
}

/// With y up and the world turned as glTF has it, the same line gives the same numbers.
TEST(test_y_up) {
    (void)state;
    static const double line[2][3] = {{0, 0, 0}, {10, 0, 0}};
    OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene();
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_ramp((double[3]){0});
    WITH_DEFAULTS(ewa_asset_options, options);
    const double turn[16] = {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1};
    memcpy(options.to_world, turn, sizeof turn);
    add(scene, &cloud, &options, NULL);
    OWNED(ewa_profile_free) ewa_profile profile;
    WITH_DEFAULTS(ewa_profile_options, own);
    own.up_world[1] = 2; // any length
    assert_int_equal(ewa_scene_profile(scene, line[0], 2, &own, &profile), EWA_OK);
    assert_true(profile.up_world[1] == 1);
    assert_int_equal(ewa_cloud_point_count(profile.points), SIDE * 5);
    const double *stations = numbers_of(&profile, "station"), *heights = numbers_of(&profile, "profile_height"),
                 *offsets = numbers_of(&profile, "offset");
    for (uint64_t i = 0; i < SIDE * 5; i++) {
        assert_true(heights[i] == 3 + 0.5 * stations[i]);
        assert_true(offsets[i] == STEP * ((double)(i % 5) - 2)); // right is +z, where -y was
    }
}

/// Decimals of a file stay decimals: the grid's step is a hundredth.
TEST(test_decimals) {
    (void)state;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_ramp((double[3]){849200, 0, 400});
    const ewa_coordinate_grid grid = {{0.01, 0.01, 0.01}, {0}};
    float *places = ewa_cloud_find(cloud, EWA_POSITION)->data;
    for (int i = 0; i < POINTS; i++) places[3 * i] += 0.01F, places[3 * i + 2] += 0.07F;
    ewa_cloud_set_grid(cloud, &grid);
    OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene();
    add(scene, &cloud, NULL, NULL);
    const double line[2][3] = {{849200, 0, 0}, {849209.99, 0, 0}};
    OWNED(ewa_profile_free) ewa_profile profile = take(scene, line[0], 2, 0.25);
    const double *stations = numbers_of(&profile, "station"), *heights = numbers_of(&profile, "profile_height");
    assert_true(ewa_cloud_point_count(profile.points) == SIDE - 1);
    assert_true(stations[1] == 0.26 && stations[2] == 0.51 && heights[2] == 403.32);
}

/// Colours are those of the scene: by height from the lowest to the highest point of all; one colour; none.
TEST(test_colors) {
    (void)state;
    static const double line[2][3] = {{0, 0, 0}, {10, 0, 0}};
    uint8_t ends[2][3];
    ewa_colormap_color(EWA_COLORMAP_TURBO, 0, ends[0]);
    ewa_colormap_color(EWA_COLORMAP_TURBO, 1, ends[1]);
    for (int committed = 0; committed < 2; committed++) {
        OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene();
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_ramp((double[3]){0});
        WITH_DEFAULTS(ewa_instance, instance);
        strcpy(instance.coloring.attribute, "z");
        instance.coloring.map = EWA_COLORING_TURBO;
        add(scene, &cloud, NULL, &instance);
        if (committed) assert_int_equal(ewa_scene_commit(scene), EWA_OK);
        OWNED(ewa_profile_free) ewa_profile profile = take(scene, line[0], 2, 0.25);
        assert_memory_equal(profile.srgb, ends[0], 3);
        assert_memory_equal(profile.srgb + 3 * (SIDE - 1), ends[1], 3);
        ewa_profile_free(&profile);
        instance.coloring.attribute[0] = 0;
        instance.coloring.tinted = true;
        instance.coloring.tint[0] = 1;
        assert_int_equal(ewa_scene_set(scene, 0, &instance), EWA_OK);
        profile = take(scene, line[0], 2, 0.25);
        assert_memory_equal(profile.srgb + 3 * 7, ((uint8_t[3]){255, 0, 0}), 3);
        ewa_profile_free(&profile);
        instance.coloring.tinted = false;
        assert_int_equal(ewa_scene_set(scene, 0, &instance), EWA_OK);
        profile = take(scene, line[0], 2, 0.25);
        assert_memory_equal(profile.srgb + 3 * 7, ((uint8_t[3]){96, 96, 96}), 3);
    }
}

/// Middle of what is red, and its count of pixels.
static double red_middle(const uint8_t *rgba8, int low_x, int high_x, double middle[2]) {
    double count = 0;
    middle[0] = middle[1] = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = low_x; x < high_x; x++) {
            const uint8_t *pixel = rgba8 + 4 * (y * WIDTH + x);
            if (pixel[0] < 150 || pixel[1] > 100) continue;
            middle[0] += x, middle[1] += y, count++;
        }
    middle[0] /= count, middle[1] /= count;
    return count;
}

/// A ramp of slope 1/2 rises by half its length on the picture, times the exaggeration.
TEST(test_graph) {
    (void)state;
    static const double line[2][3] = {{-0.125, 0, 0}, {10.125, 0, 0}};
    OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene();
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_ramp((double[3]){0});
    WITH_DEFAULTS(ewa_instance, instance);
    instance.coloring.tinted = true;
    instance.coloring.tint[0] = 1;
    add(scene, &cloud, NULL, &instance);
    OWNED(ewa_profile_free) ewa_profile profile = take(scene, line[0], 2, 0.25);
    OWNED(check_free) uint8_t *rgba8 = malloc(4 * WIDTH * HEIGHT), *again = malloc(4 * WIDTH * HEIGHT);
    const ewa_canvas canvas = {rgba8, WIDTH, HEIGHT}, other = {again, WIDTH, HEIGHT};
    static const double times[] = {0.25, 1, 1.5, 4};
    for (int k = 0; k < 4; k++) {
        WITH_DEFAULTS(ewa_profile_graph_options, options);
        options.exaggeration = times[k];
        options.point_size_px = 4;
        assert_int_equal(ewa_profile_draw(&profile, &options, &canvas), EWA_OK);
        int left = WIDTH, right = 0;
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            if (rgba8[4 * i] > 150 && rgba8[4 * i + 1] < 100) {
                left = i % WIDTH < left ? i % WIDTH : left;
                right = i % WIDTH > right ? i % WIDTH : right;
            }
        double first[2] = {0}, last[2] = {0};
        assert_true(red_middle(rgba8, left, left + 3, first) > 1 && red_middle(rgba8, right - 2, right + 1, last) > 1);
        const double run = last[0] - first[0], rise = first[1] - last[1];
        assert_true(fabs(rise / run - 0.5 * times[k]) < 0.02 * (1 + times[k]));
        assert_true(run > 100 && last[0] < WIDTH && first[0] > 0);
        // The same bytes again, and all of it opaque.
        assert_int_equal(ewa_profile_draw(&profile, &options, &other), EWA_OK);
        assert_memory_equal(rgba8, again, 4 * WIDTH * HEIGHT);
        for (int i = 0; i < WIDTH * HEIGHT; i++) assert_int_equal(rgba8[4 * i + 3], 255);
    }
    // Tiny canvases and profiles of nothing are fine.
    assert_int_equal(ewa_profile_draw(&profile, NULL, &(ewa_canvas){rgba8, 1, 1}), EWA_OK);
    assert_int_equal(ewa_profile_draw(&profile, NULL, &(ewa_canvas){rgba8, 0, 1}), EWA_ERROR_ARGUMENT);
    ewa_profile_free(&profile);
    profile = take(scene, (double[6]){100, 0, 0, 101, 0, 0}, 2, 1);
    assert_int_equal(ewa_cloud_point_count(profile.points), 0);
    assert_int_equal(ewa_profile_draw(&profile, NULL, &canvas), EWA_OK);
}

TEST(test_refused) {
    (void)state;
    double corners[3 * EWA_PROFILE_CORNERS];
    uint32_t count;
    char problem[EWA_OPTION_TEXT_BYTES];
    assert_int_equal(ewa_profile_line_read("0,1; 2.5,-3 ;4,5,6", corners, &count, problem), EWA_OK);
    assert_int_equal(count, 3);
    assert_true(corners[3] == 2.5 && corners[4] == -3 && corners[5] == 0 && corners[8] == 6);
    static const char *const wrong[] = {"", "1,2", "1,2;", "1;2", "1,2;3,x", "1,2,3,4;5,6", "1,2;;3,4", "nan,1;2,3", "inf,1;2,3"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        assert_int_equal(ewa_profile_line_read(wrong[i], corners, &count, problem), EWA_ERROR_ARGUMENT);
    OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene();
    OWNED(ewa_profile_free) ewa_profile profile;
    const double same[2][3] = {{1, 1, 0}, {1, 1, 5}}, wild[2][3] = {{0, 0, 0}, {INFINITY, 0, 0}};
    assert_int_equal(ewa_scene_profile(scene, same[0], 2, NULL, &profile), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_scene_profile(scene, wild[0], 2, NULL, &profile), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_scene_profile(scene, wild[0], 1, NULL, &profile), EWA_ERROR_ARGUMENT);
    assert_null(profile.context);
}

int main(void) { return RUN_TESTS(enter, leave); }
