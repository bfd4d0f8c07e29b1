// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours of scans that have none: a strength of light, else their height, unless somebody says otherwise.
#include "check.h"

#include <math.h>

enum { SIDE = 40, POINTS = SIDE * SIDE, WIDTH = 64, HEIGHT = 48, PIXELS = WIDTH * HEIGHT };

/// What a made-up scan has beside places, normals and radii.
typedef struct scan {
    const char *signal; ///< name of a number; NULL: none
    double first, step; ///< of that number, from point to point
    bool returns;       ///< has return numbers, as scans from the air
    int colors;         ///< -1: none; else all channels
    bool grid;          ///< says that it is a grid of heights
} scan;

/// A square with a step, shifted along x.
static ewa_cloud *make_scan(ewa_context *context, const scan *of, double shift_world) {
    void *position = NULL, *normal = NULL, *radius = NULL, *data = NULL;
    ewa_cloud *cloud = check_cloud_of(context, POINTS);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, &position), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_NORMAL, EWA_F32, 3, &normal), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, &radius), EWA_OK);
    for (int i = 0; i < POINTS; i++) {
        const double place[3] = {i % SIDE + shift_world, (double)(i / SIDE), i % SIDE < SIDE / 2 ? 0 : 3};
        memcpy((double *)position + 3 * i, place, sizeof place);
        memcpy((float *)normal + 3 * i, (const float[3]){0, 0, 1}, 3 * sizeof(float));
        ((float *)radius)[i] = 1.2F;
    }
    if (of->signal) {
        assert_int_equal(ewa_cloud_add(cloud, of->signal, EWA_F64, 1, &data), EWA_OK);
        for (int i = 0; i < POINTS; i++) ((double *)data)[i] = of->first + of->step * i;
    }
    if (of->returns) {
        assert_int_equal(ewa_cloud_add(cloud, "return_number", EWA_U8, 1, &data), EWA_OK);
        memset(data, 1, POINTS);
    }
    if (of->colors >= 0) {
        assert_int_equal(ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, &data), EWA_OK);
        memset(data, of->colors, 3 * (size_t)POINTS);
    }
    if (of->grid) assert_int_equal(ewa_cloud_set_note(cloud, "file.heights", "40 x 40", 7), EWA_OK);
    return cloud;
}

/// How a scene of one or two scans looks.
typedef struct look {
    uint8_t rgba8[4 * PIXELS];
    char attribute[EWA_SCALAR_NAME_BYTES]; ///< of the first one's legend; empty: none
    double range[2];
    int notes;
} look;

static void count_notes(void *user, ewa_severity severity, const char *message) {
    int *notes = user;
    *notes += severity == EWA_SEVERITY_NOTE && strstr(message, "no colours") != NULL;
}

/// Draws scans from above, coloured as `coloring` (NULL: the default) says.
static void draw(const scan *scans, int count, const ewa_coloring *coloring, look *to) {
    *to = (look){.notes = 0};
    WITH_DEFAULTS(ewa_context_options, options);
    options.message = count_notes;
    options.message_user = &to->notes;
    options.message_level = EWA_SEVERITY_NOTE;
    OWNED(ewa_context_destroy) ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    ewa_scene *scene = NULL;
    ewa_scene_renderer *renderer = NULL;
    assert_int_equal(ewa_scene_create(context, NULL, &scene), EWA_OK);
    ewa_cloud *clouds[2] = {NULL};
    for (int k = 0; k < count; k++) {
        clouds[k] = make_scan(context, &scans[k], k * (SIDE + 10.0));
        OWNED(ewa_asset_release) ewa_asset *asset = NULL;
        WITH_DEFAULTS(ewa_instance, instance);
        if (coloring) instance.coloring = *coloring;
        assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.cloud = clouds[k]}, NULL, &asset), EWA_OK);
        assert_int_equal(ewa_scene_add(scene, asset, &instance), EWA_OK);
    }
    ewa_camera camera = {.projection = EWA_ORTHOGRAPHIC, .width_px = WIDTH, .height_px = HEIGHT};
    const double pixels_per_unit = WIDTH / (count * (SIDE + 10.0)), down[16] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 50, 0, 0, 0, 1};
    memcpy(camera.world_to_camera, down, sizeof down);
    camera.fx_px = camera.fy_px = pixels_per_unit;
    camera.cy_px = HEIGHT;
    assert_int_equal(ewa_scene_renderer_create(context, EWA_BACKEND_CPU, NULL, &renderer), EWA_OK);
    assert_int_equal(ewa_scene_draw(scene, renderer, &camera, NULL, &(ewa_frame){.rgba8 = to->rgba8}, NULL), EWA_OK);
    const ewa_legend *legend = ewa_scene_legend(scene, 0);
    if (legend) {
        memcpy(to->attribute, legend->attribute, sizeof to->attribute);
        memcpy(to->range, legend->range, sizeof to->range);
    }
    ewa_scene_renderer_destroy(&renderer);
    ewa_scene_destroy(&scene);
    for (int k = 0; k < count; k++) ewa_cloud_destroy(&clouds[k]);
}

static ewa_coloring by(const char *word) {
    WITH_DEFAULTS(ewa_coloring, coloring);
    snprintf(coloring.attribute, sizeof coloring.attribute, "%s", word);
    return coloring;
}

static bool same(const look *a, const look *b) { return memcmp(a->rgba8, b->rgba8, sizeof a->rgba8) == 0; }

static look automatic, asked;

TEST(test_signal) {
    (void)state;
    static const char *const names[] = {"intensity", "scalar_Intensity", "Reflectance", "amplitude"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        const scan scanned = {names[i], 5, 1, i % 2, -1, false};
        const ewa_coloring coloring = by(names[i]), word = by("auto");
        draw(&scanned, 1, &coloring, &asked);
        assert_int_equal(asked.notes, 0);
        draw(&scanned, 1, NULL, &automatic);
        assert_true(same(&asked, &automatic));
        assert_int_equal(automatic.notes, 1);
        assert_true(automatic.range[0] == 5 + 32 && automatic.range[1] == 5 + 1567); // of 1600, 2 and 98 per cent
        draw(&scanned, 1, &word, &asked);
        assert_true(same(&asked, &automatic));
    }
    assert_string_equal(automatic.attribute, "amplitude");
}

/// Numbers that are the same everywhere show nothing; then surveys show their height, and bodies stay grey.
TEST(test_height) {
    (void)state;
    const scan survey = {"intensity", 7, 0, true, -1, false},
               body = {"intensity", 7, 0, false, -1, false},
               bare = {NULL, 0, 0, false, -1, false},
               grid = {.colors = -1, .grid = true};
    ewa_coloring height = by("z");
    height.ranged = height.percent[0] = height.percent[1] = true;
    height.range[0] = 2, height.range[1] = 98;
    draw(&survey, 1, &height, &asked);
    draw(&survey, 1, NULL, &automatic);
    assert_true(same(&asked, &automatic));
    draw(&grid, 1, NULL, &automatic);
    assert_true(same(&asked, &automatic));
    assert_string_equal(automatic.attribute, "z");
    draw(&bare, 1, NULL, &asked);
    draw(&body, 1, NULL, &automatic);
    assert_true(same(&asked, &automatic));
    assert_int_equal(automatic.notes, 0);
    assert_string_equal(automatic.attribute, "");
    const ewa_coloring none = by("none");
    draw(&survey, 1, &none, &automatic);
    assert_true(same(&asked, &automatic));
}

/// Colours are kept, but for those that are black everywhere, which writers leave where they know none.
TEST(test_own) {
    (void)state;
    const scan colored = {"intensity", 0, 1, true, 90, false}, plain = {NULL, 0, 0, false, 90, false};
    draw(&plain, 1, NULL, &asked);
    draw(&colored, 1, NULL, &automatic);
    assert_true(same(&asked, &automatic));
    const scan black = {"intensity", 0, 1, true, 0, false}, bare = {"intensity", 0, 1, true, -1, false};
    draw(&bare, 1, NULL, &asked);
    draw(&black, 1, NULL, &automatic);
    assert_true(same(&asked, &automatic));
    ewa_coloring tint = by("");
    tint.tinted = true;
    tint.tint[1] = 1;
    draw(&bare, 1, &tint, &automatic);
    assert_string_equal(automatic.attribute, "");
    // What a caller says of the colours holds for what is chosen.
    ewa_coloring map = by("intensity"), chosen = by("");
    map.map = chosen.map = EWA_COLORING_TURBO;
    map.ranged = chosen.ranged = true;
    map.range[1] = chosen.range[1] = 800;
    draw(&bare, 1, &map, &asked);
    draw(&bare, 1, &chosen, &automatic);
    assert_true(same(&asked, &automatic));
}

/// Scans are coloured together: on one scale, and by a number that tells them apart although it is one in each.
TEST(test_together) {
    (void)state;
    const scan tiles[2] = {{"intensity", 1, 0, true, -1, false}, {"intensity", 3, 0, true, -1, false}};
    const ewa_coloring coloring = by("intensity");
    draw(tiles, 2, &coloring, &asked);
    draw(tiles, 2, NULL, &automatic);
    assert_true(same(&asked, &automatic));
    assert_true(automatic.range[0] == 1 && automatic.range[1] == 3);
    assert_int_equal(automatic.notes, 1);
    // A coloured one beside a bare one: each as if alone.
    const scan mixed[2] = {{"intensity", 1, 1, true, 200, false}, {"intensity", 5, 2, true, -1, false}};
    draw(mixed, 2, NULL, &automatic);
    assert_string_equal(automatic.attribute, "");
    assert_int_equal(automatic.notes, 1);
}

/// Colours a cloud of four points by a number of its own.
static void color_numbers(ewa_context *context, const char *name, const double given[4], ewa_coloring *coloring, ewa_legend *legend) {
    void *data;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, 4);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, &data), EWA_OK);
    memset(data, 0, 4 * 3 * sizeof(double));
    assert_int_equal(ewa_cloud_add(cloud, name, EWA_F64, 1, &data), EWA_OK);
    memcpy(data, given, 4 * sizeof(double));
    snprintf(coloring->attribute, sizeof coloring->attribute, "%s", name);
    assert_int_equal(ewa_clouds_color(&cloud, 1, coloring, legend), EWA_OK);
}

/// Numbers that are whole and few have rows in the legend, in the colours that the points have; others have a bar.
TEST(whole_numbers_have_rows) {
    OWNED(ewa_context_destroy) ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(NULL, &context), EWA_OK);
    WITH_DEFAULTS(ewa_coloring, coloring);
    OWNED(ewa_legend_free) ewa_legend legend;
    color_numbers(context, "return_number", (double[]){5, 1, -2, 1}, &coloring, &legend);
    assert_false(legend.classes);
    assert_int_equal(legend.category_count, 3);
    for (int k = 0; k < 3; k++) {
        static const double expected[] = {-2, 1, 5};
        uint8_t srgb[3];
        ewa_colormap_color(EWA_COLORMAP_VIRIDIS, (expected[k] + 2) / 7, srgb);
        assert_true(legend.categories[k].value == expected[k] && !legend.categories[k].name);
        assert_memory_equal(legend.categories[k].srgb, srgb, 3);
    }
    ewa_legend_free(&legend);
    coloring.map = EWA_COLORING_TURBO; // classes keep their names in other colours
    color_numbers(context, "Classification", (double[]){2, 6, 6, 2}, &coloring, &legend);
    assert_false(legend.classes);
    assert_int_equal(legend.category_count, 2);
    assert_string_equal(legend.categories[1].name, "building");
    ewa_legend_free(&legend);
    coloring.map = EWA_COLORING_AUTO;
    color_numbers(context, "Classification", (double[]){2, 6, 6, 2}, &coloring, &legend);
    assert_true(legend.classes && legend.category_count == 2);
    ewa_legend_free(&legend);
    // A number between, a strength of light, a range: a bar.
    color_numbers(context, "return_number", (double[]){1, 2, 2.5, 3}, &coloring, &legend);
    assert_true(!legend.category_count && !legend.categories);
    ewa_legend_free(&legend);
    color_numbers(context, "intensity", (double[]){1, 2, 3, 4}, &coloring, &legend);
    assert_int_equal(legend.category_count, 0);
    ewa_legend_free(&legend);
    coloring.ranged = true, coloring.range[1] = 9;
    color_numbers(context, "return_number", (double[]){1, 2, 3, 4}, &coloring, &legend);
    assert_int_equal(legend.category_count, 0);
}

/// A blended picture of some Gaussians, coloured; `range`, of a legend, NULL: there is to be none.
static void draw_gaussians(const ewa_gaussians *set, const ewa_coloring *coloring, uint8_t rgba8[4 * 64 * 64], double range[2]) {
    OWNED(ewa_asset_release) ewa_asset *asset = NULL;
    OWNED(ewa_scene_destroy) ewa_scene *scene = NULL;
    OWNED(ewa_scene_renderer_destroy) ewa_scene_renderer *renderer = NULL;
    ewa_camera camera;
    WITH_DEFAULTS(ewa_instance, instance);
    if (coloring) instance.coloring = *coloring;
    const ewa_asset_source source = {.gaussians = set};
    assert_int_equal(ewa_asset_create(set->context, &source, NULL, &asset), EWA_OK);
    assert_int_equal(ewa_scene_create(set->context, NULL, &scene), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, &instance), EWA_OK);
    WITH_DEFAULTS(ewa_view_options, view);
    view.width_px = view.height_px = 64;
    assert_int_equal(ewa_scene_place_camera(scene, &view, &camera, NULL), EWA_OK);
    assert_int_equal(ewa_scene_renderer_create(set->context, EWA_BACKEND_CPU, NULL, &renderer), EWA_OK);
    assert_int_equal(ewa_scene_draw(scene, renderer, &camera, NULL, &(ewa_frame){.rgba8 = rgba8}, NULL), EWA_OK);
    const ewa_legend *legend = ewa_scene_legend(scene, 0);
    assert_true((legend != NULL) == (range != NULL));
    if (range) memcpy(range, legend->range, sizeof legend->range);
}

/// Coloured by a number, Gaussians are as those of these colours without harmonics, and as opaque as they were.
TEST_ON(gaussians_by_numbers, 2) {
    enum { COUNT = 40 };
    static uint8_t colored[4 * 64 * 64], plain[4 * 64 * 64];
    check_random random = {5};
    OWNED(ewa_gaussians_free) ewa_gaussians set;
    assert_int_equal(ewa_gaussians_create(context, COUNT, 1, &set), EWA_OK);
    for (size_t i = 0; i < COUNT; i++) {
        for (size_t k = 0; k < 3; k++) {
            set.centers[3 * i + k] = (float)check_uniform(&random, -1, 1);
            set.scales[3 * i + k] = (float)check_uniform(&random, 0.05, 0.3);
        }
        for (size_t k = 0; k < 12; k++) set.harmonics[12 * i + k] = (float)check_uniform(&random, -1, 1);
        set.rotations[4 * i] = 1;
        set.opacities[i] = (float)check_uniform(&random, 0.2, 0.9);
    }
    set.opacities[0] = 0.125f, set.opacities[1] = 0.9375f;
    assert_int_equal(ewa_gaussians_add_classes(&set), EWA_OK);
    for (int i = 0; i < COUNT; i++) set.classes[i] = (uint16_t)(i % 3 ? 6 : 900);
    static const char *const words[] = {"opacity", "size", "z", NULL, "classification"};
    for (int n = 0; n < 5; n++) {
        WITH_DEFAULTS(ewa_coloring, coloring);
        double low = INFINITY, high = -INFINITY, numbers[COUNT];
        for (size_t i = 0; i < COUNT; i++) {
            const float *s = set.scales + 3 * i;
            numbers[i] = n == 0 ? (double)set.opacities[i] : n == 1 ? (double)fmaxf(s[0], fmaxf(s[1], s[2])) : (double)set.centers[3 * i + 2];
            low = fmin(low, numbers[i]), high = fmax(high, numbers[i]);
        }
        OWNED(ewa_gaussians_free) ewa_gaussians same_colors;
        assert_int_equal(ewa_gaussians_create(context, COUNT, 0, &same_colors), EWA_OK);
        memcpy(same_colors.centers, set.centers, 3 * COUNT * sizeof(float));
        memcpy(same_colors.scales, set.scales, 3 * COUNT * sizeof(float));
        memcpy(same_colors.rotations, set.rotations, 4 * COUNT * sizeof(float));
        memcpy(same_colors.opacities, set.opacities, COUNT * sizeof(float));
        for (size_t i = 0; i < COUNT; i++) {
            uint8_t srgb[3] = {51, 102, 255};
            if (n < 3) ewa_colormap_color(EWA_COLORMAP_VIRIDIS, (numbers[i] - low) / (high - low), srgb);
            for (size_t k = 0; k < 3; k++) same_colors.harmonics[3 * i + k] = (float)(((double)srgb[k] / 255 - 0.5) / 0.28209479177387814);
        }
        for (size_t i = 0; i < COUNT && n == 4; i++) {
            uint8_t srgb[3];
            ewa_class_color(set.classes[i], srgb);
            for (size_t k = 0; k < 3; k++) same_colors.harmonics[3 * i + k] = (float)(((double)srgb[k] / 255 - 0.5) / 0.28209479177387814);
        }
        double range[2];
        if (n != 3) strcpy(coloring.attribute, words[n]);
        if (n == 3) coloring.tinted = true, coloring.tint[0] = 0.2, coloring.tint[1] = 0.4, coloring.tint[2] = 1;
        draw_gaussians(&set, &coloring, colored, n != 3 ? range : NULL);
        draw_gaussians(&same_colors, NULL, plain, NULL);
        size_t apart = 0, seen = 0;
        for (size_t i = 0; i < sizeof plain; i++) {
            const int by = abs(colored[i] - plain[i]);
            assert_true(by <= 1);
            apart += by > 0, seen += plain[i] != 255;
        }
        print_message("gaussians by %s: %zu of %zu bytes apart by 1\n", n != 3 ? words[n] : "tint", apart, seen);
        assert_true(seen > 2000 && apart < seen / 50);
        if (n < 3) assert_true(fabs(range[0] - low) < 1e-6 && fabs(range[1] - high) < 1e-6);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
