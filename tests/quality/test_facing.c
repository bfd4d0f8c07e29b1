// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What faces the viewer is what is seen, without culling: closed objects have no rims in the colours and with
// the normals of their far sides (against ray-traced truth), and sheets that fold are as opaque as if all of
// their surfels faced the viewer, whichever way their normals point.
#include "check.h"
#include "tests/prepare/check_generated.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "prepare/mesh_shapes.h"
#include "quality/solid_scene.h"

enum { SIDE = 320, REACH_PX = 9, SPACINGS = 48 };

#define PI 3.141592653589793

/// Convex solids around the origin that are no cubes: a box, or a cylinder around z.
typedef struct convex {
    bool is_round;
    double half[3]; ///< of the edges; of the cylinder: radius, radius, half the height
} convex;

static const convex plate = {false, {1, 0.8, 0.02}}, can = {true, {0.8, 0.8, 0.6}};

/// Where a ray enters the solid.
static solid_hit trace_convex(const convex *of, const double eye[3], const double ray[3]) {
    solid_hit hit = {.any = false};
    double from = 0, to = INFINITY;
    for (int c = of->is_round ? 2 : 0; c < 3; c++) {
        const double low = (-of->half[c] - eye[c]) / ray[c], high = (of->half[c] - eye[c]) / ray[c];
        if (fmin(low, high) > from) {
            from = fmin(low, high);
            memset(hit.normal, 0, sizeof hit.normal);
            hit.normal[c] = ray[c] > 0 ? -1 : 1;
            hit.surface = 2 * c + (ray[c] > 0);
        }
        to = fmin(to, fmax(low, high));
    }
    if (of->is_round) {
        const double a = ray[0] * ray[0] + ray[1] * ray[1], b = eye[0] * ray[0] + eye[1] * ray[1];
        const double c = eye[0] * eye[0] + eye[1] * eye[1] - of->half[0] * of->half[0], d = b * b - a * c;
        if (d <= 0) return hit;
        if ((-b - sqrt(d)) / a > from) {
            from = (-b - sqrt(d)) / a;
            for (int k = 0; k < 2; k++) hit.normal[k] = (eye[k] + from * ray[k]) / of->half[0];
            hit.normal[2] = 0;
            hit.surface = 0;
        }
        to = fmin(to, (-b + sqrt(d)) / a);
    }
    hit.any = from > 0 && from < to;
    return hit;
}

typedef struct truth {
    const ewa_solid_shape *shape; ///< NULL: convex
    const convex *convex;
} truth;

static solid_hit trace_px(const truth *of, const ewa_camera *camera, double x_px, double y_px) {
    if (of->shape) return solid_trace_px(of->shape, camera, x_px, y_px);
    const double x = (x_px - camera->cx_px) / camera->fx_px, y = (y_px - camera->cy_px) / camera->fy_px;
    const double *m = camera->world_to_camera;
    double eye[3], ray[3];
    ewa_camera_eye(camera, eye);
    for (int c = 0; c < 3; c++) ray[c] = m[c] * x + m[4 + c] * y + m[8 + c];
    return trace_convex(of->convex, eye, ray);
}

/// Points in rows on a piece of a surface, appended to a cloud's streams.
typedef struct points {
    float *position, *normal;
    uint64_t count;
    check_random random;
} points;

/// Adds a rectangle of the plane at `at` along axis `c`, or with `is_disc` the ellipse in it.
static void add_face(points *to, const double half[3], int c, double sign, bool is_disc, double spacing) {
    const int u = (c + 1) % 3, v = (c + 2) % 3;
    const int rows = (int)ceil(2 * half[u] / spacing), columns = (int)ceil(2 * half[v] / spacing);
    for (int i = 0; i < rows * columns; i++) {
        const double jitter_u = check_uniform(&to->random, 0.3, 0.7),
                     jitter_v = check_uniform(&to->random, 0.3, 0.7);
        const double s = 2 * (i / columns + jitter_u) / rows - 1,
                     t = 2 * (i % columns + jitter_v) / columns - 1;
        if (is_disc && s * s + t * t > 1) continue;
        float *p = to->position + 3 * to->count, *n = to->normal + 3 * to->count;
        p[u] = (float)(s * half[u]), p[v] = (float)(t * half[v]), p[c] = (float)(sign * half[c]);
        n[u] = n[v] = 0, n[c] = (float)sign;
        to->count++;
    }
}

static void add_mantle(points *to, const double half[3], double spacing) {
    const int around = (int)(2 * PI * half[0] / spacing), rows = (int)ceil(2 * half[2] / spacing);
    for (int i = 0; i < around * rows; i++) {
        const double angle = 2 * PI * (i % around + check_uniform(&to->random, 0.3, 0.7)) / around;
        float *p = to->position + 3 * to->count, *n = to->normal + 3 * to->count;
        n[0] = (float)cos(angle), n[1] = (float)sin(angle), n[2] = 0;
        p[0] = (float)half[0] * n[0], p[1] = (float)half[0] * n[1];
        p[2] = (float)(half[2] * (2 * (i / around + check_uniform(&to->random, 0.3, 0.7)) / rows - 1));
        to->count++;
    }
}

static ewa_cloud *make_cloud(ewa_context *context, const points *from, double radius) {
    ewa_cloud *cloud = check_cloud_of(context, from->count);
    float *position = check_add(cloud, EWA_POSITION, EWA_F32, 3);
    float *normal = check_add(cloud, EWA_NORMAL, EWA_F32, 3);
    float *radii = check_add(cloud, EWA_RADIUS, EWA_F32, 1);
    memcpy(position, from->position, from->count * 3 * sizeof *position);
    memcpy(normal, from->normal, from->count * 3 * sizeof *normal);
    for (uint64_t i = 0; i < from->count; i++) radii[i] = (float)radius;
    return cloud;
}

static ewa_cloud *make_convex(ewa_context *context, const convex *of) {
    enum { MAXIMUM = 100000 };
    const double spacing = 2.0 / SPACINGS;
    points made = {calloc(3 * MAXIMUM, sizeof(float)), calloc(3 * MAXIMUM, sizeof(float)), 0, {7}};
    assert_true(made.position && made.normal);
    for (int side = 0; side < 2; side++)
        for (int c = of->is_round ? 2 : 0; c < 3; c++)
            add_face(&made, of->half, c, side ? 1 : -1, of->is_round, spacing);
    if (of->is_round) add_mantle(&made, of->half, spacing);
    assert_true(made.count <= MAXIMUM);
    ewa_cloud *cloud = make_cloud(context, &made, 1.5 * spacing);
    free(made.position);
    free(made.normal);
    return cloud;
}

static ewa_cloud *make_generated(ewa_context *context, ewa_object object) {
    ewa_cloud *cloud = check_object(context, object, 20000);
    return cloud;
}

static ewa_cloud *make_sampled(ewa_context *context) {
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    WITH_DEFAULTS(ewa_mesh_sample_options, options);
    options.point_count = 20000;
    options.clip_lines = false;
    shape_cube(context, &mesh);
    ewa_cloud *cloud = shape_sample(&mesh, &options);
    return cloud;
}

/// What is found near the silhouettes of a solid.
typedef struct rim_counts {
    uint64_t outline; ///< pixels on them
    uint64_t rim;     ///< pixels, at least three quarters covered, in a colour that no place near has
    uint64_t turned;  ///< pixels inside whose normal is over 25 degrees from the truth
} rim_counts;

/// The solid's pictures: what is behind each pixel's centre.
static void trace_picture(const truth *of, const ewa_camera *camera, solid_hit *hits) {
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) hits[y * SIDE + x] = trace_px(of, camera, x + 0.5, y + 0.5);
}

/// The difference between a colour and the nearest one of the solid's pixels within reach; negative where
/// these are of two faces, which blend. Beyond reach of all: 1.
static double strangeness(const solid_hit *hits, int x, int y, const float color[3]) {
    double minimum = 1;
    int surface = -1;
    for (int dy = -REACH_PX; dy <= REACH_PX; dy++)
        for (int dx = -REACH_PX; dx <= REACH_PX; dx++) {
            const int nx = x + dx, ny = y + dy;
            if (dx * dx + dy * dy > REACH_PX * REACH_PX || nx < 0 || ny < 0 || nx >= SIDE || ny >= SIDE)
                continue;
            const solid_hit *hit = &hits[ny * SIDE + nx];
            if (!hit->any) continue;
            if (surface >= 0 && hit->surface != surface) return -1;
            surface = hit->surface;
            float there[3];
            solid_color(hit->normal, there);
            double maximum = 0;
            for (int c = 0; c < 3; c++) maximum = fmax(maximum, fabs((double)color[c] - (double)there[c]));
            minimum = fmin(minimum, maximum);
        }
    return minimum;
}

static void count_rims(ewa_renderer *renderer, const ewa_cloud *cloud, const truth *of, rim_counts *counts) {
    static solid_hit hits[SIDE * SIDE];
    static float rgba[4 * SIDE * SIDE], normals[3 * SIDE * SIDE];
    static const double eyes[][3] = {{2.2, -2.6, 1.9}, {3.2, -0.4, 1.2}, {0.3, -3.4, 0.9}, {-1.5, 1.2, -3}};
    static const double target[3] = {0, 0, 0}, up[3] = {0.1, 0.05, 1};
    *counts = (rim_counts){0};
    WITH_DEFAULTS(ewa_render_options, options);
    options.shading = EWA_SHADING_NONE;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(cloud, NULL);
    for (size_t view = 0; view < sizeof eyes / sizeof eyes[0]; view++) {
        ewa_camera camera = check_camera(SIDE, SIDE);
        assert_int_equal(ewa_camera_set_fov(&camera, 45), EWA_OK);
        assert_int_equal(ewa_camera_look_at(&camera, eyes[view], target, up), EWA_OK);
        trace_picture(of, &camera, hits);
        const ewa_frame frame = {.rgba = rgba, .normal = normals};
        assert_int_equal(ewa_render(renderer, surfels, &camera, &options, &frame, NULL), EWA_OK);
        for (int y = 1; y < SIDE; y++)
            for (int x = 1; x < SIDE; x++) {
                const int at = y * SIDE + x;
                counts->outline += hits[at].any != hits[at - 1].any || hits[at].any != hits[at - SIDE].any;
                const float alpha = rgba[4 * at + 3], *n = &normals[3 * at];
                if (!(alpha >= 0.75f)) continue;
                float color[3];
                for (int c = 0; c < 3; c++) color[c] = rgba[4 * at + c] / alpha;
                const double strange = strangeness(hits, x, y, color);
                counts->rim += strange > 0.08;
                double cosine = 0;
                for (int c = 0; c < 3; c++) cosine += hits[at].normal[c] * (double)n[c];
                counts->turned += strange >= 0 && hits[at].any && cosine < cos(25 * PI / 180);
            }
    }
}

TEST_ON(test_no_rims_of_far_sides, 0) {
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    const truth cube = {.shape = ewa_solid_shape_of(EWA_OBJECT_CUBE)};
    const struct {
        const char *name;
        ewa_cloud *cloud;
        truth of;
    } solids[] = {
        {"cube", make_generated(context, EWA_OBJECT_CUBE), cube},
        {"sampled cube", make_sampled(context), cube},
        {"part", make_generated(context, EWA_OBJECT_CSG), {.shape = ewa_solid_shape_of(EWA_OBJECT_CSG)}},
        {"plate", make_convex(context, &plate), {.convex = &plate}},
        {"can", make_convex(context, &can), {.convex = &can}},
    };
    for (size_t i = 0; i < sizeof solids / sizeof solids[0]; i++) {
        rim_counts found;
        solid_color_cloud(solids[i].cloud);
        count_rims(renderer, solids[i].cloud, &solids[i].of, &found);
        print_message("%s: %llu pixels of outline, %llu of rims, %llu with a normal turned over inside\n",
                      solids[i].name, (unsigned long long)found.outline, (unsigned long long)found.rim,
                      (unsigned long long)found.turned);
        // A rim as wide as what far sides reach past edges has several pixels per pixel of outline; what is
        // left is in front of nothing, less than a pixel wide.
        assert_true(3 * found.rim < found.outline && 10 * found.turned < found.outline);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = solids[i].cloud;
    }
}

/// A disc that faces the viewer, in a sheet that does not: as its weight grows the mean goes over to it evenly,
/// however much more the sheet weighs.
TEST_ON(test_means_go_over, 0) {
    enum { ROWS = 60 };
    static float both[4 * SIDE * SIDE], all[SIDE * SIDE], front[SIDE * SIDE];
    static const double eye[3] = {0.3, -0.4, 3}, target[3] = {0, 0, 0}, up[3] = {0.1, 1, 0};
    points made = {calloc(3 * (ROWS * ROWS + 1), sizeof(float)), calloc(3 * (ROWS * ROWS + 1), sizeof(float)), 0, {1}};
    assert_true(made.position && made.normal);
    for (int i = 0; i <= ROWS * ROWS; i++) {
        const bool disc = i == ROWS * ROWS;
        float *p = made.position + 3 * i, *n = made.normal + 3 * i;
        p[0] = disc ? 0.1f : 2 * ((float)(i % ROWS) + 0.5f) / ROWS - 1;
        p[1] = disc ? 0.2f : 2 * ((float)(i / ROWS) + 0.5f) / ROWS - 1;
        n[2] = disc ? 1 : -1;
        made.count++;
    }
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(context, &made, 0.06);
    ((float *)ewa_cloud_find(cloud, EWA_RADIUS)->data)[ROWS * ROWS] = 0.4f;
    float *color = check_add(cloud, EWA_COLOR, EWA_F32, 3);
    memset(color, 0, 3 * made.count * sizeof *color);
    for (uint64_t i = 0; i < made.count; i++) color[3 * i + (i == ROWS * ROWS ? 0 : 2)] = 1;
    ewa_camera camera = check_camera(SIDE, SIDE);
    assert_int_equal(ewa_camera_set_fov(&camera, 45), EWA_OK);
    assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
    WITH_DEFAULTS(ewa_render_options, options);
    options.shading = EWA_SHADING_NONE;
    ewa_surfels *surfels = check_surfels(cloud, NULL);
    ewa_renderer *renderer = check_renderer(context);
    const ewa_frame frames[2] = {{.rgba = both, .coverage = all}, {.coverage = front}};
    for (int f = 0; f < 2; f++) {
        options.cull = f ? EWA_CULL_BACK : EWA_CULL_NONE;
        assert_int_equal(ewa_render(renderer, surfels, &camera, &options, &frames[f], NULL), EWA_OK);
    }
    uint64_t between = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        if (!(all[i] > front[i]) || !(both[4 * i + 3] == 1)) continue;
        const double share = fmin(1, (double)front[i] / 0.05);
        between += share > 0.1 && share < 0.9;
        assert_true(fabs((double)both[4 * i] - share) < 2e-3 && fabs((double)both[4 * i + 2] - (1 - share)) < 2e-3);
    }
    assert_true(between > 500);
    ewa_renderer_destroy(&renderer);
    ewa_surfels_destroy(&surfels);
    free(made.position);
    free(made.normal);
}

/// A sheet in waves that hang over: it folds twice in each, and shows both of its sides from everywhere.
static ewa_cloud *make_waves(ewa_context *context) {
    enum { ALONG = 220, ACROSS = 110 };
    points made = {
        calloc(3 * ALONG * ACROSS, sizeof(float)), calloc(3 * ALONG * ACROSS, sizeof(float)), 0, {11}};
    assert_true(made.position && made.normal);
    for (; made.count < ALONG * ACROSS; made.count++) {
        const double x =
            2 * ((double)(made.count / ACROSS) + check_uniform(&made.random, 0.2, 0.8)) / ALONG - 1;
        const double y =
            2 * ((double)(made.count % ACROSS) + check_uniform(&made.random, 0.2, 0.8)) / ACROSS - 1;
        float *p = made.position + 3 * made.count, *n = made.normal + 3 * made.count;
        p[0] = (float)(x + 0.25 * sin(9 * x)), p[1] = (float)y, p[2] = (float)(0.3 * cos(9 * x));
        n[0] = (float)(2.7 * sin(9 * x)), n[1] = 0, n[2] = (float)(1 + 2.25 * cos(9 * x));
    }
    ewa_cloud *cloud = make_cloud(context, &made, 0.045);
    free(made.position);
    free(made.normal);
    float *color = check_add(cloud, EWA_COLOR, EWA_F32, 3);
    const float *position = ewa_cloud_find(cloud, EWA_POSITION)->data;
    for (uint64_t i = 0; i < made.count; i++)
        for (int c = 0; c < 3; c++)
            color[3 * i + (uint64_t)c] = 0.5f + 0.4f * sinf(7 * position[3 * i + 1] + (float)c);
    return cloud;
}

enum { SIGNS_ALL = 0, SIGNS_PATCHES, SIGNS_RANDOM, SIGN_KINDS };

/// Turns normals over: all, in patches, at random.
static void turn_normals(ewa_cloud *cloud, int kind) {
    float *normal = ewa_cloud_find(cloud, EWA_NORMAL)->data;
    const float *position = ewa_cloud_find(cloud, EWA_POSITION)->data;
    check_random random = {13};
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        const bool patch = sinf(6 * position[3 * i]) * sinf(5 * position[3 * i + 1]) > 0.3f;
        const bool turn = kind == SIGNS_ALL || (kind == SIGNS_PATCHES && patch) ||
                          (kind == SIGNS_RANDOM && check_uniform(&random, 0, 1) < 0.5);
        for (int c = 0; c < 3 && turn; c++) normal[3 * i + (uint64_t)c] *= -1;
    }
}

static void draw_sheet(ewa_renderer *renderer, const ewa_cloud *cloud, const double eye[3], double opacity,
                       float *rgba, float *coverage) {
    static const double target[3] = {0, 0, 0}, up[3] = {0.1, 0.05, 1};
    WITH_DEFAULTS(ewa_render_options, options);
    options.opacity = opacity;
    ewa_camera camera = check_camera(SIDE, SIDE);
    assert_int_equal(ewa_camera_set_fov(&camera, 45), EWA_OK);
    assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
    const ewa_frame frame = {.rgba = rgba, .coverage = coverage};
    ewa_surfels *surfels = check_surfels(cloud, NULL);
    assert_int_equal(ewa_render(renderer, surfels, &camera, &options, &frame, NULL), EWA_OK);
    ewa_surfels_destroy(&surfels);
}

/// The largest difference between pictures of `channels` numbers per pixel, in one of them or in all (-1).
static double largest_difference(const float *a, const float *b, int channels, int channel) {
    double maximum = 0;
    for (int i = 0; i < channels * SIDE * SIDE; i++)
        if (channel < 0 || i % channels == channel)
            maximum = fmax(maximum, fabs((double)a[i] - (double)b[i]));
    return maximum;
}

TEST_ON(test_cover_is_blind_to_normals, 0) {
    static float rgba[2][4 * SIDE * SIDE], coverage[2][SIDE * SIDE];
    static const double eyes[][3] = {{2.2, -2.6, 1.9}, {1.5, -2.2, -2.2}, {3, -0.4, 0.3}, {0.3, -0.2, -3}};
    static const char *const names[SIGN_KINDS] = {"all", "in patches", "at random"};
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    for (int kind = 0; kind < SIGN_KINDS; kind++)
        for (size_t view = 0; view < sizeof eyes / sizeof eyes[0]; view++) {
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_waves(context);
            const double opacity = view == 1 ? 0.5 : 1;
            draw_sheet(renderer, cloud, eyes[view], opacity, rgba[0], coverage[0]);
            turn_normals(cloud, kind);
            draw_sheet(renderer, cloud, eyes[view], opacity, rgba[1], coverage[1]);
            const double alpha = largest_difference(rgba[0], rgba[1], 4, 3);
            const double covered = largest_difference(coverage[0], coverage[1], 1, 0);
            print_message("normals turned over %s: alpha differs by %.2g, coverage by %.2g, colour by %.2g\n",
                          names[kind], alpha, covered, largest_difference(rgba[0], rgba[1], 4, -1));
            // Normals of 16 bits are not quite the same with the other sign.
            assert_true(alpha < 1e-3 && covered < 1e-2);
        }
}

/// A sphere seen from inside shows its whole inner side, whichever way its normals point, and the same.
TEST_ON(test_inside_is_shown, 0) {
    static float rgba[2][4 * SIDE * SIDE], coverage[SIDE * SIDE];
    static const double eye[3] = {0.2, -0.5, 0.1};
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_generated(context, EWA_OBJECT_SPHERE);
    draw_sheet(renderer, cloud, eye, 1, rgba[0], coverage);
    turn_normals(cloud, SIGNS_ALL);
    draw_sheet(renderer, cloud, eye, 1, rgba[1], coverage);
    for (int i = 0; i < SIDE * SIDE; i++) assert_true(rgba[0][4 * i + 3] > 0.999f);
    assert_true(largest_difference(rgba[0], rgba[1], 4, -1) < 2e-5);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
