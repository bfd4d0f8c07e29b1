// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scenes for tests of gradients.
#include "tests/adjoint/adjoint_scene.h"

#include <math.h>

static void borrow(ewa_cloud *cloud, const char *name, uint32_t components, const double *values) {
    assert_int_equal(ewa_cloud_borrow(cloud, name, EWA_F64, components, values, 0), EWA_OK);
}

/// A camera that is turned, of pixels that are not square; its picture is 2 wide around the world's origin.
static ewa_camera odd_camera(uint32_t kind, uint32_t side_px) {
    ewa_camera camera = check_camera(side_px, side_px - 3);
    const double eye[3] = {0.4, -0.3, kind & ADJOINT_NEAR ? -0.2 : -3};
    const double target[3] = {0.1, 0.05, kind & ADJOINT_NEAR ? 2 : 0}, up[3] = {0.1, 1, 0};
    camera.fx_px = 1.5 * side_px, camera.fy_px = 1.35 * side_px;
    camera.cx_px = 0.48 * side_px, camera.cy_px = 0.53 * side_px;
    assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
    if (kind & ADJOINT_ORTHOGRAPHIC) assert_int_equal(ewa_camera_set_ortho(&camera, 2.1), EWA_OK);
    return camera;
}

adjoint_scene *adjoint_scene_make(ewa_context *context, uint32_t kind, uint32_t count, uint32_t side_px,
                                  double radius_px, uint64_t seed) {
    adjoint_scene *s = calloc(1, sizeof *s);
    assert_non_null(s);
    assert_true(count <= ADJOINT_MAX_POINTS);
    s->count = count, s->kind = kind;
    s->camera = odd_camera(kind, side_px);
    ewa_render_options_init(&s->options, sizeof s->options);
    s->unit_coverage = 0.5;
    check_random random = {seed};
    const double radius = radius_px * 2 / side_px;
    for (uint32_t i = 0; i < count; i++) {
        double *at = &s->position[3 * i], *n = &s->normal[3 * i], *u = &s->tangent_u[3 * i], *v = &s->tangent_v[3 * i];
        check_uniform3(&random, -0.9, 0.9, at);
        at[2] = 0.3 * floor(3 * (at[2] + 0.9) / 1.8) + check_uniform(&random, -0.01, 0.01); // three surfaces
        check_uniform3(&random, -0.8, 0.8, n);
        n[2] -= 1;
        if (i % 5 == 0)
            for (int c = 0; c < 3; c++) n[c] = -n[c];
        s->radius[i] = radius * check_uniform(&random, 0.7, 1.5);
        check_uniform3(&random, -1, 1, u), check_uniform3(&random, -1, 1, v);
        u[2] *= 0.5, v[2] *= 0.5;
        for (int c = 0; c < 3; c++) u[c] *= radius / 3 * 1.5, v[c] *= radius / 3 * 1.5;
        for (int c = 0; c < 3; c++) s->color[4 * i + (uint32_t)c] = check_uniform(&random, -0.1, 1.2);
        s->color[4 * i + 3] = kind & ADJOINT_TRANSPARENT ? check_uniform(&random, 0.2, 0.9) : 1;
        // Lines that keep what lies along about one direction, so that some agree and some do not.
        const double angle = check_uniform(&random, -0.9, 0.9), x = cos(angle), y = sin(angle);
        s->clip[3 * i] = i % 2 ? x * u[0] + y * u[1] : 0;
        s->clip[3 * i + 1] = i % 2 ? x * v[0] + y * v[1] : 0;
        s->clip[3 * i + 2] = radius * check_uniform(&random, -0.1, 0.3);
        s->surfaceness[i] = i % 3 ? 1 : 0.2;
        if (kind & ADJOINT_CURVED) n[2] *= 0.15;
        s->curvature[i] = kind & ADJOINT_CURVED && i % 4 ? (i % 3 ? 1 : -1) * check_uniform(&random, 0.02, 0.4) / radius : 0;
    }
    assert_int_equal(ewa_cloud_create(context, count, &s->cloud), EWA_OK);
    borrow(s->cloud, EWA_POSITION, 3, s->position);
    borrow(s->cloud, EWA_COLOR, 4, s->color);
    if (kind & ADJOINT_ELLIPSES)
        borrow(s->cloud, EWA_TANGENT_U, 3, s->tangent_u), borrow(s->cloud, EWA_TANGENT_V, 3, s->tangent_v);
    else
        borrow(s->cloud, EWA_NORMAL, 3, s->normal), borrow(s->cloud, EWA_RADIUS, 1, s->radius);
    if (kind & ADJOINT_CLIPPED) borrow(s->cloud, EWA_CLIP0, 3, s->clip);
    if (kind & ADJOINT_CURVED) borrow(s->cloud, EWA_CURVATURE, 1, s->curvature);
    if (kind & ADJOINT_BILLBOARDS) borrow(s->cloud, EWA_SURFACENESS, 1, s->surfaceness);
    if (kind & ADJOINT_AFFINE) s->options.kernel = EWA_KERNEL_AFFINE;
    if (kind & ADJOINT_UNLIT) s->options.shading = EWA_SHADING_NONE;
    if (kind & ADJOINT_HARD) s->options.edge_antialiasing = false;
    if (kind & ADJOINT_TRANSPARENT) s->options.opacity = 0.8;
    if (kind & ADJOINT_MERGED) {
        s->options.edge_layers = 2;
        s->options.layers = kind & ADJOINT_TRANSPARENT ? 2 : 0;
    }
    if (kind & ADJOINT_LIGHTS) {
        s->options.light_count = 2;
        for (int i = 0; i < 2; i++) ewa_light_init(&s->options.lights[i]);
        const double from[3] = {0.3, 0.5, -1};
        const float colors[2][3] = {{0.5f, 0.2f, 0.8f}, {0.3f, 0.7f, 0.1f}};
        memcpy(s->options.lights[1].direction_world, from, sizeof from);
        for (int i = 0; i < 2; i++) memcpy(s->options.lights[i].color, colors[i], sizeof colors[i]);
    }
    if (kind & ADJOINT_SECTION) {
        const double plane[4] = {0.7, 0.5, -0.1, 0.1};
        s->options.section_count = 1;
        memcpy(s->options.section_planes[0], plane, sizeof plane);
    }
    const float background[4] = {0.2f, 0.4f, 0.1f, 0.7f};
    memcpy(s->options.background, background, sizeof background);
    return s;
}

void adjoint_scene_free(adjoint_scene **scene) {
    ewa_cloud_destroy(&(*scene)->cloud);
    free(*scene);
    *scene = NULL;
}
