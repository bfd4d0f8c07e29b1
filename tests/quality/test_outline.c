// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Outlines of closed shapes and borders of open ones against analytic coverage: how fat they are in pixels,
// how far alpha is off along them, and how much of what is inside is open; from generated surfels, from
// meshes and from bare points.
#include "check.h"

#include <math.h>
#include <stdbool.h>

#include "io/scratch.h"
#include "math/gaussian.h"
#include "prepare/mesh_shapes.h"
#include "quality/outline_scene.h"

static ewa_cloud *generated(ewa_context *context, ewa_object object, uint64_t point_count) {
    WITH_DEFAULTS(ewa_generate_options, options);
    options.object = object;
    options.size_world = 2;
    options.radius_scale = EWA_DEFAULT_RADIUS_SCALE;
    options.point_count = point_count;
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_generate(context, &options, &cloud), EWA_OK);
    return cloud;
}

static ewa_cloud *sampled(ewa_mesh *mesh, uint64_t point_count) {
    WITH_DEFAULTS(ewa_mesh_sample_options, options);
    options.point_count = point_count;
    ewa_cloud *cloud = shape_sample(mesh, &options);
    ewa_mesh_free(mesh);
    return cloud;
}

static ewa_cloud *sphere_from_mesh(ewa_context *context, uint64_t point_count) {
    ewa_mesh mesh;
    shape_sphere(context, 100, &mesh);
    return sampled(&mesh, point_count);
}

/// A fan, whose border a mesh knows.
static ewa_cloud *disc_from_mesh(ewa_context *context, uint64_t point_count) {
    enum { CORNERS = 200 };
    double positions[3 * (CORNERS + 1)] = {0};
    uint32_t triangles[3 * CORNERS];
    for (uint32_t i = 0; i < CORNERS; i++) {
        const double angle = 2 * 3.141592653589793 * i / CORNERS;
        positions[3 * i] = cos(angle), positions[3 * i + 1] = sin(angle);
        triangles[3 * i] = CORNERS, triangles[3 * i + 1] = i, triangles[3 * i + 2] = (i + 1) % CORNERS;
    }
    ewa_mesh mesh;
    shape_fill(context, CORNERS + 1, positions, CORNERS, triangles, &mesh);
    return sampled(&mesh, point_count);
}

static ewa_cloud *estimated(ewa_context *context, outline_shape shape, uint64_t point_count) {
    ewa_cloud *cloud = outline_points(context, shape, point_count);
    WITH_DEFAULTS(ewa_estimate_options, options);
    assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
    return cloud;
}

static outline_errors draw(ewa_context *context, const ewa_cloud *cloud, const ewa_camera *camera,
                           const ewa_render_options *options, const outline_truth *truth) {
    static float rgba[OUTLINE_SIDE_PX * OUTLINE_SIDE_PX][4];
    WITH_DEFAULTS(ewa_surfels_options, surfels_options);
    surfels_options.level_count = options ? options->level + 1 : 1;
    ewa_surfels *surfels = check_surfels(cloud, &surfels_options);
    ewa_renderer *renderer = check_renderer(context);
    const ewa_frame frame = {.rgba = &rgba[0][0]};
    assert_int_equal(ewa_render(renderer, surfels, camera, options, &frame, NULL), EWA_OK);
    ewa_renderer_destroy(&renderer);
    ewa_surfels_destroy(&surfels);
    return outline_compare(truth, &rgba[0][3], 4);
}

/// Draws a cloud, which it takes, and tells what it found.
static outline_errors measure(ewa_context *context, const char *name, outline_shape shape,
                              const double eye[3], ewa_cloud *cloud) {
    static outline_truth truth;
    ewa_camera camera;
    outline_camera(eye, 42, &camera);
    outline_trace(context, shape, &camera, &truth);
    const outline_errors found = draw(context, cloud, &camera, NULL, &truth);
    print_message("%-36s fat %+.3f px, rms %.3f, open inside %.4f %% (deepest %.3f), outside %.4f %%\n", name,
                  found.fat_px, found.rms, 100 * found.open, found.deepest, 100 * found.strewn);
    ewa_cloud_destroy(&cloud);
    return found;
}

static const double oblique[3] = {1.2, -2.6, 1.7};

TEST_ON(test_silhouettes, 0) {
    // What is sparser than pixels ends where its discs do.
    static const uint64_t counts[] = {3000, 20000, 100000};
    static const double fat_px[] = {0.2, 0.1, 0.1}, rms[] = {0.3, 0.19, 0.17};
    for (int i = 0; i < 3; i++) {
        const uint64_t n = counts[i];
        print_message("%llu points\n", (unsigned long long)n);
        const struct {
            const char *name;
            outline_shape shape;
            ewa_cloud *cloud;
        } scenes[] = {
            {"sphere, surfels", OUTLINE_SPHERE, generated(context, EWA_OBJECT_SPHERE, n)},
            {"sphere, mesh", OUTLINE_SPHERE, sphere_from_mesh(context, n)},
            {"sphere, random points", OUTLINE_SPHERE, estimated(context, OUTLINE_SPHERE, n)},
            {"torus, random points", OUTLINE_TORUS, estimated(context, OUTLINE_TORUS, n)},
        };
        for (size_t k = 0; k < sizeof scenes / sizeof scenes[0]; k++) {
            const outline_errors found =
                measure(context, scenes[k].name, scenes[k].shape, oblique, scenes[k].cloud);
            assert_true(fabs(found.fat_px) < fat_px[i] && found.rms < rms[i]);
            assert_true(found.open < 5e-4 && found.deepest < 0.1 && found.strewn < 1e-3);
        }
    }
}

/// Levels in memory, down to surfels 2.5 px apart; what stands for others where they are 5 px apart lies on the surface.
TEST_ON(test_levels, 0) {
    static outline_truth truth;
    ewa_camera camera;
    outline_camera(oblique, 42, &camera);
    for (int torus = 0; torus < 2; torus++) {
        const outline_shape shape = torus ? OUTLINE_TORUS : OUTLINE_SPHERE;
        outline_trace(context, shape, &camera, &truth);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = estimated(context, shape, 100000);
        for (uint32_t level = 1; level < 4; level++) {
            WITH_DEFAULTS(ewa_render_options, options);
            options.level = level;
            const outline_errors found = draw(context, cloud, &camera, &options, &truth);
            print_message("%s, level %u: fat %+.3f px, rms %.3f, open inside %.4f %%\n", torus ? "torus" : "sphere", level,
                          found.fat_px, found.rms, 100 * found.open);
            assert_true(fabs(found.fat_px) < (level < 3 ? 0.1 : 0.3) && found.rms < (level < 3 ? 0.18 : 0.28));
            assert_true(found.open < 5e-3);
        }
    }
}

/// The coarse nodes of an octree, of bare points and of surfels with curvatures.
TEST_ON(test_octrees, 0) {
    static outline_truth truth;
    static float rgba[OUTLINE_SIDE_PX * OUTLINE_SIDE_PX][4];
    ewa_camera camera;
    outline_camera(oblique, 42, &camera);
    outline_trace(context, OUTLINE_TORUS, &camera, &truth);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    for (int surfels = 0; surfels < 2; surfels++) {
        char points[512], octree[512];
        const char *const paths[1] = {scratch_path("torus.ply", points)};
        ewa_cloud *cloud = surfels ? estimated(context, OUTLINE_TORUS, 300000)
                                   : outline_points(context, OUTLINE_TORUS, 300000);
        assert_int_equal(ewa_cloud_save(cloud, points, NULL), EWA_OK);
        ewa_cloud_destroy(&cloud);
        assert_int_equal(ewa_lod_build(context, paths, 1, scratch_path("torus.copc.laz", octree), NULL, NULL), EWA_OK);
        ewa_lod *lod = NULL;
        assert_int_equal(ewa_lod_open(context, octree, &lod), EWA_OK);
        static const double spacings_px[] = {0.1, 2};
        for (int i = 0; i < 2; i++) {
            WITH_DEFAULTS(ewa_lod_options, options);
            options.spacing_px = spacings_px[i], options.error = 255;
            ewa_lod_stats stats;
            const ewa_frame frame = {.rgba = &rgba[0][0]};
            assert_int_equal(ewa_lod_render(lod, renderer, &camera, NULL, &options, &frame, &stats), EWA_OK);
            const outline_errors found = outline_compare(&truth, &rgba[0][3], 4);
            print_message("octree of %s: %llu surfels, fat %+.3f px, rms %.3f, open inside %.4f %%\n",
                          surfels ? "surfels" : "points", (unsigned long long)stats.surfel_count, found.fat_px, found.rms,
                          100 * found.open);
            assert_true(i == 0 ? stats.surfel_count >= 300000 : stats.surfel_count < 150000);
            assert_true(fabs(found.fat_px) < 0.1 && found.rms < 0.17 && found.open < 5e-4);
        }
        ewa_lod_close(&lod);
        unlink(points), unlink(octree);
    }
}

/// Octrees of bare points end where these do, and stay closed where nodes meet, which is amid a pixel here.
TEST_ON(test_octrees_end, 0) {
    static outline_truth truth;
    static float rgba[OUTLINE_SIDE_PX * OUTLINE_SIDE_PX][4];
    ewa_camera camera;
    outline_camera(oblique, 42, &camera);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    for (int square = 0; square < 2; square++) {
        const outline_shape shape = square ? OUTLINE_SQUARE : OUTLINE_DISC;
        outline_trace(context, shape, &camera, &truth);
        char points[512], octree[512];
        const char *const paths[1] = {scratch_path("ends.ply", points)};
        ewa_cloud *cloud = outline_points(context, shape, 100000);
        assert_int_equal(ewa_cloud_save(cloud, points, NULL), EWA_OK);
        ewa_cloud_destroy(&cloud);
        assert_int_equal(ewa_lod_build(context, paths, 1, scratch_path("ends.copc.laz", octree), NULL, NULL), EWA_OK);
        ewa_lod *lod = NULL;
        assert_int_equal(ewa_lod_open(context, octree, &lod), EWA_OK);
        WITH_DEFAULTS(ewa_lod_options, options);
        options.spacing_px = 0.1;
        ewa_lod_stats stats;
        const ewa_frame frame = {.rgba = &rgba[0][0]};
        assert_int_equal(ewa_lod_render(lod, renderer, &camera, NULL, &options, &frame, &stats), EWA_OK);
        const outline_errors found = outline_compare(&truth, &rgba[0][3], 4);
        print_message("%s, octree of %u nodes: fat %+.3f px, rms %.3f, open inside %.4f %% (deepest %.3f)\n",
                      square ? "square" : "disc", stats.node_count, found.fat_px, found.rms, 100 * found.open, found.deepest);
        assert_true(stats.node_count >= 4 && fabs(found.fat_px) < 0.1 && found.rms < 0.2 && found.open < 2e-4);
        ewa_lod_close(&lod);
        unlink(points), unlink(octree);
    }
}

/// x that the normal distribution has the share `below` below -x, 0 < below < 1/2.
static double tail(double below) {
    double low = 0, high = 6;
    for (int i = 0; i < 50; i++) {
        const double middle = (low + high) / 2;
        if (ewa_normal_below(-middle) > below)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/// Without curvatures, where samples are finer than pixels, the coverage of a smooth silhouette is the prefilter's
/// integral, alpha is that over tau, and what the near side leaves the far side covers by as much again: together a half
/// where the integral is tau (1 - sqrt(1/2)), which lies outside.
TEST_ON(test_silhouettes_follow_the_filter, 0) {
    static outline_truth truth;
    ewa_camera camera;
    outline_camera(oblique, 42, &camera);
    outline_trace(context, OUTLINE_SPHERE, &camera, &truth);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = generated(context, EWA_OBJECT_SPHERE, 400000);
    ewa_cloud_remove(cloud, EWA_CURVATURE);
    static const double prefilters_px[] = {0.25, 0.35, 0.5, 0.7}, thresholds[] = {0.3, 0.45, 0.6};
    for (int i = 0; i < 12; i++) {
        WITH_DEFAULTS(ewa_render_options, options);
        options.prefilter_px = prefilters_px[i / 3];
        options.edge_threshold = thresholds[i % 3];
        options.supersampling = 1;
        const double expected = options.prefilter_px * tail(options.edge_threshold * (1 - sqrt(0.5)));
        const outline_errors found = draw(context, cloud, &camera, &options, &truth);
        print_message("h %.2f, tau %.2f: fat %+.3f px, by the filter %+.3f, rms %.3f\n", options.prefilter_px,
                      options.edge_threshold, found.fat_px, expected, found.rms);
        assert_true(fabs(found.fat_px - expected) < 0.03);
    }
}

TEST_ON(test_borders, 0) {
    static const uint64_t counts[] = {1000, 20000, 100000}; // spacings of 6, 1.4 and 0.6 px
    static const double fat_px[] = {0.6, 0.06, 0.06}, rms[] = {0.45, 0.23, 0.15}, open[] = {0.012, 1e-4, 1e-5};
    for (int i = 0; i < 3; i++) {
        const uint64_t n = counts[i];
        print_message("%llu points\n", (unsigned long long)n);
        const outline_errors mesh =
            measure(context, "disc, mesh", OUTLINE_DISC, oblique, disc_from_mesh(context, n));
        assert_true(fabs(mesh.fat_px) < 0.05 && mesh.rms < 0.1 && mesh.open == 0);
        const outline_errors disc =
            measure(context, "disc, random points", OUTLINE_DISC, oblique, estimated(context, OUTLINE_DISC, n));
        const outline_errors square = measure(context, "square, random points", OUTLINE_SQUARE, oblique,
                                              estimated(context, OUTLINE_SQUARE, n));
        assert_true(fabs(disc.fat_px) < fat_px[i] && disc.rms < rms[i] && disc.open < open[i]);
        assert_true(fabs(square.fat_px) < fat_px[i] && square.rms < rms[i] && square.open < open[i]);
    }
}

TEST_ON(test_flat_angles, 0) {
    static const double angles_deg[] = {5, 7, 10, 20, 45, 90};
    for (int i = 0; i < 6; i++) {
        const double angle = angles_deg[i] * 3.141592653589793 / 180;
        const double eye[3] = {0.3 * cos(angle), -3.2 * cos(angle), 3.2 * sin(angle) + 1e-3};
        char name[64];
        snprintf(name, sizeof name, "square at %g degrees, random points", angles_deg[i]);
        const outline_errors found =
            measure(context, name, OUTLINE_SQUARE, eye, estimated(context, OUTLINE_SQUARE, 20000));
        assert_true(found.open < 1e-4);
    }
}

/// Ridges whose far side is just hidden, and where they end, let nothing through.
TEST_ON(test_ridges, 0) {
    for (int i = 0; i < 6; i++) {
        const double around = i * 3.141592653589793 / 3;
        const double eye[3] = {2.8 * sin(around), -2.8 * cos(around), 1.6};
        char name[64];
        snprintf(name, sizeof name, "hills from %d degrees", 60 * i);
        const outline_errors found = measure(context, name, OUTLINE_HILLS, eye, estimated(context, OUTLINE_HILLS, 200000));
        assert_true(found.open < 2e-3 && found.deepest < 0.2);
    }
}

/// A square of points whose normals are noisy, or point to either side at random.
static ewa_cloud *doubtful_square(ewa_context *context, bool noisy) {
    enum { POINTS = 20000 };
    ewa_cloud *cloud = noisy ? outline_points(context, OUTLINE_SQUARE, POINTS)
                             : estimated(context, OUTLINE_SQUARE, POINTS);
    float *numbers = ewa_cloud_find(cloud, noisy ? EWA_POSITION : EWA_NORMAL)->data;
    check_random random = {5};
    for (int i = 0; i < POINTS; i++) {
        const double spacing = 2 / sqrt(POINTS), up = check_uniform(&random, -0.5, 0.5) * spacing;
        const bool turn = check_uniform(&random, 0, 1) < 0.5;
        if (noisy) numbers[3 * i + 2] += (float)up;
        for (int c = 0; c < 3 && !noisy && turn; c++) numbers[3 * i + c] *= -1;
    }
    WITH_DEFAULTS(ewa_estimate_options, options);
    assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
    return cloud;
}

/// Where both sides of one plane face the viewer it stays closed.
TEST_ON(test_doubtful_normals, 0) {
    static const double angles_deg[] = {7, 30, 90};
    for (int noisy = 0; noisy < 2; noisy++)
        for (int i = 0; i < 3; i++) {
            const double angle = angles_deg[i] * 3.141592653589793 / 180;
            const double eye[3] = {0.3 * cos(angle), -3.2 * cos(angle), 3.2 * sin(angle) + 1e-3};
            char name[64];
            snprintf(name, sizeof name, "square at %g degrees, %s", angles_deg[i],
                     noisy ? "noise" : "random signs");
            const outline_errors found =
                measure(context, name, OUTLINE_SQUARE, eye, doubtful_square(context, noisy));
            assert_true(found.open < 0.08);
        }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
