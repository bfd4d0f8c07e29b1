// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the tables of docs/layers.md: surfaces that cross, by layers and by the paper's A-buffer; a
// transparent sphere, by layers and splat by splat. With an argument, also writes pictures into that folder.
#include "image_difference.h"
#include "measure/layers_scene.h"
#include "measure/measure.h"
#include "reference/surface.h"
#include "splat/abuffer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 300, POINTS = 40000, SPHERE_POINTS = 20000, LIMITS = 4, PANEL = SIDE / 2 };

static const uint32_t limits[LIMITS] = {1, 2, 3, 8};
static const double OPACITY = 0.5;

static float *make_plane(void) {
    float *rgba = calloc((size_t)SIDE * SIDE, 4 * sizeof *rgba);
    if (!rgba) check(EWA_ERROR_MEMORY);
    return rgba;
}

/// What is seen over white: sRGB in [0, 1], three channels.
static ewa_image over_white(ewa_context *context, const float *rgba) {
    ewa_image seen;
    check(ewa_image_create(context, SIDE, SIDE, 3, &seen));
    for (size_t i = 0; i < (size_t)SIDE * SIDE; i++)
        for (size_t c = 0; c < 3; c++)
            seen.pixels[3 * i + c] = ewa_srgb_from_linear(rgba[4 * i + c] + 1 - rgba[4 * i + 3]);
    return seen;
}

static double psnr_db(ewa_context *context, const float *a, const float *b) {
    ewa_image left = over_white(context, a), right = over_white(context, b);
    const image_difference difference = image_compare(&left, &right, 1);
    ewa_image_free(&left);
    ewa_image_free(&right);
    return difference.psnr_db;
}

static void save(ewa_context *context, const char *folder, const char *name, const float *rgba,
                 uint32_t width_px, uint32_t height_px) {
    char path[1024];
    if (!folder) return;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    ewa_image picture;
    check(ewa_image_create(context, width_px, height_px, 3, &picture));
    for (size_t i = 0; i < (size_t)width_px * height_px; i++)
        for (size_t c = 0; c < 3; c++) picture.pixels[3 * i + c] = rgba[4 * i + c] + 1 - rgba[4 * i + 3];
    check(ewa_image_save(&picture, path, NULL));
    ewa_image_free(&picture);
}

/// Puts a picture at half its size into a wide one of panels.
static void put_panel(const float *rgba, float *wide, uint32_t panels_wide, uint32_t column, uint32_t row) {
    const size_t width = (size_t)panels_wide * PANEL;
    for (size_t y = 0; y < PANEL; y++)
        for (size_t x = 0; x < PANEL; x++)
            for (size_t c = 0; c < 4; c++) {
                const float *from = rgba + 4 * (2 * y * SIDE + 2 * x) + c;
                wide[4 * ((row * PANEL + y) * width + column * PANEL + x) + c] =
                    0.25f * (from[0] + from[4] + from[(size_t)4 * SIDE] + from[(size_t)4 * SIDE + 4]);
            }
}

/// A cloud that is ready to be drawn.
typedef struct subject {
    ewa_context *context;
    ewa_cloud *cloud;
    ewa_surfels *surfels;
    ewa_renderer *renderer;
    ewa_camera camera;
    ewa_surfels_info info;
    ewa_render_options options;
} subject;

static subject subject_make(ewa_context *context, ewa_cloud *cloud) {
    subject made = {.context = context, .cloud = cloud};
    check(layers_camera_make(cloud, SIDE, &made.camera));
    check(ewa_surfels_create(cloud, NULL, &made.surfels));
    check(ewa_renderer_create(context, &made.renderer));
    ewa_surfels_describe(made.surfels, &made.info);
    ewa_render_options_init(&made.options, sizeof made.options);
    made.options.shading = EWA_SHADING_NONE;
    made.options.opacity = OPACITY;
    return made;
}

static void subject_free(subject *made) {
    ewa_renderer_destroy(&made->renderer);
    ewa_surfels_destroy(&made->surfels);
    ewa_cloud_destroy(&made->cloud);
}

static void draw(const subject *of, uint32_t layers, float *rgba) {
    ewa_render_options options = of->options;
    options.layers = layers;
    const ewa_frame frame = {.rgba = rgba};
    check(ewa_render(of->renderer, of->surfels, &of->camera, &options, &frame, NULL));
}

static void draw_greedy(const subject *of, const ewa_cloud *cloud, uint32_t fragments, float *rgba) {
    check(abuffer_render(cloud, of->info.unit_coverage, &of->camera, &of->options, fragments, NULL, NULL,
                         rgba));
}

static void measure_crossing(ewa_context *context, const char *folder) {
    ewa_cloud *cloud = NULL, *shuffled = NULL;
    check(layers_crossing_make(context, is_quick() ? POINTS / 8 : POINTS, &cloud));
    check(layers_shuffle(cloud, &shuffled));
    subject of = subject_make(context, cloud);
    float *exact = make_plane(), *layers = make_plane(), *greedy = make_plane(), *other = make_plane();
    float *wide = calloc((size_t)LIMITS * PANEL * 2 * PANEL, 4 * sizeof *wide);
    if (!wide) check(EWA_ERROR_MEMORY);
    const ewa_frame frame = {.rgba = exact};
    check(ewa_render_reference(cloud, NULL, of.info.unit_coverage, &of.camera, &of.options, &frame));
    printf("| layers, fragments | layers | A-buffer, object by object | A-buffer, shuffled | "
           "A-buffer, one order against the other |\n|---|---|---|---|---|\n");
    for (uint32_t i = 0; i < LIMITS; i++) {
        draw(&of, limits[i], layers);
        draw_greedy(&of, cloud, limits[i], greedy);
        draw_greedy(&of, shuffled, limits[i], other);
        printf("| %u | %.1f | %.1f | %.1f | %.1f |\n", limits[i], psnr_db(context, exact, layers),
               psnr_db(context, exact, greedy), psnr_db(context, exact, other),
               psnr_db(context, greedy, other));
        put_panel(layers, wide, LIMITS, i, 0);
        put_panel(other, wide, LIMITS, i, 1);
    }
    draw(&of, EWA_LAYERS_EXACT, layers);
    draw_greedy(&of, cloud, 32, greedy);
    draw_greedy(&of, shuffled, 32, other);
    printf("| exact, 32 | %.1f | %.1f | %.1f | %.1f |\n\n", psnr_db(context, exact, layers),
           psnr_db(context, exact, greedy), psnr_db(context, exact, other), psnr_db(context, greedy, other));
    save(context, folder, "layers_crossing.png", layers, SIDE, SIDE);
    save(context, folder, "layers_greedy.png", wide, LIMITS * PANEL, 2 * PANEL);
    free(wide);
    free(exact);
    free(layers);
    free(greedy);
    free(other);
    ewa_cloud_destroy(&shuffled);
    subject_free(&of);
}

static void print_alpha(const char *name, const layers_alpha *found) {
    printf("| %s | %.4f | %.2g | %.3f to %.3f |\n", name, found->mean, found->variance, found->minimum,
           found->maximum);
}

static void measure_sphere(ewa_context *context, const char *folder) {
    ewa_cloud *cloud = NULL;
    check(layers_sphere_make(context, SPHERE_POINTS, &cloud));
    subject of = subject_make(context, cloud);
    float *rgba = make_plane(), *wide = calloc((size_t)2 * PANEL * PANEL, 4 * sizeof *wide);
    if (!wide) check(EWA_ERROR_MEMORY);
    printf("| transparent sphere | mean alpha | variance | range |\n|---|---|---|---|\n");
    draw(&of, EWA_LAYERS_EXACT, rgba);
    const layers_alpha ours = layers_measure_alpha(rgba, SIDE);
    print_alpha("layers, opacity 0.5", &ours);
    put_panel(rgba, wide, 2, 0, 0);
    check(layers_blend_splats(cloud, &of.camera, OPACITY, rgba));
    layers_alpha others = layers_measure_alpha(rgba, SIDE);
    print_alpha("splat by splat, opacity 0.5", &others);
    double low = 0, high = 1;
    for (int i = 0; i < 12; i++) { // the opacity that lets as much through
        const double middle = 0.5 * (low + high);
        check(layers_blend_splats(cloud, &of.camera, middle, rgba));
        others = layers_measure_alpha(rgba, SIDE);
        *(others.mean < ours.mean ? &low : &high) = middle;
    }
    char name[64];
    snprintf(name, sizeof name, "splat by splat, opacity %.3f", 0.5 * (low + high));
    print_alpha(name, &others);
    put_panel(rgba, wide, 2, 1, 0);
    save(context, folder, "layers_sphere.png", wide, 2 * PANEL, PANEL);
    free(wide);
    free(rgba);
    subject_free(&of);
}

int main(int argument_count, char **arguments) {
    const char *folder = argument_count > 1 ? arguments[1] : NULL;
    ewa_context *context = make_context(0);
    measure_crossing(context, folder);
    measure_sphere(context, folder);
    ewa_context_destroy(&context);
    return 0;
}
