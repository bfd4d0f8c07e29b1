// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Splats of few pixels have loops of their own, but not where depths are wanted: the other planes must be the
// same bytes with and without depths. What lies behind open pixels is found by them, too.
#include "check.h"

#include <math.h>

enum { SIDE = 160, SHEETS = 3 };

/// Discs with radii of `min_px` to `max_px` pixels on wavy sheets one behind another, tilted every way; one
/// in `every` (0: none) is `times` as large.
static ewa_surfels *make_sheets(ewa_context *context, uint32_t points, double min_px, double max_px,
                                uint32_t every, double times) {
    ewa_cloud *cloud = check_cloud_of(context, points);
    float *position = check_add(cloud, EWA_POSITION, EWA_F32, 3);
    float *normal = check_add(cloud, EWA_NORMAL, EWA_F32, 3);
    float *radius = check_add(cloud, EWA_RADIUS, EWA_F32, 1);
    uint8_t *color = check_add(cloud, EWA_COLOR, EWA_U8, 3);
    check_random random = {points};
    for (uint32_t i = 0; i < points; i++) {
        const double x = check_uniform(&random, -1.2, 1.2), y = check_uniform(&random, -1.2, 1.2);
        const double slope_x = 2.4 * cos(3 * x), slope_y = 1.6 * cos(2 * y);
        const double z = 4 + 0.4 * (i % SHEETS) + 0.8 * sin(3 * x) / 3 + 0.8 * sin(2 * y) / 2;
        const double length = sqrt(1 + 0.64 / 9 * slope_x * slope_x + 0.16 * slope_y * slope_y);
        position[3 * i] = (float)x, position[3 * i + 1] = (float)y, position[3 * i + 2] = (float)z;
        normal[3 * i] = (float)(0.8 / 3 * slope_x / length);
        normal[3 * i + 1] = (float)(0.4 * slope_y / length), normal[3 * i + 2] = (float)(-1 / length);
        const double px = check_uniform(&random, min_px, max_px) * (every && i % every == 0 ? times : 1);
        radius[i] = (float)(px * 2.4 / SIDE);
        for (int c = 0; c < 3; c++) color[3 * i + (uint32_t)c] = (uint8_t)check_uniform(&random, 0, 256);
    }
    ewa_surfels *surfels = check_surfels(cloud, NULL);
    ewa_cloud_destroy(&cloud);
    return surfels;
}

typedef struct planes {
    uint8_t *rgba8;
    float *rgba, *normal, *coverage, *depth;
} planes;

enum { PIXELS = SIDE * SIDE };

static planes make_planes(void) {
    planes made = {.rgba8 = calloc(4 * PIXELS, 1),
                   .rgba = calloc(4 * PIXELS, sizeof(float)),
                   .normal = calloc(3 * PIXELS, sizeof(float)),
                   .coverage = calloc(PIXELS, sizeof(float)),
                   .depth = calloc(PIXELS, sizeof(float))};
    assert_true(made.rgba8 && made.rgba && made.normal && made.coverage && made.depth);
    return made;
}

static void free_planes(planes *of) {
    free(of->rgba8), free(of->rgba), free(of->normal), free(of->coverage), free(of->depth);
}

/// Draws twice, since the first tile tells how the next is drawn.
static void draw(ewa_renderer *renderer, const ewa_surfels *surfels, const ewa_camera *camera,
                 const ewa_render_options *options, const planes *to, bool with_depth) {
    const ewa_frame frame = {.rgba8 = to->rgba8,
                             .rgba = to->rgba,
                             .normal = options->shading != EWA_SHADING_NONE ? to->normal : NULL,
                             .coverage = to->coverage,
                             .depth = with_depth ? to->depth : NULL};
    for (int i = 0; i < 2; i++)
        assert_int_equal(ewa_render(renderer, surfels, camera, options, &frame, NULL), EWA_OK);
}

static void assert_same(const planes *a, const planes *b, const char *what) {
    const struct {
        const char *name;
        const void *a, *b;
        size_t bytes;
    } each[] = {{"rgba8", a->rgba8, b->rgba8, 4 * PIXELS},
                {"rgba", a->rgba, b->rgba, 4 * PIXELS * sizeof(float)},
                {"normal", a->normal, b->normal, 3 * PIXELS * sizeof(float)},
                {"coverage", a->coverage, b->coverage, PIXELS * sizeof(float)}};
    for (size_t i = 0; i < sizeof each / sizeof each[0]; i++)
        if (memcmp(each[i].a, each[i].b, each[i].bytes))
            fail_msg("%s: %s differs with depths and without", what, each[i].name);
}

static void hold(ewa_context *context, const ewa_surfels *surfels, const ewa_render_options *options,
                 bool orthographic, const char *what) {
    ewa_renderer *renderer[2];
    planes to[2];
    ewa_camera camera = check_camera(SIDE, SIDE);
    camera.fx_px = camera.fy_px = orthographic ? SIDE / 2.2 : 2 * SIDE;
    camera.cx_px = camera.cy_px = SIDE / 2 + 0.3;
    if (orthographic) camera.projection = EWA_ORTHOGRAPHIC;
    for (int i = 0; i < 2; i++) {
        assert_int_equal(ewa_renderer_create(context, &renderer[i]), EWA_OK);
        to[i] = make_planes();
        draw(renderer[i], surfels, &camera, options, &to[i], i == 1);
        ewa_renderer_destroy(&renderer[i]);
    }
    uint32_t shown = 0;
    for (uint32_t i = 0; i < PIXELS; i++) shown += to[0].rgba[4 * i + 3] > 0;
    assert_true(shown > PIXELS / 4);
    assert_same(&to[0], &to[1], what);
    for (int i = 0; i < 2; i++) free_planes(&to[i]);
}

TEST_ON(test_planes_do_not_depend_on_depths, 2) {
    static const struct {
        const char *name;
        uint32_t points;
        double min_px, max_px;
        uint32_t every;
        double times;
    } clouds[] = {{"sparse points", 10000, 0.1, 0.3, 0, 1},
                  {"dense points", 75000, 0.05, 0.4, 0, 1},
                  {"thin sheets that hide packets", 175000, 0.05, 0.2, 0, 1},
                  {"closed sheets", 37500, 0.5, 0.9, 0, 1},
                  {"some large discs", 15000, 0.2, 0.5, 60, 12},
                  {"all sizes", 15000, 0.1, 4, 0, 1}};
    static const ewa_kernel kernels[] = {EWA_KERNEL_PERSPECTIVE, EWA_KERNEL_AFFINE, EWA_KERNEL_SOURCE,
                                         EWA_KERNEL_CIRCULAR};
    for (size_t c = 0; c < sizeof clouds / sizeof clouds[0]; c++) {
        OWNED(ewa_surfels_destroy)
        ewa_surfels *surfels = make_sheets(context, clouds[c].points, clouds[c].min_px, clouds[c].max_px,
                                           clouds[c].every, clouds[c].times);
        for (size_t k = 0; k < sizeof kernels / sizeof kernels[0]; k++)
            for (int way = 0; way < 4; way++) {
                WITH_DEFAULTS(ewa_render_options, options);
                options.kernel = kernels[k];
                options.shading = way & 1 ? EWA_SHADING_LAMBERT : EWA_SHADING_NONE;
                char what[120];
                snprintf(what, sizeof what, "%s, kernel %d, %s, %s", clouds[c].name, (int)kernels[k],
                         way & 1 ? "lit" : "not lit", way & 2 ? "orthographic" : "perspective");
                hold(context, surfels, &options, way & 2, what);
            }
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
