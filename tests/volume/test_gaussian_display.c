// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Gaussians as ellipsoids and dots: depths and normals against those of the ellipsoids in double precision, among surfaces and cut by
// sections; the same bytes for every number of threads and order of the set.
#include "gaussian_scene.h"

#include <math.h>

enum { WIDTH = 96, HEIGHT = 72, PIXELS = WIDTH * HEIGHT, COUNT = 300 };

typedef struct planes {
    float rgba[4 * PIXELS], depth[PIXELS], normal[3 * PIXELS], coverage[PIXELS];
} planes;

static const double DIRECTION[3] = {-1, 0.3, 0.5};

static ewa_gaussian_stats draw(const ewa_gaussians *set, const ewa_camera *camera, const ewa_gaussian_options *options, planes *to) {
    OWNED(ewa_gaussian_renderer_destroy) ewa_gaussian_renderer *renderer = NULL;
    OWNED(ewa_splats_destroy) ewa_splats *splats = NULL;
    ewa_gaussian_stats stats;
    const ewa_frame frame = {.rgba = to->rgba, .depth = to->depth, .normal = to->normal, .coverage = to->coverage};
    assert_int_equal(ewa_splats_create(set, false, &splats), EWA_OK);
    assert_int_equal(ewa_gaussian_renderer_create(set->context, &renderer), EWA_OK);
    assert_int_equal(ewa_gaussian_render(renderer, splats, camera, options, &frame, &stats), EWA_OK);
    return stats;
}

static ewa_gaussian_options options_of(ewa_gaussian_display display) {
    WITH_DEFAULTS(ewa_gaussian_options, options);
    options.display = display;
    options.ellipsoid_radius = 1.5;
    options.dot_px = 5;
    return options;
}

/// Where the ray of a place on the screen enters an ellipsoid of `radius` standard deviations: depth and normal; INFINITY: nowhere.
static double enter(const ewa_gaussians *set, size_t i, const ewa_camera *camera, double radius, double x_px, double y_px, double normal[3]) {
    const double *m = camera->world_to_camera;
    const bool ortho = camera->projection == EWA_ORTHOGRAPHIC;
    const double sx = (x_px - camera->cx_px) / camera->fx_px, sy = (y_px - camera->cy_px) / camera->fy_px;
    const double from[3] = {ortho ? sx : 0, ortho ? sy : 0, 0}, ray[3] = {ortho ? 0 : sx, ortho ? 0 : sy, 1};
    const float *q = set->rotations + 4 * i;
    const double w = (double)q[0], x = (double)q[1], y = (double)q[2], z = (double)q[3];
    const double axes[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
                               {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
                               {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
    double o[3], d[3], off[3], turned[3], a = 0, b = 0, c = 0;
    for (int k = 0; k < 3; k++) {
        off[k] = turned[k] = 0;
        for (int r = 0; r < 3; r++) off[k] += m[4 * r + k] * (from[r] - m[4 * r + 3]), turned[k] += m[4 * r + k] * ray[r];
        off[k] -= (double)set->centers[3 * i + (size_t)k];
    }
    for (int k = 0; k < 3; k++) {
        const double scale = (double)set->scales[3 * i + (size_t)k] * radius;
        o[k] = d[k] = 0;
        for (int r = 0; r < 3; r++) o[k] += axes[k][r] * off[r] / scale, d[k] += axes[k][r] * turned[r] / scale;
        a += d[k] * d[k], b += o[k] * d[k], c += o[k] * o[k];
    }
    const double root = b * b - a * (c - 1);
    if (root <= 0) return INFINITY;
    double t = (-b - sqrt(root)) / a, squares = 0;
    if (t <= 0 && !ortho) t = (-b + sqrt(root)) / a;
    if (t <= 0 && !ortho) return INFINITY;
    for (int r = 0; r < 3; r++) {
        normal[r] = 0;
        for (int k = 0; k < 3; k++) normal[r] += axes[k][r] * (o[k] + t * d[k]) / (double)set->scales[3 * i + (size_t)k];
        squares += normal[r] * normal[r];
    }
    const double facing = normal[0] * turned[0] + normal[1] * turned[1] + normal[2] * turned[2];
    for (int r = 0; r < 3; r++) normal[r] *= (facing > 0 ? -1 : 1) / sqrt(squares);
    return t;
}

TEST_ON(ellipsoids_where_they_are, 2) {
    OWNED(ewa_gaussians_free) ewa_gaussians set = gaussians_random(context, COUNT, 1, 7);
    static planes out;
    for (int n = 0; n < 4; n++) { // the last ones fill the picture
        ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, n == 1 ? 110 : n == 3 ? 10 : 40, DIRECTION, n == 1 ? 1.2 : 4);
        if (n == 2) camera.projection = EWA_ORTHOGRAPHIC, camera.fx_px = camera.fy_px = 30;
        ewa_gaussian_options options = options_of(EWA_DISPLAY_ELLIPSOIDS);
        if (n == 3) options.ellipsoid_radius = 3;
        draw(&set, &camera, &options, &out);
        size_t compared = 0, apart = 0;
        double largest = 0;
        for (size_t p = 0; p < PIXELS; p++) {
            double nearest = INFINITY, sum[3] = {0};
            int hits = 0;
            for (int sample = 0; sample < 4; sample++) {
                const double x = (double)(p % WIDTH) + 0.25 + 0.5 * (sample % 2), y = (double)(p / WIDTH) + 0.25 + 0.5 * (sample / 2);
                double first = INFINITY, normal[3] = {0}, own[3] = {0};
                for (size_t i = 0; i < COUNT; i++) {
                    if (set.opacities[i] < (float)options.minimum_alpha) continue;
                    const double t = enter(&set, i, &camera, options.ellipsoid_radius, x, y, own);
                    if (t < first) first = t, memcpy(normal, own, sizeof normal);
                }
                hits += first < INFINITY;
                nearest = fmin(nearest, first);
                for (int c = 0; c < 3; c++) sum[c] += normal[c];
            }
            // Outlines may go either way in single precision.
            compared++;
            bool alike = fabs((double)out.coverage[p] - hits / 4.0) < 1e-6 && isinf(out.depth[p]) == isinf(nearest);
            if (alike && hits) {
                const double size = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
                largest = fmax(largest, fabs((double)out.depth[p] - nearest));
                for (size_t c = 0; c < 3; c++) alike = alike && fabs((double)out.normal[3 * p + c] - sum[c] / size) < 1e-2;
                alike = alike && fabs((double)out.depth[p] - nearest) < 1e-3;
            }
            apart += !alike;
        }
        print_message("ellipsoids, %d: %zu of %zu pixels apart, depths within %.2g\n", n, apart, compared, largest);
        assert_true(apart < PIXELS / 100);
    }
}

TEST_ON(dots_at_centres, 2) {
    const double center[3] = {0.1, -0.2, 0.3}, scales[3] = {0.01, 0.2, 0.05}, turn[4] = {1, 0, 0, 0}, color[3] = {0.2, 0.6, 1};
    OWNED(ewa_gaussians_free) ewa_gaussians set = gaussians_one(context, center, scales, turn, 0.5, color);
    const ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, 40, DIRECTION, 4);
    static planes out;
    const ewa_gaussian_options options = options_of(EWA_DISPLAY_POINTS);
    draw(&set, &camera, &options, &out);
    const double *m = camera.world_to_camera;
    double at[3], covered = 0;
    for (int r = 0; r < 3; r++) at[r] = m[4 * r] * center[0] + m[4 * r + 1] * center[1] + m[4 * r + 2] * center[2] + m[4 * r + 3];
    const double x = camera.fx_px * at[0] / at[2] + camera.cx_px, y = camera.fy_px * at[1] / at[2] + camera.cy_px;
    for (size_t p = 0; p < PIXELS; p++) {
        const double away = hypot((double)(p % WIDTH) + 0.5 - x, (double)(p / WIDTH) + 0.5 - y);
        covered += (double)out.coverage[p];
        if (away < 1.7) assert_true(out.coverage[p] == 1 && fabs((double)out.depth[p] - at[2]) < 1e-4);
        if (away > 3.3) assert_true(out.coverage[p] == 0 && isinf(out.depth[p]));
        if (away < 1.7) assert_true(fabsf(out.rgba[4 * p + 2] - 1) < 1e-5f && fabsf(out.rgba[4 * p] - 0.0331f) < 1e-3f);
    }
    assert_true(fabs(covered - 3.14159 * 6.25) < 1.5);
}

/// A surface before half of the picture, and one behind it; a section through the middle.
TEST_ON(among_surfaces_and_sections, 2) {
    const double center[3] = {0, 0, 0}, scales[3] = {0.6, 0.6, 0.6}, turn[4] = {1, 0, 0, 0}, color[3] = {1, 1, 1},
                 front[3] = {0, 0, 1}, inside[3] = {0, 0, 1};
    OWNED(ewa_gaussians_free) ewa_gaussians set = gaussians_one(context, center, scales, turn, 0.9, color);
    const ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, 40, front, 4);
    static planes out, alone, cut, surface;
    ewa_gaussian_options options = options_of(EWA_DISPLAY_ELLIPSOIDS);
    draw(&set, &camera, &options, &alone);
    for (size_t p = 0; p < PIXELS; p++) {
        surface.depth[p] = p % WIDTH < WIDTH / 2 ? 1 : 9;
        for (size_t c = 0; c < 4; c++) surface.rgba[4 * p + c] = c == 3 ? 1 : c == 0 ? 0.5f : 0;
        for (size_t c = 0; c < 3; c++) surface.normal[3 * p + c] = c == 1 ? 1 : 0;
        surface.coverage[p] = 1;
    }
    options.surface_depth = surface.depth, options.surface_rgba = surface.rgba, options.surface_normal = surface.normal,
    options.surface_coverage = surface.coverage;
    draw(&set, &camera, &options, &out);
    size_t before = 0;
    for (size_t p = 0; p < PIXELS; p++) {
        const bool shows = p % WIDTH >= WIDTH / 2 && alone.coverage[p] > 0;
        before += shows;
        assert_true(out.depth[p] == (shows ? alone.depth[p] : surface.depth[p]));
        assert_memory_equal(out.normal + 3 * p, shows ? alone.normal + 3 * p : surface.normal + 3 * p, 3 * sizeof(float));
        if (!shows) assert_memory_equal(out.rgba + 4 * p, surface.rgba + 4 * p, 4 * sizeof(float));
    }
    assert_true(before > 500);
    // What is nearer to the eye than the middle is cut away: of the ball the far wall is left.
    options = options_of(EWA_DISPLAY_ELLIPSOIDS);
    const double *m = camera.world_to_camera;
    for (int k = 0; k < 3; k++) options.section_planes[0][k] = m[8 + k] * inside[2];
    options.section_planes[0][3] = 0;
    options.section_count = 1;
    draw(&set, &camera, &options, &cut);
    const size_t middle = (size_t)(HEIGHT / 2) * WIDTH + WIDTH / 2;
    assert_true(fabs((double)alone.depth[middle] - 3.1) < 0.01 && fabs((double)cut.depth[middle] - 4.9) < 0.01);
}

/// What is hidden everywhere in a tile is not looked at, and changes nothing.
TEST_ON(hidden_behind, 2) {
    enum { MANY = 2000 };
    OWNED(ewa_gaussians_free) ewa_gaussians set = gaussians_random(context, MANY, 1, 7);
    const ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, 40, DIRECTION, 4);
    const double *m = camera.world_to_camera;
    const ewa_gaussian_options options = options_of(EWA_DISPLAY_ELLIPSOIDS);
    static planes all, ball;
    for (size_t k = 0; k < 3; k++) { // a ball that fills the picture, between the eye and the others
        const double eye = -(m[k] * m[3] + m[4 + k] * m[7] + m[8 + k] * m[11]);
        set.centers[k] = (float)(eye + 2 * m[8 + k]);
        set.scales[k] = 0.8f;
    }
    set.opacities[0] = 1;
    const ewa_gaussian_stats stats = draw(&set, &camera, &options, &all);
    print_message("hidden: %llu of %llu evaluated\n", (unsigned long long)stats.block_count, (unsigned long long)stats.tile_count);
    assert_true(stats.block_count > 0 && 2 * stats.block_count < stats.tile_count);
    set.count = 1;
    draw(&set, &camera, &options, &ball);
    set.count = MANY;
    assert_memory_equal(all.rgba, ball.rgba, sizeof all.rgba);
    assert_memory_equal(all.depth, ball.depth, sizeof all.depth);
}

TEST(same_bytes) {
    static planes first[2], other;
    for (uint32_t n = 0; n < 4; n++)
        for (int kind = 0; kind < 2; kind++) {
            OWNED(ewa_context_destroy) ewa_context *context = check_context(n == 3 ? 1 : n + 1, NULL);
            OWNED(ewa_gaussians_free) ewa_gaussians set = gaussians_random(context, COUNT, 1, 7);
            for (uint32_t i = 0; n == 3 && i < COUNT / 2; i++) { // in another order
                const size_t a = i, b = COUNT - 1 - i;
                float *const streams[] = {set.centers, set.scales, set.rotations, set.opacities, set.harmonics};
                const size_t counts[] = {3, 3, 4, 1, 12};
                for (int s = 0; s < 5; s++)
                    for (size_t k = 0; k < counts[s]; k++) {
                        const float swapped = streams[s][a * counts[s] + k];
                        streams[s][a * counts[s] + k] = streams[s][b * counts[s] + k];
                        streams[s][b * counts[s] + k] = swapped;
                    }
            }
            const ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, 40, DIRECTION, 3);
            const ewa_gaussian_options options = options_of(kind ? EWA_DISPLAY_POINTS : EWA_DISPLAY_ELLIPSOIDS);
            draw(&set, &camera, &options, n ? &other : &first[kind]);
            if (n) assert_memory_equal(&first[kind], &other, sizeof other);
        }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
