// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How long it takes what comes before and after a frame: files, normals and radii, surfels, PNG, clipping.
#include "bench/stages.h"

#include "bench/clip.h"
#include "bench/files.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/// Files that the stages write and read, in a folder of their own.
typedef struct scratch_folder {
    char folder[SESSION_FOLDER_BYTES], ply[288], ascii[288], again[288], png[288];
} scratch_folder;

typedef enum stage_kind {
    STAGE_WRITE,
    STAGE_READ,
    STAGE_READ_ASCII,
    STAGE_ESTIMATE,
    STAGE_ESTIMATE_UNEVEN,
    STAGE_PACK,
    STAGE_PNG_RGB,
    STAGE_PNG_RGBA,
    STAGE_CLIP,
    STAGE_COLOR_GRADIENTS,
    STAGE_GRADIENTS,
    STAGE_COUNT
} stage_kind;

static const char *const stage_names[STAGE_COUNT] = {
    [STAGE_WRITE] = "write PLY",
    [STAGE_READ] = "read PLY",
    [STAGE_READ_ASCII] = "read PLY, ASCII",
    [STAGE_ESTIMATE] = "normals and radii",
    [STAGE_ESTIMATE_UNEVEN] = "normals and radii, uneven",
    [STAGE_PACK] = "surfels",
    [STAGE_PNG_RGB] = "PNG, RGB",
    [STAGE_PNG_RGBA] = "PNG, RGBA",
    [STAGE_CLIP] = "clip segments",
    [STAGE_COLOR_GRADIENTS] = "gradients of colours",
    [STAGE_GRADIENTS] = "gradients",
};

/// The stages with one number of threads.
typedef struct stage_lane {
    ewa_context *context;
    double time_s[STAGE_COUNT][BENCH_MAX_FRAMES];
} stage_lane;

/// What all lanes work on.
typedef struct stage_input {
    const ewa_cloud *cloud;
    const ewa_camera *camera;
    const uint8_t *rgba8;
    uint8_t *rgb8;
    scratch_folder scratch;
} stage_input;

static bool scratch_open(cli_session *session, scratch_folder *scratch) {
    if (!session_make_folder(session, scratch->folder)) return false;
    snprintf(scratch->ply, sizeof scratch->ply, "%s/cloud.ply", scratch->folder);
    snprintf(scratch->ascii, sizeof scratch->ascii, "%s/ascii.ply", scratch->folder);
    snprintf(scratch->again, sizeof scratch->again, "%s/again.ply", scratch->folder);
    snprintf(scratch->png, sizeof scratch->png, "%s/picture.png", scratch->folder);
    return true;
}

static void scratch_close(const scratch_folder *scratch) {
    remove(scratch->ply);
    remove(scratch->ascii);
    remove(scratch->again);
    remove(scratch->png);
    rmdir(scratch->folder);
}

static ewa_status save_inputs(const stage_input *input) {
    ewa_cloud_save_options save;
    ewa_cloud_save_options_init(&save, sizeof save);
    save.ply_encoding = EWA_PLY_ASCII;
    const ewa_status status = ewa_cloud_save(input->cloud, input->scratch.ply, NULL);
    return status == EWA_OK ? ewa_cloud_save(input->cloud, input->scratch.ascii, &save) : status;
}

/// Writes the time since `*started_s` and begins the next stage.
static void lap(double *time_s, double *started_s) {
    const double now_s = clock_now_s();
    *time_s = now_s - *started_s;
    *started_s = clock_now_s();
}

/// Normals and radii of bare positions.
static ewa_status time_estimate(ewa_cloud **cloud, double *time_s) {
    static const char *const estimated[] = {EWA_NORMAL, EWA_RADIUS, EWA_TANGENT_U, EWA_TANGENT_V};
    for (int k = 0; k < 4; k++) ewa_cloud_remove(*cloud, estimated[k]);
    ewa_estimate_options options;
    ewa_estimate_options_init(&options, sizeof options);
    double started_s = clock_now_s();
    const ewa_status status = ewa_cloud_estimate(cloud, &options);
    lap(time_s, &started_s);
    return status;
}

/// Samples a cloud about the origin as unevenly as a scanner there does: distances r become r^3, so that the
/// density of a plane falls with their power of -4/3.
static ewa_status make_dense(ewa_cloud *cloud) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    const ewa_attribute given = *ewa_cloud_find(cloud, EWA_POSITION);
    float *numbers = malloc((3 * count + 1) * sizeof *numbers), *position = NULL;
    if (!numbers) return EWA_ERROR_MEMORY;
    ewa_attribute_read_f32(&given, 0, count, numbers);
    const ewa_status status = ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, (void **)&position);
    for (uint64_t i = 0; status == EWA_OK && i < count; i++) {
        const float *p = &numbers[3 * i];
        const float squared = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
        for (int r = 0; r < 3; r++) position[3 * i + (uint64_t)r] = squared * p[r];
    }
    free(numbers);
    return status;
}

/// Derivatives of the picture's brightness by colours, and by all that there are.
static ewa_status time_gradients(stage_lane *lane, const ewa_cloud *cloud, const ewa_camera *from, size_t run) {
    const size_t points = (size_t)ewa_cloud_point_count(cloud),
                 pixels = (size_t)from->width_px * from->height_px;
    enum { NUMBERS = 11 }; // of a point
    double *numbers = malloc((NUMBERS * points + 1) * sizeof *numbers), started_s = clock_now_s();
    float *rgba = malloc(4 * pixels * sizeof *rgba);
    ewa_status status = numbers && rgba ? EWA_OK : EWA_ERROR_MEMORY;
    for (size_t i = 0; status == EWA_OK && i < 4 * pixels; i++) rgba[i] = 1;
    for (int all = 0; status == EWA_OK && all < 2; all++) {
        ewa_camera_cotangent camera;
        const ewa_frame_cotangent cotangent = {.rgba = rgba};
        ewa_gradient gradient = {.color = numbers};
        if (all) {
            gradient.position = numbers + 3 * points, gradient.normal = numbers + 6 * points;
            gradient.radius = numbers + 9 * points, gradient.opacity = numbers + 10 * points;
            gradient.camera = &camera;
        }
        started_s = clock_now_s();
        status = ewa_render_backward(cloud, NULL, 0, from, NULL, &cotangent, &gradient);
        lap(&lane->time_s[all ? STAGE_GRADIENTS : STAGE_COLOR_GRADIENTS][run], &started_s);
    }
    free(rgba);
    free(numbers);
    return status;
}

/// Reading and writing the cloud, surfels, normals and radii from bare positions.
static ewa_status time_cloud(stage_lane *lane, const stage_input *input, size_t run) {
    ewa_cloud *loaded = NULL;
    ewa_surfels *surfels = NULL;
    double started_s = clock_now_s();
    ewa_status status = ewa_cloud_load(lane->context, input->scratch.ascii, &loaded);
    lap(&lane->time_s[STAGE_READ_ASCII][run], &started_s);
    ewa_cloud_destroy(&loaded);
    started_s = clock_now_s();
    if (status == EWA_OK) status = ewa_cloud_load(lane->context, input->scratch.ply, &loaded);
    lap(&lane->time_s[STAGE_READ][run], &started_s);
    if (status == EWA_OK) status = ewa_cloud_save(loaded, input->scratch.again, NULL);
    lap(&lane->time_s[STAGE_WRITE][run], &started_s);
    if (status == EWA_OK) status = ewa_surfels_create(loaded, NULL, &surfels);
    lap(&lane->time_s[STAGE_PACK][run], &started_s);
    ewa_surfels_destroy(&surfels);
    if (status == EWA_OK) status = time_gradients(lane, loaded, input->camera, run);
    if (status == EWA_OK) status = time_estimate(&loaded, &lane->time_s[STAGE_ESTIMATE][run]);
    if (status == EWA_OK) status = make_dense(loaded);
    if (status == EWA_OK) status = time_estimate(&loaded, &lane->time_s[STAGE_ESTIMATE_UNEVEN][run]);
    ewa_cloud_destroy(&loaded);
    return status;
}

static ewa_status time_pictures(stage_lane *lane, const stage_input *input, size_t run) {
    const uint32_t width = input->camera->width_px, height = input->camera->height_px;
    double started_s = clock_now_s();
    ewa_status status =
        ewa_png_save(lane->context, input->scratch.png, width, height, 3, input->rgb8, 3 * (size_t)width);
    lap(&lane->time_s[STAGE_PNG_RGB][run], &started_s);
    if (status == EWA_OK)
        status = ewa_png_save(lane->context, input->scratch.png, width, height, 4, input->rgba8,
                              4 * (size_t)width);
    lap(&lane->time_s[STAGE_PNG_RGBA][run], &started_s);
    return status;
}

static void report(const bench_plan *plan, stage_lane *lane, const stage_input *input,
                   const bench_sink *sink) {
    const uint64_t points = ewa_cloud_point_count(input->cloud),
                   pixels = (uint64_t)input->camera->width_px * input->camera->height_px;
    for (int stage = 0; stage < STAGE_COUNT; stage++) {
        const bool picture = stage == STAGE_PNG_RGB || stage == STAGE_PNG_RGBA;
        const bench_stage_row row = {
            .stage = stage_names[stage],
            .threads = ewa_context_worker_count(lane->context),
            .time = bench_summarise(lane->time_s[stage], plan->frame_count),
            .item_count = picture               ? pixels
                          : stage == STAGE_CLIP ? BENCH_CLIP_SEGMENTS
                                                : points,
            .bytes = stage == STAGE_READ_ASCII                     ? bench_file_bytes(input->scratch.ascii)
                     : stage == STAGE_READ || stage == STAGE_WRITE ? bench_file_bytes(input->scratch.ply)
                                                                   : 0};
        bench_report_stage(sink, &row);
    }
}

static ewa_status measure(const bench_plan *plan, stage_lane *lanes, const stage_input *input) {
    ewa_status status = save_inputs(input);
    for (size_t run = 0; status == EWA_OK && run < plan->frame_count; run++) {
        for (size_t i = 0; status == EWA_OK && i < plan->thread_counts; i++) {
            status = time_cloud(&lanes[i], input, run);
            if (status == EWA_OK) status = time_pictures(&lanes[i], input, run);
            if (status == EWA_OK) status = bench_clip(lanes[i].context, &lanes[i].time_s[STAGE_CLIP][run], 1);
        }
    }
    return status;
}

bool bench_stages(cli_session *session, const bench_plan *plan, const ewa_cloud *cloud,
                  const ewa_camera *camera, const uint8_t *rgba8, const bench_sink *sink) {
    stage_input input = {.cloud = cloud, .camera = camera, .rgba8 = rgba8};
    if (!scratch_open(session, &input.scratch)) return false;
    const size_t pixels = (size_t)camera->width_px * camera->height_px;
    stage_lane *lanes = calloc(plan->thread_counts, sizeof *lanes);
    input.rgb8 = malloc(3 * pixels);
    bool done = lanes && input.rgb8;
    if (!done) session_fail(session, "out of memory for the stages of %zu pixels", pixels);
    for (size_t i = 0; done && i < plan->thread_counts; i++) {
        lanes[i].context = session_context(session, plan->threads[i], plan->sets[0].mask);
        done = lanes[i].context != NULL;
    }
    for (size_t i = 0; done && i < pixels; i++) memcpy(input.rgb8 + 3 * i, rgba8 + 4 * i, 3);
    if (done) {
        const ewa_status status = measure(plan, lanes, &input);
        done = status == EWA_OK;
        if (!done) session_failed(session, status);
    }
    for (size_t i = 0; lanes && i < plan->thread_counts; i++) {
        if (done) report(plan, &lanes[i], &input, sink);
        ewa_context_destroy(&lanes[i].context);
    }
    free(lanes);
    free(input.rgb8);
    scratch_close(&input.scratch);
    return done;
}
