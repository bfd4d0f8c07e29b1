// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Frames that go back from pixels to points: what they are made of, and from points to surfels and back.
#include "surface/gather.h"
#include "base/base.h"
#include "surface/backend.h"
#include "surface/packet_order.h"
#include "surface/packets.h"
#include "surface/pipeline.h"

#include <math.h>
#include <string.h>

enum {
    PIECE_PACKETS = 4096, ///< per piece of parallel work
    COLOR_FLOATS = 4,
};

bool ewa_gather_takes(const ewa_render_options *options, const ewa_shading_setup *shading) {
    if (options->passes != 3 || options->kernel == EWA_KERNEL_RAYCAST || options->point_size_px > 0) return false;
    if (options->supersampling > 1) return false;
    if (options->eye_dome > 0 || options->level > 0 || options->budget_s > 0 || shading->highlights) return false;
    if (!shading->lit) return true;
    const double *color = shading->lights[0].color;
    return shading->light_count == 1 && color[0] == 1 && color[1] == 1 && color[2] == 1;
}

static float larger(float largest, float number) {
    const float size = fabsf(number);
    return size > largest ? size : largest;
}

/// The largest of some numbers; of every fourth but the last ones, if there are four to a pixel.
static double largest_of(const float *numbers, size_t pixel_count, size_t stride) {
    float largest = 0;
    for (size_t i = 0; i < pixel_count * stride; i += stride)
        for (size_t c = 0; c < stride && c < 3; c++) largest = larger(largest, numbers[i + c]);
    return (double)largest;
}

/// What no term of the sums is larger than.
static double bound_of(const ewa_gather_request *request) {
    const size_t pixels = (size_t)request->camera.width_px * request->camera.height_px;
    if (request->rgba) return largest_of(request->rgba, pixels, 4);
    const double weight = request->weights ? largest_of(request->weights, pixels, 1) : 1;
    if (!request->colors) return weight;
    double color = 0;
    for (uint64_t i = 0; i < 3 * request->point_count; i++) {
        const double size = fabs(request->colors[i]);
        if (size > color) color = size;
    }
    return weight * color;
}

/// Between surfels and points.
typedef struct points_job {
    const ewa_gather_request *request;
    const ewa_gather *gather;
    float *colors; ///< [surfel][COLOR_FLOATS]
} points_job;

/// Numbers of the points of a piece of surfels.
static void load_colors(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const points_job *job = data;
    const ewa_surfels *surfels = job->request->surfels;
    const size_t first = (size_t)part * PIECE_PACKETS * EWA_PACKET_LANES,
                 all = (size_t)surfels->packet_count * EWA_PACKET_LANES;
    for (size_t i = first; i < first + PIECE_PACKETS * EWA_PACKET_LANES && i < all; i++)
        for (size_t c = 0; c < 3 && surfels->points[i] != EWA_NO_POINT; c++)
            job->colors[COLOR_FLOATS * i + c] = (float)job->request->colors[3 * (size_t)surfels->points[i] + c];
}

static void add_sums(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const points_job *job = data;
    const ewa_surfels *surfels = job->request->surfels;
    const double unit = 1 / (double)job->gather->units;
    const size_t first = (size_t)part * PIECE_PACKETS * EWA_PACKET_LANES,
                 all = (size_t)surfels->packet_count * EWA_PACKET_LANES;
    for (size_t i = first; i < first + PIECE_PACKETS * EWA_PACKET_LANES && i < all; i++) {
        const int64_t *sums = job->gather->sums + 3 * i;
        if (surfels->points[i] == EWA_NO_POINT || !(sums[0] | sums[1] | sums[2])) continue;
        double *to = job->request->sums + 3 * (size_t)surfels->points[i];
        for (int c = 0; c < 3; c++) to[c] += (double)sums[c] * unit;
    }
}

/// Goes back once.
static ewa_status draw(const ewa_gather_request *request, const ewa_gather *gather, ewa_gather_room *room, bool *any) {
    ewa_context *context = request->surfels->context;
    const ewa_frame_source source = {request->surfels, 1, true};
    ewa_render_job job = {.camera = request->camera, .options = request->options, .sources = &source,
                          .source_count = 1, .tile_px = request->tile_px, .gather = gather,
                          .end_row_px = request->camera.height_px};
    ewa_shading_setup_make(&job.options, &job.shading);
    if (!room->state) EWA_TRY(ewa_backend_cpu.create(context, &room->state));
    ewa_render_stats stats;
    EWA_TRY(ewa_backend_cpu.draw(room->state, &job, &stats));
    if (any) *any = stats.culled_count < stats.splat_count;
    return EWA_OK;
}

void ewa_gather_room_free(ewa_context *context, ewa_gather_room *room) {
    if (room->state) ewa_backend_cpu.destroy(context, room->state);
    ewa_buffer_free(context, &room->colors);
    ewa_buffer_free(context, &room->sums);
    ewa_buffer_free(context, &room->shared);
    room->state = NULL;
}

/// With room.
static ewa_status run(const ewa_gather_request *request, ewa_gather_room *room, bool *any) {
    const ewa_surfels *surfels = request->surfels;
    ewa_context *context = surfels->context;
    const double bound = bound_of(request);
    const int exponent = bound > 0x1p-100 ? ilogb(bound) : -100;
    const size_t lanes = (size_t)surfels->packet_count * EWA_PACKET_LANES, sums = request->sums ? 3 * lanes : 0;
    const uint32_t pieces = (surfels->packet_count + PIECE_PACKETS - 1) / PIECE_PACKETS;
    if (request->colors) EWA_TRY(ewa_buffer_reserve(context, &room->colors, COLOR_FLOATS * lanes, sizeof(float)));
    if (sums) {
        EWA_TRY(ewa_buffer_reserve(context, &room->sums, sums, sizeof(int64_t)));
        EWA_TRY(ewa_buffer_reserve(context, &room->shared, surfels->packet_count, sizeof(uint8_t)));
        memset(room->sums.data, 0, sums * sizeof(int64_t));
    }
    const ewa_gather gather = {.rgba = request->rgba, .weights = request->weights, .filled = request->filled,
                               .minimum_alpha = request->minimum_alpha, .squares = request->squares, .shown = request->shown,
                               .units = ldexpf(1, EWA_GATHER_BITS - 1 - exponent),
                               .colors = request->colors ? room->colors.data : NULL,
                               .sums = sums ? room->sums.data : NULL,
                               .shared = sums ? room->shared.data : NULL};
    points_job points = {request, &gather, room->colors.data};
    if (request->colors) ewa_parallel(context, load_colors, &points, pieces);
    EWA_TRY(draw(request, &gather, room, any));
    if (sums) ewa_parallel(context, add_sums, &points, pieces);
    return EWA_OK;
}

ewa_status ewa_gather_run(const ewa_gather_request *request, bool *any) {
    ewa_context *context = request->surfels->context;
    const size_t pixels = (size_t)request->camera.width_px * request->camera.height_px;
    if (any) *any = false;
    if (request->shown) memset(request->shown, 0, 4 * pixels * sizeof *request->shown);
    if (request->surfels->packet_count == 0) return EWA_OK;
    ewa_gather_room own = {.state = NULL};
    const ewa_status status = run(request, request->room ? request->room : &own, any);
    ewa_gather_room_free(context, &own);
    return status;
}
