// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Three renderers, one picture: the reference as exactly as doubles allow, the pipeline to a limit, with
// exceptions that are listed with their reasons. measure_random_scenes draws more scenes.
#include "tests/check.h"
#include "tests/independent/exceptions.h"

#include <math.h>

/// As many of the 1,000 scenes that measure_random_scenes draws.
enum { SCENES = EWA_RANDOM_SCENES };

static const double REFERENCE_DB = 120, PIPELINE_DB = 45, PIPELINE_PLANE_DB = 30, TYPICAL_DB = 80;

static int compare_doubles(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static const scene_exception *find_exception(const char *set, uint64_t number) {
    for (size_t i = 0; i < sizeof scene_exceptions / sizeof *scene_exceptions; i++)
        if (!strcmp(scene_exceptions[i].set, set) && scene_exceptions[i].number == number)
            return &scene_exceptions[i];
    return NULL;
}

/// Draws a scene and holds it to its limits; returns the pipeline's colours in decibels.
static double hold(ewa_context *context, const char *set, uint64_t number, random_scene *made) {
    random_scene_result result;
    assert_true(random_scene_run(context, made, NULL, &result));
    const random_scene_distance *pipeline = &result.pipeline, *reference = &result.reference;
    const scene_exception *exception = find_exception(set, number);
    bool good = reference->color_db >= REFERENCE_DB && reference->depth_db >= REFERENCE_DB &&
                reference->normal_db >= REFERENCE_DB && reference->coverage_db >= REFERENCE_DB &&
                reference->codes_over == 0;
    if (!exception)
        good = good && pipeline->color_db >= PIPELINE_DB && pipeline->depth_db >= PIPELINE_PLANE_DB &&
               pipeline->normal_db >= PIPELINE_PLANE_DB && pipeline->coverage_db >= PIPELINE_PLANE_DB;
    else if (exception->reason == SCENE_DECISIONS)
        good = good && pipeline->decided_db >= PIPELINE_DB;
    if (!good)
        fail_msg(
            "%s scene %llu: pipeline %.1f dB, %.1f where decided, depth %.1f, normal %.1f, coverage %.1f; "
            "reference %.1f, depth %.1f, normal %.1f, coverage "
            "%.1f, %llu codes: %s",
            set, (unsigned long long)number, pipeline->color_db, pipeline->decided_db, pipeline->depth_db,
            pipeline->normal_db, pipeline->coverage_db, reference->color_db, reference->depth_db,
            reference->normal_db, reference->coverage_db, (unsigned long long)reference->codes_over,
            made->words);
    return pipeline->color_db;
}

TEST_ON(test_random, 0) {
    double pipeline[SCENES];
    for (uint64_t i = 0; i < SCENES; i++) {
        OWNED(random_scene_free) random_scene made;
        random_scene_make(context, i, &made);
        pipeline[i] = hold(context, "random", i, &made);
    }
    qsort(pipeline, SCENES, sizeof *pipeline, compare_doubles);
    print_message("pipeline: least %.1f, median %.1f dB\n", pipeline[0], pipeline[SCENES / 2]);
    assert_true(pipeline[SCENES / 2] >= TYPICAL_DB);
}

TEST_ON(test_named, 0) {
    random_scene made;
    for (uint32_t i = 0; named_scene_make(context, i, &made); i++) {
        hold(context, "named", i, &made);
        random_scene_free(&made);
    }
}

/// The scale must not read zero where something is wrong.
TEST_ON(test_distance, 0) {
    OWNED(random_scene_free) random_scene made;
    random_scene_make(context, 1, &made);
    made.scene.unit_coverage = 0.5;
    OWNED(independent_free) independent_picture truth = independent_render(&made.scene);
    const size_t count = (size_t)truth.width_px * truth.height_px;
    OWNED(check_free)
    float *rgba = calloc(4 * count, sizeof *rgba), *depth = calloc(count, sizeof *depth),
          *normal = calloc(3 * count, sizeof *normal), *coverage = calloc(count, sizeof *coverage);
    OWNED(check_free) uint8_t *rgba8 = calloc(4 * count, 1);
    assert_true(rgba && depth && normal && coverage && rgba8);
    const ewa_frame frame = {
        .rgba8 = rgba8, .rgba = rgba, .depth = depth, .normal = normal, .coverage = coverage};
    for (size_t i = 0; i < 4 * count; i++)
        rgba[i] = (float)truth.rgba[i], rgba8[i] = (uint8_t)(truth.srgb[i] + 0.5);
    for (size_t i = 0; i < 3 * count; i++) normal[i] = (float)truth.normal[i];
    for (size_t i = 0; i < count; i++)
        depth[i] = (float)truth.depth[i], coverage[i] = (float)truth.coverage[i];
    random_scene_distance same = random_scene_compare(&truth, &frame);
    assert_true(same.color_db > 130 && same.depth_db > 130 && same.normal_db > 130 && same.coverage_db > 130);
    assert_int_equal(same.codes_over, 0);
    // All numbers of one pixel off by a half: 10 log10(pixels / 0.25) of the four numbers.
    for (size_t c = 0; c < 4; c++)
        rgba[4 * 777 + c] = rgba[4 * 777 + c] > 0.5f ? rgba[4 * 777 + c] - 0.5f : rgba[4 * 777 + c] + 0.5f;
    const double wanted = 10 * log10((double)count / 0.25);
    assert_true(fabs(random_scene_compare(&truth, &frame).color_db - wanted) < 0.01);
    rgba[0] = NAN;
    assert_true(random_scene_compare(&truth, &frame).color_db < wanted);
    rgba8[3] ^= 0x80;
    assert_int_equal(random_scene_compare(&truth, &frame).codes_over, 1);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
