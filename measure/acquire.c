// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints a table of docs/acquisition.md: a checkerboard (and a photograph, when its path is the second
// argument) on irregular points, by every filter, from far away to very near. With a folder as first argument
// ("": none), the first setting only, and its pictures.
#include "measure/measure.h"
#include "quality/acquire_scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VIEWS = 3, WAYS = 4 };

static const double views_px_per_cell[VIEWS] = {0.125, 4, 20};
static const char *const view_names[VIEWS] = {"minified", "magnified", "extreme"};

typedef struct way {
    const char *name;
    ewa_texture_filter filter;
    ewa_texture_fit fit;
} way;

static const way ways[WAYS] = {
    {"nearest", EWA_TEXTURE_NEAREST, EWA_FIT_NORMALIZED},
    {"ewa", EWA_TEXTURE_EWA, EWA_FIT_NORMALIZED},
    {"optimal", EWA_TEXTURE_OPTIMAL, EWA_FIT_NORMALIZED},
    {"optimal-sum", EWA_TEXTURE_OPTIMAL, EWA_FIT_SUM},
};

static void save(const char *folder, const char *scene, const char *name, const char *view,
                 const ewa_image *picture) {
    char path[1024];
    if (!folder) return;
    snprintf(path, sizeof path, "%s/%s_%s_%s.png", folder, scene, name, view);
    check(ewa_image_save(picture, path, NULL));
}

static void measure(acquire_scene *scene, const char *name, const char *folder) {
    double rms[WAYS][VIEWS];
    ewa_acquire_report reports[WAYS];
    for (int w = 0; w < WAYS; w++) {
        WITH_DEFAULTS(ewa_acquire_options, options);
        options.filter = ways[w].filter;
        options.fit = ways[w].fit;
        options.wrap_s = options.wrap_t = EWA_TEXTURE_CLAMP;
        options.pixel_sigma_px = scene->pixel_sigma_px;
        ewa_cloud *cloud = NULL;
        check(acquire_points(scene, &cloud));
        check(ewa_cloud_acquire(cloud, &scene->texture, 1, &options, &reports[w]));
        for (int v = 0; v < VIEWS; v++) {
            ewa_image truth = {0}, picture = {0};
            scene->view_px_per_cell = views_px_per_cell[v];
            check(acquire_truth(scene, &truth));
            check(acquire_draw(scene, cloud, &picture));
            rms[w][v] = acquire_rms(scene, &truth, &picture);
            save(folder, name, ways[w].name, view_names[v], &picture);
            if (w == 0) save(folder, name, "truth", view_names[v], &truth);
            ewa_image_free(&truth);
            ewa_image_free(&picture);
        }
        ewa_cloud_destroy(&cloud);
    }
    for (int w = 0; w < WAYS; w++) {
        printf("| %s | %.3g | %g | %s |", name, scene->radius_scale, scene->pixel_sigma_px, ways[w].name);
        for (int v = 0; v < VIEWS; v++)
            printf(" %.2f (%+.0f %%) |", 100 * rms[w][v], 100 * (rms[w][v] / rms[1][v] - 1));
        printf(" %u |\n", reports[w].iterations);
    }
}

int main(int argument_count, char **arguments) {
    const char *folder = argument_count > 1 && *arguments[1] ? arguments[1] : NULL;
    ewa_context *context = make_context(0);
    static const struct {
        double radius_scale, jitter, pixel_sigma_px;
    } settings[] = {{1.44, 1, 1}, {1.44, 1, 0.5}, {1.14, 0.5, 1}, {1.14, 0.5, 0.5}};
    printf("| picture | radius / spacing | pixel sigma | filter | minified | magnified | extreme | "
           "iterations |\n"
           "|---|---|---|---|---|---|---|---|\n");
    for (size_t i = 0; i < (folder ? 1 : sizeof settings / sizeof settings[0]); i++) {
        acquire_scene scene = {.context = context,
                               .radius_scale = settings[i].radius_scale,
                               .jitter = settings[i].jitter,
                               .pixel_sigma_px = settings[i].pixel_sigma_px};
        check(acquire_checker(context, 1024, 8, &scene.texture));
        measure(&scene, "checker", folder);
        ewa_image_free(&scene.texture);
        if (argument_count < 3) continue;
        check(ewa_image_load(context, arguments[2], &scene.texture));
        measure(&scene, "photo", folder);
        ewa_image_free(&scene.texture);
    }
    ewa_context_destroy(&context);
    return 0;
}
