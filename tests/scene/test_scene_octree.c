// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Octrees in scenes that are moved, coloured, filtered: what is drawn of their nodes is what is drawn of a cloud of the
// same points, and nothing of it stays when they are drawn as they are.
#include "lod/lod_scene.h"

#include <math.h>

enum { WIDTH = 160, HEIGHT = 120, PIXELS = WIDTH * HEIGHT, POINTS = 150000 };

static const char file[] = "ground.copc.laz", points[] = "ground.ply";

/// A turn about an axis that is none of the coordinates', twice as large, and away.
static const double turned[16] = {2.0 / 3, -4.0 / 3, 4.0 / 3, 3,  4.0 / 3, -2.0 / 3, -4.0 / 3, -5,
                                  4.0 / 3, 4.0 / 3,  2.0 / 3, 40, 0,       0,        0,        1};
/// The same in a mirror, and flattened.
static const double mirrored[16] = {-2.0 / 3, -4.0 / 3, 2.0 / 3, 3,  -4.0 / 3, -2.0 / 3, -2.0 / 3, -5,
                                    -4.0 / 3, 4.0 / 3,  1.0 / 3, 40, 0,        0,        0,        1};

typedef struct picture {
    ewa_scene_stats stats;
    uint8_t rgba8[4 * PIXELS];
    float depth[PIXELS];
} picture;

static picture first, second, third;

/// One octree, and its points as a cloud, for all tests.
static int enter(void **state) {
    static const char *const names[] = {points};
    lod_clear();
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    ewa_cloud *cloud = lod_ground(context, 0, POINTS, (lod_look){true, true});
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    void *data = NULL, *classes = NULL, *other = NULL;
    assert_int_equal(ewa_cloud_add(cloud, "intensity", EWA_U16, 1, &data), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, "classification", EWA_U8, 1, &classes), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, "user_data", EWA_U8, 1, &other), EWA_OK);
    for (uint64_t i = 0; i < POINTS; i++) {
        double p[3];
        ewa_attribute_read_f64(position, i, 1, p);
        ((uint16_t *)data)[i] = (uint16_t)(30000 + 10000 * (p[0] + p[1]));
        ((uint8_t *)classes)[i] = p[0] + 2 * p[1] < 0.3 ? 2 : p[0] < 0.2 ? 5 : 6;
        ((uint8_t *)other)[i] = (uint8_t)(2 * (p[0] + 1));
    }
    // With curvatures that the file says: those that an octree measures, piece by piece, are like those of a scene.
    WITH_DEFAULTS(ewa_estimate_options, estimate);
    assert_int_equal(ewa_cloud_estimate(&cloud, &estimate), EWA_OK);
    assert_non_null(ewa_cloud_find(cloud, EWA_CURVATURE));
    lod_save(cloud, points);
    assert_int_equal(lod_build(context, names, 1, file, NULL, NULL), EWA_OK);
    return 0;
}

static int leave(void **state) {
    lod_clear();
    return 0;
}

static ewa_asset_options asset_options(const double to_world[16]) {
    WITH_DEFAULTS(ewa_asset_options, options);
    options.levels = EWA_OCTREE_ALWAYS;
    if (to_world) memcpy(options.to_world, to_world, sizeof options.to_world);
    return options;
}

/// A scene of the octree, or of the cloud.
static ewa_scene *make_scene(ewa_context *context, const char *name, const ewa_asset_options *options) {
    char path[512];
    OWNED(ewa_asset_release) ewa_asset *asset = NULL;
    ewa_scene *scene = NULL;
    WITH_DEFAULTS(ewa_scene_options, of);
    of.close_gaps = false; // the radii of both are those of the file
    assert_int_equal(ewa_asset_load(context, scratch_path(name, path), options, &asset), EWA_OK);
    assert_int_equal(ewa_scene_create(context, &of, &scene), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
    return scene;
}

static ewa_camera place(ewa_scene *scene) {
    WITH_DEFAULTS(ewa_view_options, options);
    options.width_px = WIDTH, options.height_px = HEIGHT;
    ewa_camera camera;
    assert_int_equal(ewa_scene_place_camera(scene, &options, &camera, NULL), EWA_OK);
    return camera;
}

static ewa_status try_draw(ewa_context *context, ewa_scene *scene, const ewa_camera *camera, double error,
                           picture *to) {
    ewa_scene_renderer *renderer = NULL;
    ewa_scene_options options;
    ewa_scene_get_options(scene, &options);
    options.lod.error = error;
    options.lod.spacing_px = 4;                // the picture is small
    options.render.shading = EWA_SHADING_NONE; // so that only places and colours differ
    options.render.supersampling = 1;
    assert_int_equal(ewa_scene_renderer_create(context, EWA_BACKEND_CPU, NULL, &renderer), EWA_OK);
    const ewa_frame frame = {.rgba8 = to->rgba8, .depth = to->depth};
    const ewa_status status = ewa_scene_draw(scene, renderer, camera, &options, &frame, &to->stats);
    ewa_scene_renderer_destroy(&renderer);
    return status;
}

static void draw(ewa_context *context, ewa_scene *scene, const ewa_camera *camera, double error,
                 picture *to) {
    assert_int_equal(try_draw(context, scene, camera, error, to), EWA_OK);
}

static double psnr_db(const picture *a, const picture *b) {
    double sum = 0;
    for (int i = 0; i < 4 * PIXELS; i++) {
        const double off = (double)a->rgba8[i] - (double)b->rgba8[i];
        sum += off * off;
    }
    return sum > 0 ? 10 * log10(255.0 * 255 * 4 * PIXELS / sum) : (double)INFINITY;
}

static void hold_like(const char *what, const picture *a, const picture *b, double min_db) {
    const double found = psnr_db(a, b);
    print_message("%s: %.1f dB, %llu surfels\n", what, found, (unsigned long long)b->stats.lod.surfel_count);
    assert_true(found >= min_db);
}

static void set(ewa_scene *scene, const ewa_instance *instance) {
    assert_int_equal(ewa_scene_set(scene, 0, instance), EWA_OK);
}

/// What is done to the octree is done to the camera the other way round: cuts and places are those of its own space.
TEST_ON(test_moves_like_a_camera, 2) {
    const ewa_asset_options still = asset_options(NULL), moved = asset_options(turned);
    OWNED(ewa_scene_destroy)
    ewa_scene *scene = make_scene(context, file, &still), *away = make_scene(context, file, &moved);
    ewa_camera camera = place(scene);
    // From far away by a level of the root, whose groups follow the world's axes; nearer by a few nodes; nearest by all points.
    static const struct {
        const char *what;
        double nearer, least_db;
    } views[] = {{"moved, far", 1, 33}, {"moved", 2, 60}, {"moved, near", 10, 60}};
    for (int v = 0; v < 3; v++) {
        camera.fx_px *= views[v].nearer, camera.fy_px *= views[v].nearer;
        ewa_camera with = camera;
        ewa_mat4 map;
        memcpy(map.m, turned, sizeof turned);
        assert_int_equal(ewa_mat4_invert(&map, &map), EWA_OK);
        for (int r = 0; r < 4; r++)
            for (int c = 0; c < 4; c++) {
                double sum = 0;
                for (int k = 0; k < 4; k++) sum += camera.world_to_camera[4 * r + k] * map.m[k][c];
                with.world_to_camera[4 * r + c] = sum;
            }
        draw(context, scene, &camera, 16, &first);
        draw(context, away, &with, 16, &second);
        hold_like(views[v].what, &first, &second, views[v].least_db);
        for (int i = 0; i < PIXELS && v > 0; i++) {
            assert_int_equal(isfinite(first.depth[i]), isfinite(second.depth[i]));
            if (isfinite(first.depth[i])) assert_true(fabsf(first.depth[i] - second.depth[i]) < 1e-3f);
        }
    }
}

/// All points of the octree are those of the cloud, wherever both are put; its levels are like them.
TEST_ON(test_moves_like_a_cloud, 2) {
    const double *const maps[] = {turned, mirrored};
    for (int m = 0; m < 2; m++) {
        const ewa_asset_options options = asset_options(maps[m]);
        OWNED(ewa_scene_destroy)
        ewa_scene *octree = make_scene(context, file, &options),
                  *cloud = make_scene(context, points, &options);
        const ewa_camera camera = place(cloud);
        draw(context, cloud, &camera, 0, &first);
        draw(context, octree, &camera, 0, &second);
        draw(context, octree, &camera, 16, &third);
        hold_like("all points", &first, &second, 65);
        hold_like("levels", &first, &third, 38); // at contours each moves by its own size
        ewa_bounds boxes[2];
        ewa_scene_bounds(octree, &boxes[0]), ewa_scene_bounds(cloud, &boxes[1]);
        for (int c = 0; c < 3; c++) { // of the moved box, in which the moved points are
            assert_true(boxes[0].low_world[c] <= boxes[1].low_world[c] + 1e-5);
            assert_true(boxes[0].high_world[c] >= boxes[1].high_world[c] - 1e-5);
            assert_true(boxes[0].high_world[c] - boxes[0].low_world[c] < 9);
        }
    }
}

/// Colours by numbers, a tint, opacity, sizes: as the cloud's; and the old picture when all is as it was.
TEST_ON(test_instances, 2) {
    static const char *const attributes[] = {"z", "normal.x", "red", "intensity", "", ""};
    const ewa_asset_options options = asset_options(turned);
    OWNED(ewa_scene_destroy)
    ewa_scene *octree = make_scene(context, file, &options), *cloud = make_scene(context, points, &options);
    const ewa_camera camera = place(cloud);
    draw(context, octree, &camera, 0, &third);
    for (int k = 0; k < 6; k++) {
        WITH_DEFAULTS(ewa_instance, instance);
        snprintf(instance.coloring.attribute, sizeof instance.coloring.attribute, "%s", attributes[k]);
        instance.coloring.ranged = instance.coloring.percent[0] = k == 1; // of all, and of given ends
        instance.coloring.range[1] = 0.3;
        instance.coloring.tinted = k == 4;
        instance.coloring.tint[1] = 0.75;
        if (k > 3) instance.opacity = 0.5, instance.radius_scale = 1.5;
        set(octree, &instance), set(cloud, &instance);
        draw(context, cloud, &camera, 0, &first);
        draw(context, octree, &camera, 0, &second);
        hold_like(attributes[k], &first, &second, 65);
        assert_true(psnr_db(&second, &third) < 40);
        if (k == 3) continue; // what represents points has none
        draw(context, octree, &camera, 16, &second);
        hold_like("its levels", &first, &second, k < 4 ? 38 : 33); // whose rims are wider
        assert_true((ewa_scene_legend(octree, 0) != NULL) == (k < 4));
    }
    WITH_DEFAULTS(ewa_instance, plain);
    set(octree, &plain);
    draw(context, octree, &camera, 0, &second);
    assert_memory_equal(second.rgba8, third.rgba8, sizeof second.rgba8);
}

/// A scale is one for a cloud and an octree that are coloured alike.
TEST_ON(test_one_scale, 1) {
    const ewa_asset_options still = asset_options(NULL), away = asset_options(turned);
    OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene(context, file, &still);
    OWNED(ewa_asset_release) ewa_asset *cloud = NULL;
    char path[512];
    WITH_DEFAULTS(ewa_instance, instance);
    snprintf(instance.coloring.attribute, sizeof instance.coloring.attribute, "z");
    assert_int_equal(ewa_asset_load(context, scratch_path(points, path), &away, &cloud), EWA_OK);
    set(scene, &instance);
    assert_int_equal(ewa_scene_commit(scene), EWA_OK);
    const ewa_legend *legend = ewa_scene_legend(scene, 0);
    assert_true(legend->length && fabs(legend->range[0] + 0.1) < 0.01 && fabs(legend->range[1] - 0.1) < 0.01);
    assert_int_equal(ewa_scene_add(scene, cloud, &instance), EWA_OK);
    assert_int_equal(ewa_scene_commit(scene), EWA_OK);
    legend = ewa_scene_legend(scene, 0);
    assert_ptr_equal(legend, ewa_scene_legend(scene, 1));
    assert_true(fabs(legend->range[0] + 0.1) < 0.01 && legend->range[1] > 41);
}

/// A filter takes the points that it takes of a cloud, in the octree's own space.
TEST_ON(test_filters, 2) {
    static const char *const terms[] = {"x > 0.25 and normal.z > 0.97", "intensity < 30000",
                                        "classification < 6", "user_data < 3"};
    for (int k = 0; k < 4; k++) {
        ewa_filter filter = {.term_count = 0};
        assert_int_equal(ewa_filter_add(&filter, terms[k], NULL), EWA_OK);
        ewa_asset_options options = asset_options(turned);
        options.filter = &filter;
        OWNED(ewa_scene_destroy)
        ewa_scene *octree = make_scene(context, file, &options),
                  *cloud = make_scene(context, points, &options);
        const ewa_camera camera = place(cloud);
        draw(context, cloud, &camera, 0, &first);
        draw(context, octree, &camera, 0, &second);
        hold_like(terms[k], &first, &second, 65);
        if (k < 3) {
            draw(context, octree, &camera, 16, &second);
            hold_like("by levels", &first, &second, 33);
            assert_true(second.stats.lod.surfel_count < POINTS * 3 / 4); // of some, near by
        } else {
            assert_int_equal(try_draw(context, octree, &camera, 16, &second), EWA_ERROR_UNSUPPORTED);
        }
    }
    // One that takes nothing of the points that stand for the whole leaves nothing to see, and a camera.
    ewa_filter none = {.term_count = 0};
    assert_int_equal(ewa_filter_add(&none, "x > 5", NULL), EWA_OK);
    ewa_asset_options options = asset_options(NULL);
    options.filter = &none;
    OWNED(ewa_scene_destroy) ewa_scene *empty = make_scene(context, file, &options);
    const ewa_camera camera = place(empty);
    draw(context, empty, &camera, 16, &first);
    for (int i = 0; i < PIXELS; i++) assert_true(isinf(first.depth[i]));
}

/// Of points that a filter takes here and there, what they sum up to is theirs: they cover as much as those of a cloud.
TEST_ON(test_few_of_many, 2) {
    static const char strewn_points[] = "strewn.ply", strewn_file[] = "strewn.copc.laz";
    static const char *const names[] = {strewn_points};
    ewa_cloud *made = lod_ground(context, 0, POINTS, (lod_look){true, true});
    void *classes = NULL;
    assert_int_equal(ewa_cloud_add(made, "classification", EWA_U8, 1, &classes), EWA_OK);
    for (uint64_t i = 0; i < POINTS; i++) ((uint8_t *)classes)[i] = i % 16 ? 2 : 9;
    WITH_DEFAULTS(ewa_estimate_options, estimate);
    assert_int_equal(ewa_cloud_estimate(&made, &estimate), EWA_OK);
    lod_save(made, strewn_points);
    assert_int_equal(lod_build(context, names, 1, strewn_file, NULL, NULL), EWA_OK);
    ewa_filter filter = {.term_count = 0};
    assert_int_equal(ewa_filter_add(&filter, "classification = 9", NULL), EWA_OK);
    ewa_asset_options options = asset_options(NULL);
    options.filter = &filter;
    OWNED(ewa_scene_destroy)
    ewa_scene *octree = make_scene(context, strewn_file, &options), *cloud = make_scene(context, strewn_points, &options);
    const ewa_camera camera = place(cloud);
    draw(context, cloud, &camera, 0, &first);
    draw(context, octree, &camera, 16, &second);
    hold_like("strewn", &first, &second, 36);
}

/// What represents points is coloured by their attributes: like the cloud, each class in its own colour, the same bytes for threads.
TEST(test_attributes_of_levels) {
    static const char *const words[] = {"intensity", "classification"};
    for (int k = 0; k < 2; k++) {
        for (uint32_t threads = 1; threads <= 3; threads += 2) {
            OWNED(ewa_context_destroy) ewa_context *context = check_context(threads, NULL);
            const ewa_asset_options options = asset_options(NULL);
            OWNED(ewa_scene_destroy)
            ewa_scene *octree = make_scene(context, file, &options), *cloud = make_scene(context, points, &options);
            const ewa_camera camera = place(cloud);
            WITH_DEFAULTS(ewa_instance, instance);
            snprintf(instance.coloring.attribute, sizeof instance.coloring.attribute, "%s", words[k]);
            set(octree, &instance), set(cloud, &instance);
            draw(context, cloud, &camera, 0, &first);
            draw(context, octree, &camera, 16, &second);
            hold_like(words[k], &first, &second, 33);
            assert_true(second.stats.lod.surfel_count < POINTS / 4);
            if (threads == 1) third = second;
            assert_memory_equal(third.rgba8, second.rgba8, sizeof third.rgba8);
            draw(context, octree, &camera, 0, &second);
            hold_like("all points", &first, &second, 65);
        }
    }
}

/// Whoever makes an octree chooses what its levels have; what is no attribute of the points is refused.
TEST(test_choice_of_attributes) {
    static const char *const names[] = {points};
    static const struct {
        const char *list, *made;
        ewa_status status;
    } cases[] = {{NULL, "classification,intensity", EWA_OK}, {"", "", EWA_OK},
                 {"user_data,User_Data,intensity", "user_data,intensity", EWA_OK}, {"user_data,", "user_data", EWA_OK},
                 {"warmth", NULL, EWA_ERROR_ARGUMENT}, {"normal", NULL, EWA_ERROR_ARGUMENT}, {"x", NULL, EWA_ERROR_ARGUMENT},
                 {",user_data", NULL, EWA_ERROR_ARGUMENT}};
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, &log);
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        WITH_DEFAULTS(ewa_lod_build_options, options);
        options.memory_bytes = LOD_MEMORY_BYTES;
        options.attributes = cases[k].list;
        assert_int_equal(lod_build(context, names, 1, "chosen.copc.laz", &options, NULL), cases[k].status);
        assert_int_equal(log.count > 0, cases[k].status != EWA_OK);
        log = (check_log){.count = 0};
        if (cases[k].status != EWA_OK) continue;
        char path[512], found[256] = "";
        ewa_lod *lod = NULL;
        ewa_lod_info info;
        assert_int_equal(ewa_lod_open(context, scratch_path("chosen.copc.laz", path), &lod), EWA_OK);
        ewa_lod_describe(lod, &info);
        assert_non_null(ewa_cloud_find(info.represented, EWA_CURVATURE));
        for (uint32_t a = 5; a < ewa_cloud_attribute_count(info.represented); a++)
            strcat(strcat(found, a > 5 ? "," : ""), ewa_cloud_attribute_at(info.represented, a)->name);
        assert_string_equal(found, cases[k].made);
        ewa_lod_close(&lod);
        unlink(path);
    }
}

/// What cannot be is refused with the file's name, and leaves the octree as it was.
TEST_LOGGED(test_refused, 1) {
    const ewa_asset_options options = asset_options(NULL);
    OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene(context, file, &options);
    const ewa_camera camera = place(scene);
    draw(context, scene, &camera, 16, &first);
    WITH_DEFAULTS(ewa_instance, instance);
    snprintf(instance.coloring.attribute, sizeof instance.coloring.attribute, "user_data");
    set(scene, &instance);
    assert_int_equal(try_draw(context, scene, &camera, 16, &second), EWA_ERROR_UNSUPPORTED);
    assert_non_null(
        strstr(log->text, "ground.copc.laz: what represents points at its levels has no user_data"));
    draw(context, scene, &camera, 0, &second);
    snprintf(instance.coloring.attribute, sizeof instance.coloring.attribute, "warmth");
    set(scene, &instance);
    assert_int_equal(try_draw(context, scene, &camera, 0, &second), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "warmth"));
    ewa_instance_init(&instance, sizeof instance);
    set(scene, &instance);
    draw(context, scene, &camera, 16, &second);
    assert_memory_equal(first.rgba8, second.rgba8, sizeof first.rgba8);
}

/// Picks find points where they were moved to.
TEST_ON(test_pick, 1) {
    const ewa_asset_options options = asset_options(turned);
    OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene(context, file, &options);
    const ewa_camera camera = place(scene);
    OWNED(ewa_scene_renderer_destroy) ewa_scene_renderer *renderer = NULL;
    assert_int_equal(ewa_scene_renderer_create(context, EWA_BACKEND_CPU, NULL, &renderer), EWA_OK);
    ewa_scene_hit hit;
    assert_int_equal(ewa_scene_pick(scene, renderer, &camera, NULL, WIDTH / 2, HEIGHT / 2, 2, 0.1, &hit),
                     EWA_OK);
    assert_true(hit.hit && hit.has_point && hit.points);
    double back[3], away[3], height = 0;
    for (int c = 0; c < 3; c++) away[c] = hit.point_world[c] - turned[4 * c + 3];
    for (int c = 0; c < 3; c++) // the map is a rotation times 2: its inverse is its transpose over 4
        back[c] = (turned[c] * away[0] + turned[4 + c] * away[1] + turned[8 + c] * away[2]) / 4;
    height = 0.1 * sin(4 * back[0]) * cos(3 * back[1]); // of the ground that the octree was made of
    assert_true(fabs(back[2] - height) < 1e-5 && fabs(back[0]) <= 1 && fabs(back[1]) <= 1);
    ewa_cloud_destroy(&hit.points);
}

/// An octree that is lent to a scene is drawn as it is where nobody says otherwise.
TEST_ON(test_lent, 1) {
    char path[512];
    OWNED(ewa_lod_close) ewa_lod *lod = NULL;
    assert_int_equal(ewa_lod_open(context, scratch_path(file, path), &lod), EWA_OK);
    const ewa_asset_options options = asset_options(turned);
    OWNED(ewa_asset_release) ewa_asset *asset = NULL;
    OWNED(ewa_scene_destroy) ewa_scene *scene = NULL;
    assert_int_equal(ewa_scene_create(context, NULL, &scene), EWA_OK);
    assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.lod = lod}, &options, &asset), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
    const ewa_camera camera = place(scene);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    ewa_frame frame = {.rgba8 = third.rgba8};
    assert_int_equal(ewa_lod_render(lod, renderer, &camera, NULL, NULL, &frame, NULL), EWA_OK);
    draw(context, scene, &camera, 16, &first);
    frame.rgba8 = second.rgba8;
    assert_int_equal(ewa_lod_render(lod, renderer, &camera, NULL, NULL, &frame, NULL), EWA_OK);
    assert_memory_equal(second.rgba8, third.rgba8, sizeof second.rgba8);
    assert_true(psnr_db(&first, &second) < 30);
}

/// Adds one octree in two places, and in one of them once more in another colour: of one that is lent, or of files that
/// are opened for themselves.
static void add_three(ewa_context *context, ewa_scene *scene, ewa_lod *lent) {
    char path[512];
    OWNED(ewa_asset_release) ewa_asset *asset = NULL;
    WITH_DEFAULTS(ewa_instance, instance);
    for (int i = 0; i < 3; i++) {
        const ewa_asset_options options = asset_options(i ? turned : NULL);
        if (i < 2 || !lent) ewa_asset_release(&asset);
        if (lent && i < 2)
            assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.lod = lent}, &options, &asset), EWA_OK);
        else if (!lent)
            assert_int_equal(ewa_asset_load(context, scratch_path(file, path), &options, &asset), EWA_OK);
        instance.coloring.tinted = i == 2, instance.coloring.tint[0] = 0.25;
        assert_int_equal(ewa_scene_add(scene, asset, &instance), EWA_OK);
    }
}

/// One octree several times in a scene is drawn as octrees of their own are, whichever of them can be seen.
TEST_ON(test_several_times, 1) {
    char path[512];
    OWNED(ewa_lod_close) ewa_lod *lod = NULL;
    OWNED(ewa_scene_destroy) ewa_scene *shared = NULL, *apart = NULL;
    assert_int_equal(ewa_lod_open(context, scratch_path(file, path), &lod), EWA_OK);
    assert_int_equal(ewa_scene_create(context, NULL, &shared), EWA_OK);
    assert_int_equal(ewa_scene_create(context, NULL, &apart), EWA_OK);
    add_three(context, shared, lod), add_three(context, apart, NULL);
    const ewa_camera camera = place(apart);
    for (int hidden = 3; hidden >= 0; hidden--) { // all three at first
        for (uint32_t i = 0; i < 3; i++) {
            ewa_instance instance;
            assert_int_equal(ewa_scene_get(shared, i, &instance), EWA_OK);
            instance.visible = (int)i != hidden;
            assert_int_equal(ewa_scene_set(shared, i, &instance), EWA_OK);
            assert_int_equal(ewa_scene_set(apart, i, &instance), EWA_OK);
        }
        draw(context, shared, &camera, 16, &first);
        draw(context, apart, &camera, 16, &second);
        assert_memory_equal(first.rgba8, second.rgba8, sizeof first.rgba8);
        assert_memory_equal(first.depth, second.depth, sizeof first.depth);
        assert_int_equal(first.stats.lod.surfel_count, second.stats.lod.surfel_count);
        if (hidden == 3) third = first;
        if (hidden < 3) assert_true(psnr_db(&first, &third) < 60);
    }
}

int main(void) { return RUN_TESTS(enter, leave); }
