// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What is far against its truth: scenes, cameras and the comparison.
#include "quality/far_scene.h"

#include <math.h>
#include <stdbool.h>

const char *const far_names[FAR_KINDS] = {"town", "sphere, noise", "terrain, marble"};

ewa_status far_make(ewa_context *context, far_kind kind, uint64_t point_count, ewa_cloud **cloud) {
    static const ewa_object objects[FAR_KINDS] = {EWA_OBJECT_TOWN, EWA_OBJECT_SPHERE, EWA_OBJECT_TERRAIN};
    WITH_DEFAULTS(ewa_generate_options, options);
    options.object = objects[kind];
    options.point_count = point_count;
    ewa_status status = ewa_cloud_generate(context, &options, cloud);
    if (status != EWA_OK || kind == FAR_TOWN) return status;
    ewa_procedure_options procedure;
    ewa_procedure_options_init(&procedure, kind == FAR_SPHERE ? EWA_PROCEDURE_NOISE : EWA_PROCEDURE_MARBLE,
                               sizeof procedure);
    status = ewa_cloud_color_by_procedure(*cloud, &procedure);
    if (status != EWA_OK) ewa_cloud_destroy(cloud);
    return status;
}

ewa_camera far_camera(const ewa_bounds *bounds, double times, uint32_t side_px, uint32_t finer) {
    static const double direction[3] = {-0.577, 0.577, -0.577}, up[3] = {0, 0, 1};
    ewa_camera camera;
    ewa_camera_init(&camera);
    camera.width_px = side_px * finer;
    camera.height_px = side_px * finer;
    double eye[3], middle[3];
    bool placed =
        ewa_camera_set_fov(&camera, 30) == EWA_OK && ewa_camera_frame(&camera, bounds, direction, up, 0) == EWA_OK;
    ewa_camera_eye(&camera, eye);
    for (int c = 0; c < 3; c++) {
        middle[c] = (bounds->low_world[c] + bounds->high_world[c]) / 2;
        eye[c] = middle[c] + (eye[c] - middle[c]) * times;
    }
    placed = placed && ewa_camera_look_at(&camera, eye, middle, up) == EWA_OK;
    if (!placed) camera.width_px = 0; // what draws by it refuses
    return camera;
}

void far_average(const float *fine, uint32_t side_px, uint32_t finer, float *rgba) {
    const size_t row = (size_t)4 * finer * side_px;
    for (size_t y = 0; y < side_px; y++)
        for (size_t x = 0; x < side_px; x++) {
            double sum[4] = {0};
            for (size_t j = 0; j < finer; j++)
                for (size_t i = 0; i < finer; i++)
                    for (size_t c = 0; c < 4; c++)
                        sum[c] += (double)fine[(y * finer + j) * row + 4 * (x * finer + i) + c];
            for (size_t c = 0; c < 4; c++) rgba[4 * (y * side_px + x) + c] = (float)(sum[c] / ((double)finer * finer));
        }
}

/// A linear premultiplied number over white, as a screen shows it.
static double over_white(const float *rgba, int channel) {
    const double linear = fmin(fmax((double)rgba[channel] + 1 - (double)rgba[3], 0), 1);
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

static double db(double square, uint64_t count) {
    return 10 * log10(3 * (double)count / fmax(square, 1e-12 * (double)count));
}

static double alpha_at(const float *rgba, uint32_t side_px, int64_t x, int64_t y) {
    const int64_t end = side_px;
    return x < 0 || y < 0 || x >= end || y >= end ? 0 : (double)rgba[4 * (y * end + x) + 3];
}

static bool is_inner(const float *truth, uint32_t side_px, int64_t x, int64_t y) {
    for (int64_t dy = -1; dy <= 1; dy++)
        for (int64_t dx = -1; dx <= 1; dx++)
            if (alpha_at(truth, side_px, x + dx, y + dy) < 0.999) return false;
    return true;
}

void far_compare(const float *truth, const float *other, uint32_t side_px, far_errors *errors) {
    double linear = 0, screen = 0, excess = 0, length = 0, light[2] = {0};
    uint64_t count = 0;
    *errors = (far_errors){0};
    for (int64_t y = 0; y < side_px; y++)
        for (int64_t x = 0; x < side_px; x++) {
            const float *t = truth + 4 * (y * side_px + x), *o = other + 4 * (y * side_px + x);
            const double along = alpha_at(truth, side_px, x + 1, y) - alpha_at(truth, side_px, x - 1, y);
            const double down = alpha_at(truth, side_px, x, y + 1) - alpha_at(truth, side_px, x, y - 1);
            length += hypot(along, down) / 2;
            if (!(t[3] > 0) && !(o[3] > 0)) continue;
            count++;
            excess += (double)o[3] - (double)t[3];
            const bool inner = is_inner(truth, side_px, x, y);
            for (int c = 0; c < 3; c++) {
                const double off = (double)o[c] - (double)t[c], seen = over_white(o, c) - over_white(t, c);
                linear += off * off, screen += seen * seen;
                if (inner) light[0] += (double)t[c], light[1] += (double)o[c];
            }
            errors->inner_count += inner;
            errors->open_count += inner && o[3] < 0.99f;
        }
    errors->linear_db = db(linear, count), errors->screen_db = db(screen, count);
    errors->fat_px = length > 0 ? excess / length : 0;
    errors->lighter_percent = light[0] > 0 ? 100 * (light[1] / light[0] - 1) : 0;
}
