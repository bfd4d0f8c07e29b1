// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scripts through the viewer without a window: the pictures and words that each expects, on every instruction set.
#include "check.h"
#include "tests/prepare/check_generated.h"
#include "cli/base/commands.h"
#include "cli/view/window_services.h"
#include "viewer/front.h"

#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

#ifndef FRONT_RUN
#define FRONT_RUN front_script_run
#endif

enum { WIDTH = 320, HEIGHT = 240, MAX_SCRIPTS = 128 };

static char scripts_folder[1024];

static void save(const ewa_cloud *cloud, const char *path) {
    assert_int_equal(ewa_cloud_save(cloud, path, NULL), EWA_OK);
}

/// A part of the landscape with what surveys have: intensities and classes.
static ewa_cloud *make_survey(ewa_context *context) {
    ewa_cloud *cloud = check_object(context, EWA_OBJECT_TERRAIN, 20000);
    void *intensities, *classes;
    assert_int_equal(ewa_cloud_add(cloud, "intensity", EWA_F32, 1, &intensities), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, "classification", EWA_U8, 1, &classes), EWA_OK);
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        double p[3];
        ewa_attribute_read_f64(position, i, 1, p);
        ((float *)intensities)[i] = (float)(p[0] * p[0] + p[1] * p[1]);
        ((uint8_t *)classes)[i] = p[2] <= 0 ? 9 : p[2] > 0.2 ? 6 : p[0] > 0 ? 5 : 2;
    }
    return cloud;
}

static void write_text(const char *path, const char *text) {
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

/// The files that scripts name, in a folder of the build.
/// A helix of Gaussians of all colours, around the middle.
static void save_gaussians(ewa_context *context) {
    ewa_gaussians set;
    assert_int_equal(ewa_gaussians_create(context, 400, 0, &set), EWA_OK);
    for (uint32_t i = 0; i < set.count; i++) {
        // A square way round, so that no sine is asked for.
        const float along = (float)(i % 100) / 25, side = along - (float)(int)along;
        const float x[4] = {1, 1 - 2 * side, -1, 2 * side - 1}, y[4] = {2 * side - 1, 1, 1 - 2 * side, -1};
        const int k = (int)along;
        const float center[3] = {1.4f * x[k], (float)i / 100 - 2, 1.4f * y[k]};
        memcpy(set.centers + 3 * (size_t)i, center, sizeof center);
        for (int c = 0; c < 3; c++) set.scales[3 * (size_t)i + (size_t)c] = c == 1 ? 0.03f : 0.12f;
        set.rotations[4 * (size_t)i] = 1;
        set.opacities[i] = 0.8f;
        for (int c = 0; c < 3; c++) set.harmonics[3 * (size_t)i + (size_t)c] = center[c];
    }
    assert_int_equal(ewa_gaussians_save(&set, "helix.splat", NULL), EWA_OK);
    ewa_gaussians_free(&set);
}

/// Draws a ball from four sides and says how in ball_photos.json.
static void take_photos(ewa_context *context, const ewa_cloud *ball) {
    enum { SIDE_PX = 120, VIEWS = 4 };
    static uint8_t rgba8[SIDE_PX * SIDE_PX * 4];
    WITH_DEFAULTS(ewa_render_options, options);
    options.shading = EWA_SHADING_NONE;
    ewa_surfels *surfels = check_surfels(ball, NULL);
    ewa_renderer *renderer = check_renderer(context);
    FILE *file = fopen("ball_photos.json", "w");
    assert_non_null(file);
    for (int i = 0; i < VIEWS; i++) {
        // Rows: right, down, ahead.
        const double x = i == 0 ? 1 : i == 2 ? -1 : 0, y = i == 1 ? 1 : i == 3 ? -1 : 0;
        const double rows[16] = {-y, x, 0, 0, 0, 0, -1, 0, -x, -y, 0, 4, 0, 0, 0, 1};
        ewa_camera camera = check_camera(SIDE_PX, SIDE_PX);
        camera.fx_px = camera.fy_px = 2 * SIDE_PX, camera.cx_px = camera.cy_px = SIDE_PX / 2.0;
        memcpy(camera.world_to_camera, rows, sizeof rows);
        assert_int_equal(ewa_render(renderer, surfels, &camera, &options, &(ewa_frame){.rgba8 = rgba8}, NULL), EWA_OK);
        char name[32];
        snprintf(name, sizeof name, "ball_%d.png", i);
        assert_int_equal(ewa_png_save(context, name, SIDE_PX, SIDE_PX, 4, rgba8, 4 * SIDE_PX), EWA_OK);
        fprintf(file, "%s{\"file_path\": \"%s\", \"width\": %d, \"height\": %d, \"fx\": %d, \"fy\": %d, \"cx\": %d, \"cy\": %d, "
                "\"world_to_camera\": [", i ? ",\n" : "[", name, SIDE_PX, SIDE_PX, 2 * SIDE_PX, 2 * SIDE_PX, SIDE_PX / 2, SIDE_PX / 2);
        for (int k = 0; k < 16; k++) fprintf(file, "%s%g", k ? ", " : "", rows[k]);
        fputs("]}", file);
    }
    fputs("]\n", file);
    assert_int_equal(fclose(file), 0);
    ewa_renderer_destroy(&renderer);
    ewa_surfels_destroy(&surfels);
}

/// Writes masks of the photographs, of which the first `white_count` count.
static void write_masks(ewa_context *context, const char *folder, int white_count) {
    enum { SIDE_PX = 120, VIEWS = 4 };
    static uint8_t rgb8[SIDE_PX * SIDE_PX * 3];
    (void)mkdir(folder, 0777);
    for (int i = 0; i < VIEWS; i++) {
        char name[64];
        snprintf(name, sizeof name, "%s/ball_%d.png", folder, i);
        memset(rgb8, i < white_count ? 255 : 0, sizeof rgb8);
        assert_int_equal(ewa_png_save(context, name, SIDE_PX, SIDE_PX, 3, rgb8, 3 * SIDE_PX), EWA_OK);
    }
}

/// A ball without colours, photographs of it with some, and the two together as the program puts them.
static void make_photos(ewa_context *context) {
    WITH_DEFAULTS(ewa_generate_options, options);
    options.object = EWA_OBJECT_SPHERE;
    options.point_count = 4000;
    ewa_cloud *ball = NULL, *colored = NULL;
    assert_int_equal(ewa_cloud_generate(context, &options, &ball), EWA_OK);
    save(ball, "grey_ball.ply");
    void *colors;
    assert_int_equal(ewa_cloud_add(ball, EWA_COLOR, EWA_U8, 3, &colors), EWA_OK);
    for (uint64_t i = 0; i < ewa_cloud_point_count(ball); i++) {
        double p[3];
        ewa_attribute_read_f64(ewa_cloud_find(ball, EWA_POSITION), i, 1, p);
        for (int c = 0; c < 3; c++) ((uint8_t *)colors)[3 * i + (uint64_t)c] = (uint8_t)(120 + 100 * p[c]);
    }
    take_photos(context, ball);
    write_masks(context, "ball_masks", 4);
    write_masks(context, "ball_first", 1);
    ewa_cloud_destroy(&ball);
    ewa_photo_list *list = NULL;
    uint32_t count;
    assert_int_equal(ewa_cloud_load(context, "grey_ball.ply", &colored), EWA_OK);
    assert_int_equal(ewa_photo_list_load(context, "ball_photos.json", NULL, &list), EWA_OK);
    const ewa_photo *photos = ewa_photo_list_photos(list, &count);
    assert_int_equal(count, 4);
    assert_int_equal(ewa_cloud_color_from_photos(colored, photos, count, NULL, NULL, NULL), EWA_OK);
    save(colored, "ball_program.ply");
    ewa_photo_list_destroy(&list);
    ewa_cloud_destroy(&colored);
}

/// A ramp on the map, of height x / 2 + 3 above 100, in decimals of centimetres; its northern half is a building.
static void write_ramp(const char *path) {
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("x,y,z,intensity,classification\n", file);
    for (int i = 0; i < 41 * 41; i++) {
        const int x = i % 41, y = i / 41; // quarters
        fprintf(file, "%d.%02d,%d.%02d,%d.%02d,%d,%d\n", 849201 + x / 4, 25 * (x % 4), 1233495 + y / 4, 25 * (y % 4),
                103 + (25 * x / 2) / 100, 25 * x / 2 % 100, i, y > 20 ? 6 : 2);
    }
    assert_int_equal(fclose(file), 0);
}

static int make_files(void **state) {
    char folder[1024];
    snprintf(folder, sizeof folder, "%s/%s", getenv("EWA_BINARY_DIR"), getenv("EWA_TEST"));
    snprintf(scripts_folder, sizeof scripts_folder, "%s/tests/viewer/scripts", getenv("EWA_SOURCE_DIR"));
    mkdir(folder, 0777);
    assert_int_equal(chdir(folder), 0);
    ewa_context *context = check_context(2, NULL);
    ewa_cloud *cloud = check_object(context, EWA_OBJECT_SPHERE, 20000);
    save(cloud, "sphere.ply");
    const double far_world[16] = {1, 0, 0, 500000.25, 0, 1, 0, 4200000.125, 0, 0, 1, 300, 0, 0, 0, 1};
    assert_int_equal(ewa_cloud_transform(cloud, far_world), EWA_OK);
    save(cloud, "far.ply");
    ewa_cloud_destroy(&cloud);
    ewa_generate_options options = check_generate_options(EWA_OBJECT_TORUS, 20000);
    options.positions_only = true;
    cloud = check_generated(context, &options);
    save(cloud, "scan.ply");
    ewa_cloud_destroy(&cloud);
    cloud = make_survey(context);
    save(cloud, "survey.ply");
    ewa_cloud_destroy(&cloud);
    static const char *const survey = "survey.ply";
    assert_int_equal(ewa_lod_build(context, &survey, 1, "survey.copc.laz", NULL, NULL), EWA_OK);
    write_ramp("ramp.csv");
    assert_int_equal(ewa_cloud_load(context, "ramp.csv", &cloud), EWA_OK);
    static const char feet[] = "PROJCS[\"A grid of feet\",GEOGCS[\"G\",UNIT[\"degree\",0.0174532925199433]],"
                               "UNIT[\"US survey foot\",0.304800609601219]]";
    assert_int_equal(ewa_cloud_set_note(cloud, "crs", feet, sizeof feet - 1), EWA_OK);
    save(cloud, "feet.las");
    ewa_cloud_destroy(&cloud);
    write_text("cube.obj",
               "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
               "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    write_text("broken.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 100\nproperty float x\n"
                             "property float y\nproperty float z\nend_header\n123");
    write_text(
        "scene.json",
        "{\"ewa_scene\": 1, \"options\": {\"render\": {\"background\": [0.1, 0.2, 0.1, 1]}}, \"items\": ["
        "{\"file\": \"sphere.ply\", \"tint\": [1, 0, 0], \"to_world\": [0.5,0,0,0, 0,0.5,0,0, 0,0,0.5,0, "
        "0,0,0,1]},"
        "{\"file\": \"scan.ply\", \"color_by\": \"z\", \"range\": [\"10%\", 0.3]}], \"camera\": {"
        "\"width\": 320, \"height\": 240, \"fx\": 400, \"fy\": 400, \"cx\": 160, \"cy\": 120, "
        "\"world_to_camera\": "
        "[1,0,0,0, 0,-0.6,-0.8,0, 0,0.8,-0.6,4, 0,0,0,1]}}");
    write_text("scene_circle.json", "{\"ewa_scene\": 1, \"items\": [{\"scene\": \"scene_circle.json\"}]}");
    WITH_DEFAULTS(ewa_volume_generate_options, volume_options);
    volume_options.object = EWA_VOLUME_BALL;
    for (int c = 0; c < 3; c++) volume_options.dims[c] = 32;
    ewa_volume volume;
    assert_int_equal(ewa_volume_generate(context, &volume_options, &volume), EWA_OK);
    assert_int_equal(ewa_volume_save(&volume, "ball.nrrd", NULL), EWA_OK);
    ewa_volume_free(&volume);
    save_gaussians(context);
    make_photos(context);
    ewa_context_destroy(&context);
    return 0;
}

static int compare_names(const void *a, const void *b) { return strcmp(a, b); }

static size_t list_scripts(char names[MAX_SCRIPTS][256]) {
    DIR *folder = opendir(scripts_folder);
    assert_non_null(folder);
    size_t count = 0;
    const struct dirent *entry;
    while ((entry = readdir(folder)) && count < MAX_SCRIPTS)
        if (strstr(entry->d_name, ".txt")) snprintf(names[count++], 256, "%.250s", entry->d_name);
    closedir(folder);
    qsort(names, count, 256, compare_names);
    return count;
}

static int run_script(const char *name, uint32_t cpu_mask, int64_t threads) {
    static const char *const no_paths[] = {NULL};
    char path[2048];
    snprintf(path, sizeof path, "%s/%.255s", scripts_folder, name);
    view_arguments view = {.common = {.operands = no_paths, .threads = threads, .quiet = true}};
    view_set_defaults(&view);
    look_arguments arguments;
    look_set_defaults(memset(&arguments, 0, sizeof arguments));
    arguments.lod.levels = EWA_OCTREE_ALWAYS;
    window_services services;
    viewer_look look;
    front_job job = {.script_path = path,
                     .options = {.thread_count = (uint32_t)threads,
                                 .cpu_mask = cpu_mask,
                                 .width = WIDTH,
                                 .height = HEIGHT,
                                 .scale = 1,
                                 .look = &look,
                                 .waits = true}};
    assert_true(window_services_make(&services, &view, &arguments, &look, &job.options.services));
    const int exit_status = FRONT_RUN(&job);
    window_services_free(&services);
    return exit_status;
}

static void run_all(uint32_t cpu_mask, int64_t threads) {
    char names[MAX_SCRIPTS][256];
    const size_t count = list_scripts(names);
    assert_true(count >= 30);
    size_t failed = 0;
    for (size_t i = 0; i < count; i++) {
        const int exit_status = run_script(names[i], cpu_mask, threads);
        if (exit_status != 0) print_error("%s failed\n", names[i]);
        failed += exit_status != 0;
    }
    print_message("%zu scripts\n", count);
    assert_int_equal(failed, 0);
}

#ifdef OTHER_SETS // the same hashes by the other instruction sets
TEST(scripts_without_avx512) { run_all(EWA_CPU_AVX2, 1); }

TEST(scripts_portable) { run_all(0, 3); }
#else
TEST(scripts_with_everything) { run_all(EWA_CPU_ALL, 2); }

TEST(wrong_scripts_fail) {
    static const char *const wrong[] = {"nothing\n",       "1 frame\n0.5 frame\n",
                                        "press 1\n",       "do nothing\n",
                                        "key\n",           "expect-hash 0123456789abcdef\n",
                                        "expect-said x\n", "refuse view front\n",
                                        "inf frame\n",     "expect-same nowhere.png\n",
                                        "drop\n",          "shot /nowhere/at/all.png\n",
                                        "key nosuchkey\n", "wheel 1 2\n",
                                        // Else it would draw for minutes.
                                        "do open survey.ply\ndo mode fly\n0.1 key a\nsettle\n"};
    char path[2048];
    snprintf(path, sizeof path, "%s/%s/wrong.txt", getenv("EWA_BINARY_DIR"), getenv("EWA_TEST"));
    char saved[1024];
    memcpy(saved, scripts_folder, sizeof saved);
    snprintf(scripts_folder, sizeof scripts_folder, "%s/%s", getenv("EWA_BINARY_DIR"), getenv("EWA_TEST"));
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        write_text(path, wrong[i]);
        if (run_script("wrong.txt", EWA_CPU_ALL, 1) != 1) fail_msg("'%s' did not fail", wrong[i]);
    }
    assert_int_equal(run_script("absent.txt", EWA_CPU_ALL, 1), 1);
    memcpy(scripts_folder, saved, sizeof saved);
}
#endif

int main(void) { return RUN_TESTS(make_files, NULL); }
