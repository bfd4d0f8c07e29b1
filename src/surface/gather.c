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
    if (options->supersampling != 1) return false;
    if (options->eye_dome > 0 || options->level > 0 || options->budget_s > 0 || shading->highlights) return false;
    if (!shading->lit) return true;
    const double *color = shading->lights[0].color;
    return shading->light_count == 1 && color[0] == 1 && color[1] == 1 && color[2] == 1;
}

/// The largest of some numbers; of every fourth but the last ones, if there are four to a pixel.
static double largest_of(const float *numbers, size_t pixel_count, size_t stride) {
    float largest = 0;
    for (size_t i = 0; i < pixel_count * stride; i++)
        if (i % stride < 3) largest = fmaxf(largest, fabsf(numbers[i]));
    return (double)largest;
}

/// What no term of the sums is larger than.
static double bound_of(const ewa_gather_request *request) {
    const size_t pixels = (size_t)request->camera.width_px * request->camera.height_px;
    if (request->rgba) return largest_of(request->rgba, pixels, 4);
    const double weight = request->weights ? largest_of(request->weights, pixels, 1) : 1;
    double color = request->colors ? 0 : 1;
    for (uint64_t i = 0; i < 3 * request->point_count && request->colors; i++)
        color = fmax(color, fabs(request->colors[i]));
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

static void store_sums(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const points_job *job = data;
    const ewa_surfels *surfels = job->request->surfels;
    const double unit = 1 / (double)job->gather->units;
    const size_t first = (size_t)part * PIECE_PACKETS * EWA_PACKET_LANES,
                 all = (size_t)surfels->packet_count * EWA_PACKET_LANES;
    for (size_t i = first; i < first + PIECE_PACKETS * EWA_PACKET_LANES && i < all; i++)
        for (size_t c = 0; c < 3 && surfels->points[i] != EWA_NO_POINT; c++)
            job->request->sums[3 * (size_t)surfels->points[i] + c] = (double)job->gather->sums[3 * i + c] * unit;
}

/// Goes back once.
static ewa_status draw(const ewa_gather_request *request, const ewa_gather *gather, bool *any) {
    ewa_context *context = request->surfels->context;
    const ewa_frame_source source = {request->surfels, 1, true};
    ewa_render_job job = {.camera = request->camera, .options = request->options, .sources = &source,
                          .source_count = 1, .tile_px = request->tile_px, .gather = gather,
                          .end_row_px = request->camera.height_px};
    ewa_shading_setup_make(&job.options, &job.shading);
    void *state;
    EWA_TRY(ewa_backend_cpu.create(context, &state));
    ewa_render_stats stats;
    const ewa_status status = ewa_backend_cpu.draw(state, &job, &stats);
    ewa_backend_cpu.destroy(context, state);
    if (status == EWA_OK && any) *any = stats.culled_count < stats.splat_count;
    return status;
}

/// With memory for the surfels.
static ewa_status run(const ewa_gather_request *request, ewa_gather *gather, float *colors, bool *any) {
    const ewa_surfels *surfels = request->surfels;
    const uint32_t pieces = (surfels->packet_count + PIECE_PACKETS - 1) / PIECE_PACKETS;
    points_job points = {request, gather, colors};
    if (colors) ewa_parallel(surfels->context, load_colors, &points, pieces);
    EWA_TRY(draw(request, gather, any));
    if (request->sums) ewa_parallel(surfels->context, store_sums, &points, pieces);
    return EWA_OK;
}

ewa_status ewa_gather_run(const ewa_gather_request *request, bool *any) {
    const ewa_surfels *surfels = request->surfels;
    ewa_context *context = surfels->context;
    const size_t pixels = (size_t)request->camera.width_px * request->camera.height_px;
    if (any) *any = false;
    if (request->sums) memset(request->sums, 0, request->point_count * 3 * sizeof *request->sums);
    if (request->shown) memset(request->shown, 0, 4 * pixels * sizeof *request->shown);
    if (surfels->packet_count == 0) return EWA_OK;
    const double bound = bound_of(request);
    const int exponent = bound > 0x1p-100 ? ilogb(bound) : -100;
    const size_t lanes = (size_t)surfels->packet_count * EWA_PACKET_LANES,
                 sums = request->sums ? 3 * lanes : 0, color_floats = request->colors ? COLOR_FLOATS * lanes : 0,
                 packets = request->sums ? surfels->packet_count : 0;
    ewa_gather gather = {.rgba = request->rgba, .weights = request->weights, .filled = request->filled,
                         .least_alpha = request->least_alpha, .squares = request->squares, .shown = request->shown,
                         .units = ldexpf(1, EWA_GATHER_BITS - 1 - exponent)};
    float *colors = color_floats ? ewa_allocate_zeroed(context, color_floats, sizeof *colors) : NULL;
    gather.colors = colors;
    gather.sums = sums ? ewa_allocate_zeroed(context, sums, sizeof *gather.sums) : NULL;
    gather.shared = sums ? ewa_allocate(context, packets, sizeof *gather.shared) : NULL;
    ewa_status status = EWA_OK;
    if ((color_floats && !colors) || (sums && (!gather.sums || !gather.shared))) status = EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = run(request, &gather, colors, any);
    ewa_release(context, colors, color_floats, sizeof *colors);
    ewa_release(context, gather.sums, sums, sizeof *gather.sums);
    ewa_release(context, gather.shared, packets, sizeof *gather.shared);
    return status;
}
