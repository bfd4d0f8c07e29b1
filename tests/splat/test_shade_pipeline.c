// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Shading by the fast pipeline against the reference, and against itself: threads, instruction sets, order of
// the points, memory; materials that differ from surfel to surfel.
#include "cloud/cloud.h"
#include "reference/surface.h"
#include "tests/splat/shade_scene.h"

#include <math.h>
#include <string.h>

enum { SIDE_PX = 112, POINTS = 1500, MATERIALS = 3 };

static const ewa_material TABLE[MATERIALS] = {
    {.ambient = 0.2f, .diffuse = 0.7f, .specular = 0.4f, .shininess = 12, .reflection = 0},
    {.ambient = 0, .diffuse = 0.2f, .specular = 0.1f, .shininess = 3, .reflection = 0.8f},
    {.ambient = 0.05f, .diffuse = 1, .specular = 0, .shininess = 1, .reflection = 0.1f},
};

/// Slabs of the three materials.
static int slab(const float position[3]) {
    const double at = 3 * ((double)position[0] + 0.3 * (double)position[2]);
    return ((int)floor(at) % MATERIALS + MATERIALS) % MATERIALS;
}

static int all_one(const float position[3]) {
    (void)position;
    return 1;
}

/// Everything at once.
static ewa_render_options all_options(const ewa_environment *environment) {
    WITH_DEFAULTS(ewa_render_options, options);
    options.shading = EWA_SHADING_PHONG;
    options.materials = TABLE;
    options.material_count = MATERIALS;
    options.environment = environment;
    options.environment_up[2] = 0.5;
    options.light_count = 3;
    for (uint32_t i = 0; i < 3; i++) ewa_light_init(&options.lights[i]);
    // Along no surface of the scenes: a highlight begins where N.L is zero.
    const double directions[2][3] = {{-2, -0.7, 1}, {0.4, 7, 3}};
    for (int i = 0; i < 2; i++)
        memcpy(options.lights[1 + i].direction_world, directions[i], sizeof directions[i]);
    options.lights[1].color[1] = 0.5f, options.lights[2].color[0] = 0.1f;
    options.background[0] = 0.3f, options.background[3] = 0.8f;
    return options;
}

/// Fewer than two in a thousand pixels may be beyond the threshold: surfels on the edge of a cutoff or of the
/// depth bound are in or out by the last digit.
static void hold(const scene *of, const ewa_render_options *options, const char *what) {
    static const double THRESHOLD = 3e-3;
    OWNED(picture_free) picture reference = shade_reference(of->cloud, &of->camera, options);
    OWNED(picture_free) picture fast = shade_draw(ewa_cloud_context(of->cloud), of->cloud, &of->camera, options);
    const picture_report report = picture_compare(&reference, &fast, THRESHOLD, NULL);
    picture_print(what, &report);
    assert_true(report.over_count * 500 < report.pixel_count);
}

static scene make_scene(ewa_context *context, scene_kind kind, bool orthographic) {
    scene made;
    assert_int_equal(scene_make(context, kind, POINTS, SIDE_PX, SIDE_PX, &made), EWA_OK);
    shade_set_material(made.cloud, slab);
    if (orthographic) picture_set_orthographic(&made);
    return made;
}

TEST_ON(test_pipeline_holds_to_the_reference, 0) {
    OWNED(ewa_environment_destroy) ewa_environment *environment = shade_environment(context, 64, shade_linear_light);
    for (int kind = 0; kind < 2 * SCENE_COUNT; kind++) {
        if (kind == 2 * SCENE_NEAR + 1) continue; // touches the eye, which orthographic views do not have
        OWNED(scene_free) scene of = make_scene(context, (scene_kind)(kind / 2), kind % 2);
        char name[64];
        snprintf(name, sizeof name, "%s%s", scene_name((scene_kind)(kind / 2)),
                 kind % 2 ? ", orthographic" : "");
        print_message("%s\n", name);
        ewa_render_options options = all_options(environment);
        hold(&of, &options, "all");
        options.edge_layers = 1;
        hold(&of, &options, "one edge layer");
        options.passes = 1; // of coplanar discs anyone may be the nearest
        if (kind / 2 == SCENE_SPHERE || kind / 2 == SCENE_TORUS) hold(&of, &options, "one pass");
        options = all_options(environment);
        options.opacity = 0.6, options.layers = 3;
        hold(&of, &options, "transparent");
        options.opacity = 1, options.layers = 0, options.edge_layers = 1;
        options.kernel = EWA_KERNEL_RAYCAST;
        hold(&of, &options, "raycast");
        ewa_render_options_init(&options, sizeof options);
        options.shading = EWA_SHADING_PHONG;
        hold(&of, &options, "phong alone");
        options.shading = EWA_SHADING_LAMBERT;
        options.eye_dome = 0.3;
        options.background[1] = 0.5f, options.background[3] = 0.7f;
        options.edge_layers = 1;
        hold(&of, &options, "eye dome");
    }
}

/// Surfels with an alpha and a material each: colours are weighted by the alpha, materials are not.
TEST_ON(test_transparent_materials_hold, 0) {
    const float white[3] = {1, 1, 1};
    const double eye[3] = {1, 0.6, 4};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = shade_sphere(context, 3000, white);
    OWNED(ewa_environment_destroy) ewa_environment *environment = shade_environment(context, 64, shade_linear_light);
    void *data = NULL;
    ewa_cloud_remove(cloud, EWA_COLOR);
    assert_int_equal(ewa_cloud_add(cloud, EWA_COLOR, EWA_F32, 4, &data), EWA_OK);
    float *colors = data;
    check_random random = {5};
    for (uint64_t i = 0; i < 4 * ewa_cloud_point_count(cloud); i++)
        colors[i] = (float)check_uniform(&random, 0.1, 1);
    shade_set_material(cloud, slab);
    for (int run = 0; run < 3; run++) {
        const scene of = {.cloud = cloud, .camera = shade_camera(SIDE_PX, eye, 32, run == 2 ? 2.2 : 0)};
        ewa_render_options options = all_options(environment);
        options.layers = run == 0 ? 1 : 0; // as if opaque
        hold(&of, &options, run == 0 ? "alpha not used" : "alpha");
    }
}

static void assert_same_bytes(const picture *a, const picture *b) {
    const size_t pixels = (size_t)a->width_px * a->height_px;
    assert_memory_equal(a->frame.rgba8, b->frame.rgba8, 4 * pixels);
    assert_memory_equal(a->frame.rgba, b->frame.rgba, 16 * pixels);
    assert_memory_equal(a->frame.depth, b->frame.depth, 4 * pixels);
}

TEST(test_same_bytes_everywhere) {
    static const struct {
        uint32_t threads, mask;
    } runs[] = {{1, EWA_CPU_ALL}, {5, EWA_CPU_ALL}, {2, EWA_CPU_AVX2}, {2, 0}};
    for (int kind = 0; kind < 2 * SCENE_COUNT; kind++) {
        OWNED(picture_free) picture first = {0};
        for (size_t i = 0; i < sizeof runs / sizeof runs[0]; i++) {
            OWNED(ewa_context_destroy) ewa_context *context = check_context_of(runs[i].threads, runs[i].mask);
            OWNED(scene_free) scene of;
            assert_int_equal(scene_make(context, (scene_kind)(kind / 2), POINTS / 3, 83, 77, &of), EWA_OK);
            shade_set_material(of.cloud, slab);
            OWNED(ewa_environment_destroy)
            ewa_environment *environment = shade_environment(context, 32, shade_linear_light);
            ewa_render_options options = all_options(environment);
            if (kind % 2) options.eye_dome = 1;
            picture made = shade_draw(context, of.cloud, &of.camera, &options);
            if (i == 0) {
                first = made;
            } else {
                assert_same_bytes(&first, &made);
                picture_free(&made);
            }
        }
    }
}

/// Two points at the same place that differ in nothing but their material.
TEST_ON(test_order_of_materials_does_not_matter, 0) {
    enum { COUNT = 64 };
    const double eye[3] = {0, 0, 5};
    const ewa_camera camera = shade_camera(64, eye, 30, 0);
    picture shown[2];
    for (int run = 0; run < 2; run++) {
        float position[COUNT][3] = {{0}}, normal[COUNT][3], radius[COUNT];
        uint8_t material[COUNT];
        for (int i = 0; i < COUNT; i++) {
            const int k = run ? COUNT - 1 - i : i;
            material[i] = (uint8_t)(k * k % MATERIALS);
            normal[i][0] = 0, normal[i][1] = 0.3f, normal[i][2] = 1, radius[i] = 1;
        }
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, COUNT);
        assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F32, 3, position, 0), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(cloud, EWA_NORMAL, EWA_F32, 3, normal, 0), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(cloud, EWA_RADIUS, EWA_F32, 1, radius, 0), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(cloud, EWA_MATERIAL, EWA_U8, 1, material, 0), EWA_OK);
        const ewa_render_options options = all_options(NULL);
        shown[run] = shade_draw(context, cloud, &camera, &options);
    }
    assert_same_bytes(&shown[0], &shown[1]);
    picture_free(&shown[0]);
    picture_free(&shown[1]);
}

/// Stripes as narrow as the points' spacing.
static int alternate(const float position[3]) { return (int)(1000 + floor((double)position[0] * 400)) % 2; }

/// Where pixels hold surfels of two materials in equal parts, they look like the material between them.
TEST_ON(test_materials_are_averaged, 0) {
    const float white[3] = {1, 1, 1};
    const double eye[3] = {0, 0, 5};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = shade_sphere(context, 200000, white);
    const ewa_camera camera = shade_camera(40, eye, 26, 0);
    ewa_material table[2], middle;
    for (int i = 0; i < 2; i++) ewa_material_init(&table[i]);
    table[0].ambient = 0.1f, table[1].ambient = 0.5f, table[0].diffuse = 0, table[1].diffuse = 0.4f;
    table[0].specular = 1, table[1].specular = 0;
    ewa_material_init(&middle);
    middle.ambient = 0.3f, middle.diffuse = 0.2f, middle.specular = 0.5f;
    WITH_DEFAULTS(ewa_render_options, options);
    options.shading = EWA_SHADING_PHONG;
    options.materials = &middle, options.material_count = 1;
    OWNED(picture_free) picture wanted = shade_draw(context, cloud, &camera, &options);
    shade_set_material(cloud, alternate);
    options.materials = table, options.material_count = 2;
    OWNED(picture_free) picture shown = shade_draw(context, cloud, &camera, &options);
    double worst = 0, mean = 0;
    for (uint32_t y = 12; y < 28; y++) // towards the edge the stripes are not of equal width
        for (uint32_t x = 12; x < 28; x++) {
            const size_t i = 4 * ((size_t)y * 40 + x);
            const double error = (double)shown.frame.rgba[i] - (double)wanted.frame.rgba[i];
            mean += error / 256;
            worst = fmax(worst, fabs(error));
        }
    print_message("mean error %.2g, largest %.2g\n", mean, worst);
    assert_true(fabs(mean) < 0.01); // the two materials are 0.5 apart, and twice that at the highlight
    assert_true(worst < 0.25);      // some fifty points in a pixel, at random
}

/// One material that all surfels have needs no memory of its own and looks as the table's only one does.
TEST_ON(test_one_material_of_many, 0) {
    OWNED(scene_free) scene of;
    assert_int_equal(scene_make(context, SCENE_TORUS, POINTS, 64, 64, &of), EWA_OK);
    ewa_surfels_info plain, one, several;
    ewa_surfels *surfels = check_surfels(of.cloud, NULL);
    ewa_surfels_describe(surfels, &plain);
    ewa_surfels_destroy(&surfels);
    ewa_render_options options = all_options(NULL);
    options.materials = &TABLE[1], options.material_count = 1;
    OWNED(picture_free) picture wanted = shade_draw(context, of.cloud, &of.camera, &options);
    shade_set_material(of.cloud, all_one);
    assert_int_equal(ewa_surfels_create(of.cloud, NULL, &surfels), EWA_OK);
    ewa_surfels_describe(surfels, &one);
    ewa_surfels_destroy(&surfels);
    options.materials = TABLE, options.material_count = MATERIALS;
    OWNED(picture_free) picture shown = shade_draw(context, of.cloud, &of.camera, &options);
    assert_same_bytes(&wanted, &shown);
    shade_set_material(of.cloud, slab);
    assert_int_equal(ewa_surfels_create(of.cloud, NULL, &surfels), EWA_OK);
    ewa_surfels_describe(surfels, &several);
    ewa_surfels_destroy(&surfels);
    assert_int_equal(plain.material_count, 1);
    assert_int_equal(one.material_count, 2);
    assert_int_equal(several.material_count, MATERIALS);
    assert_int_equal(one.resident_bytes, plain.resident_bytes);
    assert_int_equal(several.resident_bytes, plain.resident_bytes + (plain.point_count + 15) / 16 * 16);
}

static void refuse(ewa_context *context, const check_log *log, const scene *of,
                   const ewa_render_options *options, const char *words) {
    picture made = picture_make(64, 64);
    ewa_surfels *surfels = check_surfels(of->cloud, NULL);
    ewa_renderer *renderer = check_renderer(context);
    assert_int_equal(ewa_render(renderer, surfels, &of->camera, options, &made.frame, NULL),
                     EWA_ERROR_ARGUMENT);
    if (!strstr(log->text, words)) fail_msg("'%s' does not say '%s'", log->text, words);
    assert_int_equal(ewa_render_reference(of->cloud, NULL, 1, &of->camera, options, &made.frame),
                     EWA_ERROR_ARGUMENT);
    ewa_renderer_destroy(&renderer);
    ewa_surfels_destroy(&surfels);
    picture_free(&made);
}

TEST_LOGGED(test_wrong_options_are_refused, 0) {
    OWNED(scene_free) scene of;
    assert_int_equal(scene_make(context, SCENE_TORUS, 300, 64, 64, &of), EWA_OK);
    shade_set_material(of.cloud, slab);
    ewa_render_options options = all_options(NULL);
    options.material_count = 2;
    refuse(context, log, &of, &options, "material 2, the table has 2");
    options = all_options(NULL), options.material_count = 257;
    refuse(context, log, &of, &options, "material_count");
    options = all_options(NULL), options.materials = NULL;
    refuse(context, log, &of, &options, "without materials");
    options = all_options(NULL), options.light_count = 9;
    refuse(context, log, &of, &options, "light_count");
    options = all_options(NULL), options.lights[2].color[1] = -1;
    refuse(context, log, &of, &options, "lights[2].color[1] is -1");
    options = all_options(NULL), options.lights[1].direction_world[0] = INFINITY;
    refuse(context, log, &of, &options, "lights[1].direction_world is inf");
    options = all_options(NULL), options.environment_up[1] = NAN;
    refuse(context, log, &of, &options, "environment_up");
    options = all_options(NULL), memset(options.environment_up, 0, sizeof options.environment_up);
    refuse(context, log, &of, &options, "environment_up");
    options = all_options(NULL), options.eye_dome = 101;
    refuse(context, log, &of, &options, "eye_dome");
    ewa_material table[MATERIALS];
    memcpy(table, TABLE, sizeof table);
    table[1].shininess = 0.5f;
    options = all_options(NULL), options.materials = table;
    refuse(context, log, &of, &options, "shininess of material 1");
}

TEST(test_every_failing_allocation_is_clean) {
    float pixels[8 * 4 * 3] = {1};
    uint8_t rgba8[64 * 64 * 4], material[300];
    for (int i = 0; i < 300; i++) material[i] = (uint8_t)(i % MATERIALS);
    bool done = false;
    for (long n = 0; !done; n++) {
        check_memory memory = {.calls_left = n};
        WITH_DEFAULTS(ewa_context_options, context_options);
        context_options.allocator = check_allocator(&memory);
        context_options.thread_count = 2;
        ewa_context *context = NULL;
        scene of = {0};
        ewa_surfels *surfels = NULL;
        ewa_renderer *renderer = NULL;
        ewa_environment *environment = NULL;
        const ewa_frame frame = {.rgba8 = rgba8};
        ewa_status status = ewa_context_create(&context_options, &context);
        const ewa_image image = {context, 8, 4, 3, pixels};
        if (status == EWA_OK) status = ewa_environment_create(&image, &environment);
        if (status == EWA_OK) status = scene_make(context, SCENE_SPHERE, 300, 64, 64, &of);
        if (status == EWA_OK) {
            assert_true(ewa_cloud_point_count(of.cloud) <= 300);
            status = ewa_cloud_borrow(of.cloud, EWA_MATERIAL, EWA_U8, 1, material, 0);
        }
        if (status == EWA_OK) status = ewa_surfels_create(of.cloud, NULL, &surfels);
        if (status == EWA_OK) status = ewa_renderer_create(context, &renderer);
        ewa_render_options options = all_options(environment);
        options.eye_dome = 1;
        if (status == EWA_OK) status = ewa_render(renderer, surfels, &of.camera, &options, &frame, NULL);
        const long calls = memory.calls_left;
        done = status == EWA_OK;
        if (done) { // a warm renderer allocates nothing
            assert_int_equal(ewa_render(renderer, surfels, &of.camera, &options, &frame, NULL), EWA_OK);
            assert_int_equal(memory.calls_left, calls);
        } else {
            assert_int_equal(status, EWA_ERROR_MEMORY);
        }
        ewa_renderer_destroy(&renderer);
        ewa_surfels_destroy(&surfels);
        ewa_environment_destroy(&environment);
        scene_free(&of);
        ewa_context_destroy(&context);
        assert_int_equal(memory.held_bytes, 0);
        assert_true(n < 1000);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
