// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scene files: what was saved opens as the same picture; files within files; what a caller sets wins; every truncation, and
// what names nothing, itself or something elsewhere, is refused with its place and leaves the scene as it was.
#define _XOPEN_SOURCE 700
#include "check_scene.h"
#include "ewa/scene_file.h"
#include "io/scratch.h"

#include <math.h>
#include <sys/stat.h>
#include <unistd.h>

static planes first, second;

static void write_text(const char *path, const char *text) { scratch_write(path, text, strlen(text)); }

/// Returns a file's text, to be freed.
static char *read_text(const char *path) {
    size_t size_bytes;
    char *text = (char *)scratch_read(path, &size_bytes);
    text[size_bytes] = 0;
    return text;
}

static void save_object(ewa_context *context, ewa_object object, const char *path) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_object(context, object, 0);
    assert_int_equal(ewa_cloud_save(cloud, path, NULL), EWA_OK);
}

static int set_up(void **state) {
    char folder[512];
    assert_int_equal(chdir(scratch_path("", folder)), 0);
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, NULL);
    mkdir("deep", 0777);
    save_object(context, EWA_OBJECT_TORUS, "torus.ply");
    save_object(context, EWA_OBJECT_SPHERE, "deep/sphere.ply");
    WITH_DEFAULTS(ewa_volume_generate_options, options);
    options.object = EWA_VOLUME_BALL;
    for (int c = 0; c < 3; c++) options.dims[c] = 16;
    OWNED(ewa_volume_free) ewa_volume volume;
    assert_int_equal(ewa_volume_generate(context, &options, &volume), EWA_OK);
    assert_int_equal(ewa_volume_save(&volume, "deep/ball.nrrd", NULL), EWA_OK);
    return 0;
}

static void add(ewa_context *context, ewa_scene *scene, const char *path, const ewa_asset_options *options,
                const ewa_instance *instance) {
    ewa_asset *asset = NULL;
    assert_int_equal(ewa_asset_load(context, path, options, &asset), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, instance), EWA_OK);
    ewa_asset_release(&asset);
}

/// Options of which many are no default.
static ewa_scene_options make_options(void) {
    WITH_DEFAULTS(ewa_scene_options, options);
    options.up = EWA_UP_MINUS_Y;
    options.surfels.radius_scale = 1.25;
    options.render.kernel = EWA_KERNEL_AFFINE;
    options.render.ambient = 0.1; // no double's text is shorter than its digits
    options.render.shading = EWA_SHADING_LAMBERT;
    options.render.background[0] = 0.125f;
    options.render.background[3] = 0.1f;
    options.render.light_count = 2;
    for (int i = 0; i < 2; i++) ewa_light_init(&options.render.lights[i]);
    options.render.lights[0].direction_world[0] = 1.0 / 3;
    options.render.lights[1].color[2] = 0.7f;
    options.render.section_count = 1;
    memcpy(options.render.section_planes[0], (const double[4]){1, 0.25, 0, 0.3}, 4 * sizeof(double));
    options.volumes.density_scale = 3;
    options.gaussians.cutoff = 3;
    return options;
}

TEST_ON(test_saved_opens_alike, 0) {
    OWNED(ewa_scene_destroy) ewa_scene *made = NULL, *opened = NULL;
    const ewa_scene_options options = make_options();
    assert_int_equal(ewa_scene_create(context, &options, &made), EWA_OK);
    ewa_asset_options asset;
    ewa_instance instance;
    ewa_asset_options_init(&asset, sizeof asset);
    ewa_instance_init(&instance, sizeof instance);
    ewa_filter filter = {.term_count = 0};
    assert_int_equal(ewa_filter_add(&filter, "z>-0.25 and x!=0.1..0.2,5 and y<=0.875", NULL), EWA_OK);
    asset.filter = &filter;
    instance.coloring.map = EWA_COLORING_TURBO;
    strcpy(instance.coloring.attribute, "normal.x");
    instance.coloring.ranged = true;
    instance.coloring.percent[0] = true;
    instance.coloring.range[0] = 2.5, instance.coloring.range[1] = 0.7;
    instance.radius_scale = 1.1;
    add(context, made, "torus.ply", &asset, &instance);
    asset.filter = NULL;
    const double to_world[16] = {0.3, 0,          0, 1.0 / 3,   0, 0, 0.3 * 1.1, 0,
                                 0,   -0.3 / 1.3, 0, 0.1 + 0.2, 0, 0, 0,         1};
    memcpy(asset.to_world, to_world, sizeof to_world);
    ewa_instance_init(&instance, sizeof instance);
    instance.opacity = 0.6;
    instance.coloring.tinted = true;
    instance.coloring.tint[1] = 0.2;
    add(context, made, "deep/sphere.ply", &asset, &instance);
    asset.transfer = "fog";
    add(context, made, "deep/ball.nrrd", &asset, NULL);
    ewa_instance_init(&instance, sizeof instance);
    instance.visible = false;
    add(context, made, "torus.ply", NULL, &instance);
    ewa_camera camera = place(made), again;
    camera.cx_px += 0.1;
    assert_int_equal(ewa_scene_save(made, &camera, "saved.json"), EWA_OK);
    assert_true(ewa_scene_file_probe("saved.json"));
    assert_false(ewa_scene_file_probe("torus.ply"));
    assert_int_equal(ewa_scene_create(context, NULL, &opened), EWA_OK);
    assert_int_equal(ewa_scene_open(opened, "saved.json", NULL), EWA_OK);
    assert_int_equal(ewa_scene_count(opened), 4);
    assert_true(ewa_scene_get_camera(opened, &again));
    assert_memory_equal(&camera, &again, sizeof camera);
    again = place(opened);
    assert_memory_equal(&camera, &again, sizeof camera);
    draw(context, made, &camera, &first);
    draw(context, opened, &camera, &second);
    assert_memory_equal(&first, &second, sizeof first);
    // Saved once more, it is the same text.
    assert_int_equal(ewa_scene_save(opened, NULL, "again.json"), EWA_OK);
    char *texts[2] = {read_text("saved.json"), read_text("again.json")};
    assert_string_equal(texts[0], texts[1]);
    free(texts[0]), free(texts[1]);
    OWNED(ewa_text_free) char *told = NULL;
    assert_int_equal(ewa_scene_describe_json(opened, &told), EWA_OK);
    assert_non_null(strstr(told, "\"kind\":\t\"volume\""));
    assert_non_null(strstr(told, "\"high_world\""));
}

/// Saves a scene of one file with these options of its asset; the text is the caller's.
static char *save_asset(ewa_context *context, const char *path, const ewa_asset_options *options) {
    OWNED(ewa_scene_destroy) ewa_scene *scene = NULL, *opened = NULL;
    assert_int_equal(ewa_scene_create(context, NULL, &scene), EWA_OK);
    add(context, scene, path, options, NULL);
    const ewa_camera camera = place(scene);
    assert_int_equal(ewa_scene_save(scene, NULL, "asset.json"), EWA_OK);
    assert_int_equal(ewa_scene_create(context, NULL, &opened), EWA_OK);
    assert_int_equal(ewa_scene_open(opened, "asset.json", NULL), EWA_OK);
    draw(context, scene, &camera, &first);
    draw(context, opened, &camera, &second);
    assert_memory_equal(&first, &second, sizeof first);
    return read_text("asset.json");
}

/// What a kind of asset is made by is saved with it, and nothing else.
TEST_ON(test_saved_assets, 0) {
    static const char off[] = "OFF\n4 2 0\n-1 -1 0\n1 -1 0\n1 1 0.5\n-1 1 0\n3 0 1 2\n3 0 2 3\n";
    static const char *const files[] = {"square.off", "torus.ply", "deep/ball.nrrd"};
    FILE *file = fopen(files[0], "w");
    assert_true(file && fputs(off, file) >= 0 && fclose(file) == 0);
    WITH_DEFAULTS(ewa_asset_options, options);
    options.cutoff = 2;
    options.voxel_level_count = 2;
    options.reach_steps = 3;
    for (int i = 0; i < 3; i++) {
        OWNED(check_free) char *text = save_asset(context, files[i], &options);
        assert_true((strstr(text, "\"cutoff\":\t2") != NULL) == (i == 0));
        assert_true((strstr(text, "\"voxel_level_count\":\t2") != NULL) == (i == 2));
        assert_true((strstr(text, "\"reach_steps\":\t3") != NULL) == (i == 2));
    }
}

TEST_ON(test_files_in_files, 0) {
    write_text("deep/inner.json",
               "{\"ewa_scene\": 1, \"options\": {\"render\": {\"ambient\": 0.9}}, \"items\": ["
               "{\"file\": \"sphere.ply\", \"to_world\": [0.5,0,0,0, 0,0.5,0,0.25, 0,0,0.5,0, 0,0,0,1]},"
               "{\"file\": \"ball.nrrd\", \"transfer\": \"fog\"}]}");
    write_text("outer.json",
               "{\"ewa_scene\": 1, \"items\": [{\"file\": \"torus.ply\", \"tint\": [1, 0.5, 0]},"
               "{\"scene\": \"deep/inner.json\", \"to_world\": [0,-1,0,2, 1,0,0,0, 0,0,1,0, 0,0,0,1]},"
               "{\"scene\": \"deep/inner.json\", \"visible\": false}]}");
    OWNED(ewa_scene_destroy) ewa_scene *opened = NULL, *made = NULL;
    assert_int_equal(ewa_scene_create(context, NULL, &opened), EWA_OK);
    assert_int_equal(ewa_scene_create(context, NULL, &made), EWA_OK);
    assert_int_equal(ewa_scene_open(opened, "outer.json", NULL), EWA_OK);
    assert_int_equal(ewa_scene_count(opened), 5);
    WITH_DEFAULTS(ewa_instance, instance);
    instance.coloring.tinted = true;
    memcpy(instance.coloring.tint, (const double[3]){1, 0.5, 0}, 3 * sizeof(double));
    add(context, made, "torus.ply", NULL, &instance);
    WITH_DEFAULTS(ewa_asset_options, asset);
    const double both[16] = {0, -0.5, 0, 1.75, 0.5, 0, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1},
                 outer[16] = {0, -1, 0, 2, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    memcpy(asset.to_world, both, sizeof both);
    add(context, made, "deep/sphere.ply", &asset, NULL);
    memcpy(asset.to_world, outer, sizeof outer);
    asset.transfer = "fog";
    add(context, made, "deep/ball.nrrd", &asset, NULL);
    const ewa_camera camera = place(made), again = place(opened);
    assert_memory_equal(&camera, &again, sizeof camera);
    draw(context, made, &camera, &first);
    draw(context, opened, &camera, &second);
    assert_memory_equal(&first, &second, sizeof first);
    // Options and cameras are those of the outer file.
    ewa_scene_options options;
    ewa_scene_get_options(opened, &options);
    assert_true(options.render.ambient == 0.15);
}

TEST_ON(test_callers_options_win, 0) {
    write_text("options.json",
               "{\"ewa_scene\": 1, \"options\": {\"up\": \"z\", \"render\": {\"ambient\": 0.5, "
               "\"eye_dome\": 0.5}, \"lights\": [{\"color\": [1, 0, 0]}]}, \"items\": []}");
    WITH_DEFAULTS(ewa_scene_options, options);
    options.render.ambient = 0.25;
    options.render.light_count = 1;
    ewa_light_init(&options.render.lights[0]);
    OWNED(ewa_scene_destroy) ewa_scene *scene = NULL;
    assert_int_equal(ewa_scene_create(context, &options, &scene), EWA_OK);
    assert_int_equal(ewa_scene_open(scene, "options.json", NULL), EWA_OK);
    ewa_scene_get_options(scene, &options);
    assert_true(options.render.ambient == 0.25 && options.render.eye_dome == 0.5);
    assert_int_equal(options.up, EWA_UP_Z);
    assert_int_equal(options.render.light_count, 1);
    assert_true(options.render.lights[0].color[1] == 1);
}

TEST_ON(test_cameras_keep_their_heights, 0) {
    OWNED(ewa_scene_destroy) ewa_scene *scene = NULL;
    assert_int_equal(ewa_scene_create(context, NULL, &scene), EWA_OK);
    add(context, scene, "torus.ply", NULL, NULL);
    ewa_camera camera = place(scene), placed;
    camera.cx_px = 40, camera.cy_px = 30;
    assert_int_equal(ewa_scene_set_camera(scene, &camera), EWA_OK);
    WITH_DEFAULTS(ewa_view_options, options);
    assert_int_equal(ewa_scene_place_camera(scene, &options, &placed, NULL), EWA_OK);
    assert_memory_equal(&camera, &placed, sizeof camera);
    options.width_px = 400, options.height_px = 2 * HEIGHT;
    assert_int_equal(ewa_scene_place_camera(scene, &options, &placed, NULL), EWA_OK);
    assert_true(placed.width_px == 400 && placed.height_px == 2 * HEIGHT);
    // Twice as high, everything is twice as large; 8 pixels left of the middle become 16.
    assert_true(placed.fx_px == 2 * camera.fx_px && placed.fy_px == 2 * camera.fy_px);
    assert_true(placed.cx_px == 200 - 16 && placed.cy_px == 60);
    // Whoever asks for a view gets it.
    options.view = EWA_VIEW_TOP;
    ewa_camera top;
    assert_int_equal(ewa_scene_place_camera(scene, &options, &top, NULL), EWA_OK);
    assert_memory_not_equal(top.world_to_camera, camera.world_to_camera, sizeof camera.world_to_camera);
    assert_int_equal(ewa_scene_set_camera(scene, NULL), EWA_OK);
    assert_false(ewa_scene_get_camera(scene, &top));
}

static void refuse(const char *text, ewa_status expected, const char *part) {
    check_log heard = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, &heard);
    OWNED(ewa_scene_destroy) ewa_scene *scene = NULL;
    assert_int_equal(ewa_scene_create(context, NULL, &scene), EWA_OK);
    add(context, scene, "torus.ply", NULL, NULL);
    ewa_scene_options before, after;
    ewa_scene_get_options(scene, &before);
    write_text("bad.json", text);
    const ewa_status status = ewa_scene_open(scene, "bad.json", NULL);
    if (status != expected || !strstr(heard.text, part))
        fail_msg("%s: %d, %s", text, (int)status, heard.text);
    ewa_scene_get_options(scene, &after);
    assert_int_equal(ewa_scene_count(scene), 1);
    assert_memory_equal(&before, &after, sizeof before);
    ewa_camera camera;
    assert_false(ewa_scene_get_camera(scene, &camera));
}

#define ITEM(members) "{\"ewa_scene\": 1, \"items\": [{\"file\": \"torus.ply\"}, {" members "}]}"
#define OPTIONS(members)                                                                                     \
    "{\"ewa_scene\": 1, \"items\": [{\"file\": \"torus.ply\"}], \"options\": {" members "}}"

#define TEXT_16 "0123456789abcdef"
#define TEXT_64 TEXT_16 TEXT_16 TEXT_16 TEXT_16
#define MEASURE(members) "{\"ewa_scene\": 1, \"measures\": [{" members "}]}"

/// Measurements are saved and come back, number by number; scenes of scenes have their own alone.
TEST_ON(test_measures_come_back, 0) {
    OWNED(ewa_scene_destroy) ewa_scene *scene = NULL, *copy = NULL, *again = NULL;
    assert_int_equal(ewa_scene_create(context, NULL, &scene), EWA_OK);
    add(context, scene, "torus.ply", NULL, NULL);
    ewa_measure measures[2] = {{EWA_MEASURE_HEIGHT, "mast \"3\" \xc3\xa4", 2, {849211.24, 1233496.1, 103, 1, 2, 1.0 / 3}},
                               {EWA_MEASURE_AREA, "", 3, {0, 0, 0, 1, 0, 0, 0, 1, 1e-300}}};
    assert_int_equal(ewa_scene_set_measures(scene, measures, 2), EWA_OK);
    measures[1].count = 2;
    assert_int_equal(ewa_scene_set_measures(scene, measures, 2), EWA_ERROR_ARGUMENT); // no area; those before stay
    measures[1].count = 3;
    assert_int_equal(ewa_scene_copy(scene, context, &copy), EWA_OK);
    assert_int_equal(ewa_scene_save(copy, NULL, "measures.json"), EWA_OK);
    assert_int_equal(ewa_scene_create(context, NULL, &again), EWA_OK);
    assert_int_equal(ewa_scene_open(again, "measures.json", NULL), EWA_OK);
    for (uint32_t i = 0; i < 2; i++) assert_memory_equal(ewa_scene_measure(again, i), &measures[i], sizeof measures[i]);
    assert_null(ewa_scene_measure(again, 2));
    // Those that a scene has stay.
    assert_int_equal(ewa_scene_set_measures(again, measures, 1), EWA_OK);
    assert_int_equal(ewa_scene_open(again, "measures.json", NULL), EWA_OK);
    assert_null(ewa_scene_measure(again, 1));
    write_text("outer.json", "{\"ewa_scene\": 1, \"items\": [{\"scene\": \"measures.json\"}]}");
    OWNED(ewa_scene_file_destroy) ewa_scene_file *file = NULL;
    ewa_measure measure;
    assert_int_equal(ewa_scene_file_load(context, "outer.json", NULL, &file), EWA_OK);
    assert_false(ewa_scene_file_measure(file, 0, &measure));
}

/// So are keyframes, as cameras that --path reads, too; a scene that has some keeps them.
TEST_ON(test_keyframes_come_back, 0) {
    OWNED(ewa_scene_destroy) ewa_scene *scene = NULL, *copy = NULL, *again = NULL;
    assert_int_equal(ewa_scene_create(context, NULL, &scene), EWA_OK);
    add(context, scene, "torus.ply", NULL, NULL);
    ewa_camera keys[EWA_MAX_KEYFRAMES + 1];
    for (int i = 0; i <= EWA_MAX_KEYFRAMES; i++) {
        ewa_camera_init(&keys[i]);
        keys[i].width_px = 320, keys[i].height_px = 240;
        keys[i].world_to_camera[11] = 4 + i / 3.0;
    }
    assert_int_equal(ewa_scene_set_keyframes(scene, keys, EWA_MAX_KEYFRAMES + 1), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_scene_set_keyframes(scene, keys, 3), EWA_OK);
    assert_int_equal(ewa_scene_copy(scene, context, &copy), EWA_OK);
    assert_int_equal(ewa_scene_save(copy, &keys[5], "keyframes.json"), EWA_OK);
    assert_int_equal(ewa_scene_create(context, NULL, &again), EWA_OK);
    assert_int_equal(ewa_scene_open(again, "keyframes.json", NULL), EWA_OK);
    for (uint32_t i = 0; i < 3; i++) assert_memory_equal(ewa_scene_keyframe(again, i), &keys[i], sizeof keys[i]);
    assert_null(ewa_scene_keyframe(again, 3));
    ewa_camera camera;
    assert_int_equal(ewa_camera_load(context, "keyframes.json", 0, &camera), EWA_OK);
    assert_memory_equal(&camera, &keys[5], sizeof camera); // from which the scene is seen
    assert_int_equal(ewa_camera_load(context, "keyframes.json", 3, &camera), EWA_OK);
    assert_memory_equal(&camera, &keys[2], sizeof camera);
    assert_int_equal(ewa_scene_set_keyframes(again, keys, 1), EWA_OK);
    assert_int_equal(ewa_scene_open(again, "keyframes.json", NULL), EWA_OK);
    assert_null(ewa_scene_keyframe(again, 1));
}

TEST(test_bad_is_refused) {
    static const struct {
        const char *text;
        ewa_status status;
        const char *part;
    } rows[] = {
        {"", EWA_ERROR_FORMAT, "bad.json"},
        {"[]", EWA_ERROR_FORMAT, "ewa_scene"},
        {"{\"ewa_scene\": \"1\"}", EWA_ERROR_FORMAT, "ewa_scene"},
        {"{\"ewa_scene\": 2}", EWA_ERROR_UNSUPPORTED, "is 2"},
        {"{\"ewa_scene\": 1, \"item\": []}", EWA_ERROR_FORMAT, "'item'"},
        {"{\"ewa_scene\": 1, \"items\": [], \"items\": []}", EWA_ERROR_FORMAT, "twice"},
        {"{\"ewa_scene\": 1, \"items\": {}}", EWA_ERROR_FORMAT, "items"},
        {"{\"ewa_scene\": 1, \"items\": [3]}", EWA_ERROR_FORMAT, "items[0]"},
        {"{\"ewa_scene\": 1, \"camera\": []}", EWA_ERROR_FORMAT, "camera"},
        {"{\"ewa_scene\": 1, \"keyframes\": {}}", EWA_ERROR_FORMAT, "keyframes"},
        {"{\"ewa_scene\": 1, \"keyframes\": [{\"width\": 3}]}", EWA_ERROR_FORMAT, "height"},
        {"{\"ewa_scene\": 1, \"measures\": {}}", EWA_ERROR_FORMAT, "measures"},
        {"{\"ewa_scene\": 1, \"measures\": [3]}", EWA_ERROR_FORMAT, "measures[0]"},
        {MEASURE("\"kind\": \"length\""), EWA_ERROR_FORMAT, "measures[0].kind"},
        {MEASURE("\"note\": \"a\""), EWA_ERROR_FORMAT, "measures[0].note"},
        {MEASURE("\"places_world\": [1, 2, 3, 4]"), EWA_ERROR_FORMAT, "measures[0].places_world"},
        {MEASURE("\"places_world\": [1, 2, \"x\"]"), EWA_ERROR_FORMAT, "measures[0].places_world"},
        {MEASURE("\"kind\": \"angle\", \"places_world\": [1, 2, 3, 4, 5, 6]"), EWA_ERROR_FORMAT, "measures[0]"},
        {MEASURE("\"name\": \"" TEXT_64 "\", \"places_world\": [1, 2, 3, 4, 5, 6]"), EWA_ERROR_FORMAT, "measures[0].name"},
        {"{\"ewa_scene\": 1, \"camera\": {\"width\": 3}}", EWA_ERROR_FORMAT, "height"},
        {"{\"ewa_scene\": 1, \"items\": [{\"file\": \"\"}]}", EWA_ERROR_FORMAT,
         "items[0].file: it has no name"},
        {ITEM(""), EWA_ERROR_FORMAT, "items[1]: names no file"},
        {ITEM("\"file\": \"none.ply\""), EWA_ERROR_FORMAT, "items[1].file: it is not there"},
        {ITEM("\"file\": \"\""), EWA_ERROR_FORMAT, "items[1].file"},
        {ITEM("\"file\": \"/etc/hostname\""), EWA_ERROR_FORMAT, "relative to the folder"},
        {ITEM("\"file\": \"../\""), EWA_ERROR_FORMAT, "not below the folder"},
        {ITEM("\"scene\": \"torus.ply\""), EWA_ERROR_FORMAT, "torus.ply"},
        {ITEM("\"scene\": \"bad.json\""), EWA_ERROR_LIMIT, "part of"},
        {ITEM("\"scene\": \"outer.json\", \"opacity\": 0.5"), EWA_ERROR_FORMAT, "items[1].opacity"},
        {ITEM("\"file\": \"torus.ply\", \"scene\": \"outer.json\""), EWA_ERROR_FORMAT, "items[1].scene"},
        {ITEM("\"file\": \"torus.ply\", \"opacity\": 2"), EWA_ERROR_FORMAT, "items[1].opacity: 2 is outside"},
        {ITEM("\"file\": \"torus.ply\", \"opacity\": {}"), EWA_ERROR_FORMAT, "items[1].opacity"},
        {ITEM("\"file\": \"torus.ply\", \"opacity\": [[1]]"), EWA_ERROR_FORMAT, "items[1].opacity"},
        {ITEM("\"file\": \"torus.ply\", \"own_context\": true"), EWA_ERROR_FORMAT, "own_context"},
        {ITEM("\"file\": \"torus.ply\", \"visible\": 1"), EWA_ERROR_FORMAT, "items[1].visible"},
        {ITEM("\"file\": \"torus.ply\", \"visible\": true, \"visible\": true"), EWA_ERROR_FORMAT, "twice"},
        {ITEM("\"file\": \"torus.ply\", \"color_by\": \"zork\", \"tint\": [1]"), EWA_ERROR_FORMAT,
         "items[1].tint"},
        {ITEM("\"file\": \"torus.ply\", \"range\": [1]"), EWA_ERROR_FORMAT, "items[1].range"},
        {ITEM("\"file\": \"torus.ply\", \"range\": [\"101%\", 1]"), EWA_ERROR_FORMAT, "items[1].range"},
        {ITEM("\"file\": \"torus.ply\", \"filter\": \"z>>1\""), EWA_ERROR_FORMAT, "items[1].filter"},
        {ITEM("\"file\": \"torus.ply\", \"transfer\": \"../f\""), EWA_ERROR_FORMAT, "items[1].transfer"},
        {ITEM("\"file\": \"torus.ply\", \"to_world\": [1,0,0,0, 0,1,0,0, 0,0,0,0, 0,0,0,1]"),
         EWA_ERROR_FORMAT, "items[1]: to_world"},
        {ITEM("\"file\": \"torus.ply\", \"to_world\": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,1,1]"),
         EWA_ERROR_FORMAT, "items[1]: to_world"},
        {ITEM("\"file\": \"torus.ply\", \"to_world\": [1,0,0,1e999, 0,1,0,0, 0,0,1,0, 0,0,0,1]"),
         EWA_ERROR_FORMAT, "items[1].to_world"},
        {OPTIONS("\"ambient\": 0.5"), EWA_ERROR_FORMAT, "options.ambient"},
        {OPTIONS("\"up\": \"x\""), EWA_ERROR_FORMAT, "options.up"},
        {ITEM("\"file\": \"deep\\\\..\\\\..\""), EWA_ERROR_FORMAT, "not below the folder"},
        {OPTIONS("\"render\": []"), EWA_ERROR_FORMAT, "options.render"},
        {OPTIONS("\"render\": {\"ambient\": -1}"), EWA_ERROR_FORMAT, "options.render.ambient: -1 is outside"},
        {OPTIONS("\"render\": {\"light_count\": 2}"), EWA_ERROR_FORMAT, "options.render.light_count"},
        {OPTIONS("\"lights\": [{}, {\"colour\": [1, 1, 1]}]"), EWA_ERROR_FORMAT, "options.lights[1].colour"},
        {OPTIONS("\"lights\": [{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}]"), EWA_ERROR_LIMIT,
         "17 lights"},
        {OPTIONS("\"section_planes\": [[1,2,3]]"), EWA_ERROR_FORMAT, "options.section_planes[0]"},
        {OPTIONS("\"section_planes\": [[0,0,0,1]]"), EWA_ERROR_FORMAT,
         "options.section_planes[0]: its normal"},
        {OPTIONS("\"section_planes\": [4]"), EWA_ERROR_FORMAT, "options.section_planes[0]"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        refuse(rows[i].text, rows[i].status, rows[i].part);
}

/// A byte order mark, ends of lines and names as programs of Windows write them.
TEST_ON(test_text_of_windows, 0) {
    write_text("windows.json", "\xef\xbb\xbf{\r\n  \"ewa_scene\": 1,\r\n  \"items\": [{\"file\": \"deep\\\\sphere.ply\"}]\r\n}\r\n");
    assert_true(ewa_scene_file_probe("windows.json"));
    OWNED(ewa_scene_destroy) ewa_scene *scene = NULL;
    assert_int_equal(ewa_scene_create(context, NULL, &scene), EWA_OK);
    assert_int_equal(ewa_scene_open(scene, "windows.json", NULL), EWA_OK);
    assert_int_equal(ewa_scene_count(scene), 1);
}

TEST(test_links_and_pipes) {
    (void)symlink("/etc/hostname", "away.ply");
    (void)mkfifo("pipe.ply", 0666);
    refuse(ITEM("\"file\": \"away.ply\""), EWA_ERROR_FORMAT, "not below the folder");
    refuse(ITEM("\"file\": \"pipe.ply\""), EWA_ERROR_FORMAT, "neither a regular file nor a folder");
    refuse(ITEM("\"scene\": \"pipe.ply\""), EWA_ERROR_FORMAT, "no regular file");
}

/// Percentiles are those from the lowest number to the highest.
TEST_ON(test_percentiles, 0) {
    write_text("all.json", ITEM("\"file\": \"torus.ply\", \"range\": [\"0%\", \"100%\"]"));
    OWNED(ewa_scene_file_destroy) ewa_scene_file *file = NULL;
    ewa_scene_entry entry;
    assert_int_equal(ewa_scene_file_load(context, "all.json", NULL, &file), EWA_OK);
    assert_int_equal(ewa_scene_file_entry(file, 1, &entry), EWA_OK);
    const ewa_coloring *coloring = &entry.instance.coloring;
    assert_true(coloring->ranged && coloring->percent[0] && coloring->percent[1]);
    assert_true(coloring->range[0] == 0 && coloring->range[1] == 100);
}

TEST_ON(test_depth_and_number, 0) {
    char name[64], text[1 << 12];
    for (int i = 1; i <= 9; i++) {
        snprintf(name, sizeof name, "level%d.json", i);
        snprintf(text, sizeof text, "{\"ewa_scene\": 1, \"items\": [{\"scene\": \"level%d.json\"}]}", i - 1);
        write_text(name, text);
    }
    write_text("level0.json", "{\"ewa_scene\": 1, \"items\": [{\"file\": \"torus.ply\"}]}");
    ewa_scene_file *file = NULL;
    assert_int_equal(ewa_scene_file_load(context, "level7.json", NULL, &file), EWA_OK);
    assert_int_equal(ewa_scene_file_count(file), 1);
    ewa_scene_file_destroy(&file);
    assert_int_equal(ewa_scene_file_load(context, "level8.json", NULL, &file), EWA_ERROR_LIMIT);
    assert_null(file);
    // Ten in each of ten of ... name ten million, of which nothing is loaded.
    for (int i = 1; i <= 6; i++) {
        snprintf(name, sizeof name, "many%d.json", i);
        size_t used = (size_t)snprintf(text, sizeof text, "{\"ewa_scene\": 1, \"items\": [");
        for (int k = 0; k < 10; k++)
            used += (size_t)snprintf(text + used, sizeof text - used, "%s{\"scene\": \"many%d.json\"}",
                                     k ? "," : "", i - 1);
        snprintf(text + used, sizeof text - used, "]}");
        write_text(name, text);
    }
    write_text("many0.json", "{\"ewa_scene\": 1, \"items\": []}");
    assert_int_equal(ewa_scene_file_load(context, "many6.json", NULL, &file), EWA_ERROR_LIMIT);
}

TEST_ON(test_truncations, 0) {
    OWNED(check_free) char *text = read_text("saved.json");
    const size_t size = strlen(text);
    assert_true(size > 500);
    ewa_scene_file *file = NULL;
    for (size_t length = size - 2; length < size; length--) {
        text[length] = 0;
        write_text("cut.json", text);
        if (ewa_scene_file_load(context, "cut.json", NULL, &file) == EWA_OK)
            fail_msg("%zu bytes are enough", length);
        assert_null(file);
        if (!length) break;
    }
}

TEST(test_unsaveable) {
    check_log heard = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, &heard);
    OWNED(ewa_scene_destroy) ewa_scene *scene = NULL;
    assert_int_equal(ewa_scene_create(context, NULL, &scene), EWA_OK);
    add(context, scene, "torus.ply", NULL, NULL);
    assert_int_equal(ewa_scene_save(scene, NULL, "deep/outside.json"), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(heard.text, "torus.ply"));
    assert_int_not_equal(access("deep/outside.json", F_OK), 0);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    WITH_DEFAULTS(ewa_generate_options, options);
    options.point_count = 100;
    assert_int_equal(ewa_cloud_generate(context, &options, &cloud), EWA_OK);
    ewa_asset *asset = NULL;
    assert_int_equal(
        ewa_asset_create(context, &(ewa_asset_source){.name = "mine", .cloud = cloud}, NULL, &asset), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
    ewa_asset_release(&asset);
    assert_int_equal(ewa_scene_save(scene, NULL, "memory.json"), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(heard.text, "mine"));
}

TEST(test_filters_as_text) {
    static const char *const texts[] = {"classification=2,6",
                                        "z>0.1",
                                        "z>=0.1",
                                        "x<-3",
                                        "x<=1e300",
                                        "y!=1..2,5,..-3",
                                        "a=1 and b!=2",
                                        "intensity=3..",
                                        "gps_time=0.1 and z<0.3"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        ewa_filter filter = {.term_count = 0}, again = {.term_count = 0};
        char text[512];
        assert_int_equal(ewa_filter_add(&filter, texts[i], NULL), EWA_OK);
        assert_true(ewa_filter_write(&filter, text, sizeof text));
        assert_int_equal(ewa_filter_add(&again, text, NULL), EWA_OK);
        if (memcmp(&filter, &again, sizeof filter) != 0) fail_msg("%s became %s", texts[i], text);
        assert_false(ewa_filter_write(&filter, text, strlen(text)));
    }
}

int main(void) { return RUN_TESTS(set_up, NULL); }
