// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures at a multiple of their resolution, averaged.
//
// Where a pixel holds many surfels of many small surfaces, the nearest of these takes all of it, however small its share
// is: trees grow fat and dark. No depth tolerance mends that (docs/quality.md, what is far). Parts of a pixel that are about
// as large as its surfels have one surface each again.
//
// Implements docs/math.md section 7 (semantics.h, supersampling).
#include "surface/supersampling.h"
#include "homogeneous/camera.h"
#include "image/srgb.h"
#include "surface/pipeline.h"

#include <math.h>
#include <string.h>

/// Bytes of a band's parts, about.
#define BAND_BYTES ((uint64_t)128 << 20)

/// The camera of a picture of `finer` times the pixels along each side.
static ewa_camera finer_camera(const ewa_camera *camera, uint32_t finer) {
    ewa_camera fine = *camera;
    fine.width_px *= finer, fine.height_px *= finer;
    fine.fx_px *= finer, fine.fy_px *= finer, fine.cx_px *= finer, fine.cy_px *= finer;
    return fine;
}

/// A pixel of parts on which nothing is drawn.
typedef struct blank_pixel {
    float rgba[4], depth, normal[3], coverage;
    uint8_t codes[4];
} blank_pixel;

typedef struct average_job {
    const ewa_frame *fine, *frame;
    uint32_t finer, width_px;
    const uint8_t *blank; ///< of the fine picture's squares; NULL: all have been written
    blank_pixel nothing;
} average_job;

/// Sums `count` floats of each of finer x finer parts of the pixel at (x, y).
static void sum_parts(const average_job *job, const float *plane, uint32_t count, uint32_t x, uint32_t y, float *sum) {
    const size_t row = (size_t)job->width_px * job->finer * count;
    for (uint32_t c = 0; c < count; c++) sum[c] = 0;
    for (uint32_t j = 0; j < job->finer; j++) {
        const float *parts = plane + ((size_t)y * job->finer + j) * row + (size_t)x * job->finer * count;
        for (uint32_t i = 0; i < job->finer * count; i += count)
            for (uint32_t c = 0; c < count; c++) sum[c] += parts[i + c];
    }
}

/// Stores a pixel's colour, linear and premultiplied, in the planes that there are.
static void store_color(const ewa_frame *frame, size_t pixel, const float rgba[4]) {
    if (frame->rgba) memcpy(frame->rgba + 4 * pixel, rgba, 4 * sizeof *rgba);
    if (!frame->rgba8) return;
    uint8_t *codes = frame->rgba8 + 4 * pixel;
    const float alpha = rgba[3] < 1 ? rgba[3] : 1;
    for (uint32_t c = 0; c < 3; c++) codes[c] = alpha > 0 ? ewa_srgb8_from_linear(rgba[c] / alpha) : 0;
    codes[3] = (uint8_t)(255 * alpha + 0.5f);
}

/// Stores a pixel's normal, of length 1 unless it is 0.
static void store_normal(const ewa_frame *frame, size_t pixel, const float n[3]) {
    const float length2 = n[0] * n[0] + n[1] * n[1] + n[2] * n[2], scale = length2 > 0 ? 1 / sqrtf(length2) : 0;
    for (uint32_t c = 0; c < 3; c++) frame->normal[3 * pixel + c] = n[c] * scale;
}

static void average_colors(const average_job *job, uint32_t x, uint32_t y) {
    const float share = 1 / (float)(job->finer * job->finer);
    const size_t pixel = (size_t)y * job->width_px + x;
    float rgba[4];
    sum_parts(job, job->fine->rgba, 4, x, y, rgba);
    for (uint32_t c = 0; c < 4; c++) rgba[c] *= share;
    store_color(job->frame, pixel, rgba);
}

/// The nearest depth, so that none lies between two surfaces.
static void take_depth(const average_job *job, uint32_t x, uint32_t y) {
    const size_t row = (size_t)job->width_px * job->finer;
    float nearest = INFINITY;
    for (uint32_t j = 0; j < job->finer; j++)
        for (uint32_t i = 0; i < job->finer; i++)
            nearest = fminf(nearest, job->fine->depth[((size_t)y * job->finer + j) * row + (size_t)x * job->finer + i]);
    job->frame->depth[(size_t)y * job->width_px + x] = nearest;
}

static void average_normals(const average_job *job, uint32_t x, uint32_t y) {
    float n[3];
    sum_parts(job, job->fine->normal, 3, x, y, n);
    store_normal(job->frame, (size_t)y * job->width_px + x, n);
}

static void store_nothing(const average_job *job, size_t pixel) {
    const ewa_frame *frame = job->frame;
    const blank_pixel *nothing = &job->nothing;
    if (frame->rgba) memcpy(frame->rgba + 4 * pixel, nothing->rgba, sizeof nothing->rgba);
    if (frame->rgba8) memcpy(frame->rgba8 + 4 * pixel, nothing->codes, sizeof nothing->codes);
    if (frame->depth) frame->depth[pixel] = nothing->depth;
    if (frame->normal) memcpy(frame->normal + 3 * pixel, nothing->normal, sizeof nothing->normal);
    if (frame->coverage) frame->coverage[pixel] = nothing->coverage;
}

static void average_row(void *data, uint32_t y, uint32_t worker) {
    (void)worker;
    const average_job *job = data;
    const ewa_frame *fine = job->fine, *frame = job->frame;
    const uint32_t columns = (job->width_px * job->finer + EWA_BLANK_PX - 1) / EWA_BLANK_PX;
    const uint8_t *blank = job->blank ? job->blank + (size_t)(y * job->finer / EWA_BLANK_PX) * columns : NULL;
    for (uint32_t x = 0; x < job->width_px; x++) {
        if (blank && blank[x * job->finer / EWA_BLANK_PX]) {
            store_nothing(job, (size_t)y * job->width_px + x);
            continue;
        }
        if (fine->rgba) average_colors(job, x, y);
        if (fine->depth && frame->depth) take_depth(job, x, y);
        if (fine->normal && frame->normal) average_normals(job, x, y);
        if (!fine->coverage || !frame->coverage) continue;
        float sum;
        sum_parts(job, fine->coverage, 1, x, y, &sum);
        frame->coverage[(size_t)y * job->width_px + x] = sum / (float)(job->finer * job->finer);
    }
}

/// Finds what pixels without anything get: the mean of such parts, with the roundings of any other.
static blank_pixel make_nothing(const ewa_render_job *job, uint32_t finer) {
    enum { PARTS = EWA_MAX_SUPERSAMPLING * EWA_MAX_SUPERSAMPLING };
    const float *color = job->options.background;
    const float background[4] = {color[0] * color[3], color[1] * color[3], color[2] * color[3], color[3]};
    float rgba[4 * PARTS], depth[PARTS], normal[3 * PARTS] = {0}, coverage[PARTS] = {0};
    for (uint32_t i = 0; i < PARTS; i++) {
        memcpy(&rgba[4 * i], background, sizeof background);
        depth[i] = INFINITY;
    }
    blank_pixel nothing;
    const ewa_frame fine = {.rgba = rgba, .depth = depth, .normal = normal, .coverage = coverage};
    const ewa_frame pixel = {.rgba8 = nothing.codes, .rgba = nothing.rgba, .depth = &nothing.depth, .normal = nothing.normal, .coverage = &nothing.coverage};
    average_job one = {.fine = &fine, .frame = &pixel, .finer = finer, .width_px = 1};
    average_row(&one, 0, 0);
    return nothing;
}

/// The planes of a frame from one of its rows on.
static ewa_frame frame_from(const ewa_frame *frame, size_t pixel) {
    ewa_frame from = *frame;
    if (from.rgba8) from.rgba8 += 4 * pixel;
    if (from.rgba) from.rgba += 4 * pixel;
    if (from.depth) from.depth += pixel;
    if (from.normal) from.normal += 3 * pixel;
    if (from.coverage) from.coverage += pixel;
    return from;
}

/// Where a plane would begin whose pixel `first` is at `at`: a back end that draws a band of a picture counts from the
/// picture's first pixel, and only the band has memory.
static float *plane_before(const float *at, size_t first, size_t channel_count) {
    return (float *)((uintptr_t)at - first * channel_count * sizeof *at);
}

/// Squares that may be blank along a side of so many pixels.
static size_t blank_squares(uint32_t side_px, uint32_t finer) { return ((size_t)side_px * finer + EWA_BLANK_PX - 1) / EWA_BLANK_PX; }

/// Planes for the parts of a band of `frame`'s pixels, as they are (`band`), and for a back end (`drawn`), and bytes behind them.
static ewa_status reserve_parts(ewa_context *context, ewa_buffer *room, const ewa_frame *frame, size_t first_part,
                                size_t part_count, size_t byte_count, ewa_frame *band, ewa_frame *drawn, uint8_t **bytes) {
    const struct {
        float **band, **drawn;
        size_t channel_count;
    } planes[] = {{&band->rgba, &drawn->rgba, frame->rgba || frame->rgba8 ? 4 : 0},
                  {&band->depth, &drawn->depth, frame->depth ? 1 : 0},
                  {&band->normal, &drawn->normal, frame->normal ? 3 : 0},
                  {&band->coverage, &drawn->coverage, frame->coverage ? 1 : 0}};
    enum { PLANES = sizeof planes / sizeof *planes };
    size_t channels = 0;
    for (int i = 0; i < PLANES; i++) channels += planes[i].channel_count;
    EWA_TRY(ewa_buffer_reserve(context, room, part_count * channels * sizeof(float) + byte_count, 1));
    *band = *drawn = (ewa_frame){.rgba8 = NULL};
    float *at = room->data;
    for (int i = 0; i < PLANES; i++) {
        if (!planes[i].channel_count) continue;
        *planes[i].band = at;
        *planes[i].drawn = plane_before(at, first_part, planes[i].channel_count);
        at += planes[i].channel_count * part_count;
    }
    *bytes = (uint8_t *)at;
    return EWA_OK;
}

/// Rows of pixels that are drawn at a time. Frames of several processes are drawn whole.
static uint32_t band_rows_px(const ewa_backend *backend, const ewa_render_job *job, uint64_t finer) {
    if (backend->add) return job->camera.height_px;
    const uint64_t row_bytes = finer * finer * job->camera.width_px * 4 * sizeof(float);
    const uint64_t fields = BAND_BYTES / (row_bytes * EWA_FIELD_PX);
    return EWA_FIELD_PX * (uint32_t)(fields < 1 ? 1
                                     : fields > EWA_CAMERA_MAX_SIDE_PX / EWA_FIELD_PX
                                         ? EWA_CAMERA_MAX_SIDE_PX / EWA_FIELD_PX
                                         : fields);
}

/// The frame of parts of rows of a frame.
static ewa_render_job finer_job(const ewa_render_job *job, uint32_t finer, uint32_t first_px, uint32_t end_px) {
    ewa_render_job fine = *job;
    fine.camera = finer_camera(&job->camera, finer);
    fine.options.point_size_px *= finer;
    fine.first_row_px = first_px * finer, fine.end_row_px = end_px * finer;
    return fine;
}

ewa_status ewa_parts_draw(ewa_context *context, const ewa_backend *backend, void *state, const ewa_render_job *job,
                          uint32_t finer, ewa_buffer *room, ewa_render_stats *stats) {
    const uint32_t width_px = job->camera.width_px;
    *stats = (ewa_render_stats){.splat_count = 0};
    const uint32_t band_px = band_rows_px(backend, job, finer);
    const blank_pixel nothing = make_nothing(job, finer);
    // Squares are of whole pixels, and what lights edges looks at all parts.
    const bool with_blank = EWA_BLANK_PX % finer == 0 && !backend->add && !(job->options.eye_dome > 0);
    const size_t blank_bytes = blank_squares(width_px, finer) * blank_squares(band_px, finer);
    for (uint32_t first_px = job->first_row_px; first_px < job->end_row_px; first_px += band_px) {
        const uint32_t end_px = job->end_row_px - first_px < band_px ? job->end_row_px : first_px + band_px;
        ewa_render_job fine = finer_job(job, finer, first_px, end_px);
        const size_t row = fine.camera.width_px;
        ewa_frame parts;
        EWA_TRY(reserve_parts(context, room, &job->frame, row * fine.first_row_px,
                              row * (fine.end_row_px - fine.first_row_px), blank_bytes, &parts, &fine.frame, &fine.blank));
        if (with_blank)
            memset(fine.blank, 0, blank_bytes);
        else
            fine.blank = NULL;
        ewa_render_stats took;
        EWA_TRY(backend->draw(state, &fine, &took));
        took.level = 0;
        ewa_render_stats_add(stats, &took);
        const ewa_frame band = frame_from(&job->frame, (size_t)first_px * width_px);
        average_job average = {&parts, &band, finer, width_px, fine.blank, nothing};
        ewa_parallel(context, average_row, &average, end_px - first_px);
    }
    return EWA_OK;
}

/// Sets up the frame of parts for a back end that averages them itself: its planes are the averages', without bytes, in linear colours
/// and sums of normals. `room` is memory that survives frames.
static ewa_status start_parts(ewa_context *context, const ewa_render_job *job, uint32_t finer, ewa_buffer *room,
                              ewa_render_job *fine) {
    *fine = finer_job(job, finer, job->first_row_px, job->end_row_px);
    fine->frame.rgba8 = NULL;
    if (!job->frame.rgba8 || job->frame.rgba) return EWA_OK;
    const size_t width = job->camera.width_px, rows = job->end_row_px - job->first_row_px;
    EWA_TRY(ewa_buffer_reserve(context, room, 4 * width * rows, sizeof(float)));
    fine->frame.rgba = plane_before(room->data, width * job->first_row_px, 4);
    return EWA_OK;
}

typedef struct finish_job {
    const ewa_frame *means, *frame;
    uint32_t first_px, width_px;
} finish_job;

static void finish_row(void *data, uint32_t y, uint32_t worker) {
    (void)worker;
    const finish_job *job = data;
    const size_t first = ((size_t)job->first_px + y) * job->width_px;
    for (size_t i = first; i < first + job->width_px; i++) {
        if (job->frame->rgba8) store_color(job->frame, i, job->means->rgba + 4 * i);
        if (!job->frame->normal) continue;
        float n[3];
        memcpy(n, job->frame->normal + 3 * i, sizeof n);
        store_normal(job->frame, i, n);
    }
}

/// Makes of these averages the planes of the frame.
static void finish_parts(ewa_context *context, const ewa_render_job *job, const ewa_render_job *fine) {
    ewa_frame bytes = job->frame;
    bytes.rgba = NULL; // are there
    finish_job finish = {&fine->frame, &bytes, job->first_row_px, job->camera.width_px};
    ewa_parallel(context, finish_row, &finish, job->end_row_px - job->first_row_px);
}

ewa_status ewa_parts_draw_averaged(ewa_context *context, const ewa_backend *backend, void *state, const ewa_render_job *job,
                                   uint32_t finer, ewa_buffer *room, uint32_t *averaged, ewa_render_stats *stats) {
    // Bands are of whole fields.
    if (EWA_FIELD_PX % finer) return ewa_parts_draw(context, backend, state, job, finer, room, stats);
    const double start_s = ewa_now_s();
    ewa_render_job fine;
    EWA_TRY(start_parts(context, job, finer, room, &fine));
    *averaged = finer;
    const ewa_status status = backend->draw(state, &fine, stats);
    *averaged = 1;
    EWA_TRY(status);
    finish_parts(context, job, &fine);
    stats->total_s = ewa_now_s() - start_s;
    return EWA_OK;
}

/// Draws every pixel as `finer` squared, by the back end's own averages if it makes some.
static ewa_status draw_averages(ewa_context *context, const ewa_backend *backend, void *state, const ewa_render_job *job,
                                uint32_t finer, ewa_buffer *room, ewa_render_stats *stats) {
    const ewa_camera *camera = &job->camera;
    if ((uint64_t)finer * camera->width_px > EWA_CAMERA_MAX_SIDE_PX ||
        (uint64_t)finer * camera->height_px > EWA_CAMERA_MAX_SIDE_PX)
        return ewa_fail(context, EWA_ERROR_LIMIT,
                        "render: supersampling is %u; %u times %u x %u pixels are more than %d along a side", finer,
                        finer, camera->width_px, camera->height_px, EWA_CAMERA_MAX_SIDE_PX);
    ewa_render_stats took;
    if (backend->draw_parts)
        EWA_TRY(backend->draw_parts(state, job, finer, &took));
    else
        EWA_TRY(ewa_parts_draw(context, backend, state, job, finer, room, &took));
    took.level = 0;
    ewa_render_stats_add(stats, &took);
    return EWA_OK;
}

ewa_status ewa_supersampling_draw(ewa_context *context, const ewa_backend *backend, void *state, const ewa_render_job *job,
                                  ewa_buffer *room, ewa_buffer *mixing, ewa_render_stats *stats) {
    *stats = (ewa_render_stats){.splat_count = 0};
    const ewa_division parts = job->parts;
    if (!(parts.finer_share > 0)) return draw_averages(context, backend, state, job, parts.count, room, stats);
    ewa_frame_pair pair;
    EWA_TRY(ewa_frame_pair_reserve(context, mixing, &job->camera, &job->frame, &pair));
    ewa_render_job own = *job;
    own.frame = pair.coarse;
    EWA_TRY(draw_averages(context, backend, state, &own, parts.count, room, stats));
    own.frame = pair.fine;
    EWA_TRY(draw_averages(context, backend, state, &own, 2 * parts.count, room, stats));
    ewa_frame_pair_mix(context, &pair, parts.finer_share, &job->camera, job->first_row_px, job->end_row_px, &job->frame);
    return EWA_OK;
}

ewa_status ewa_frame_pair_reserve(ewa_context *context, ewa_buffer *room, const ewa_camera *camera, const ewa_frame *frame,
                                  ewa_frame_pair *pair) {
    const size_t count = (size_t)camera->width_px * camera->height_px;
    const size_t channels = (frame->rgba || frame->rgba8 ? 4 : 0) + (frame->depth ? 1 : 0) + (frame->normal ? 3 : 0) +
                            (frame->coverage ? 1 : 0);
    EWA_TRY(ewa_buffer_reserve(context, room, count * channels, 2 * sizeof(float)));
    // Ranks that get no picture draw nothing into them.
    if (channels > 0) memset(room->data, 0, count * channels * 2 * sizeof(float));
    float *at = room->data;
    ewa_frame *const frames[] = {&pair->coarse, &pair->fine};
    for (int i = 0; i < 2; i++) {
        *frames[i] = (ewa_frame){.rgba8 = NULL};
        if (frame->rgba || frame->rgba8) frames[i]->rgba = at, at += 4 * count;
        if (frame->depth) frames[i]->depth = at, at += count;
        if (frame->normal) frames[i]->normal = at, at += 3 * count;
        if (frame->coverage) frames[i]->coverage = at, at += count;
    }
    return EWA_OK;
}

typedef struct mix_job {
    const ewa_frame_pair *pair;
    const ewa_frame *frame;
    float finer_share;
    uint32_t first_px, width_px;
} mix_job;

static float mix(float coarse, float fine, float finer_share) { return coarse + finer_share * (fine - coarse); }

static void mix_row(void *data, uint32_t y, uint32_t worker) {
    (void)worker;
    const mix_job *job = data;
    const ewa_frame *coarse = &job->pair->coarse, *fine = &job->pair->fine, *frame = job->frame;
    const size_t first = ((size_t)job->first_px + y) * job->width_px;
    for (size_t i = first; i < first + job->width_px; i++) {
        if (coarse->rgba) {
            float rgba[4];
            for (int c = 0; c < 4; c++) rgba[c] = mix(coarse->rgba[4 * i + c], fine->rgba[4 * i + c], job->finer_share);
            store_color(frame, i, rgba);
        }
        if (frame->depth) frame->depth[i] = fminf(coarse->depth[i], fine->depth[i]);
        if (frame->coverage) frame->coverage[i] = mix(coarse->coverage[i], fine->coverage[i], job->finer_share);
        if (!frame->normal) continue;
        float n[3];
        for (int c = 0; c < 3; c++) n[c] = mix(coarse->normal[3 * i + c], fine->normal[3 * i + c], job->finer_share);
        store_normal(frame, i, n);
    }
}

void ewa_frame_pair_mix(ewa_context *context, const ewa_frame_pair *pair, double finer_share, const ewa_camera *camera,
                        uint32_t first_px, uint32_t end_px, const ewa_frame *frame) {
    mix_job job = {pair, frame, (float)finer_share, first_px, camera->width_px};
    ewa_parallel(context, mix_row, &job, end_px - first_px);
}
