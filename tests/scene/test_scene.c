// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scenes: what is added is what was merged before, whatever the order; tiles without normals are one file; every plane is
// of everything; what is shared stays right; what cannot be is refused.
#include "check.h"

#include <math.h>

enum { WIDTH = 96, HEIGHT = 72, PIXELS = WIDTH * HEIGHT, POINTS = 6000 };

/// All planes of a picture.
typedef struct planes {
    uint8_t rgba8[4 * PIXELS];
    float rgba[4 * PIXELS], depth[PIXELS], normal[3 * PIXELS], coverage[PIXELS];
} planes;

static planes first, second;

static ewa_cloud *make_object(ewa_context *context, ewa_object object, double shift_world) {
    ewa_generate_options options;
    ewa_generate_options_init(&options, sizeof options);
    options.object = object;
    options.point_count = POINTS;
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_generate(context, &options, &cloud), EWA_OK);
    const double to_world[16] = {1, 0, 0, shift_world, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    assert_int_equal(ewa_cloud_transform(cloud, to_world), EWA_OK);
    return cloud;
}

/// The points of a cloud for which `side` is true, positions alone.
static ewa_cloud *bare_part(ewa_context *context, const ewa_cloud *from,
                            bool (*side)(uint64_t, const double *)) {
    const uint64_t count = ewa_cloud_point_count(from);
    const ewa_attribute *position = ewa_cloud_find(from, EWA_POSITION);
    uint64_t kept = 0, at = 0;
    double p[3];
    for (uint64_t i = 0; i < count; i++) {
        ewa_attribute_read_f64(position, i, 1, p);
        kept += side(i, p);
    }
    ewa_cloud *cloud = NULL;
    void *data = NULL;
    assert_int_equal(ewa_cloud_create(context, kept, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, &data), EWA_OK);
    for (uint64_t i = 0; i < count; i++) {
        ewa_attribute_read_f64(position, i, 1, p);
        if (side(i, p)) memcpy((double *)data + 3 * at++, p, sizeof p);
    }
    return cloud;
}

static void add_cloud(ewa_context *context, ewa_scene *scene, const ewa_cloud *cloud,
                      const ewa_instance *instance) {
    ewa_asset *asset = NULL;
    assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.cloud = cloud}, NULL, &asset), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, instance), EWA_OK);
    ewa_asset_release(&asset);
}

static void draw(ewa_context *context, ewa_scene *scene, const ewa_camera *camera, planes *to) {
    ewa_scene_renderer *renderer = NULL;
    assert_int_equal(ewa_scene_renderer_create(context, EWA_BACKEND_CPU, NULL, &renderer), EWA_OK);
    const ewa_frame frame = {to->rgba8, to->rgba, to->depth, to->normal, to->coverage};
    assert_int_equal(ewa_scene_draw(scene, renderer, camera, NULL, &frame, NULL), EWA_OK);
    ewa_scene_renderer_destroy(&renderer);
}

static ewa_scene *make_scene(ewa_context *context) {
    ewa_scene *scene = NULL;
    assert_int_equal(ewa_scene_create(context, NULL, &scene), EWA_OK);
    return scene;
}

/// A scene of one object, and the object's cloud.
static ewa_scene *make_scene_of(ewa_context *context, ewa_object object, ewa_cloud **cloud) {
    ewa_scene *scene = make_scene(context);
    *cloud = make_object(context, object, 0);
    add_cloud(context, scene, *cloud, NULL);
    return scene;
}

static ewa_camera place(ewa_scene *scene) {
    ewa_view_options options;
    ewa_view_options_init(&options, sizeof options);
    options.width_px = WIDTH;
    options.height_px = HEIGHT;
    ewa_camera camera;
    assert_int_equal(ewa_scene_place_camera(scene, &options, &camera, NULL), EWA_OK);
    return camera;
}

TEST_ON(test_added_is_merged, 0) {
    ewa_cloud *clouds[2] = {make_object(context, EWA_OBJECT_TORUS, 0),
                            make_object(context, EWA_OBJECT_SPHERE, 1.25)};
    ewa_cloud *merged = NULL;
    assert_int_equal(ewa_cloud_merge((const ewa_cloud *const *)clouds, 2, &merged), EWA_OK);
    ewa_scene *one = make_scene(context), *two = make_scene(context), *turned = make_scene(context);
    add_cloud(context, one, merged, NULL);
    for (int i = 0; i < 2; i++) {
        add_cloud(context, two, clouds[i], NULL);
        add_cloud(context, turned, clouds[1 - i], NULL);
    }
    const ewa_camera camera = place(one), again = place(two);
    assert_memory_equal(&camera, &again, sizeof camera);
    draw(context, one, &camera, &first);
    draw(context, two, &camera, &second);
    assert_memory_equal(&first, &second, sizeof first);
    draw(context, turned, &camera, &second);
    assert_memory_equal(&first, &second, sizeof first);
    assert_true(isfinite(first.depth[PIXELS / 2 + WIDTH / 2]) || isfinite(first.depth[PIXELS / 2]));
    ewa_scene_destroy(&one), ewa_scene_destroy(&two), ewa_scene_destroy(&turned);
    ewa_cloud_destroy(&clouds[0]), ewa_cloud_destroy(&clouds[1]), ewa_cloud_destroy(&merged);
}

static bool all(uint64_t i, const double *p) { return (void)i, (void)p, true; }

/// How points are divided among files: tiles of a survey, scans of one place whose points lie between each other.
typedef enum division { HALVES, QUADRANTS, TWO_SCANS, FIVE_SCANS, DIVISIONS } division;
static const int part_counts[DIVISIONS] = {2, 4, 2, 5};
static division divided;
static int part;

static bool is_in_part(uint64_t i, const double *p) {
    const int tile = (p[0] >= 0) + 2 * (divided == QUADRANTS && p[1] >= 0);
    return (divided <= QUADRANTS ? tile : (int)(i % (uint64_t)part_counts[divided])) == part;
}

static double psnr(const planes *a, const planes *b) {
    double sum = 0;
    for (int i = 0; i < 4 * PIXELS; i++) {
        const double d = (double)a->rgba[i] - (double)b->rgba[i];
        sum += d * d;
    }
    return sum > 0 ? 10 * log10(4 * PIXELS / sum) : INFINITY;
}

static double largest_difference(const planes *a, const planes *b) {
    double largest = 0;
    for (int i = 0; i < 4 * PIXELS; i++)
        largest = fmax(largest, fabs((double)a->rgba[i] - (double)b->rgba[i]));
    return largest;
}

/// Tiles and interleaved scans of one place are the picture of the one file. Not to the byte: among neighbours that are
/// equally far, as on the regular grid of a torus, the numbering of points decides which ones count.
TEST_ON(test_estimated_together, 0) {
    ewa_cloud *object = make_object(context, EWA_OBJECT_TORUS, 0), *whole = bare_part(context, object, all);
    ewa_scene *one = make_scene(context);
    add_cloud(context, one, whole, NULL);
    const ewa_camera camera = place(one);
    draw(context, one, &camera, &first);
    for (divided = HALVES; divided < DIVISIONS; divided++) {
        ewa_scene *many = make_scene(context);
        ewa_cloud *parts[5] = {NULL};
        for (part = 0; part < part_counts[divided]; part++) {
            parts[part] = bare_part(context, object, is_in_part);
            add_cloud(context, many, parts[part], NULL);
        }
        draw(context, many, &camera, &second);
        // A seam would be a few pixels that differ by much.
        const double equal_db = psnr(&first, &second), largest = largest_difference(&first, &second);
        if (!(equal_db >= 90 && largest < 0.004))
            fail_msg("division %d: %g dB, %g", (int)divided, equal_db, largest);
        ewa_scene_info info;
        ewa_scene_describe(many, &info);
        assert_int_equal(info.estimated_count, ewa_cloud_point_count(whole));
        ewa_scene_destroy(&many);
        for (int k = 0; k < 5; k++) ewa_cloud_destroy(&parts[k]);
    }
    ewa_scene_destroy(&one);
    ewa_cloud_destroy(&whole), ewa_cloud_destroy(&object);
}

/// Gaussians out of sight change none of the planes of a surface but where colours are rounded.
TEST_ON(test_planes_among_gaussians, 0) {
    ewa_cloud *cloud = make_object(context, EWA_OBJECT_SPHERE, 0);
    ewa_scene *scene = make_scene(context);
    add_cloud(context, scene, cloud, NULL);
    const ewa_camera camera = place(scene);
    draw(context, scene, &camera, &first);
    ewa_gaussians set;
    assert_int_equal(ewa_gaussians_create(context, 1, 0, &set), EWA_OK);
    for (int c = 0; c < 3; c++) set.centers[c] = 1000, set.scales[c] = 0.1f, set.harmonics[c] = 0;
    set.rotations[0] = 1, set.rotations[1] = set.rotations[2] = set.rotations[3] = 0;
    set.opacities[0] = 0.9f;
    ewa_asset *asset = NULL;
    assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.gaussians = &set}, NULL, &asset), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
    ewa_asset_release(&asset);
    ewa_gaussians_free(&set);
    draw(context, scene, &camera, &second);
    assert_memory_equal(first.depth, second.depth, sizeof first.depth);
    assert_memory_equal(first.normal, second.normal, sizeof first.normal);
    assert_memory_equal(first.coverage, second.coverage, sizeof first.coverage);
    ewa_scene_destroy(&scene);
    ewa_cloud_destroy(&cloud);
}

/// A hidden instance is not drawn, a tint is one colour, and a copy goes its own way.
TEST_ON(test_instances, 0) {
    ewa_cloud *clouds[2] = {make_object(context, EWA_OBJECT_TORUS, 0),
                            make_object(context, EWA_OBJECT_SPHERE, 1.25)};
    ewa_scene *scene = make_scene(context), *alone = make_scene(context), *copy = NULL;
    for (int i = 0; i < 2; i++) add_cloud(context, scene, clouds[i], NULL);
    add_cloud(context, alone, clouds[0], NULL);
    const ewa_camera camera = place(scene);
    ewa_bounds box;
    ewa_scene_bounds(scene, &box); // of a torus about 0 and a unit sphere about 1.25
    assert_true(fabs(box.low_world[0] + 1) < 0.05 && fabs(box.high_world[0] - 2.25) < 0.05);
    assert_true(fabs(box.high_world[1] - 1) < 0.05 && fabs(box.high_world[2] - 1) < 0.05);
    assert_int_equal(ewa_scene_commit(scene), EWA_OK);
    assert_int_equal(ewa_scene_copy(scene, context, &copy), EWA_OK);
    ewa_instance instance;
    assert_int_equal(ewa_scene_get(copy, 1, &instance), EWA_OK);
    instance.visible = false;
    assert_int_equal(ewa_scene_set(copy, 1, &instance), EWA_OK);
    draw(context, alone, &camera, &first);
    draw(context, copy, &camera, &second);
    assert_memory_equal(&first, &second, sizeof first);
    draw(context, scene, &camera, &second);
    assert_memory_not_equal(first.rgba8, second.rgba8, sizeof first.rgba8);
    assert_int_equal(ewa_scene_get(copy, 0, &instance), EWA_OK);
    instance.coloring.tinted = true;
    instance.coloring.tint[0] = 1;
    assert_int_equal(ewa_scene_set(copy, 0, &instance), EWA_OK);
    draw(context, copy, &camera, &second);
    int red = 0;
    for (int i = 0; i < PIXELS; i++) {
        if (!(second.coverage[i] >= 1)) continue;
        red += second.rgba8[4 * i] > 0;
        assert_int_equal(second.rgba8[4 * i + 1], second.rgba8[4 * i + 2]);
    }
    assert_true(red > 100);
    ewa_scene_destroy(&scene), ewa_scene_destroy(&alone), ewa_scene_destroy(&copy);
    ewa_cloud_destroy(&clouds[0]), ewa_cloud_destroy(&clouds[1]);
}

/// A range is one for all clouds that are coloured alike, and percentiles are those of all their numbers.
TEST_ON(test_one_range, 0) {
    ewa_cloud *clouds[2];
    for (int k = 0; k < 2; k++) {
        void *data = NULL;
        assert_int_equal(ewa_cloud_create(context, 51, &clouds[k]), EWA_OK);
        assert_int_equal(ewa_cloud_add(clouds[k], EWA_POSITION, EWA_F64, 3, &data), EWA_OK);
        memset(data, 0, 51 * 3 * sizeof(double));
        assert_int_equal(ewa_cloud_add(clouds[k], "height", EWA_F64, 1, &data), EWA_OK);
        for (int i = 0; i < 51; i++) ((double *)data)[i] = 2 * i + k; // 0 to 101, all of them
    }
    ewa_coloring coloring;
    ewa_coloring_init(&coloring, sizeof coloring);
    snprintf(coloring.attribute, sizeof coloring.attribute, "height");
    ewa_legend legend;
    assert_int_equal(ewa_clouds_color(clouds, 2, &coloring, &legend), EWA_OK);
    assert_true(legend.range[0] == 0 && legend.range[1] == 101);
    ewa_legend_free(&legend);
    coloring.ranged = coloring.percent[0] = coloring.percent[1] = true;
    coloring.range[0] = 10, coloring.range[1] = 50;
    assert_int_equal(ewa_clouds_color(clouds, 2, &coloring, &legend), EWA_OK);
    // Ranks 10.1 and 50.5 of 0 to 101, rounded to the nearest.
    assert_true(legend.range[0] == 10 && legend.range[1] == 51);
    ewa_legend_free(&legend);
    ewa_cloud_destroy(&clouds[0]), ewa_cloud_destroy(&clouds[1]);
}

TEST(test_refused) {
    check_log log = {.count = 0};
    ewa_context *context = check_context(1, &log);
    ewa_cloud *cloud = make_object(context, EWA_OBJECT_PLANE, 0);
    ewa_scene *scene = make_scene(context);
    ewa_asset_options options;
    ewa_asset_options_init(&options, sizeof options);
    ewa_asset *asset = NULL;
    options.to_world[0] = 0;
    assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.cloud = cloud}, &options, &asset),
                     EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log.text, "determinant"));
    options.to_world[0] = NAN;
    assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.cloud = cloud}, &options, &asset),
                     EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.name = "x"}, NULL, &asset),
                     EWA_ERROR_ARGUMENT);
    assert_null(asset);
    assert_int_equal(ewa_asset_load(context, "/nowhere/there.ply", NULL, &asset), EWA_ERROR_IO);
    assert_non_null(strstr(log.text, "/nowhere/there.ply"));
    add_cloud(context, scene, cloud, NULL);
    ewa_instance instance;
    ewa_instance_init(&instance, sizeof instance);
    instance.opacity = 2;
    assert_int_equal(ewa_scene_set(scene, 0, &instance), EWA_ERROR_ARGUMENT);
    instance.opacity = 1;
    snprintf(instance.coloring.attribute, sizeof instance.coloring.attribute, "nothing");
    assert_int_equal(ewa_scene_set(scene, 0, &instance), EWA_OK);
    assert_int_equal(ewa_scene_commit(scene), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log.text, "points: there is no attribute 'nothing'"));
    instance.coloring.ranged = instance.coloring.percent[1] = true;
    instance.coloring.range[1] = 101;
    assert_int_equal(ewa_scene_set(scene, 0, &instance), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log.text, "101 is no percentile"));
    memset(instance.coloring.attribute, 'a', sizeof instance.coloring.attribute);
    instance.coloring.ranged = false;
    assert_int_equal(ewa_scene_set(scene, 0, &instance), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log.text, "attribute: a name has at most"));
    assert_int_equal(ewa_scene_remove(scene, 1), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_scene_remove(scene, 0), EWA_OK);
    ewa_scene_destroy(&scene);
    ewa_scene_destroy(&scene);
    ewa_cloud_destroy(&cloud);
    ewa_context_destroy(&context);
}

/// What was made for an asset that is gone is not taken for another one, which may lie in the same place of memory.
TEST_ON(test_another_asset, 1) {
    ewa_cloud *clouds[2] = {make_object(context, EWA_OBJECT_TORUS, 0), make_object(context, EWA_OBJECT_SPHERE, 0)};
    ewa_scene *scene = make_scene(context), *alone = make_scene(context);
    add_cloud(context, alone, clouds[1], NULL);
    const ewa_camera camera = place(alone);
    draw(context, alone, &camera, &first);
    for (int i = 0; i < 8; i++) {
        add_cloud(context, scene, clouds[i % 2], NULL);
        draw(context, scene, &camera, &second);
        assert_int_equal(memcmp(&first, &second, sizeof first) == 0, i % 2);
        assert_int_equal(ewa_scene_remove(scene, 0), EWA_OK);
    }
    ewa_scene_destroy(&scene), ewa_scene_destroy(&alone);
    ewa_cloud_destroy(&clouds[0]), ewa_cloud_destroy(&clouds[1]);
}

/// A thousand tiles without normals, each of which touches the next, in an order in which none comes after a neighbour: one
/// group, found before long.
TEST(test_chain_of_tiles) {
    enum { TILES = 1000, OF_TILE = 4 };
    check_log log = {.count = 0};
    ewa_context *context = check_context(1, &log);
    ewa_scene *scene = make_scene(context);
    static double places[TILES][OF_TILE][3];
    ewa_cloud *clouds[TILES];
    for (int t = 0; t < TILES; t++) {
        for (int k = 0; k < OF_TILE; k++) places[t][k][0] = t + 0.5 * (k & 1), places[t][k][1] = 0.5 * (k >> 1);
        assert_int_equal(ewa_cloud_create(context, OF_TILE, &clouds[t]), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(clouds[t], EWA_POSITION, EWA_F64, 3, places[t], sizeof places[t][0]), EWA_OK);
    }
    add_cloud(context, scene, clouds[0], NULL);
    for (int t = TILES; t-- > 1;) add_cloud(context, scene, clouds[t], NULL);
    assert_int_equal(ewa_scene_complete(scene), EWA_OK);
    ewa_scene_info info;
    ewa_scene_describe(scene, &info);
    assert_int_equal(info.estimated_count, TILES * OF_TILE);
    ewa_cloud *whole = NULL;
    assert_int_equal(ewa_scene_cloud(scene, &whole), EWA_OK);
    assert_int_equal(ewa_cloud_point_count(whole), TILES * OF_TILE);
    assert_true(ewa_cloud_is_drawable(whole));
    ewa_cloud_destroy(&whole);
    ewa_scene_destroy(&scene);
    for (int t = 0; t < TILES; t++) ewa_cloud_destroy(&clouds[t]);
    ewa_context_destroy(&context);
}

/// The cloud of a scene is what its surfels are made of: their picture is the scene's.
TEST(test_cloud_of_scene) {
    check_log log = {.count = 0};
    ewa_context *context = check_context(1, &log);
    ewa_cloud *clouds[2] = {make_object(context, EWA_OBJECT_TORUS, 0), make_object(context, EWA_OBJECT_SPHERE, 1.25)};
    ewa_scene *scene = make_scene(context), *of_cloud = make_scene(context);
    ewa_cloud *whole = NULL;
    assert_int_equal(ewa_scene_cloud(scene, &whole), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log.text, "shows no points"));
    for (int i = 0; i < 2; i++) {
        ewa_instance instance;
        ewa_instance_init(&instance, sizeof instance);
        instance.radius_scale = 1 + i;
        add_cloud(context, scene, clouds[i], &instance);
        assert_int_equal(ewa_scene_cloud(scene, &whole), EWA_OK);
        assert_int_equal(ewa_cloud_point_count(whole), POINTS * (1 + i));
        if (!i) ewa_cloud_destroy(&whole);
    }
    const ewa_camera camera = place(scene);
    draw(context, scene, &camera, &first);
    ewa_scene_destroy(&scene); // what was made of it stays
    ewa_cloud_destroy(&clouds[0]), ewa_cloud_destroy(&clouds[1]);
    add_cloud(context, of_cloud, whole, NULL);
    draw(context, of_cloud, &camera, &second);
    assert_memory_equal(&first, &second, sizeof first);
    ewa_scene_destroy(&of_cloud);
    ewa_cloud_destroy(&whole);
    ewa_context_destroy(&context);
}

/// Who puts things of different coordinates together is told.
TEST(test_far_apart) {
    const double shifts_world[2] = {900, 4e6};
    for (int i = 0; i < 2; i++) {
        check_log log = {.count = 0};
        ewa_context *context = check_context(1, &log);
        ewa_cloud *clouds[2] = {make_object(context, EWA_OBJECT_TORUS, 0),
                                make_object(context, EWA_OBJECT_SPHERE, shifts_world[i])};
        ewa_scene *scene = make_scene(context);
        for (int k = 0; k < 2; k++) add_cloud(context, scene, clouds[k], NULL);
        assert_int_equal(ewa_scene_commit(scene), EWA_OK);
        assert_int_equal(strstr(log.text, "of one system?") != NULL, i);
        ewa_scene_destroy(&scene);
        for (int k = 0; k < 2; k++) ewa_cloud_destroy(&clouds[k]);
        ewa_context_destroy(&context);
    }
}

/// Picks find the point that is nearest to what is seen, and sections hide points.
TEST_ON(test_pick, 1) {
    ewa_cloud *cloud = NULL;
    ewa_scene *scene = make_scene_of(context, EWA_OBJECT_SPHERE, &cloud);
    ewa_camera camera = place(scene);
    camera.world_to_camera[3] += 0.2; // off the middle
    ewa_scene_renderer *renderer = NULL;
    assert_int_equal(ewa_scene_renderer_create(context, EWA_BACKEND_CPU, NULL, &renderer), EWA_OK);
    ewa_scene_hit hit;
    assert_int_equal(ewa_scene_pick(scene, renderer, &camera, NULL, WIDTH / 2, HEIGHT / 2, 2, 0.2, &hit),
                     EWA_OK);
    assert_true(hit.hit && hit.has_point && hit.instance == 0);
    double eye_world[3], p[3], away = 0, radius = 0;
    ewa_camera_eye(&camera, eye_world);
    ewa_attribute_read_f64(ewa_cloud_find(cloud, EWA_POSITION), hit.point, 1, p);
    for (int c = 0; c < 3; c++) {
        assert_true(p[c] == hit.point_world[c]);
        away += (hit.place_world[c] - eye_world[c]) * (hit.place_world[c] - eye_world[c]);
        radius += hit.place_world[c] * hit.place_world[c];
    }
    const double *m = camera.world_to_camera, *at = hit.place_world; // which is seen where it was asked for
    const double x = m[0] * at[0] + m[1] * at[1] + m[2] * at[2] + m[3],
                 z = m[8] * at[0] + m[9] * at[1] + m[10] * at[2] + m[11];
    assert_true(fabs(camera.fx_px * x / z + camera.cx_px - WIDTH / 2) < 1e-6);
    assert_true(fabs(sqrt(radius) - 1) < 0.02); // on the unit sphere, on the side of the eye
    assert_true(sqrt(away) < sqrt(eye_world[0] * eye_world[0] + eye_world[1] * eye_world[1] +
                                  eye_world[2] * eye_world[2]));
    assert_int_equal(ewa_scene_pick(scene, renderer, &camera, NULL, 1, 1, 1, 0.2, &hit), EWA_OK);
    assert_false(hit.hit);
    ewa_scene_renderer_destroy(&renderer);
    ewa_scene_destroy(&scene);
    ewa_cloud_destroy(&cloud);
}

/// From wherever a sphere is seen, what is picked lies on it, behind the pixel that was asked for.
TEST_ON(test_pick_aslant, 1) {
    ewa_cloud *cloud = NULL;
    ewa_scene *scene = make_scene_of(context, EWA_OBJECT_SPHERE, &cloud);
    ewa_camera camera = place(scene);
    const double eye[3] = {3, 2, 4}, target[3] = {0.1, 0, 0}, up[3] = {0.2, 1, 0};
    assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
    ewa_scene_renderer *renderer = NULL;
    assert_int_equal(ewa_scene_renderer_create(context, EWA_BACKEND_CPU, NULL, &renderer), EWA_OK);
    const double x_px = WIDTH / 2 + 5, y_px = HEIGHT / 2 - 7;
    ewa_scene_hit hit;
    assert_int_equal(ewa_scene_pick(scene, renderer, &camera, NULL, x_px, y_px, 2, 0.2, &hit), EWA_OK);
    assert_true(hit.hit && hit.has_point);
    const double *m = camera.world_to_camera, *at = hit.place_world;
    double seen[3];
    for (int r = 0; r < 3; r++) seen[r] = m[4 * r] * at[0] + m[4 * r + 1] * at[1] + m[4 * r + 2] * at[2] + m[4 * r + 3];
    assert_true(fabs(camera.fx_px * seen[0] / seen[2] + camera.cx_px - x_px) < 1e-6);
    assert_true(fabs(camera.fy_px * seen[1] / seen[2] + camera.cy_px - y_px) < 1e-6);
    assert_true(fabs(sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]) - 1) < 0.02);
    ewa_scene_renderer_destroy(&renderer);
    ewa_scene_destroy(&scene);
    ewa_cloud_destroy(&cloud);
}

/// Few points are dots of 0.004 of the scene's size; those that have radii keep them.
TEST_ON(test_dots, 1) {
    static double places[3][3] = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}};
    static float radii[3] = {1, 2, 3};
    for (int sized = 0; sized < 2; sized++) {
        ewa_cloud *cloud = NULL, *whole = NULL;
        assert_int_equal(ewa_cloud_create(context, 3, &cloud), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F64, 3, places, sizeof places[0]), EWA_OK);
        if (sized)
            assert_int_equal(ewa_cloud_borrow(cloud, EWA_RADIUS, EWA_F32, 1, radii, sizeof radii[0]), EWA_OK);
        ewa_scene *scene = make_scene(context);
        add_cloud(context, scene, cloud, NULL);
        assert_int_equal(ewa_scene_cloud(scene, &whole), EWA_OK);
        for (uint64_t i = 0; i < 3; i++) {
            double radius;
            ewa_attribute_read_f64(ewa_cloud_find(whole, EWA_RADIUS), i, 1, &radius);
            assert_true(fabs(radius - (sized ? (double)radii[i] : 0.004 * 5)) < 1e-7);
        }
        ewa_cloud_destroy(&whole);
        ewa_scene_destroy(&scene);
        ewa_cloud_destroy(&cloud);
    }
}

/// Small radii of points on no surface, as of lines, are kept; those of a surface would leave gaps.
TEST_ON(test_no_surface_has_no_gaps, 1) {
    for (int surface = 0; surface < 2; surface++) {
        ewa_cloud *cloud = make_object(context, EWA_OBJECT_SPHERE, 0);
        void *radius, *surfaceness;
        ewa_cloud_remove(cloud, EWA_CURVATURE);
        assert_int_equal(ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, &radius), EWA_OK);
        assert_int_equal(ewa_cloud_add(cloud, EWA_SURFACENESS, EWA_F32, 1, &surfaceness), EWA_OK);
        for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++)
            ((float *)radius)[i] = 0.003f, ((float *)surfaceness)[i] = (float)surface;
        ewa_scene *scene = make_scene(context);
        add_cloud(context, scene, cloud, NULL);
        const ewa_camera camera = place(scene);
        draw(context, scene, &camera, &first);
        int covered = 0;
        for (int i = 0; i < PIXELS; i++) covered += first.coverage[i] >= 0.5f;
        assert_true(surface ? covered > 0.3 * PIXELS : covered < 0.2 * PIXELS);
        ewa_scene_destroy(&scene);
        ewa_cloud_destroy(&cloud);
    }
}

/// Radius of the first point of 5,000 on a helix, forwards or backwards, or strewn in a cube, over the size of all.
static double first_radius(bool curve, bool backwards) {
    enum { COUNT = 5000 };
    static double places[COUNT][3];
    double size2 = 0, radius;
    check_random random = {11};
    for (int i = 0; i < COUNT; i++) {
        const double t = 0.004 * (backwards ? COUNT - 1 - i : i);
        const double helix[3] = {cos(t), sin(t), 0.1 * t};
        for (int c = 0; c < 3; c++) places[i][c] = curve ? helix[c] : check_uniform(&random, 0, 1);
    }
    ewa_context *context = check_context(2, NULL);
    ewa_cloud *cloud = NULL, *whole = NULL;
    assert_int_equal(ewa_cloud_create(context, COUNT, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F64, 3, places, sizeof places[0]), EWA_OK);
    ewa_bounds box;
    assert_int_equal(ewa_cloud_measure(cloud, &box), EWA_OK);
    for (int c = 0; c < 3; c++) size2 += (box.high_world[c] - box.low_world[c]) * (box.high_world[c] - box.low_world[c]);
    ewa_scene *scene = make_scene(context);
    add_cloud(context, scene, cloud, NULL);
    assert_int_equal(ewa_scene_cloud(scene, &whole), EWA_OK);
    ewa_attribute_read_f64(ewa_cloud_find(whole, EWA_RADIUS), 0, 1, &radius);
    ewa_cloud_destroy(&whole);
    ewa_scene_destroy(&scene);
    ewa_cloud_destroy(&cloud);
    ewa_context_destroy(&context);
    return radius / sqrt(size2);
}

/// A curve is dots of any number of points: lines as thin as its spacing were next to nothing. Many points that are strewn
/// are none.
TEST(test_curve) {
    assert_true(fabs(first_radius(true, false) - 0.004) < 1e-9);
    assert_true(fabs(first_radius(true, true) - 0.004) < 1e-9);
    assert_true(first_radius(false, false) > 0.01);
}

/// What is asked to be up is up, along any axis.
TEST_ON(test_asked_up, 1) {
    ewa_cloud *cloud = NULL;
    ewa_scene *scene = make_scene_of(context, EWA_OBJECT_TORUS, &cloud);
    for (int axis = 0; axis < 3; axis++) {
        ewa_view_options options;
        ewa_view_options_init(&options, sizeof options);
        options.up_world[axis] = axis == 1 ? -2 : 3;
        ewa_view_info info;
        ewa_camera camera;
        assert_int_equal(ewa_scene_place_camera(scene, &options, &camera, &info), EWA_OK);
        for (int c = 0; c < 3; c++) assert_true(info.up_world[c] == (c != axis ? 0 : axis == 1 ? -1 : 1));
    }
    ewa_scene_destroy(&scene);
    ewa_cloud_destroy(&cloud);
}

/// Small coordinates far from the origin whose heights stand out are degrees, unless no degrees are so many.
TEST_ON(test_degrees, 1) {
    static const struct {
        double x, y, z;
        bool degrees;
    } cases[] = {{13, 52, 100, true},   {13, 52, -5000, true}, {179, -89, 9000, true}, {181, 52, 100, false},
                 {-181, 52, 100, false}, {13, 91, 100, false},  {13, -91, 100, false}, {0.001, 52, 100, false}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        double places[8][3];
        for (int i = 0; i < 8; i++) {
            places[i][0] = cases[k].x + 0.01 * (i & 1) - 0.005, places[i][1] = cases[k].y + 0.01 * (i >> 1 & 1) - 0.005;
            places[i][2] = cases[k].z + 20 * (i >> 2);
        }
        ewa_cloud *cloud = NULL;
        char text[EWA_DIAGNOSIS_TEXT_BYTES];
        assert_int_equal(ewa_cloud_create(context, 8, &cloud), EWA_OK);
        assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F64, 3, places, sizeof places[0]), EWA_OK);
        assert_int_equal(ewa_cloud_find_degrees(cloud, text), cases[k].degrees);
        ewa_cloud_destroy(&cloud);
    }
}

/// A description has the options that are no defaults, and all that is there.
TEST_ON(test_described, 1) {
    ewa_cloud *cloud = NULL;
    ewa_scene *scene = make_scene_of(context, EWA_OBJECT_PLANE, &cloud);
    ewa_scene_options options;
    ewa_scene_get_options(scene, &options);
    options.up = EWA_UP_Z;
    assert_int_equal(ewa_scene_set_options(scene, &options), EWA_OK);
    char *text = NULL;
    assert_int_equal(ewa_scene_describe_json(scene, &text), EWA_OK);
    assert_non_null(strstr(text, "\"up\":\t\"z\""));
    assert_non_null(strstr(text, "\"count\":\t6000"));
    ewa_text_free(&text);
    assert_null(text);
    ewa_scene_destroy(&scene);
    ewa_cloud_destroy(&cloud);
}

/// By how much the left half is brighter than the right one, the upper than the lower one, in shares of all light.
static void measure_slant(const planes *of, double slant[2]) {
    double sum = 0;
    slant[0] = slant[1] = 0;
    for (int i = 0; i < PIXELS; i++) {
        const double light = of->coverage[i] > 0.99f ? (double)of->rgba[4 * i] : 0;
        sum += light;
        slant[0] += i % WIDTH < WIDTH / 2 ? light : -light;
        slant[1] += i / WIDTH < HEIGHT / 2 ? light : -light;
    }
    for (int k = 0; k < 2; k++) slant[k] /= sum;
}

/// Adds a cloud, or the surfels made of it.
static ewa_surfels *add_as(ewa_context *context, ewa_scene *scene, const ewa_cloud *cloud, bool resident) {
    ewa_surfels *surfels = NULL;
    if (!resident) {
        add_cloud(context, scene, cloud, NULL);
        return NULL;
    }
    ewa_asset *asset = NULL;
    assert_int_equal(ewa_surfels_create(cloud, NULL, &surfels), EWA_OK);
    assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.surfels = surfels}, NULL, &asset), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
    ewa_asset_release(&asset);
    return surfels;
}

/// A sphere without colours is lit from above left, wherever it is seen from, as points and as resident surfels; one with
/// colours, or by lights that are given, is not.
TEST(test_bare_light) {
    (void)state;
    ewa_context *context = check_context(1, NULL);
    ewa_cloud *cloud = make_object(context, EWA_OBJECT_SPHERE, 0);
    ewa_cloud_remove(cloud, EWA_COLOR);
    for (int round = 0; round < 6; round++) {
        const int kind = round % 3;
        uint8_t(*colors)[3] = NULL;
        if (kind == 1) {
            assert_int_equal(ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, (void **)&colors), EWA_OK);
            memset(colors, 200, 3 * POINTS);
        }
        ewa_scene *scene = make_scene(context);
        ewa_surfels *surfels = add_as(context, scene, cloud, round >= 3);
        ewa_scene_options options;
        ewa_scene_get_options(scene, &options);
        options.render.light_count = kind == 2; // the headlight
        ewa_light_init(&options.render.lights[0]);
        assert_int_equal(ewa_scene_set_options(scene, &options), EWA_OK);
        const ewa_camera camera = place(scene);
        double slant[2];
        draw(context, scene, &camera, &first);
        measure_slant(&first, slant);
        for (int k = 0; k < 2; k++) assert_true(kind ? fabs(slant[k]) < 0.01 : slant[k] > 0.1);
        ewa_scene_destroy(&scene);
        ewa_surfels_destroy(&surfels);
        if (kind == 1) ewa_cloud_remove(cloud, EWA_COLOR);
    }
    ewa_cloud_destroy(&cloud);
    ewa_context_destroy(&context);
}

/// An octahedron of one colour is lit as what has none, since its form is all there is to see; one of many, one that is
/// tinted, and one coloured by its heights keep the headlight.
TEST_ON(test_plain_mesh, 1) {
    static const double corners[18] = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
    static const uint32_t faces[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    enum { BARE, PLAIN, MANY, TINTED, HEIGHTS, KINDS };
    for (int kind = 0; kind < KINDS; kind++) {
        ewa_mesh mesh;
        assert_int_equal(ewa_mesh_create(context, 6, 8, 0, kind == BARE ? 0 : EWA_MESH_COLORS, &mesh), EWA_OK);
        memcpy(mesh.positions, corners, sizeof corners);
        memcpy(mesh.triangles, faces, sizeof faces);
        for (int i = 0; mesh.colors && i < 24; i++)
            mesh.colors[i] = i % 4 == 3 ? 1 : kind == MANY ? 0.5f + 0.2f * (float)(i / 8) : 0.5f;
        ewa_asset *asset = NULL;
        assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.mesh = &mesh}, NULL, &asset), EWA_OK);
        ewa_mesh_free(&mesh);
        ewa_scene *scene = make_scene(context);
        ewa_instance instance;
        ewa_instance_init(&instance, sizeof instance);
        instance.coloring.tinted = kind == TINTED;
        if (kind == HEIGHTS) snprintf(instance.coloring.attribute, sizeof instance.coloring.attribute, "z");
        assert_int_equal(ewa_scene_add(scene, asset, &instance), EWA_OK);
        ewa_asset_release(&asset);
        const ewa_camera camera = place(scene);
        draw(context, scene, &camera, &first);
        ewa_scene_options options;
        ewa_scene_get_options(scene, &options);
        options.render.light_count = 1; // the headlight
        ewa_light_init(&options.render.lights[0]);
        assert_int_equal(ewa_scene_set_options(scene, &options), EWA_OK);
        draw(context, scene, &camera, &second);
        assert_true((memcmp(first.rgba, second.rgba, sizeof first.rgba) == 0) == (kind > PLAIN));
        ewa_scene_destroy(&scene);
    }
}

/// A sloping wall in steps of depth as a depth camera at the origin sees it, of one colour, linear.
static ewa_cloud *make_photograph(ewa_context *context, float color) {
    enum { COLUMNS = 80, ROWS = 60 };
    ewa_cloud *cloud = NULL;
    float(*position)[3] = NULL, (*colors)[3] = NULL;
    assert_int_equal(ewa_cloud_create(context, COLUMNS * ROWS, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, (void **)&position), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_COLOR, EWA_F32, 3, (void **)&colors), EWA_OK);
    for (int i = 0; i < COLUMNS * ROWS; i++) {
        const float x = ((float)(i % COLUMNS) - 39.5f) / 80, y = ((float)(i / COLUMNS) - 29.5f) / 80;
        const float z = 0.1f * roundf((3 + 2 * x + y) / 0.1f);
        position[i][0] = x * z, position[i][1] = y * z, position[i][2] = z;
        for (int c = 0; c < 3; c++) colors[i][c] = color;
    }
    return cloud;
}

/// The colours of photographed points are drawn as they are, but by lights that are given, with normals of the file's, where
/// the camera was elsewhere, or beside what has no colours.
TEST_ON(test_photographed, 1) {
    enum { PLAIN, LIT, NORMALS, ELSEWHERE, BESIDE_BARE, KINDS };
    for (int kind = 0; kind < KINDS; kind++) {
        ewa_cloud *cloud = make_photograph(context, 0.5f);
        if (kind == NORMALS) {
            ewa_estimate_options options;
            ewa_estimate_options_init(&options, sizeof options);
            assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
        }
        const double away[16] = {1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        if (kind == ELSEWHERE) assert_int_equal(ewa_cloud_transform(cloud, away), EWA_OK);
        ewa_scene *scene = make_scene(context);
        add_cloud(context, scene, cloud, NULL);
        ewa_scene_options options;
        ewa_scene_get_options(scene, &options);
        options.render.light_count = kind == LIT;
        ewa_light_init(&options.render.lights[0]);
        assert_int_equal(ewa_scene_set_options(scene, &options), EWA_OK);
        const ewa_camera camera = place(scene);
        ewa_cloud *bare = kind == BESIDE_BARE ? make_object(context, EWA_OBJECT_SPHERE, 0) : NULL;
        if (bare) {
            ewa_cloud_remove(bare, EWA_COLOR);
            add_cloud(context, scene, bare, NULL);
        }
        draw(context, scene, &camera, &first);
        int inner = 0, shaded = 0;
        for (int i = 0; i < PIXELS; i++) {
            if (!(first.coverage[i] > 0.99f)) continue;
            inner++;
            shaded += fabsf(first.rgba[4 * i] - 0.5f * first.rgba[4 * i + 3]) > 1e-4f;
        }
        assert_true(inner > PIXELS / 4);
        assert_true(kind == PLAIN ? shaded < inner / 100 : shaded > inner / 10); // pixels of edges have a little less
        options.render.light_count = 1; // the headlight
        assert_int_equal(ewa_scene_set_options(scene, &options), EWA_OK);
        draw(context, scene, &camera, &second);
        assert_true((memcmp(first.rgba, second.rgba, sizeof first.rgba) == 0) == (kind != PLAIN));
        ewa_scene_destroy(&scene);
        ewa_cloud_destroy(&cloud);
        ewa_cloud_destroy(&bare);
    }
}

#define FOOT "UNIT[\"foot\",0.3048]"
#define US_FOOT "UNIT[\"US survey foot\",0.304800609601219,AUTHORITY[\"EPSG\",\"9003\"]]"
#define METRE "UNIT[\"metre\",1]"
#define GEOGRAPHIC "GEOGCS[\"G [UNIT\",DATUM[\"D\",SPHEROID[\"S\",6378137,298.25]],UNIT[\"degree\",0.0174532925199433]]"
#define PROJECTED(unit) "PROJCS[\"P\"," GEOGRAPHIC ",PROJECTION[\"M\"]," unit "]"
#define COMPOUND(horizontal, vertical) "COMPD_CS[\"C\"," PROJECTED(horizontal) ",VERT_CS[\"V\",VERT_DATUM[\"D\",2005]," vertical "]]"

/// What is said of lengths by a scene of a bare cloud, moved by a map, with a reference system.
static const char *unit_of(ewa_context *context, const char *crs, const char *note, double scale) {
    ewa_cloud *cloud = make_object(context, EWA_OBJECT_SPHERE, 0);
    if (crs) assert_int_equal(ewa_cloud_set_note(cloud, "crs", crs, strlen(crs)), EWA_OK);
    if (note) assert_int_equal(ewa_cloud_set_note(cloud, "crs_unit", note, strlen(note)), EWA_OK);
    ewa_asset_options options;
    ewa_asset_options_init(&options, sizeof options);
    // Turned by a quarter, and as large as the scale says.
    const double to_world[16] = {0, -scale, 0, 500, scale, 0, 0, 0, 0, 0, scale, 0, 0, 0, 0, 1};
    memcpy(options.to_world, to_world, sizeof to_world);
    ewa_asset *asset = NULL;
    ewa_scene *scene = NULL;
    ewa_scene_info info;
    assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.cloud = cloud}, &options, &asset), EWA_OK);
    assert_int_equal(ewa_scene_create(context, NULL, &scene), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
    ewa_scene_describe(scene, &info);
    ewa_scene_destroy(&scene);
    ewa_asset_release(&asset);
    ewa_cloud_destroy(&cloud);
    return info.unit ? info.unit : "none";
}

/// Two systems of coordinates in one scene are told with both names, and drawn as they are.
TEST(test_two_systems) {
    check_log log = {.count = 0};
    ewa_context *context = check_context(1, &log);
    ewa_scene *scene = make_scene(context);
    static const char *const systems[] = {NULL, PROJECTED(METRE), PROJECTED(METRE), PROJECTED(FOOT)};
    ewa_cloud *clouds[4];
    for (int i = 0; i < 4; i++) {
        clouds[i] = make_object(context, EWA_OBJECT_SPHERE, 0);
        if (systems[i]) assert_int_equal(ewa_cloud_set_note(clouds[i], "crs", systems[i], strlen(systems[i])), EWA_OK);
        ewa_asset *asset = NULL;
        const ewa_asset_source source = {.cloud = clouds[i], .name = (const char *[]){"none", "one", "same", "other"}[i]};
        assert_int_equal(ewa_asset_create(context, &source, NULL, &asset), EWA_OK);
        assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
        ewa_asset_release(&asset);
        assert_int_equal(ewa_scene_complete(scene), EWA_OK);
        assert_int_equal(log.count, i == 3);
    }
    assert_ptr_equal(strstr(log.text, "other: its coordinate reference system (PROJCS"), log.text);
    assert_non_null(strstr(log.text, "is not that of one (PROJCS"));
    ewa_scene_destroy(&scene);
    for (int i = 0; i < 4; i++) ewa_cloud_destroy(&clouds[i]);
    ewa_context_destroy(&context);
}

/// A sphere on a foot along an axis, 1 y, 2 z, with normals.
static ewa_cloud *make_stand(ewa_context *context, int up) {
    ewa_cloud *cloud = make_object(context, EWA_OBJECT_CUBE, 0);
    double to_world[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    to_world[5 * up] = 4;
    assert_int_equal(ewa_cloud_transform(cloud, to_world), EWA_OK);
    return cloud;
}

/// Files that have not the same up are told of, once; what a map moves lies as somebody wants it.
TEST(test_two_ups) {
    static const struct {
        const char *names[2];
        int up[2];
        bool moved;
        const char *said;
    } rows[] = {
        {{"mug.glb", "scan.las"}, {1, 2}, false, "mug.glb has y up, scan.las z"},
        {{"mug.glb", "scan.las"}, {1, 2}, true, NULL},
        {{"mug.glb", "part.obj"}, {1, 1}, false, NULL},
        {{"tower.las", "part.laz"}, {2, 2}, false, NULL},
        {{"one.ply", "two.ply"}, {1, 2}, false, NULL},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        check_log log = {.count = 0};
        ewa_context *context = check_context(1, &log);
        ewa_scene *scene = make_scene(context);
        ewa_cloud *clouds[2];
        for (int k = 0; k < 2; k++) {
            clouds[k] = make_stand(context, rows[i].up[k]);
            ewa_asset_options options;
            ewa_asset_options_init(&options, sizeof options);
            if (k && rows[i].moved) options.to_world[3] = 1;
            ewa_asset *asset = NULL;
            const ewa_asset_source source = {.cloud = clouds[k], .name = rows[i].names[k]};
            assert_int_equal(ewa_asset_create(context, &source, &options, &asset), EWA_OK);
            assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
            ewa_asset_release(&asset);
        }
        ewa_camera camera;
        for (int again = 0; again < 2; again++) {
            assert_int_equal(ewa_scene_place_camera(scene, NULL, &camera, NULL), EWA_OK);
            const bool told = strstr(log.text, " up, ") != NULL;
            if (told != (rows[i].said && !again)) fail_msg("row %zu: '%s'", i, log.text);
            if (told) assert_non_null(strstr(log.text, rows[i].said));
            log = (check_log){.count = 0};
        }
        ewa_scene_destroy(&scene);
        for (int k = 0; k < 2; k++) ewa_cloud_destroy(&clouds[k]);
        ewa_context_destroy(&context);
    }
}

/// Lengths have the unit that reference systems say, unless it is none, several, or changed by a map.
TEST(test_units) {
    static const struct {
        const char *crs, *unit;
    } systems[] = {
        {NULL, "none"},
        {PROJECTED(METRE), "m"},
        {PROJECTED(FOOT), "ft"},
        {PROJECTED("UNIT[\"Foot_US\",0.3048006096012192]"), "US ft"},
        {PROJECTED("UNIT[\"link\",0.201168]"), "none"},
        {"PROJCS[\"P\"," GEOGRAPHIC "]", "none"},
        {COMPOUND(METRE, METRE), "m"},
        {COMPOUND(US_FOOT, US_FOOT), "US ft"},
        {COMPOUND(METRE, FOOT), "none"},
        {COMPOUND(FOOT, US_FOOT), "ft"},
        {COMPOUND(US_FOOT, FOOT), "US ft"},
        {GEOGRAPHIC, "none"},
        {"PROJCRS[\"P\",BASEGEOGCRS[\"B\",DATUM[\"D\",ELLIPSOID[\"E\",6378137,298.25,LENGTHUNIT[\"metre\",1]]]],CS[Cartesian,2],"
         "AXIS[\"(E)\",east,ORDER[1],LENGTHUNIT[\"foot\", 0.3048]],AXIS[\"(N)\",north,LENGTHUNIT[\"foot\",0.3048]]]",
         "ft"},
        {"PROJCRS[\"P\",CS[Cartesian,2],AXIS[\"e\",east],AXIS[\"n\",north],LENGTHUNIT[\"metre\",1]]", "m"},
        {"EPSG:32633", "m"},
        {"EPSG:25832+7837", "m"},
        {"EPSG:26910+6360", "none"}, // heights in feet
        {"EPSG:4326", "none"},
        {"EPSG:1", "none"},
        {"user-defined: PROJCS[", "none"},
    };
    ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(NULL, &context), EWA_OK);
    for (size_t i = 0; i < sizeof systems / sizeof systems[0]; i++)
        assert_string_equal(unit_of(context, systems[i].crs, NULL, 1), systems[i].unit);
    assert_string_equal(unit_of(context, PROJECTED(METRE), NULL, 0.5), "none");
    assert_string_equal(unit_of(context, "user-defined", "US ft", 1), "US ft");
    assert_string_equal(unit_of(context, "user-defined", "rods", 1), "none");
    // Texts that end anywhere say nothing wrong.
    const char *whole = COMPOUND(FOOT, FOOT);
    char begun[512];
    for (size_t length = 0; length < strlen(whole); length++) {
        snprintf(begun, sizeof begun, "%.*s", (int)length, whole);
        const char *unit = unit_of(context, length ? begun : NULL, NULL, 1);
        assert_true(strcmp(unit, "none") == 0 || strcmp(unit, "ft") == 0);
    }
    ewa_context_destroy(&context);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
