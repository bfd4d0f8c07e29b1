// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Closed surfaces, sampled evenly and unevenly.
#include "splat/level_scene.h"

#include <math.h>

const char *const level_names[LEVEL_KINDS] = {"grid", "jittered", "even", "white", "slanted", "sphere"};

static const double PI = 3.14159265358979323846;

/// Poisson-disc samples by dart throwing, in a grid of cells of that size.
static uint32_t throw_darts(check_random *random, uint32_t count, float *xy) {
    const double apart = 2 * 0.81 / sqrt(count);
    const uint32_t side = (uint32_t)(2 / (apart / sqrt(2))) + 1;
    OWNED(check_free) int32_t *cells = malloc((size_t)side * side * sizeof *cells);
    assert_non_null(cells);
    for (size_t i = 0; i < (size_t)side * side; i++) cells[i] = -1;
    uint32_t made = 0;
    for (uint64_t candidate = 0; candidate < 60 * (uint64_t)count && made < count; candidate++) {
        const double x = check_uniform(random, -1, 1), y = check_uniform(random, -1, 1);
        const int32_t cx = (int32_t)((x + 1) / 2 * side), cy = (int32_t)((y + 1) / 2 * side);
        bool taken = false;
        for (int32_t j = cy - 2; j <= cy + 2 && !taken; j++)
            for (int32_t i = cx - 2; i <= cx + 2 && !taken; i++) {
                if (i < 0 || j < 0 || i >= (int32_t)side || j >= (int32_t)side) continue;
                const int32_t other = cells[(size_t)j * side + (size_t)i];
                taken = other >= 0 && hypot((double)xy[2 * other] - x, (double)xy[2 * other + 1] - y) < apart;
            }
        if (taken) continue;
        cells[(size_t)cy * side + (size_t)cx] = (int32_t)made;
        xy[2 * made] = (float)x, xy[2 * made + 1] = (float)y;
        made++;
    }
    return made;
}

/// Places in the square; returns their number.
static uint32_t make_places(level_kind kind, uint32_t count, float *xy) {
    check_random random = {(uint64_t)kind + 11};
    if (kind == LEVEL_EVEN) return throw_darts(&random, count, xy);
    if (kind == LEVEL_WHITE) {
        for (uint32_t i = 0; i < 2 * count; i++) xy[i] = (float)check_uniform(&random, -1, 1);
        return count;
    }
    const double stretch = kind == LEVEL_SLANTED ? 1.5 : 1;
    const uint32_t columns = (uint32_t)(sqrt(count) * sqrt(stretch)),
                   rows = (uint32_t)(sqrt(count / stretch));
    for (uint32_t i = 0; i < columns * rows; i++) {
        const double shift = kind == LEVEL_SLANTED ? i / columns % 3 / 3.0 : 0.5;
        const bool anywhere = kind == LEVEL_JITTERED;
        const double u = anywhere ? check_uniform(&random, 0, 1) : shift;
        const double v = anywhere ? check_uniform(&random, 0, 1) : 0.5;
        xy[2 * i] = (float)(2 * (i % columns + u) / columns - 1);
        xy[2 * i + 1] = (float)(2 * (i / columns + v) / rows - 1);
    }
    return columns * rows;
}

ewa_cloud *level_cloud(ewa_context *context, level_kind kind, uint32_t count) {
    float *xy = malloc(2 * (size_t)count * sizeof *xy), *position, *normal, *radius;
    assert_non_null(xy);
    const bool sphere = kind == LEVEL_SPHERE;
    const uint32_t made = make_places(sphere ? LEVEL_WHITE : kind, count, xy);
    ewa_cloud *cloud = check_cloud_of(context, made);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, (void **)&position), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_NORMAL, EWA_F32, 3, (void **)&normal), EWA_OK);
    uint8_t *color = check_add(cloud, EWA_COLOR, EWA_U8, 3);
    for (uint32_t i = 0; i < made; i++) {
        double x = (double)xy[2 * i], y = (double)xy[2 * i + 1], z = 0;
        if (sphere) {
            const double angle = PI * x, ring = sqrt(1 - y * y);
            z = y, x = ring * cos(angle), y = ring * sin(angle);
        }
        const double at[3] = {x, y, z}, up[3] = {0, 0, 1};
        for (int c = 0; c < 3; c++) {
            position[3 * i + (uint32_t)c] = (float)at[c];
            normal[3 * i + (uint32_t)c] = (float)(sphere ? at[c] : up[c]);
            color[3 * i + (uint32_t)c] = (uint8_t)(128 + 100 * sin((7 + 5 * c) * (x + 0.7 * y + 1.3 * z)));
        }
    }
    free(xy);
    if (kind == LEVEL_WHITE || sphere) {
        WITH_DEFAULTS(ewa_estimate_options, options);
        assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
        return cloud;
    }
    assert_int_equal(ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, (void **)&radius), EWA_OK);
    // The widest gaps decide: those between rows, and those that chance leaves.
    static const double spacings[] = {1.14, 2.2, 1.5, 0, 1.4};
    for (uint32_t i = 0; i < made; i++) radius[i] = (float)(spacings[kind] * 2 / sqrt(made));
    return cloud;
}

ewa_camera level_camera(uint32_t width_px, uint32_t height_px, double distance, double tilt_deg) {
    ewa_camera camera = check_camera(width_px, height_px);
    camera.fx_px = camera.fy_px = height_px;
    camera.cx_px = width_px / 2.0, camera.cy_px = height_px / 2.0;
    const double c = cos(tilt_deg * PI / 180), s = sin(tilt_deg * PI / 180);
    const double rows[16] = {1, 0, 0, 0, 0, -c, -s, 0, 0, s, -c, distance, 0, 0, 0, 1};
    memcpy(camera.world_to_camera, rows, sizeof rows);
    return camera;
}

bool level_inside(level_kind kind, const ewa_camera *camera, uint32_t x_px, uint32_t y_px, double margin) {
    const double *m = camera->world_to_camera;
    const double d[3] = {(x_px + 0.5 - camera->cx_px) / camera->fx_px,
                         (y_px + 0.5 - camera->cy_px) / camera->fy_px, 1};
    double eye[3], ray[3];
    for (int c = 0; c < 3; c++) {
        eye[c] = -(m[c] * m[3] + m[4 + c] * m[7] + m[8 + c] * m[11]);
        ray[c] = m[c] * d[0] + m[4 + c] * d[1] + m[8 + c] * d[2];
    }
    if (kind == LEVEL_SPHERE) {
        double along = 0, length2 = 0, far2 = 0;
        for (int c = 0; c < 3; c++) along -= eye[c] * ray[c], length2 += ray[c] * ray[c];
        for (int c = 0; c < 3; c++) {
            const double from = eye[c] + along / length2 * ray[c];
            far2 += from * from;
        }
        return far2 < (1 - margin) * (1 - margin);
    }
    const double along = -eye[2] / ray[2];
    return along > 0 && fabs(eye[0] + along * ray[0]) < 1 - margin &&
           fabs(eye[1] + along * ray[1]) < 1 - margin;
}
