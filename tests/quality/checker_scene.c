// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The checkerboard to the horizon: truth by exact integration along lines, picture by the library, errors by
// bands.
#include "quality/checker_scene.h"
#include "base/base.h"

#include <math.h>
#include <string.h>

enum {
    SIDE = CHECKER_SIDE,
    LINES = 32, ///< per pixel row
    CELLS = 8,  ///< per pixel along a line, integrated exactly each
    MARGIN = 4, ///< pixels around the picture that the Gaussian needs
    REACH = 2,  ///< pixels that the Gaussian reaches: 4 standard deviations
    ROW_CELLS = (SIDE + 2 * MARGIN) * CELLS,
    GAUSS_TAPS = 2 * REACH * CELLS,
};

#define EYE_HEIGHT  0.1
#define CHECKS      100.0
#define SQUARE      (2 / CHECKS)
#define GAUSS_SIGMA 0.5 // pixels

/// Where a line of the picture meets the ground: y there, and world units per pixel along x.
typedef struct ground_line {
    double y_world, pixel_world;
} ground_line;

static bool meet_ground(const ewa_camera *camera, double y_px, ground_line *line) {
    const double below = (y_px - camera->cy_px) / camera->fy_px;
    if (below <= 0) return false;
    const double distance = EYE_HEIGHT / below;
    *line = (ground_line){.y_world = distance - 1, .pixel_world = distance / camera->fx_px};
    return line->y_world <= 1;
}

/// Integral from 0 to t of a wave that is +1 on [0, 1), -1 on [1, 2) and so on.
static double wave_integral(double t) {
    const double phase = t - 2 * floor(t / 2);
    return phase < 1 ? phase : 2 - phase;
}

/// Means over the cells of one line, white 1, black 0; the checker's first square is white.
static void integrate_line(const ewa_camera *camera, const ground_line *line, double *cells) {
    const double sign = fmod(floor((line->y_world + 1) / SQUARE), 2) == 0 ? 1 : -1;
    const double step = line->pixel_world / CELLS / SQUARE;
    const double left = (1 + (-MARGIN - camera->cx_px) * line->pixel_world) / SQUARE;
    double before = wave_integral(left);
    for (int i = 0; i < ROW_CELLS; i++) {
        const double after = wave_integral(left + (i + 1) * step);
        cells[i] = 0.5 + 0.5 * sign * (after - before) / step;
        before = after;
    }
}

static void classify_row(checker_truth *truth, int y) {
    ground_line line, below = {0}, upper, lower = {0};
    truth->band[y] = -1;
    for (int x = 0; x < SIDE; x++) truth->counts[y][x] = false;
    if (!meet_ground(&truth->camera, y + 0.5, &line)) return;
    meet_ground(&truth->camera, y + 1.5, &below);
    const double height_px = SQUARE / (line.y_world - below.y_world);
    truth->band[y] = height_px < 2 ? 0 : height_px < 8 ? 1 : 2;
    if (!meet_ground(&truth->camera, y - 2.5, &upper)) return;
    meet_ground(&truth->camera, y + 3.5, &lower);
    if (lower.y_world < -1) return;
    for (int x = 0; x < SIDE; x++) {
        const double reach = fabs(x + 0.5 - truth->camera.cx_px) + 3;
        truth->counts[y][x] = reach * upper.pixel_world < 1;
    }
}

typedef struct trace_job {
    checker_truth *truth;
    double taps[GAUSS_TAPS];
} trace_job;

/// One row of both truths: its own lines for the box, those within reach for the Gaussian.
static void trace_row(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const trace_job *job = data;
    checker_truth *truth = job->truth;
    const int y = (int)index;
    classify_row(truth, y);
    if (truth->band[y] < 0) return;
    double cells[ROW_CELLS], weight_sum = 0;
    memset(truth->box[y], 0, sizeof truth->box[y]);
    memset(truth->gauss[y], 0, sizeof truth->gauss[y]);
    for (int k = -REACH * LINES; k < (REACH + 1) * LINES; k++) {
        const double offset = (k + 0.5) / LINES - 0.5;
        ground_line line;
        if (!meet_ground(&truth->camera, y + 0.5 + offset, &line)) continue;
        integrate_line(&truth->camera, &line, cells);
        const double weight = exp(-0.5 * (offset / GAUSS_SIGMA) * (offset / GAUSS_SIGMA));
        weight_sum += weight;
        for (int x = 0; x < SIDE; x++) {
            const double *pixel = &cells[(x + MARGIN) * CELLS];
            double sum = 0;
            for (int i = 0; i < GAUSS_TAPS; i++) sum += job->taps[i] * pixel[CELLS / 2 - GAUSS_TAPS / 2 + i];
            truth->gauss[y][x] += weight * sum;
            if (k < 0 || k >= LINES) continue;
            sum = 0;
            for (int i = 0; i < CELLS; i++) sum += pixel[i];
            truth->box[y][x] += sum / (CELLS * LINES);
        }
    }
    for (int x = 0; x < SIDE; x++) truth->gauss[y][x] /= weight_sum;
}

void checker_trace(ewa_context *context, double zoom, checker_truth *truth) {
    const double eye[3] = {0, -1, EYE_HEIGHT}, target[3] = {0, 0, EYE_HEIGHT}, up[3] = {0, 0, 1};
    ewa_camera_init(&truth->camera);
    truth->camera.width_px = truth->camera.height_px = SIDE;
    ewa_camera_set_fov(&truth->camera, 60);
    truth->camera.fx_px *= zoom, truth->camera.fy_px *= zoom;
    ewa_camera_look_at(&truth->camera, eye, target, up);
    trace_job job = {.truth = truth};
    double sum = 0;
    for (int i = 0; i < GAUSS_TAPS; i++) {
        const double offset = (i + 0.5 - GAUSS_TAPS / 2) / CELLS / GAUSS_SIGMA;
        sum += job.taps[i] = exp(-0.5 * offset * offset);
    }
    for (int i = 0; i < GAUSS_TAPS; i++) job.taps[i] /= sum;
    ewa_parallel(context, trace_row, &job, SIDE);
}

static void compare(const checker_truth *truth, const float *rgba, checker_errors *errors) {
    double box[CHECKER_BANDS] = {0}, gauss[CHECKER_BANDS] = {0};
    uint64_t counts[CHECKER_BANDS] = {0};
    for (int y = 0; y < SIDE; y++) {
        const int band = truth->band[y];
        for (int x = 0; x < SIDE && band >= 0; x++) {
            if (!truth->counts[y][x]) continue;
            const float *pixel = &rgba[4 * (y * SIDE + x)];
            const double by_box = pixel[0] - truth->box[y][x], by_gauss = pixel[0] - truth->gauss[y][x];
            box[band] += by_box * by_box;
            gauss[band] += by_gauss * by_gauss;
            counts[band]++;
            errors->hole_count += pixel[3] == 0;
        }
    }
    double box_sum = 0, gauss_sum = 0;
    for (int band = 0; band < CHECKER_BANDS; band++) {
        box_sum += box[band], gauss_sum += gauss[band];
        errors->box_percent[band] = 100 * sqrt(box[band] / (double)counts[band]);
        errors->gauss_percent[band] = 100 * sqrt(gauss[band] / (double)counts[band]);
        errors->pixel_count += counts[band];
    }
    errors->box_psnr_db = 10 * log10((double)errors->pixel_count / box_sum);
    errors->gauss_psnr_db = 10 * log10((double)errors->pixel_count / gauss_sum);
}

static void measure_alpha(const checker_truth *truth, const float *rgba, checker_errors *errors) {
    uint64_t translucent = 0;
    errors->lowest_alpha = 1;
    for (int i = 0; i < SIDE * SIDE; i++) {
        if (!truth->counts[i / SIDE][i % SIDE]) continue;
        const double alpha = rgba[4 * i + 3];
        translucent += alpha < 0.999;
        errors->lowest_alpha = fmin(errors->lowest_alpha, alpha);
    }
    errors->translucent_percent = 100 * (double)translucent / (double)errors->pixel_count;
}

ewa_status checker_make(ewa_context *context, const checker_setting *setting, ewa_surfels **surfels) {
    WITH_DEFAULTS(ewa_generate_options, board);
    board.object = EWA_OBJECT_CHECKER;
    board.point_count = CHECKER_POINTS;
    board.checks = CHECKS;
    board.jitter = setting->jitter;
    board.radius_scale = setting->cutoff * setting->sigma;
    WITH_DEFAULTS(ewa_surfels_options, options);
    options.cutoff = setting->cutoff;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    ewa_status status = ewa_cloud_generate(context, &board, &cloud);
    if (status == EWA_OK) status = ewa_surfels_create(cloud, &options, surfels);
    return status;
}

/// Positions and colours of the board, by default all else estimated.
static ewa_status make_points(ewa_context *context, ewa_cloud **cloud) {
    WITH_DEFAULTS(ewa_generate_options, board);
    board.object = EWA_OBJECT_CHECKER;
    board.point_count = CHECKER_POINTS;
    board.checks = CHECKS;
    board.jitter = 0.4;
    WITH_DEFAULTS(ewa_estimate_options, options);
    options.keep_normals = options.keep_radii = false;
    const ewa_status status = ewa_cloud_generate(context, &board, cloud);
    return status == EWA_OK ? ewa_cloud_estimate(cloud, &options) : status;
}

/// Points on a square with a picture of the board of 1,000 x 1,000 pixels.
static ewa_status sample_mesh(ewa_context *context, ewa_cloud **cloud) {
    enum { PICTURE = 1000, CELL = PICTURE / (int)CHECKS };
    static const double corners[12] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    static const float texcoords[8] = {0, 0, 1, 0, 1, 1, 0, 1};
    static const uint32_t triangles[6] = {0, 1, 2, 0, 2, 3};
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    OWNED(ewa_image_free) ewa_image picture;
    WITH_DEFAULTS(ewa_mesh_sample_options, options);
    options.point_count = CHECKER_POINTS;
    EWA_TRY(ewa_mesh_create(context, 4, 2, 0, EWA_MESH_TEXCOORDS, &mesh));
    memcpy(mesh.positions, corners, sizeof corners);
    memcpy(mesh.texcoords, texcoords, sizeof texcoords);
    memcpy(mesh.triangles, triangles, sizeof triangles);
    ewa_status status = ewa_image_create(context, PICTURE, PICTURE, 1, &picture);
    for (int i = 0; i < PICTURE * PICTURE && status == EWA_OK; i++) {
        const int column = i % PICTURE / CELL, row = (PICTURE - 1 - i / PICTURE) / CELL;
        picture.pixels[i] = (float)((column + row + 1) % 2);
    }
    if (status == EWA_OK) status = ewa_mesh_set_picture(&mesh, &picture);
    if (status == EWA_OK) status = ewa_mesh_sample(&mesh, &options, cloud);
    return status;
}

ewa_status checker_make_from(ewa_context *context, checker_source source, double radius_scale, ewa_surfels **surfels) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    WITH_DEFAULTS(ewa_surfels_options, options);
    options.radius_scale = radius_scale;
    ewa_status status = source == CHECKER_OF_MESH ? sample_mesh(context, &cloud) : make_points(context, &cloud);
    if (status == EWA_OK && source == CHECKER_OF_POINTS_REFITTED) status = ewa_cloud_refit_colors(cloud, NULL, NULL);
    if (status == EWA_OK) status = ewa_surfels_create(cloud, &options, surfels);
    return status;
}

ewa_render_options checker_options(const checker_setting *setting) {
    WITH_DEFAULTS(ewa_render_options, options);
    options.kernel = setting->kernel;
    options.prefilter_px = setting->prefilter_px;
    options.passes = setting->one_pass ? 1 : 3;
    options.shading = EWA_SHADING_NONE;
    options.edge_antialiasing = false;
    return options;
}

ewa_status checker_compare(ewa_context *context, const checker_truth *truth, const ewa_render_options *given,
                           const ewa_surfels *surfels, checker_errors *errors) {
    *errors = (checker_errors){0};
    ewa_render_options options = *given;
    ewa_renderer *renderer = NULL;
    float *rgba = ewa_allocate(context, (size_t)SIDE * SIDE, 4 * sizeof *rgba);
    const ewa_frame frame = {.rgba = rgba};
    ewa_status status = rgba ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = ewa_renderer_create(context, &renderer);
    if (status == EWA_OK) status = ewa_render(renderer, surfels, &truth->camera, &options, &frame, NULL);
    if (status == EWA_OK) compare(truth, rgba, errors);
    options.edge_antialiasing = true;
    if (status == EWA_OK) status = ewa_render(renderer, surfels, &truth->camera, &options, &frame, NULL);
    if (status == EWA_OK) measure_alpha(truth, rgba, errors);
    ewa_renderer_destroy(&renderer);
    ewa_release(context, rgba, (size_t)SIDE * SIDE, 4 * sizeof *rgba);
    return status;
}

ewa_status checker_measure(ewa_context *context, const checker_truth *truth, const checker_setting *setting,
                           checker_errors *errors) {
    const ewa_render_options options = checker_options(setting);
    ewa_surfels *surfels = NULL;
    ewa_status status = checker_make(context, setting, &surfels);
    if (status == EWA_OK) status = checker_compare(context, truth, &options, surfels, errors);
    ewa_surfels_destroy(&surfels);
    return status;
}
