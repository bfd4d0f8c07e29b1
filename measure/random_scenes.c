// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Draws many random scenes by the pipeline, the reference and the independent renderer and says how far they
// are apart.
//
//   measure_random_scenes [FIRST COUNT [below DB | keep PREFIX]]    default: 0 1000
//   measure_random_scenes named [PREFIX]                            the scenes with names; PREFIX keeps
//   pictures
//
// Ends with quantiles over all scenes and lists those whose pipeline is below DB (default 50) or whose
// reference is below 80, with what is special about them.
#include "measure/measure.h"
#include "tests/independent/random_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void print_quantiles(const char *name, double *values, uint64_t count) {
    qsort(values, count, sizeof *values, compare_doubles);
    printf("%-20s least %6.1f  1%% %6.1f  5%% %6.1f  median %6.1f dB\n", name, values[0], values[count / 100],
           values[count / 20], values[count / 2]);
}

/// Prints a line about a scene.
static void print_scene(const char *name, const random_scene_result *result, const char *words) {
    const random_scene_distance *pipeline = &result->pipeline, *reference = &result->reference;
    printf("%s: pipeline %.1f, %.1f but for %llu (depth %.1f normal %.1f coverage %.1f) worst %.2g at %u,%u; "
           "reference %.1f "
           "(%.1f %.1f %.1f): %s\n",
           name, pipeline->color_db, pipeline->decided_db, (unsigned long long)pipeline->doubtful_count,
           pipeline->depth_db, pipeline->normal_db, pipeline->coverage_db, pipeline->worst,
           pipeline->worst_px[0], pipeline->worst_px[1], reference->color_db, reference->depth_db,
           reference->normal_db, reference->coverage_db, words);
    fflush(stdout);
}

static int measure_named(ewa_context *context, const char *keep) {
    random_scene made;
    int failed = 0;
    for (uint32_t i = 0; named_scene_make(context, i, &made); i++) {
        char path[256], name[16];
        random_scene_result result;
        snprintf(path, sizeof path, "%s-%u", keep ? keep : "", i);
        snprintf(name, sizeof name, "%u", i);
        if (random_scene_run(context, &made, keep ? path : NULL, &result))
            print_scene(name, &result, made.words);
        else
            printf("%u: failed: %s\n", i, made.words), failed = 1;
        random_scene_free(&made);
    }
    return failed;
}

static int measure_random(ewa_context *context, uint64_t first, uint64_t count, double limit,
                          const char *keep) {
    static const char *const names[8] = {"pipeline color",    "pipeline depth",    "pipeline normal",
                                         "pipeline coverage", "reference color",   "reference depth",
                                         "reference normal",  "reference coverage"};
    double *values = calloc(8 * count, sizeof *values);
    if (!values) return 1;
    uint64_t listed = 0, failed = 0, codes = 0;
    for (uint64_t i = 0; i < count; i++) {
        char name[32];
        random_scene made;
        random_scene_result result;
        random_scene_make(context, first + i, &made);
        snprintf(name, sizeof name, "%llu", (unsigned long long)(first + i));
        if (!random_scene_run(context, &made, keep, &result)) {
            printf("%s: failed: %s\n", name, made.words);
            failed++;
            random_scene_free(&made);
            continue;
        }
        const random_scene_distance *of[2] = {&result.pipeline, &result.reference};
        for (uint64_t k = 0; k < 2; k++) {
            values[(4 * k + 0) * count + i] = of[k]->color_db;
            values[(4 * k + 1) * count + i] = of[k]->depth_db;
            values[(4 * k + 2) * count + i] = of[k]->normal_db;
            values[(4 * k + 3) * count + i] = of[k]->coverage_db;
        }
        codes += result.reference.codes_over;
        if (result.pipeline.color_db < limit || result.reference.color_db < 80 || keep) {
            print_scene(name, &result, made.words);
            listed++;
        }
        random_scene_free(&made);
    }
    for (uint64_t k = 0; k < 8; k++) print_quantiles(names[k], values + k * count, count);
    printf(
        "%llu scenes, %llu listed, %llu failed; 8-bit numbers of the reference off by more than one: %llu\n",
        (unsigned long long)count, (unsigned long long)listed, (unsigned long long)failed,
        (unsigned long long)codes);
    free(values);
    return failed > 0;
}

int main(int argc, char **argv) {
    const bool named = argc > 1 && !strcmp(argv[1], "named");
    const uint64_t first = !named && argc > 2 ? strtoull(argv[1], NULL, 10) : 0;
    const uint64_t count = !named && argc > 2 ? strtoull(argv[2], NULL, 10) : 1000;
    const double limit = argc > 4 && !strcmp(argv[3], "below") ? atof(argv[4]) : 50;
    const char *keep = argc > 4 && !strcmp(argv[3], "keep") ? argv[4] : NULL;
    ewa_context *context = NULL;
    if (!count || ewa_context_create(NULL, &context) != EWA_OK) return 1;
    const int failed = named ? measure_named(context, argc > 2 ? argv[2] : NULL)
                             : measure_random(context, first, count, limit, keep);
    ewa_context_destroy(&context);
    return failed;
}
