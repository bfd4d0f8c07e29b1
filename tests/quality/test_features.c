// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How many edge surfels of noisy solids are found and right, and that no hole is along the edges found.
#include "quality/feature_scene.h"

#include <math.h>

enum { SIDE = 192, CAMERAS = 40, MARGIN = 4 };

TEST_ON(test_scores, 0) {
    // The floors leave some room below what docs/features.md says.
    static const struct {
        feature_solid solid;
        double noise, recall, precision, line_error;
    } rows[] = {
        {SOLID_CUBE, 0, 0.99, 0.99, 0.03},       {SOLID_CUBE, 0.1, 0.98, 0.99, 0.1},
        {SOLID_CUBE, 0.25, 0.97, 0.95, 0.2},     {SOLID_CYLINDER, 0, 0.99, 0.99, 0.06},
        {SOLID_CYLINDER, 0.1, 0.98, 0.98, 0.12}, {SOLID_CYLINDER, 0.25, 0.95, 0.93, 0.25},
        {SOLID_PART, 0, 0.75, 0.98, 0.5},        {SOLID_PART, 0.1, 0.65, 0.95, 0.5},
    };
    char path[512];
    const char *part = check_data("models/fuze/fuze.obj", path, sizeof path);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        OWNED(feature_scene_free) feature_scene scene;
        if (!feature_scene_make(rows[i].solid, part, rows[i].solid == SOLID_PART ? 60000 : 24000, &scene))
            continue;
        feature_score score;
        feature_scene_measure(context, &scene, rows[i].noise, &score);
        print_message("solid %d, noise %g: recall %.3f, precision %.3f, line error %.3f\n",
                      (int)rows[i].solid, rows[i].noise, score.recall, score.precision, score.line_error);
        assert_true(score.recall >= rows[i].recall);
        assert_true(score.precision >= rows[i].precision);
        assert_true(score.line_error <= rows[i].line_error);
        assert_true(fabs(score.counts.noise - rows[i].noise) < 0.05);
    }
}

/// Whether the ray through a point of the picture meets the cube of edge 2.
static bool meets_cube(const ewa_camera *camera, const double eye[3], double x_px, double y_px) {
    const double x = (x_px - camera->cx_px) / camera->fx_px, y = (y_px - camera->cy_px) / camera->fy_px;
    const double *m = camera->world_to_camera;
    double enter = 0, leave = INFINITY;
    for (int c = 0; c < 3; c++) {
        const double ray = m[c] * x + m[4 + c] * y + m[8 + c];
        const double low = (-1 - eye[c]) / ray, high = (1 - eye[c]) / ray;
        enter = fmax(enter, fmin(low, high));
        leave = fmin(leave, fmax(low, high));
    }
    return enter < leave;
}

/// Looks at a random place of a random edge, from outside of the cube and close by.
static void edge_camera(check_random *random, ewa_camera *camera) {
    double target[3], eye[3];
    const int along = (int)(check_random_u64(random) % 3);
    for (int c = 0; c < 3; c++) {
        const double end = check_random_u64(random) % 2 ? 1 : -1;
        target[c] = c == along ? check_uniform(random, -0.9, 0.9) : end;
        eye[c] = target[c] * check_uniform(random, 1.1, 2.5);
    }
    const double up[3] = {0.3, 0.2, 1};
    ewa_camera_init(camera);
    camera->width_px = camera->height_px = SIDE;
    assert_int_equal(ewa_camera_set_fov(camera, 50), EWA_OK);
    assert_int_equal(ewa_camera_look_at(camera, eye, target, up), EWA_OK);
}

/// Pixels within the cube's picture, seen close to its edges, and those of them that are not quite covered.
typedef struct hole_counts {
    uint64_t inside, holes, thin;
} hole_counts;

static void count_holes(ewa_context *context, double noise, hole_counts *found) {
    *found = (hole_counts){0};
    feature_scene scene;
    assert_true(feature_scene_make(SOLID_CUBE, NULL, 6 * 40 * 40, &scene));
    ewa_feature_counts counts;
    double seconds;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = feature_scene_detect(context, &scene, noise, &counts, &seconds);
    feature_scene_free(&scene);
    assert_true(counts.edge_count > 1000 && counts.corner_count >= 8);
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(cloud, NULL);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    WITH_DEFAULTS(ewa_render_options, render);
    render.cull = EWA_CULL_BACK; // or the far side would fill the holes of the near one
    static float rgba[4 * SIDE * SIDE];
    const ewa_frame frame = {.rgba = rgba};
    check_random random = {7};
    for (int i = 0; i < CAMERAS; i++) {
        ewa_camera camera;
        edge_camera(&random, &camera);
        double eye[3];
        ewa_camera_eye(&camera, eye);
        assert_int_equal(ewa_render(renderer, surfels, &camera, &render, &frame, NULL), EWA_OK);
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                bool covered = true;
                // A pixel beyond on all sides: silhouettes are antialiased.
                for (int corner = 0; corner < 4; corner++)
                    covered =
                        covered && meets_cube(&camera, eye, x - MARGIN + (2 * MARGIN + 1) * (corner & 1),
                                              y - MARGIN + (2 * MARGIN + 1) * (corner >> 1));
                if (!covered) continue;
                found->inside++;
                found->holes += rgba[4 * (y * SIDE + x) + 3] == 0;
                found->thin += rgba[4 * (y * SIDE + x) + 3] < 0.999f;
            }
    }
    print_message("noise %g: %llu pixels, %llu holes, %llu translucent\n", noise,
                  (unsigned long long)found->inside, (unsigned long long)found->holes,
                  (unsigned long long)found->thin);
}

TEST_ON(test_no_holes, 0) {
    static const double noises[] = {0, 0.1, 0.25};
    for (int i = 0; i < 3; i++) {
        hole_counts found;
        count_holes(context, noises[i], &found);
        assert_true(found.inside > 100000);
        assert_int_equal(found.holes, 0);
        // Noise moves the silhouette; without clip lines as many pixels are translucent.
        assert_true((double)found.thin < (noises[i] > 0 ? 0.05 : 2e-4) * (double)found.inside);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
