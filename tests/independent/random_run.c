// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A scene drawn three times, and how far the pictures are from each other.
#include "reference/surface.h"
#include "tests/independent/random_scene.h"
#include "tests/owned.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/// Sum of squares, count and peak of one kind of numbers.
typedef struct tally {
    double squares, count;
} tally;

static void count_number(tally *t, double difference) {
    t->squares += isfinite(difference) ? difference * difference : 1;
    t->count++;
}

static double decibels(const tally *t, double peak) {
    const double mean = t->count > 0 ? t->squares / t->count : 0;
    return mean > 0 ? fmin(10 * log10(peak * peak / mean), 200) : 200;
}

static double clamped(double value) { return value < 0 ? 0 : value > 1 ? 1 : value; }

/// The planes of the nearest surface at a pixel.
static void compare_surface(const independent_picture *truth, const ewa_frame *frame, size_t i,
                            double deepest, tally *depth, tally *normal) {
    const double MIN_COVERAGE = 0.01;
    const bool in_truth = truth->coverage[i] > 0, in_frame = frame->coverage[i] > 0;
    if (!in_truth && !in_frame) return;
    if (truth->coverage[i] < MIN_COVERAGE || (double)frame->coverage[i] < MIN_COVERAGE) return;
    count_number(depth, fmin(fabs((double)frame->depth[i] - truth->depth[i]) / deepest, 1));
    for (size_t c = 3 * i; c < 3 * i + 3; c++)
        count_number(normal, (double)frame->normal[c] - truth->normal[c]);
}

random_scene_distance random_scene_compare(const independent_picture *truth, const ewa_frame *frame) {
    random_scene_distance found = {0};
    tally color = {0}, bright = {0}, decided[2] = {{0, 0}, {0, 0}}, depth = {0}, normal = {0}, coverage = {0};
    double peak = 1, deepest = 1e-300;
    const size_t count = (size_t)truth->width_px * truth->height_px;
    for (size_t i = 0; i < count; i++)
        if (isfinite(truth->depth[i])) deepest = fmax(deepest, fabs(truth->depth[i]));
    for (size_t i = 0; i < count; i++) {
        for (size_t c = 4 * i; c < 4 * i + 4; c++) {
            const double a = truth->rgba[c], b = (double)frame->rgba[c],
                         difference = isnan(b) ? 1 : clamped(b) - clamped(a);
            count_number(&color, difference);
            count_number(&bright, b - a);
            if (!truth->doubtful[i]) {
                count_number(&decided[0], difference);
                count_number(&decided[1], b - a);
            }
            peak = fmax(peak, a);
            if (fabs(difference) > found.worst) {
                found.worst = fabs(difference);
                found.worst_px[0] = (uint32_t)(i % truth->width_px);
                found.worst_px[1] = (uint32_t)(i / truth->width_px);
            }
            found.codes_over += fabs(frame->rgba8[c] - truth->srgb[c]) > 1;
        }
        if (truth->doubtful[i]) {
            found.doubtful_count++;
            continue;
        }
        count_number(&coverage,
                     ((double)frame->coverage[i] - truth->coverage[i]) / fmax(1, truth->coverage[i]));
        compare_surface(truth, frame, i, deepest, &depth, &normal);
    }
    found.color_db = fmin(decibels(&color, 1), decibels(&bright, peak));
    found.decided_db = fmin(decibels(&decided[0], 1), decibels(&decided[1], peak));
    found.depth_db = decibels(&depth, 1);
    found.normal_db = decibels(&normal, 1);
    found.coverage_db = decibels(&coverage, 1);
    return found;
}

static void make_frame(ewa_frame *frame, uint32_t width_px, uint32_t height_px) {
    const size_t count = (size_t)width_px * height_px;
    *frame = (ewa_frame){.rgba8 = calloc(count, 4),
                         .rgba = calloc(count, 4 * sizeof(float)),
                         .depth = calloc(count, sizeof(float)),
                         .normal = calloc(count, 3 * sizeof(float)),
                         .coverage = calloc(count, sizeof(float))};
    if (!frame->rgba8 || !frame->rgba || !frame->depth || !frame->normal || !frame->coverage) abort();
}

static void free_frame(ewa_frame *frame) {
    free(frame->rgba8);
    free(frame->rgba);
    free(frame->depth);
    free(frame->normal);
    free(frame->coverage);
}

static void keep_picture(const char *keep, const char *name, const ewa_camera *camera, float *rgba,
                         ewa_context *context) {
    char path[512];
    snprintf(path, sizeof path, "%s-%s.png", keep, name);
    const ewa_image image = {context, camera->width_px, camera->height_px, 4, rgba};
    ewa_image_save(&image, path, NULL);
}

static void keep_pictures(ewa_context *context, const char *keep, const ewa_camera *camera,
                          const independent_picture *truth, const ewa_frame frames[2]) {
    const size_t count = 4 * (size_t)camera->width_px * camera->height_px;
    float *rgba = calloc(count, sizeof *rgba);
    if (!rgba) abort();
    for (size_t i = 0; i < count; i++) rgba[i] = (float)truth->rgba[i];
    keep_picture(keep, "truth", camera, rgba, context);
    keep_picture(keep, "pipeline", camera, frames[0].rgba, context);
    keep_picture(keep, "reference", camera, frames[1].rgba, context);
    for (size_t i = 0; i < count; i++)
        rgba[i] = i % 4 == 3 ? 1 : (float)fmin(1, 10 * fabs((double)frames[0].rgba[i] - truth->rgba[i]));
    keep_picture(keep, "difference", camera, rgba, context);
    free(rgba);
}

bool random_scene_run(ewa_context *context, random_scene *made, const char *keep,
                      random_scene_result *result) {
    ewa_surfels *surfels = NULL;
    ewa_renderer *renderer = NULL;
    ewa_frame frames[2];
    for (int i = 0; i < 2; i++)
        make_frame(&frames[i], made->scene.camera.width_px, made->scene.camera.height_px);
    ewa_status status = ewa_surfels_create(made->cloud, &made->surfels_options, &surfels);
    if (status == EWA_OK) status = ewa_renderer_create(context, &renderer);
    if (status == EWA_OK)
        status = ewa_render(renderer, surfels, &made->scene.camera, &made->scene.options, &frames[0], NULL);
    if (status == EWA_OK) {
        ewa_surfels_info info;
        ewa_surfels_describe(surfels, &info);
        made->scene.unit_coverage = info.unit_coverage;
        status = ewa_render_reference(made->cloud, &made->surfels_options, info.unit_coverage,
                                      &made->scene.camera, &made->scene.options, &frames[1]);
    }
    if (status == EWA_OK) {
        OWNED(independent_free) independent_picture truth = independent_render(&made->scene);
        result->pipeline = random_scene_compare(&truth, &frames[0]);
        result->reference = random_scene_compare(&truth, &frames[1]);
        if (keep) keep_pictures(context, keep, &made->scene.camera, &truth, frames);
    }
    for (int i = 0; i < 2; i++) free_frame(&frames[i]);
    ewa_renderer_destroy(&renderer);
    ewa_surfels_destroy(&surfels);
    return status == EWA_OK;
}
