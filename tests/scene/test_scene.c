// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scenes: what is added is what was merged before, whatever the order; tiles without normals are one file; every plane is
// of everything; what is shared stays right; what cannot be is refused.
#include "check_scene.h"

#include <math.h>

static planes first, second;

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
    void *data = NULL;
    ewa_cloud *cloud = check_cloud_of(context, kept);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, &data), EWA_OK);
    for (uint64_t i = 0; i < count; i++) {
        ewa_attribute_read_f64(position, i, 1, p);
        if (side(i, p)) memcpy((double *)data + 3 * at++, p, sizeof p);
    }
    return cloud;
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
    OWNED(ewa_cloud_destroy)
    ewa_cloud *object = make_object(context, EWA_OBJECT_TORUS, 0), *whole = bare_part(context, object, all);
    OWNED(ewa_scene_destroy) ewa_scene *one = make_scene(context);
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
}

/// Scans that are estimated together keep their scanners: each point's normal looks at the one that saw it, of a file with two, too, wherever the
/// file lies.
TEST_ON(test_scanners_together, 2) {
    enum { SIDE = 40, COUNT = SIDE * SIDE };
    static const char *const notes[2] = {"0.5 0.5 -5\n0.5 0.5 5\n", "1.5 0.5 -5\n"};
    for (int turned = 0; turned < 2; turned++) {
        ewa_cloud *clouds[2];
        ewa_scene *scene = make_scene(context);
        for (int k = 0; k < 2; k++) {
            const int tile = turned ? 1 - k : k;
            ewa_cloud *cloud = clouds[k] = check_cloud_of(context, COUNT);
            float *xyz = check_add(cloud, EWA_POSITION, EWA_F32, 3);
            for (int i = 0; i < COUNT; i++)
                xyz[3 * i] = (float)(i % SIDE) / SIDE + (float)tile, xyz[3 * i + 1] = (float)(i / SIDE) / SIDE, xyz[3 * i + 2] = 0;
            if (tile == 0) {
                uint8_t *scan = check_add(cloud, "scan", EWA_U8, 1);
                for (int i = 0; i < COUNT; i++) scan[i] = i / SIDE >= SIDE / 2;
            }
            assert_int_equal(ewa_cloud_set_note(cloud, "scanners", notes[tile], strlen(notes[tile])), EWA_OK);
            add_cloud(context, scene, cloud, NULL);
        }
        assert_int_equal(ewa_scene_commit(scene), EWA_OK);
        OWNED(ewa_cloud_destroy) ewa_cloud *all_points = NULL;
        assert_int_equal(ewa_scene_cloud(scene, &all_points), EWA_OK);
        assert_int_equal(ewa_cloud_point_count(all_points), 2 * COUNT);
        uint32_t wrong = 0;
        for (uint64_t i = 0; i < 2 * COUNT; i++) {
            double p[3], n[3];
            ewa_attribute_read_f64(ewa_cloud_find(all_points, EWA_POSITION), i, 1, p);
            ewa_attribute_read_f64(ewa_cloud_find(all_points, EWA_NORMAL), i, 1, n);
            const bool above = p[0] < 0.999 && p[1] > 0.499;
            wrong += above ? !(n[2] > 0.99) : !(n[2] < -0.99);
        }
        assert_int_equal(wrong, 0);
        ewa_scene_destroy(&scene);
        ewa_cloud_destroy(&clouds[0]), ewa_cloud_destroy(&clouds[1]);
    }
}

/// Gaussians out of sight change none of the planes of a surface but where colours are rounded.
TEST_ON(test_planes_among_gaussians, 0) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_object(context, EWA_OBJECT_SPHERE, 0);
    OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene(context);
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
    WITH_DEFAULTS(ewa_coloring, coloring);
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

TEST_LOGGED(test_refused, 1) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_object(context, EWA_OBJECT_PLANE, 0);
    OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene(context);
    WITH_DEFAULTS(ewa_asset_options, options);
    ewa_asset *asset = NULL;
    options.to_world[0] = 0;
    assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.cloud = cloud}, &options, &asset),
                     EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "determinant"));
    options.to_world[0] = NAN;
    assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.cloud = cloud}, &options, &asset),
                     EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.name = "x"}, NULL, &asset),
                     EWA_ERROR_ARGUMENT);
    assert_null(asset);
    assert_int_equal(ewa_asset_load(context, "/nowhere/there.ply", NULL, &asset), EWA_ERROR_IO);
    assert_non_null(strstr(log->text, "/nowhere/there.ply"));
    add_cloud(context, scene, cloud, NULL);
    WITH_DEFAULTS(ewa_instance, instance);
    instance.opacity = 2;
    assert_int_equal(ewa_scene_set(scene, 0, &instance), EWA_ERROR_ARGUMENT);
    instance.opacity = 1;
    snprintf(instance.coloring.attribute, sizeof instance.coloring.attribute, "nothing");
    assert_int_equal(ewa_scene_set(scene, 0, &instance), EWA_OK);
    assert_int_equal(ewa_scene_commit(scene), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "points: there is no attribute 'nothing'"));
    instance.coloring.ranged = instance.coloring.percent[1] = true;
    instance.coloring.range[1] = 101;
    assert_int_equal(ewa_scene_set(scene, 0, &instance), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "101 is no percentile"));
    memset(instance.coloring.attribute, 'a', sizeof instance.coloring.attribute);
    instance.coloring.ranged = false;
    assert_int_equal(ewa_scene_set(scene, 0, &instance), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "attribute: a name has at most"));
    assert_int_equal(ewa_scene_remove(scene, 1), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_scene_remove(scene, 0), EWA_OK);
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
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
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
}

/// The cloud of a scene is what its surfels are made of: their picture is the scene's.
TEST_LOGGED(test_cloud_of_scene, 1) {
    ewa_cloud *clouds[2] = {make_object(context, EWA_OBJECT_TORUS, 0), make_object(context, EWA_OBJECT_SPHERE, 1.25)};
    ewa_scene *scene = make_scene(context), *of_cloud = make_scene(context);
    OWNED(ewa_cloud_destroy) ewa_cloud *whole = NULL;
    assert_int_equal(ewa_scene_cloud(scene, &whole), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "shows no points"));
    for (int i = 0; i < 2; i++) {
        WITH_DEFAULTS(ewa_instance, instance);
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
}

/// Who puts things of different coordinates together is told.
TEST(test_far_apart) {
    const double shifts_world[2] = {900, 4e6};
    for (int i = 0; i < 2; i++) {
        check_log log = {.count = 0};
        OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
        ewa_cloud *clouds[2] = {make_object(context, EWA_OBJECT_TORUS, 0),
                                make_object(context, EWA_OBJECT_SPHERE, shifts_world[i])};
        ewa_scene *scene = make_scene(context);
        for (int k = 0; k < 2; k++) add_cloud(context, scene, clouds[k], NULL);
        assert_int_equal(ewa_scene_commit(scene), EWA_OK);
        assert_int_equal(strstr(log.text, "of one system?") != NULL, i);
        ewa_scene_destroy(&scene);
        for (int k = 0; k < 2; k++) ewa_cloud_destroy(&clouds[k]);
    }
}

/// Picks find the point that is nearest to what is seen, and sections hide points.
TEST_ON(test_pick, 1) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene_of(context, EWA_OBJECT_SPHERE, &cloud);
    ewa_camera camera = place(scene);
    camera.world_to_camera[3] += 0.2; // off the middle
    OWNED(ewa_scene_renderer_destroy) ewa_scene_renderer *renderer = NULL;
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
}

/// From wherever a sphere is seen, what is picked lies on it, behind the pixel that was asked for.
TEST_ON(test_pick_aslant, 1) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene_of(context, EWA_OBJECT_SPHERE, &cloud);
    ewa_camera camera = place(scene);
    const double eye[3] = {3, 2, 4}, target[3] = {0.1, 0, 0}, up[3] = {0.2, 1, 0};
    assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
    OWNED(ewa_scene_renderer_destroy) ewa_scene_renderer *renderer = NULL;
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
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_object(context, EWA_OBJECT_SPHERE, 0);
        void *radius, *surfaceness;
        ewa_cloud_remove(cloud, EWA_CURVATURE);
        assert_int_equal(ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, &radius), EWA_OK);
        assert_int_equal(ewa_cloud_add(cloud, EWA_SURFACENESS, EWA_F32, 1, &surfaceness), EWA_OK);
        for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++)
            ((float *)radius)[i] = 0.003f, ((float *)surfaceness)[i] = (float)surface;
        OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene(context);
        add_cloud(context, scene, cloud, NULL);
        const ewa_camera camera = place(scene);
        draw(context, scene, &camera, &first);
        int covered = 0;
        for (int i = 0; i < PIXELS; i++) covered += first.coverage[i] >= 0.5f;
        assert_true(surface ? covered > 0.3 * PIXELS : covered < 0.2 * PIXELS);
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
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
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
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene_of(context, EWA_OBJECT_TORUS, &cloud);
    for (int axis = 0; axis < 3; axis++) {
        WITH_DEFAULTS(ewa_view_options, options);
        options.up_world[axis] = axis == 1 ? -2 : 3;
        ewa_view_info info;
        ewa_camera camera;
        assert_int_equal(ewa_scene_place_camera(scene, &options, &camera, &info), EWA_OK);
        for (int c = 0; c < 3; c++) assert_true(info.up_world[c] == (c != axis ? 0 : axis == 1 ? -1 : 1));
    }
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
        char text[EWA_DIAGNOSIS_TEXT_BYTES];
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, 8);
        assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F64, 3, places, sizeof places[0]), EWA_OK);
        assert_int_equal(ewa_cloud_find_degrees(cloud, text), cases[k].degrees);
    }
}

/// A description has the options that are no defaults, and all that is there.
TEST_ON(test_described, 1) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene_of(context, EWA_OBJECT_PLANE, &cloud);
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
}

int main(void) { return RUN_TESTS(NULL, NULL); }
