// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Turns a checker box through 45 degrees in steps of 0.25 and prints, as CSV, how much each picture differs
// from the one before; the summary goes to standard error. tools/volume_popping.gnuplot plots it.
//
// measure_volume_popping [FOLDER]: with a folder, also writes the pictures at 44.5 and 45.5 degrees there.
#include "image_difference.h"
#include "measure/measure.h"
#include "volume/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE_PX = 400, FIRST_DEG = 0, LAST_DEG = 90, STEPS = (LAST_DEG - FIRST_DEG) * 4 };

static void save(const ewa_image *image, const char *folder, double degrees) {
    char path[1024];
    snprintf(path, sizeof path, "%s/volume_checker_%g.png", folder, degrees);
    check(ewa_image_save(image, path, NULL));
}

/// How far two pictures are from each other, in % of full scale.
static image_difference change(const ewa_image *a, const ewa_image *b) {
    const image_difference difference = image_compare(a, b, 0);
    return difference;
}

/// Largest change near 45 degrees, and elsewhere.
typedef struct extremes {
    double rms_near, rms_else, max_near, max_else;
} extremes;

int main(int argc, char **argv) {
    static const uint32_t dims[3] = {64, 64, 64};
    static const double spacing[3] = {1, 1, 1}, sides[2] = {6, 27};
    ewa_context *context;
    check(ewa_context_create(NULL, &context));
    ewa_volume volume = scene_volume(context, dims, spacing, scene_checker, sides);
    ewa_transfer transfer = {.point_count = 4, .unit_length_world = 1};
    transfer.points[0] = (ewa_transfer_point){0.75, {0.9f, 0.25f, 0.1f}, 0.5f};
    transfer.points[1] = (ewa_transfer_point){1.5, {0.9f, 0.25f, 0.1f}, 0.5f};
    transfer.points[2] = (ewa_transfer_point){1.5, {0.9f, 0.85f, 0.6f}, 0.5f};
    transfer.points[3] = (ewa_transfer_point){2.25, {0.9f, 0.85f, 0.6f}, 0.5f};
    ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    printf("degrees,splats rms,splats largest,points rms,points largest\n");
    ewa_image before[2];
    extremes found[2] = {{0}};
    for (int step = 0; step <= STEPS; step++) {
        const double degrees = FIRST_DEG + step / 4.0, angle = degrees * 3.14159265358979323846 / 180;
        const double direction[3] = {sin(angle), 0, -cos(angle)};
        image_difference differences[2];
        for (int far = 0; far < 2; far++) {
            // Splats of 3 px from near, points of 0.8 px from afar.
            ewa_camera camera = scene_camera(SIDE_PX, SIDE_PX, direction, far ? 690 : 183);
            WITH_DEFAULTS(ewa_volume_options, options);
            ewa_image image = scene_draw(context, voxels, &camera, &options);
            if (argc > 1 && !far && (degrees == 44.5 || degrees == 45.5)) save(&image, argv[1], degrees);
            if (step) {
                differences[far] = change(&image, &before[far]);
                extremes *to = &found[far];
                const bool near = fabs(degrees - 0.125 - 45) < 2;
                double *rms = near ? &to->rms_near : &to->rms_else;
                double *maximum = near ? &to->max_near : &to->max_else;
                *rms = fmax(*rms, differences[far].rms);
                *maximum = fmax(*maximum, differences[far].maximum);
                ewa_image_free(&before[far]);
            }
            before[far] = image;
        }
        if (step)
            printf("%.3f,%.5f,%.5f,%.5f,%.5f\n", degrees - 0.125, differences[0].rms, differences[0].maximum,
                   differences[1].rms, differences[1].maximum);
    }
    for (int far = 0; far < 2; far++) {
        fprintf(
            stderr,
            "%s: rms change between frames at most %.5f within 2 degrees of 45, %.5f elsewhere; of one pixel "
            "%.4f and %.4f\n",
            far ? "points" : "splats", found[far].rms_near, found[far].rms_else, found[far].max_near,
            found[far].max_else);
        ewa_image_free(&before[far]);
    }
    ewa_voxels_destroy(&voxels);
    ewa_volume_free(&volume);
    ewa_context_destroy(&context);
    return 0;
}
