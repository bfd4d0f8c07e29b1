// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files whose bytes the caller has: what they show is what the same files show, of octrees little of them is read, and callbacks that
// fail, give too little or say too much end in an error with the name and the place.
#include "lod/lod_scene.h"

#include "base/base.h"

/// Of a volume, before the name of the file that its voxels are in.
#define HEADER "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\ndata file: "

enum { WIDTH = 160, HEIGHT = 120, PIXELS = WIDTH * HEIGHT, POINTS = 60000, MANY_POINTS = 900000 };

static const char octree[] = "ground.copc.laz", points[] = "ground.ply", far[] = "far://place";
static const char large[] = "large.copc.laz"; // of which a picture needs a part

/// Files under far://place are those of the test's folder, read as the test wants.
typedef struct far_place {
    long reads_left; ///< before the first that fails, as all after it do; negative: none does
    uint64_t more_bytes;  ///< that files are said to be longer
    bool failed;          ///< it did
    bool by_little;       ///< a read gives less than it is asked for
    bool says_too_much;   ///< a read says that it gave more
    uint64_t read_bytes, file_bytes;
    int opened_count, closed_count, read_count;
    bool others; ///< a name that leads out of the place was asked for
    bool stops;  ///< progress is stopped once something was read
} far_place;

typedef struct far_file {
    far_place *place;
    FILE *file;
} far_file;

static int64_t read_far(void *user, uint64_t at_bytes, void *bytes, size_t size_bytes) {
    far_file *f = user;
    far_place *place = f->place;
    place->read_count++;
    assert_true(size_bytes > 0 && size_bytes <= EWA_FILE_PIECE_BYTES);
    if (place->reads_left == 0) {
        place->failed = true;
        return -1;
    }
    if (place->reads_left > 0) place->reads_left--;
    if (place->by_little) size_bytes = size_bytes / 2 + 1;
    assert_int_equal(fseek(f->file, (long)at_bytes, SEEK_SET), 0);
    const size_t got = fread(bytes, 1, size_bytes, f->file);
    place->read_bytes += got;
    return (int64_t)got + (place->says_too_much ? EWA_FILE_PIECE_BYTES : 0);
}

static void close_far(void *user) {
    OWNED(check_free) far_file *f = user;
    f->place->closed_count++;
    fclose(f->file);
}

static bool open_far(void *user, const char *path, ewa_file_source *source) {
    far_place *place = user;
    char own[512];
    if (strncmp(path, far, strlen(far)) != 0) return false;
    place->others = place->others || strstr(path, "..");
    FILE *file = fopen(scratch_path(path + strlen(far) + 1, own), "rb");
    if (!file) return false;
    far_file *f = malloc(sizeof *f);
    assert_non_null(f);
    *f = (far_file){place, file};
    fseek(file, 0, SEEK_END);
    place->file_bytes = (uint64_t)ftell(file);
    *source = (ewa_file_source){place->file_bytes + place->more_bytes, read_far, close_far, f};
    place->opened_count++;
    return true;
}

static bool stop_far(void *user, const char *stage, double fraction) {
    const far_place *place = user;
    return !(place->stops && place->read_bytes);
}

static ewa_context *far_context(far_place *place, check_log *log, check_memory *memory) {
    WITH_DEFAULTS(ewa_context_options, options);
    if (memory) options.allocator = check_allocator(memory);
    options.thread_count = 2;
    options.message = check_log_keep;
    options.message_user = log;
    options.progress = stop_far;
    options.progress_user = place;
    options.open_file = open_far;
    options.open_file_user = place;
    ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    return context;
}

static const char *far_path(const char *name, char path[512]) {
    snprintf(path, 512, "%s/%s", far, name);
    return path;
}

/// Saves points, and the octree with levels that they make.
static void make_octree(uint64_t count, const char *name) {
    static const char *const names[] = {points};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    lod_save(lod_ground(context, 0, count, (lod_look){true, true}), points);
    assert_int_equal(lod_build(context, names, 1, name, NULL, NULL), EWA_OK);
}

static int enter(void **state) {
    lod_clear();
    make_octree(MANY_POINTS, large);
    make_octree(POINTS, octree);
    return 0;
}

static int leave(void **state) {
    lod_clear();
    return 0;
}

static ewa_status load(ewa_context *context, const char *path, ewa_octree_levels levels, ewa_scene **scene) {
    ewa_asset_options options;
    ewa_asset *asset = NULL;
    ewa_asset_options_init(&options, sizeof options);
    options.levels = levels;
    *scene = NULL;
    ewa_status status = ewa_asset_load(context, path, &options, &asset);
    if (status == EWA_OK) status = ewa_scene_create(context, NULL, scene);
    if (status == EWA_OK) status = ewa_scene_add(*scene, asset, NULL);
    ewa_asset_release(&asset);
    if (status != EWA_OK) ewa_scene_destroy(scene);
    return status;
}

/// Draws a scene as it is placed, `zoom` times as large.
static ewa_status draw(ewa_context *context, ewa_scene *scene, double zoom, uint8_t *rgba8) {
    WITH_DEFAULTS(ewa_view_options, view);
    view.width_px = WIDTH, view.height_px = HEIGHT;
    ewa_camera camera;
    OWNED(ewa_scene_renderer_destroy) ewa_scene_renderer *renderer = NULL;
    EWA_TRY(ewa_scene_place_camera(scene, &view, &camera, NULL));
    camera.fx_px *= zoom, camera.fy_px *= zoom;
    EWA_TRY(ewa_scene_renderer_create(context, EWA_BACKEND_CPU, NULL, &renderer));
    ewa_scene_options options;
    ewa_scene_get_options(scene, &options);
    options.render.supersampling = 1; // by nodes as fine as pixels
    const ewa_status status = ewa_scene_draw(scene, renderer, &camera, &options, &(ewa_frame){.rgba8 = rgba8}, NULL);
    return status;
}

static uint8_t near_picture[4 * PIXELS], far_picture[4 * PIXELS];

/// What is drawn of a file here and of the same one there; returns what was read there.
static far_place hold_same(const char *name, ewa_octree_levels levels, double zoom, far_place place) {
    char path[512];
    check_log log = {0};
    ewa_context *here = check_context(2, NULL), *there = far_context(&place, &log, NULL);
    ewa_scene *near_scene, *far_scene;
    assert_int_equal(load(here, scratch_path(name, path), levels, &near_scene), EWA_OK);
    assert_int_equal(load(there, far_path(name, path), levels, &far_scene), EWA_OK);
    assert_int_equal(draw(here, near_scene, zoom, near_picture), EWA_OK);
    assert_int_equal(draw(there, far_scene, zoom, far_picture), EWA_OK);
    assert_memory_equal(near_picture, far_picture, sizeof near_picture);
    ewa_scene_destroy(&near_scene), ewa_scene_destroy(&far_scene);
    ewa_context_destroy(&here), ewa_context_destroy(&there);
    assert_true(place.opened_count > 0 && place.opened_count == place.closed_count);
    assert_int_equal(log.count, 0);
    return place;
}

/// From far, from near, by short reads: the same bytes as of the file, of which a part is read.
TEST(test_octree) {
    static const double zooms[] = {1, 20, 1};
    for (int i = 0; i < 3; i++) {
        const far_place place = hold_same(large, EWA_OCTREE_ALWAYS, zooms[i], (far_place){.reads_left = -1, .by_little = i == 2});
        print_message("zoom %g: %llu of %llu bytes in %d reads\n", zooms[i], (unsigned long long)place.read_bytes,
                      (unsigned long long)place.file_bytes, place.read_count);
        assert_true(place.read_bytes < place.file_bytes / 4 * 3);
    }
}

/// Whole files are read once, whoever looks at them before; files that they name beside them.
TEST(test_whole_files) {
    static const char obj[] = "mtllib red.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                      mtl[] = "newmtl red\nKd 1 0 0\n",
                      header[] = HEADER "voxels.raw\n\n";
    uint8_t voxels[64];
    char path[512];
    for (int i = 0; i < 64; i++) voxels[i] = (uint8_t)(4 * i);
    scratch_write(scratch_path("red.obj", path), obj, sizeof obj - 1);
    scratch_write(scratch_path("red.mtl", path), mtl, sizeof mtl - 1);
    scratch_write(scratch_path("grid.nhdr", path), header, sizeof header - 1);
    scratch_write(scratch_path("voxels.raw", path), voxels, sizeof voxels);
    far_place place = hold_same(points, EWA_OCTREE_AUTO, 1, (far_place){.reads_left = -1});
    assert_true(place.read_bytes < place.file_bytes + 1024); // heads, once more
    hold_same(octree, EWA_OCTREE_NEVER, 1, (far_place){.reads_left = -1});
    hold_same(octree, EWA_OCTREE_AUTO, 1, (far_place){.reads_left = -1, .by_little = true});
    hold_same("red.obj", EWA_OCTREE_AUTO, 1, (far_place){.reads_left = -1});
    assert_true(far_picture[4 * (PIXELS / 2 + WIDTH / 2)] > far_picture[4 * (PIXELS / 2 + WIDTH / 2) + 1]);
    hold_same("grid.nhdr", EWA_OCTREE_AUTO, 1, (far_place){.reads_left = -1});
    // What leads out of the folder, or has a drive, is looked for beside the file.
    static const char *const elsewhere[] = {"../a/voxels.raw", "C:\\data\\voxels.raw"};
    for (int i = 0; i < 2; i++) {
        char text[256];
        const int length = snprintf(text, sizeof text, HEADER "%s\n\n", elsewhere[i]);
        scratch_write(scratch_path("beside.nhdr", path), text, (size_t)length);
        hold_same("beside.nhdr", EWA_OCTREE_AUTO, 1, (far_place){.reads_left = -1});
    }
}

/// A name that leads out of the folder is not asked for, and none is where named files are not opened.
TEST(test_named_files) {
    static const char out[] = HEADER "../a/absent.raw\n\n";
    char path[512];
    scratch_write(scratch_path("out.nhdr", path), out, sizeof out - 1);
    for (int none = 0; none < 2; none++) {
        far_place place = {.reads_left = -1};
        check_log log = {0};
        WITH_DEFAULTS(ewa_context_options, options);
        options.message = check_log_keep, options.message_user = &log;
        options.open_file = open_far, options.open_file_user = &place;
        options.named_files = none ? EWA_NAMED_NONE : EWA_NAMED_BELOW;
        OWNED(ewa_context_destroy) ewa_context *context = NULL;
        ewa_scene *scene;
        assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
        assert_int_not_equal(load(context, far_path(none ? "grid.nhdr" : "out.nhdr", path), EWA_OCTREE_AUTO, &scene), EWA_OK);
        assert_non_null(strstr(log.text, none ? "named_files none" : "not there"));
        assert_false(place.others);
    }
}

/// Loads and draws; what fails says where, and leaves nothing behind.
static ewa_status try_far(const char *name, far_place *place, check_log *log) {
    char path[512];
    check_memory memory = {.calls_left = -1};
    OWNED(ewa_context_destroy) ewa_context *context = far_context(place, log, &memory);
    const int64_t before = memory.held_bytes;
    ewa_scene *scene;
    ewa_status status = load(context, far_path(name, path), EWA_OCTREE_ALWAYS, &scene);
    if (status == EWA_OK) status = draw(context, scene, 20, far_picture);
    ewa_scene_destroy(&scene);
    assert_int_equal(place->opened_count, place->closed_count);
    assert_int_equal(memory.held_bytes, before);
    return status;
}

static void hold_failure(const char *name, far_place place, const char *reason) {
    check_log log = {0};
    assert_int_equal(try_far(name, &place, &log), EWA_ERROR_IO);
    if (!strstr(log.text, far) || !strstr(log.text, ": bytes ") || !strstr(log.text, reason)) fail_msg("%s", log.text);
}

/// The first, the second, ... reading and all after it fail, until none does.
TEST(test_failures) {
    static const char *const names[] = {octree, "red.obj"};
    for (int i = 0; i < 2; i++) {
        int failed = 0;
        for (long nth = 0;; nth++) {
            far_place place = {.reads_left = nth};
            check_log log = {0};
            const ewa_status status = try_far(names[i], &place, &log);
            if (!place.failed) {
                assert_int_equal(status, EWA_OK);
                break;
            }
            // A library of materials that is missing is a warning.
            if (status == EWA_OK && i == 1) continue;
            if (status != EWA_ERROR_IO) fail_msg("%ld: %s", nth, log.text);
            assert_non_null(strstr(log.text, far));
            failed++;
        }
        print_message("%s: %d readings that failed\n", names[i], failed);
        assert_true(failed > 0);
    }
}

TEST(test_lies) {
    hold_failure(points, (far_place){.reads_left = -1, .more_bytes = 1000}, "shorter than it was said to be");
    hold_failure(points, (far_place){.reads_left = -1, .more_bytes = 1 << 20}, "shorter than it was said to be");
    hold_failure(points, (far_place){.reads_left = -1, .says_too_much = true}, "more came than were asked for");
    check_log log = {0};
    far_place endless = {.reads_left = -1, .more_bytes = UINT64_C(1) << 62};
    assert_int_equal(try_far(points, &endless, &log), EWA_ERROR_LIMIT);
    far_place stopped = {.reads_left = -1, .stops = true};
    assert_int_equal(try_far(points, &stopped, &log), EWA_CANCELLED);
}

static bool open_without_reader(void *user, const char *path, ewa_file_source *source) {
    source->size_bytes = 100;
    return true;
}

TEST(test_no_reader) {
    check_log log = {0};
    WITH_DEFAULTS(ewa_context_options, options);
    options.message = check_log_keep, options.message_user = &log;
    options.open_file = open_without_reader;
    OWNED(ewa_context_destroy) ewa_context *context = NULL;
    ewa_cloud *cloud;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    assert_int_equal(ewa_cloud_load(context, "any.ply", &cloud), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log.text, "any.ply"));
}

int main(void) { return RUN_TESTS(enter, leave); }
