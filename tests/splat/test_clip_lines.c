// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clip lines (docs/math.md section 5): known answers, the fast pipeline against the reference in every mode,
// what is no line.
#include "tests/splat/picture.h"

#include <math.h>
#include <string.h>

enum { POINTS = 1200, SIDE = 128 };

static void hold(scene_kind kind, const ewa_render_options *options, bool orthographic, const char *what) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(0, NULL);
    OWNED(scene_free) scene of = picture_measured_scene(context, kind, POINTS, NULL);
    picture_add_clips(of.cloud);
    char name[96];
    snprintf(name, sizeof name, "%s, %s", scene_name(kind), what);
    picture_hold(&of, options, orthographic, name);
}

TEST(test_pipeline_holds) {
    static const scene_kind kinds[] = {SCENE_ELLIPSES, SCENE_NEAR};
    static const char *const names[] = {"perspective", "affine", "source", "circular", "raycast"};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        ewa_render_options o;
        for (int kernel = 0; kernel < 5; kernel++) {
            ewa_render_options_init(&o, sizeof o);
            o.kernel = (ewa_kernel)kernel;
            hold(kinds[i], &o, false, names[kernel]);
        }
        ewa_render_options_init(&o, sizeof o);
        o.edge_layers = 1;
        hold(kinds[i], &o, false, "one edge layer");
        o.edge_layers = 8, o.opacity = 0.5;
        hold(kinds[i], &o, false, "transparent");
        o.layers = 2;
        hold(kinds[i], &o, false, "two layers");
    }
    WITH_DEFAULTS(ewa_render_options, o);
    hold(SCENE_ELLIPSES, &o, true, "orthographic");
}

/// One ellipse with lines, seen straight on: `inside` pixels show, others do not.
static ewa_cloud *one_surfel(ewa_context *context, const float lines[2][3], uint8_t mode) {
    ewa_cloud *cloud = check_cloud_of(context, 1);
    float *position = check_add(cloud, EWA_POSITION, EWA_F32, 3);
    float *u = check_add(cloud, EWA_TANGENT_U, EWA_F32, 3);
    float *v = check_add(cloud, EWA_TANGENT_V, EWA_F32, 3);
    float *clip0 = check_add(cloud, EWA_CLIP0, EWA_F32, 3);
    float *clip1 = check_add(cloud, EWA_CLIP1, EWA_F32, 3);
    uint8_t *either = check_add(cloud, EWA_CLIP_MODE, EWA_U8, 1);
    position[0] = position[1] = 0, position[2] = 4;
    u[0] = 0, u[1] = 0.5f, u[2] = 0; // the shorter axis first: the lines have to follow the turn
    v[0] = -1, v[1] = v[2] = 0;
    memcpy(clip0, lines[0], 3 * sizeof(float));
    memcpy(clip1, lines[1], 3 * sizeof(float));
    *either = mode;
    return cloud;
}

/// At the origin, one unit at depth 1 as wide as the picture.
static ewa_camera ahead(void) {
    ewa_camera camera = check_camera(SIDE, SIDE);
    camera.fx_px = camera.fy_px = SIDE;
    camera.cx_px = camera.cy_px = SIDE / 2;
    return camera;
}

TEST_ON(test_known_answers, 0) {
    // Picture x = -v, y = u / 2 in world units; 32 pixels per unit.
    static const struct {
        float lines[2][3];
        uint8_t mode;
        int quadrants; // bits: right lower, left lower, left upper, right upper
    } rows[] = {
        {{{1, 0, 0}, {0, 0, 0}}, 0, 0x3},  // u > 0: below the middle
        {{{0, 1, 0}, {0, 0, 0}}, 0, 0x6},  // v > 0: left
        {{{0, -3, 0}, {0, 0, 0}}, 1, 0x9}, // one line, whatever the mode
        {{{1, 0, 0}, {0, 1, 0}}, 0, 0x2},  // convex corner
        {{{1, 0, 0}, {0, 1, 0}}, 1, 0x7},  // concave corner
        {{{0, 0, 0}, {0, 0, -5}}, 0, 0xf}, // no lines
        {{{NAN, 1, 0}, {1, 0, INFINITY}}, 0, 0xf}, {{{0, 1, -9}, {0, 0, 0}}, 0, 0}, // all cut off
    };
    const ewa_camera camera = ahead();
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = one_surfel(context, rows[i].lines, rows[i].mode);
        for (int kernel = 0; kernel < 5; kernel++) {
            WITH_DEFAULTS(ewa_render_options, o);
            o.kernel = (ewa_kernel)kernel;
            o.shading = EWA_SHADING_NONE;
            OWNED(picture_free) picture made = picture_draw(context, cloud, &camera, NULL, &o);
            for (int q = 0; q < 4; q++) {
                // Two pixels and more from the lines, well within the ellipse.
                const int right = q == 0 || q == 3, below = q < 2;
                for (int away = 2; away < 14; away++) {
                    const int x = SIDE / 2 + (right ? away : -1 - away),
                              y = SIDE / 2 + (below ? away : -1 - away);
                    const float alpha = made.frame.rgba[4 * (y * SIDE + x) + 3];
                    assert_true(alpha == (rows[i].quadrants >> q & 1 ? 1 : 0));
                }
            }
        }
    }
}

/// A scaled radius moves no line; a line elsewhere than through the centre is where it should be.
TEST_ON(test_line_stays, 0) {
    static const float lines[2][3] = {{0, 1, 0.25f},
                                      {0, 0, 0}}; // v > -0.25: x < 0.25, 8 pixels right of the middle
    const ewa_camera camera = ahead();
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = one_surfel(context, lines, 0);
    for (double scale = 0.5; scale < 3; scale *= 2) {
        WITH_DEFAULTS(ewa_surfels_options, surfels);
        surfels.radius_scale = scale;
        OWNED(picture_free) picture made = picture_draw(context, cloud, &camera, &surfels, NULL);
        const float *row = &made.frame.coverage[SIDE / 2 * SIDE];
        assert_true(row[SIDE / 2 + 7] > 0 && row[SIDE / 2 + 8] == 0);
    }
}

/// A disc of radius 3 seen straight on, whose surface ends at `border`.
static ewa_cloud *one_disc(ewa_context *context, const float normal[3], const float border[3]) {
    ewa_cloud *cloud = check_cloud_of(context, 1);
    float *position = check_add(cloud, EWA_POSITION, EWA_F32, 3);
    float *n = check_add(cloud, EWA_NORMAL, EWA_F32, 3);
    float *radius = check_add(cloud, EWA_RADIUS, EWA_F32, 1);
    float *to = check_add(cloud, EWA_BORDER, EWA_F32, 3);
    position[0] = position[1] = 0, position[2] = 4;
    memcpy(n, normal, 3 * sizeof *n);
    *radius = 3;
    memcpy(to, border, 3 * sizeof *to);
    return cloud;
}

/// Discs end at their borders, whichever way normals point; borders off the plane cut it where they meet it.
TEST_ON(test_borders, 0) {
    static const float normals[][3] = {{0, 0, -1}, {0, 0, 2}};
    static const struct {
        float border[3];
        int first, end; // pixels of the middle row that show; 32 per unit
    } rows[] = {
        {{0.25f, 0, 0}, -40, 8},        {{-0.25f, 0, 0}, -8, 40}, {{0.25f, 0, 0.25f}, -40, 16},
        {{0, 0, 0}, -40, 40},           {{NAN, 0, 0}, -40, 40},   {{9, 0, 0}, -40, 40},
        {{0, 0, 1}, -40, 40}, // beyond the disc, along its normal
    };
    const ewa_camera camera = ahead();
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        for (int side = 0; side < 2; side++) {
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud = one_disc(context, normals[side], rows[i].border);
            OWNED(picture_free) picture made = picture_draw(context, cloud, &camera, NULL, NULL);
            const float *row = &made.frame.coverage[SIDE / 2 * SIDE + SIDE / 2];
            for (int x = -40; x < 40; x++) assert_true((row[x] > 0) == (x >= rows[i].first && x < rows[i].end));
        }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
