// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scenes that were hard once, each for one reason.
#include "tests/independent/random_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { ROOM = 700 };

static const double PI = 3.14159265358979323846;

static independent_surfel *put(random_scene *made, double x, double y, double z) {
    independent_surfel *s = &made->surfels[made->scene.surfel_count++];
    *s = (independent_surfel){.position = {x, y, z}, .alpha = 1};
    const uint64_t k = made->scene.surfel_count;
    for (uint64_t c = 0; c < 3; c++) s->color[c] = 0.1 + 0.8 * (double)((k * (7 + 4 * c)) % 31) / 30;
    return s;
}

static void make_disc(independent_surfel *s, double nx, double ny, double nz, double radius) {
    s->disc = true;
    s->normal[0] = nx, s->normal[1] = ny, s->normal[2] = nz;
    s->radius = radius;
}

static void make_sphere(random_scene *made, double x, double y, double z, double radius, int count) {
    for (int i = 0; i < count; i++) {
        const double h = 1 - (2 * i + 1.0) / count, turn = 2.399963229728653 * i, r = sqrt(1 - h * h);
        const double n[3] = {r * cos(turn), r * sin(turn), h};
        make_disc(put(made, x + radius * n[0], y + radius * n[1], z + radius * n[2]), n[0], n[1], n[2],
                  1.2 * radius * sqrt(4 * PI / count));
    }
}

/// The camera at -z `distance` from a place, looking along +z, as wide as `view` there.
static void look(random_scene *made, double x, double y, double z, double distance, double view) {
    ewa_camera *camera = &made->scene.camera;
    camera->fx_px = camera->fy_px = camera->height_px * distance / view;
    const double eye[3] = {x, y, z - distance};
    for (int i = 0; i < 3; i++) camera->world_to_camera[4 * i + 3] = -eye[i];
}

/// A tilted sheet of a spacing of 1 around (0, 0, 20), of which `lines` lines cut the rim off.
static void make_cut_sheet(random_scene *made, int lines, bool either) {
    const double tilt = 0.6, sigma = 1.14 / 3;
    static const double normal[2][2] = {{0.8, 0.6}, {-0.7, 0.714142842854285}}, offset[2] = {3.2, 2.7};
    for (int i = 0; i < 17 * 17; i++) {
        const double x = i % 17 - 8, y = i / 17 - 8;
        independent_surfel *s = put(made, x, y * cos(tilt), 20 + y * sin(tilt));
        s->axis_u[0] = sigma, s->axis_v[1] = sigma * cos(tilt), s->axis_v[2] = sigma * sin(tilt);
        s->clip_count = (uint32_t)lines, s->clip_either = either;
        for (int k = 0; k < lines; k++) {
            s->clip[k][0] = sigma * normal[k][0], s->clip[k][1] = sigma * normal[k][1];
            s->clip[k][2] = normal[k][0] * x + normal[k][1] * y + offset[k];
        }
    }
    look(made, 0, 0, 20, 20, 20);
}

static void make_cut_edge(random_scene *made) { make_cut_sheet(made, 1, false); }
static void make_cut_corner(random_scene *made) { make_cut_sheet(made, 2, false); }
static void make_cut_notch(random_scene *made) { make_cut_sheet(made, 2, true); }

static void make_bright(random_scene *made) {
    make_sphere(made, 0, 0, 5, 1, 400);
    for (int i = 0; i < 400; i++)
        for (int c = 0; c < 3; c++)
            made->surfels[i].color[c] = i == 123 ? 1e4 : 0.2 * made->surfels[i].color[c];
    look(made, 0, 0, 5, 4, 2.6);
}

static void make_needles(random_scene *made, double aspect) {
    for (int i = 0; i < 600; i++) {
        const double turn = 2.399963229728653 * i, lean = 0.3 * sin(7.0 * i), length = 0.1 + 0.02 * (i % 10);
        independent_surfel *s = put(made, cos(5.0 * i), sin(3.0 * i), 4 + 0.5 * cos(11.0 * i));
        const double u[3] = {cos(turn) * cos(lean), sin(turn) * cos(lean), sin(lean)};
        const double v[3] = {-sin(turn), cos(turn), 0};
        for (int c = 0; c < 3; c++) s->axis_u[c] = length * u[c], s->axis_v[c] = length / aspect * v[c];
    }
    made->scene.options.edge_antialiasing = false; // so that needles show whatever they cover
    look(made, 0, 0, 4, 4, 2.6);
}

static void make_needles_2000(random_scene *made) { make_needles(made, 2e3); }
static void make_needles_100000(random_scene *made) { make_needles(made, 1e5); }

/// A sphere and its camera, all lengths times `unit`.
static void make_unit(random_scene *made, double unit) {
    make_sphere(made, 0, 0, 5 * unit, unit, 400);
    look(made, 0, 0, 5 * unit, 4 * unit, 2.6 * unit);
}

static void make_huge(random_scene *made) { make_unit(made, 1e13); }
static void make_tiny(random_scene *made) { make_unit(made, 1e-13); }

/// The same with a camera matrix that has the scale instead.
static void make_scaled(random_scene *made, double scale) {
    make_unit(made, 1);
    for (int i = 0; i < 12; i++) made->scene.camera.world_to_camera[i] *= scale;
}

static void make_scaled_up(random_scene *made) { make_scaled(made, 1e14); }
static void make_scaled_down(random_scene *made) { make_scaled(made, 1e-15); }

/// Two spheres of a centimetre, seen one after the other from a few centimetres.
static void make_pair(random_scene *made, double distance) {
    make_sphere(made, 0.0123, 0.0456, 0.0789, 0.01, 200);
    make_sphere(made, 0.77 * distance, 0.5 * distance, -0.4 * distance, 0.01, 400);
    look(made, 0.77 * distance, 0.5 * distance, -0.4 * distance, 0.05, 0.03);
}

static void make_kilometre(random_scene *made) { make_pair(made, 1e3); }
static void make_continent(random_scene *made) { make_pair(made, 1e5); }

/// Discs larger than their distance to the eye, on a floor, a wall and a step.
static void make_near(random_scene *made) {
    for (int i = 0; i < 40; i++) {
        const double x = 0.8 * (i % 5 - 2), z = 0.35 + 0.5 * (i / 5);
        make_disc(put(made, x, 0.5, z), 0, -1, 0, 0.9);
        make_disc(put(made, -1.2, 0.3 * (i % 5) - 0.6, z), 1, 0, 0, 0.7);
        make_disc(put(made, x, 0.2 + 0.1 * (i % 3), z + 0.4), 0.1, -0.8, -0.6, 0.4);
    }
    look(made, 0, 0, 0.5, 0.5, 1.4);
}

/// A sphere around the corner of a very wide picture whose principal point is outside of it.
static void make_wide(random_scene *made) {
    make_sphere(made, 2.6, 1.9, 1.5, 0.8, 400);
    make_sphere(made, 0.4, 0.2, 1.1, 0.3, 200);
    look(made, 0, 0, 1, 1, 2 * tan(75 * PI / 180));
    made->scene.camera.cx_px = -20, made->scene.camera.cy_px = 5;
    made->scene.camera.fx_px *= 1.3;
}

static const struct {
    const char *name;
    void (*make)(random_scene *made);
} scenes[] = {
    {"cut edge", make_cut_edge},
    {"cut corner", make_cut_corner},
    {"cut notch", make_cut_notch},
    {"one colour of 1e4", make_bright},
    {"needles of 2,000", make_needles_2000},
    {"needles of 100,000", make_needles_100000},
    {"lengths of 1e13", make_huge},
    {"lengths of 1e-13", make_tiny},
    {"camera scaled by 1e14", make_scaled_up},
    {"camera scaled by 1e-15", make_scaled_down},
    {"1 cm, 1 km apart", make_kilometre},
    {"1 cm, 100 km apart", make_continent},
    {"discs near the eye", make_near},
    {"wide and off its axis", make_wide},
};

bool named_scene_make(ewa_context *context, uint32_t index, random_scene *made) {
    static const double ORIGIN[3] = {0, 0, 0};
    if (index >= sizeof scenes / sizeof *scenes) return false;
    *made = (random_scene){.surfels = calloc(ROOM, sizeof *made->surfels)};
    if (!made->surfels) abort();
    ewa_camera *camera = &made->scene.camera;
    ewa_camera_init(camera);
    camera->width_px = camera->height_px = 96;
    camera->cx_px = camera->cy_px = 48;
    for (int i = 0; i < 16; i++) camera->world_to_camera[i] = i % 5 == 0;
    ewa_render_options_init(&made->scene.options, sizeof made->scene.options);
    ewa_surfels_options_init(&made->surfels_options, sizeof made->surfels_options);
    made->scene.cutoff = made->surfels_options.cutoff, made->scene.radius_scale = 1;
    snprintf(made->words, sizeof made->words, "%s", scenes[index].name);
    scenes[index].make(made);
    scene_cloud_make(context, made, ORIGIN, EWA_F64, EWA_F32);
    return true;
}
