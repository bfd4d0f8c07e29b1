// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What axis-aligned sheet buffers do when a volume is turned past 45 degrees (Westover 1990; figure 7 of HFR, Yuan et al.
// 2003): a checker box is turned in steps of half a degree, drawn by the library and by sheets, and as CSV it is printed how
// much each picture differs from the one before. measure_volume_sheets [FOLDER]: also writes both at 44.75 and 45.25 degrees.
//
// A sheet is a slice of voxels across the grid's axis that is nearest to the view. The circular footprints of its voxels
// are added up in a buffer, which is then composited: what belongs to one sheet changes at 45 degrees.
#include "image_difference.h"
#include "measure/measure.h"
#include "volume/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 40, SIDE_PX = 200 };

static const double SIGMA = 0.6, EXTINCTION = 0.5, PREFILTER_PX = 0.35, PI = 3.14159265358979323846;
static const float COLORS[2][3] = {{0.9f, 0.25f, 0.1f}, {0.9f, 0.85f, 0.6f}};

/// Adds a voxel's optical depth, times its colour and alone, to a sheet.
static void add_footprint(const ewa_camera *camera, const double place[3], const float color[3], double *sheet) {
    double camera_space[3];
    for (int row = 0; row < 3; row++) {
        const double *m = camera->world_to_camera + 4 * row;
        camera_space[row] = m[0] * place[0] + m[1] * place[1] + m[2] * place[2] + m[3];
    }
    const double scale = camera->fx_px / camera_space[2];
    const double x = camera->cx_px + scale * camera_space[0], y = camera->cy_px + scale * camera_space[1];
    const double variance = SIGMA * SIGMA * scale * scale + PREFILTER_PX * PREFILTER_PX, reach = 3 * sqrt(variance);
    const double height = EXTINCTION * scale * scale / (2 * PI * variance);
    for (int j = (int)fmax(0, floor(y - reach)); j <= (int)fmin(SIDE_PX - 1, y + reach); j++)
        for (int i = (int)fmax(0, floor(x - reach)); i <= (int)fmin(SIDE_PX - 1, x + reach); i++) {
            const double dx = i + 0.5 - x, dy = j + 0.5 - y;
            const double depth = height * exp(-0.5 * (dx * dx + dy * dy) / variance);
            double *pixel = sheet + 4 * ((size_t)j * SIDE_PX + (size_t)i);
            for (int c = 0; c < 3; c++) pixel[c] += depth * (double)color[c];
            pixel[3] += depth;
        }
}

/// Puts a sheet behind what is there: premultiplied colours and alpha.
static void composite(const double *sheet, float *rgba) {
    for (size_t i = 0; i < (size_t)SIDE_PX * SIDE_PX; i++) {
        const double depth = sheet[4 * i + 3];
        if (depth <= 0) continue;
        const double left = 1 - (double)rgba[4 * i + 3], share = left * (1 - exp(-depth));
        for (size_t c = 0; c < 3; c++) rgba[4 * i + c] += (float)(share * sheet[4 * i + c] / depth);
        rgba[4 * i + 3] += (float)share;
    }
}

static ewa_image draw_sheets(ewa_context *context, const ewa_volume *volume, const ewa_camera *camera, const double eye[3]) {
    ewa_image image;
    check(ewa_image_create(context, SIDE_PX, SIDE_PX, 4, &image));
    double *sheet = malloc((size_t)SIDE_PX * SIDE_PX * 4 * sizeof *sheet);
    if (!sheet) check(EWA_ERROR_MEMORY);
    const float *values = volume->voxels;
    const int across = fabs(eye[0]) > fabs(eye[2]) ? 0 : 2;
    for (int step = 0; step < SIDE; step++) {
        const int slice = eye[across] > 0 ? SIDE - 1 - step : step; // front to back
        memset(sheet, 0, (size_t)SIDE_PX * SIDE_PX * 4 * sizeof *sheet);
        for (int j = 0; j < SIDE; j++)
            for (int i = 0; i < SIDE; i++) {
                int index[3] = {i, j, i};
                index[across] = slice;
                const float value = values[((size_t)index[2] * SIDE + (size_t)index[1]) * SIDE + (size_t)index[0]];
                if (value < 0.5f) continue;
                const double place[3] = {index[0] - (SIDE - 1) / 2.0, index[1] - (SIDE - 1) / 2.0, index[2] - (SIDE - 1) / 2.0};
                add_footprint(camera, place, COLORS[value > 1.5f], sheet);
            }
        composite(sheet, image.pixels);
    }
    free(sheet);
    return image;
}

static void save(const ewa_image *image, const char *folder, const char *name, double degrees) {
    char path[1024];
    snprintf(path, sizeof path, "%s/%s_%g.png", folder, name, degrees);
    check(ewa_image_save(image, path, NULL));
}

int main(int argc, char **argv) {
    static const uint32_t dims[3] = {SIDE, SIDE, SIDE};
    static const double spacing[3] = {1, 1, 1}, sides[2] = {5, 17}, first_deg = 37.75, step_deg = 0.5;
    const int steps = is_quick() ? 2 : 30;
    ewa_context *context = make_context(0);
    ewa_volume volume = scene_volume(context, dims, spacing, scene_checker, sides);
    ewa_transfer transfer = {.point_count = 4, .unit_length_world = 1};
    for (int k = 0; k < 4; k++) {
        transfer.points[k] = (ewa_transfer_point){0.75 * (1 + k - k / 2), {0, 0, 0}, (float)EXTINCTION};
        memcpy(transfer.points[k].color, COLORS[k / 2], sizeof transfer.points[k].color);
    }
    ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    ewa_image before[2] = {{0}, {0}};
    printf("degrees,ours,sheets\n");
    for (int step = 0; step <= steps; step++) {
        const double degrees = (steps < 14 ? 44.75 : first_deg) + step * step_deg, angle = degrees * PI / 180;
        const double direction[3] = {sin(angle), 0.35, -cos(angle)};
        ewa_camera camera = scene_camera(SIDE_PX, SIDE_PX, direction, 105);
        WITH_DEFAULTS(ewa_volume_options, options);
        options.shading = EWA_SHADING_NONE;
        double eye[3];
        ewa_camera_eye(&camera, eye);
        ewa_image now[2] = {scene_draw(context, voxels, &camera, &options), draw_sheets(context, &volume, &camera, eye)};
        if (argc > 1 && fabs(degrees - 45) < 0.3)
            for (int k = 0; k < 2; k++) save(&now[k], argv[1], k ? "sheets" : "ours", degrees);
        if (step)
            printf("%.2f,%.5f,%.5f\n", degrees - step_deg / 2, image_compare(&now[0], &before[0], 0).rms,
                   image_compare(&now[1], &before[1], 0).rms);
        for (int k = 0; k < 2; k++) {
            ewa_image_free(&before[k]);
            before[k] = now[k];
        }
    }
    for (int k = 0; k < 2; k++) ewa_image_free(&before[k]);
    ewa_voxels_destroy(&voxels);
    ewa_volume_free(&volume);
    ewa_context_destroy(&context);
    return 0;
}
