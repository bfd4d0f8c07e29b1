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
#include "surface/levels.h"
#include "surface/packets.h"
#include "surface/pipeline.h"
#include "surface/semantics.h"

#include <math.h>
#include <string.h>

/// Packets of which the sizes are looked at, at most.
enum { SAMPLED_PACKETS = 1 << 14 };

/// Bytes of a band's parts, about.
#define BAND_BYTES ((uint64_t)128 << 20)

/// The camera of a picture of `finer` times the pixels along each side.
static ewa_camera finer_camera(const ewa_camera *camera, uint32_t finer) {
    ewa_camera fine = *camera;
    fine.width_px *= finer, fine.height_px *= finer;
    fine.fx_px *= finer, fine.fy_px *= finer, fine.cx_px *= finer, fine.cy_px *= finer;
    return fine;
}

void ewa_part_areas_add(ewa_part_areas *areas, double radius_px, double area) {
    areas->all += area;
    for (int k = 0; k < 3; k++)
        if (radius_px * (1 << k) < EWA_PART_RADIUS_PX) areas->smaller[k] += area;
}

uint32_t ewa_part_areas_choose(const ewa_part_areas *areas, const ewa_camera *camera) {
    const uint32_t side_px = camera->width_px > camera->height_px ? camera->width_px : camera->height_px;
    uint32_t parts = 1;
    for (int k = 0; k < 3 && areas->smaller[k] > areas->all / 2 && 2 * parts * side_px <= EWA_CAMERA_MAX_SIDE_PX; k++)
        parts *= 2;
    return parts;
}

static void add_sizes(const ewa_render_job *job, const ewa_surfels *surfels, uint32_t step, ewa_part_areas *areas) {
    const ewa_camera *camera = &job->camera;
    const double *m = camera->world_to_camera;
    const double zoom = fmax(camera->fx_px, camera->fy_px);
    for (uint32_t p = 0; p < surfels->packet_count; p += step) {
        const ewa_vec3 center = ewa_packet_center(surfels, p);
        const double at[3] = {center.x * surfels->unit + surfels->origin_world[0],
                              center.y * surfels->unit + surfels->origin_world[1],
                              center.z * surfels->unit + surfels->origin_world[2]};
        double camera_at[3];
        for (int r = 0; r < 3; r++)
            camera_at[r] = m[4 * r] * at[0] + m[4 * r + 1] * at[1] + m[4 * r + 2] * at[2] + m[4 * r + 3];
        const bool flat = camera->projection == EWA_ORTHOGRAPHIC;
        const double depth = flat ? 1 : camera_at[2], sigma = (double)surfels->packets[p].sigma[0] * surfels->unit;
        if (!(camera_at[2] > 0) || !(sigma > 0)) continue;
        const double x = camera->fx_px * camera_at[0] / depth + camera->cx_px;
        const double y = camera->fy_px * camera_at[1] / depth + camera->cy_px;
        if (x < 0 || y < 0 || x > camera->width_px || y > camera->height_px) continue;
        const double scale = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
        const double radius_px = surfels->cutoff * sigma * scale * zoom / depth;
        ewa_part_areas_add(areas, radius_px, radius_px * radius_px);
    }
}

/// A source at the level that the options ask for.
static const ewa_surfels *drawn_surfels(const ewa_render_job *job, uint32_t source) {
    uint32_t level = job->options.level;
    return ewa_levels_find(job->sources[source].surfels, &level);
}

uint32_t ewa_supersampling_choose(const ewa_render_job *job) {
    uint64_t packet_count = 0;
    for (uint32_t i = 0; i < job->source_count; i++) packet_count += drawn_surfels(job, i)->packet_count;
    ewa_part_areas areas = {.all = 0};
    for (uint32_t i = 0; i < job->source_count; i++)
        add_sizes(job, drawn_surfels(job, i), (uint32_t)(packet_count / SAMPLED_PACKETS) + 1, &areas);
    return ewa_part_areas_choose(&areas, &job->camera);
}

typedef struct average_job {
    const ewa_frame *fine, *frame;
    uint32_t finer, width_px;
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

static void average_colors(const average_job *job, uint32_t x, uint32_t y) {
    const float share = 1 / (float)(job->finer * job->finer);
    const size_t pixel = (size_t)y * job->width_px + x;
    float rgba[4];
    sum_parts(job, job->fine->rgba, 4, x, y, rgba);
    for (uint32_t c = 0; c < 4; c++) rgba[c] *= share;
    if (job->frame->rgba) memcpy(job->frame->rgba + 4 * pixel, rgba, sizeof rgba);
    if (!job->frame->rgba8) return;
    uint8_t *codes = job->frame->rgba8 + 4 * pixel;
    const float alpha = rgba[3] < 1 ? rgba[3] : 1;
    for (uint32_t c = 0; c < 3; c++) codes[c] = alpha > 0 ? ewa_srgb8_from_linear(rgba[c] / alpha) : 0;
    codes[3] = (uint8_t)(255 * alpha + 0.5f);
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
    const float length2 = n[0] * n[0] + n[1] * n[1] + n[2] * n[2], scale = length2 > 0 ? 1 / sqrtf(length2) : 0;
    for (uint32_t c = 0; c < 3; c++) job->frame->normal[3 * ((size_t)y * job->width_px + x) + c] = n[c] * scale;
}

static void average_row(void *data, uint32_t y, uint32_t worker) {
    (void)worker;
    const average_job *job = data;
    const ewa_frame *fine = job->fine, *frame = job->frame;
    for (uint32_t x = 0; x < job->width_px; x++) {
        if (fine->rgba) average_colors(job, x, y);
        if (fine->depth && frame->depth) take_depth(job, x, y);
        if (fine->normal && frame->normal) average_normals(job, x, y);
        if (!fine->coverage || !frame->coverage) continue;
        float sum;
        sum_parts(job, fine->coverage, 1, x, y, &sum);
        frame->coverage[(size_t)y * job->width_px + x] = sum / (float)(job->finer * job->finer);
    }
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

/// Planes for the parts of a band of `frame`'s pixels, as they are (`band`), and for a back end (`drawn`).
static ewa_status reserve_parts(ewa_context *context, ewa_buffer *room, const ewa_frame *frame, size_t first_part,
                                size_t part_count, ewa_frame *band, ewa_frame *drawn) {
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
    EWA_TRY(ewa_buffer_reserve(context, room, part_count * channels, sizeof(float)));
    *band = *drawn = (ewa_frame){.rgba8 = NULL};
    float *at = room->data;
    for (int i = 0; i < PLANES; i++) {
        if (!planes[i].channel_count) continue;
        *planes[i].band = at;
        *planes[i].drawn = plane_before(at, first_part, planes[i].channel_count);
        at += planes[i].channel_count * part_count;
    }
    return EWA_OK;
}

/// Rows of pixels that are drawn at a time. Frames of several processes are drawn whole.
static uint32_t band_rows_px(const ewa_backend *backend, const ewa_render_job *job) {
    if (backend->joint) return job->camera.height_px;
    const uint64_t finer = job->options.supersampling,
                   row_bytes = finer * finer * job->camera.width_px * 4 * sizeof(float);
    const uint64_t fields = BAND_BYTES / (row_bytes * EWA_FIELD_PX);
    return EWA_FIELD_PX * (uint32_t)(fields < 1 ? 1
                                     : fields > EWA_CAMERA_MAX_SIDE_PX / EWA_FIELD_PX
                                         ? EWA_CAMERA_MAX_SIDE_PX / EWA_FIELD_PX
                                         : fields);
}

ewa_status ewa_supersampling_draw(ewa_context *context, const ewa_backend *backend, void *state,
                                  const ewa_render_job *job, ewa_buffer *room, ewa_render_stats *stats) {
    const uint32_t finer = job->options.supersampling, width_px = job->camera.width_px;
    if ((uint64_t)finer * width_px > EWA_CAMERA_MAX_SIDE_PX ||
        (uint64_t)finer * job->camera.height_px > EWA_CAMERA_MAX_SIDE_PX)
        return ewa_fail(context, EWA_ERROR_LIMIT,
                        "render: supersampling is %u; %u times %u x %u pixels are more than %d along a side", finer,
                        finer, width_px, job->camera.height_px, EWA_CAMERA_MAX_SIDE_PX);
    const uint32_t band_px = band_rows_px(backend, job);
    *stats = (ewa_render_stats){.splat_count = 0};
    for (uint32_t first_px = job->first_row_px; first_px < job->end_row_px; first_px += band_px) {
        const uint32_t end_px = job->end_row_px - first_px < band_px ? job->end_row_px : first_px + band_px;
        ewa_render_job fine = *job;
        fine.camera = finer_camera(&job->camera, finer);
        fine.options.point_size_px *= finer;
        fine.first_row_px = first_px * finer, fine.end_row_px = end_px * finer;
        const size_t row = fine.camera.width_px;
        ewa_frame parts;
        EWA_TRY(reserve_parts(context, room, &job->frame, row * fine.first_row_px,
                              row * (fine.end_row_px - fine.first_row_px), &parts, &fine.frame));
        ewa_render_stats took;
        EWA_TRY(backend->draw(state, &fine, &took));
        took.level = 0;
        ewa_render_stats_add(stats, &took);
        const ewa_frame band = frame_from(&job->frame, (size_t)first_px * width_px);
        average_job average = {&parts, &band, finer, width_px};
        ewa_parallel(context, average_row, &average, end_px - first_px);
    }
    return EWA_OK;
}
