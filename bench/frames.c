// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Frames of one scene, measured in turns for all numbers of threads and instruction sets.
//
// Machines are noisy: what is compared is measured in turns (A B A B), and the lower quartile is what ratios
// are of.
#include "bench/frames.h"

#include "bench/competitor.h"

#include <stdlib.h>
#include <string.h>

enum { WARM_FRAMES = 2, MAX_WAYS = 6 };

/// A way of drawing that costs more or less than another.
typedef struct bench_way {
    const char *name;
    double opacity;
    uint32_t layers, edge_layers; ///< 0: the default, as the command line says
    bool without_edges, without_light;
} bench_way;

/// The first is what the command line says and what the others are compared with.
static const bench_way all_ways[MAX_WAYS] = {
    {.name = "opaque", .opacity = 1},
    {.name = "3 layers", .opacity = 0.5, .layers = 3},
    {.name = "exact", .opacity = 0.5, .layers = EWA_LAYERS_EXACT},
    {.name = "1 edge layer", .opacity = 1, .edge_layers = 1},
    {.name = "no edges", .opacity = 1, .without_edges = true},
    {.name = "no light", .opacity = 1, .without_light = true},
};

/// One context, what it draws with and how, what it measured.
typedef struct bench_lane {
    const bench_way *way; ///< NULL: as the command line says, the only one
    const bench_sets *sets;
    ewa_context *context;
    ewa_surfels *surfels;
    ewa_renderer *renderer;
    double total_s[BENCH_MAX_FRAMES];
    double stage_s[BENCH_FRAME_STAGES][BENCH_MAX_FRAMES]; // thread time
    ewa_render_stats last;
    bench_competitor competitor; ///< where it draws the same
    double competitor_s[BENCH_MAX_FRAMES];
} bench_lane;

ewa_status bench_borrow(ewa_context *context, const ewa_cloud *cloud, ewa_cloud **borrowed) {
    ewa_status status = ewa_cloud_create(context, ewa_cloud_point_count(cloud), borrowed);
    const ewa_attribute *attribute;
    for (uint32_t k = 0; status == EWA_OK && (attribute = ewa_cloud_attribute_at(cloud, k)); k++)
        status = ewa_cloud_borrow(*borrowed, attribute->name, attribute->type, attribute->component_count,
                                  attribute->data, attribute->stride_bytes);
    double origin_world[3];
    ewa_cloud_origin(cloud, origin_world);
    if (status == EWA_OK) ewa_cloud_set_origin(*borrowed, origin_world);
    return status;
}

static bool open_lane(cli_session *session, bench_lane *lane, const bench_sets *sets, uint32_t threads,
                      ewa_backend_kind backend, uint32_t level, const ewa_cloud *cloud) {
    lane->sets = sets;
    lane->context = session_context(session, threads, sets->mask);
    if (!lane->context) return false;
    ewa_cloud *borrowed = NULL;
    ewa_surfels_options surfels;
    ewa_surfels_options_init(&surfels, sizeof surfels);
    surfels.level_count = level + 1;
    ewa_status status = bench_borrow(lane->context, cloud, &borrowed);
    if (status == EWA_OK) status = ewa_surfels_create(borrowed, &surfels, &lane->surfels);
    if (status == EWA_OK) status = ewa_renderer_create_on(lane->context, backend, &lane->renderer);
    ewa_cloud_destroy(&borrowed);
    return session_passed(session, status);
}

static void close_lane(bench_lane *lane) {
    bench_competitor_drop(&lane->competitor);
    ewa_renderer_destroy(&lane->renderer);
    ewa_surfels_destroy(&lane->surfels);
    ewa_context_destroy(&lane->context);
}

/// Draws a frame; negative numbers warm up.
static bool draw_frame(cli_session *session, bench_lane *lane, const ewa_camera *camera,
                       const ewa_render_options *render, uint8_t *rgba8, int64_t frame) {
    const ewa_frame planes = {.rgba8 = rgba8};
    ewa_render_stats *last = &lane->last;
    ewa_render_options options = *render;
    if (lane->way) {
        options.opacity = lane->way->opacity;
        options.layers = lane->way->layers;
        if (lane->way->edge_layers) options.edge_layers = lane->way->edge_layers;
        if (lane->way->without_edges) options.edge_antialiasing = false;
        if (lane->way->without_light) options.shading = EWA_SHADING_NONE;
    }
    const double started_s = clock_now_s();
    const ewa_status status = ewa_render(lane->renderer, lane->surfels, camera, &options, &planes, last);
    const double took_s = clock_now_s() - started_s;
    if (!session_passed(session, status)) return false;
    double competitor_s = 0;
    if (lane->competitor.program && !bench_competitor_draw(session, &lane->competitor, &competitor_s))
        return false;
    if (frame < 0) return true;
    lane->total_s[frame] = took_s;
    lane->competitor_s[frame] = competitor_s;
    const double stages[BENCH_FRAME_STAGES] = {last->bin_s,        last->setup_s, last->visibility_s,
                                               last->accumulate_s, last->edge_s,  last->resolve_s};
    for (int k = 0; k < BENCH_FRAME_STAGES; k++) lane->stage_s[k][frame] = stages[k];
    return true;
}

static void report(const bench_plan *plan, const bench_scene *scene, uint32_t passes, bench_lane *lanes,
                   size_t lane_count, const bench_sink *sink) {
    const double clock_ghz = bench_clock_ghz();
    bench_frame_row rows[OPTION_VECTOR_MAX * BENCH_MAX_SETS * MAX_WAYS];
    for (size_t i = 0; i < lane_count; i++) {
        bench_lane *lane = &lanes[i];
        bench_frame_row *row = &rows[i];
        *row = (bench_frame_row){.scene = scene,
                                 .way = lane->way ? lane->way->name : NULL,
                                 .cpu = lane->sets->name,
                                 .threads = ewa_context_worker_count(lane->context),
                                 .total = bench_summarise(lane->total_s, plan->frame_count),
                                 .stats = lane->last,
                                 .passes = passes,
                                 .renderer.struct_size = sizeof row->renderer,
                                 .clock_ghz = clock_ghz};
        for (int k = 0; k < BENCH_FRAME_STAGES; k++)
            row->stage_s[k] = bench_summarise(lane->stage_s[k], plan->frame_count).median;
        ewa_surfels_describe(lane->surfels, &row->info);
        ewa_renderer_describe(lane->renderer, &row->renderer);
        if (lane->competitor.program) {
            row->competitor = lane->competitor.name;
            row->competitor_total = bench_summarise(lane->competitor_s, plan->frame_count);
        }
    }
    for (size_t i = 0; i < lane_count; i++) {
        for (size_t k = 0; k < lane_count; k++) {
            if (lanes[k].way != lanes[i].way) {
                if (lanes[k].way == all_ways && rows[k].cpu == rows[i].cpu &&
                    rows[k].threads == rows[i].threads)
                    rows[i].first_way_s = rows[k].total.quartile;
                continue;
            }
            if (rows[k].cpu == rows[i].cpu && rows[k].threads == 1 && rows[i].threads > 1)
                rows[i].one_thread_s = rows[k].total.quartile;
            if (rows[k].cpu == plan->sets[0].name && rows[i].cpu != rows[k].cpu &&
                rows[k].threads == rows[i].threads)
                rows[i].all_sets_s = rows[k].total.quartile;
        }
        bench_report_frames(sink, &rows[i]);
    }
}

bool bench_frames(cli_session *session, const bench_plan *plan, const bench_scene *scene,
                  const ewa_render_options *render, uint8_t *rgba8, const bench_sink *sink) {
    const size_t way_count = scene->in_all_ways ? MAX_WAYS : 1;
    const size_t lane_count = way_count * plan->thread_counts * plan->set_count;
    bench_lane *lanes = calloc(lane_count, sizeof *lanes);
    bool done = lanes != NULL;
    if (!done) session_fail(session, "out of memory for %zu measurements", lane_count);
    for (size_t i = 0; done && i < lane_count; i++) {
        const size_t count = i / way_count;
        if (scene->in_all_ways) lanes[i].way = &all_ways[i % way_count];
        done =
            open_lane(session, &lanes[i], &plan->sets[count / plan->thread_counts],
                      plan->threads[count % plan->thread_counts], plan->backend, render->level, scene->cloud);
        if (done && plan->against && count < plan->thread_counts && i % way_count == 0)
            done = bench_competitor_start(session, plan->against, scene, plan->threads[count],
                                          &lanes[i].competitor);
    }
    ewa_render_options options = *render;
    options.cull = scene->cull;
    options.supersampling = 1; // rows are of splats of a size, and the programs beside them divide no pixels
    if (scene->color_only) options.shading = EWA_SHADING_NONE;
    if (scene->glossy) {
        options.shading = EWA_SHADING_PHONG;
        static const double direction[3] = {0.3, -0.2, 1};
        options.light_count = 1;
        ewa_light_init(&options.lights[0]);
        memcpy(options.lights[0].direction_world, direction, sizeof direction);
    }
    for (int64_t frame = -WARM_FRAMES; done && frame < (int64_t)plan->frame_count; frame++)
        for (size_t i = 0; done && i < lane_count; i++)
            done = draw_frame(session, &lanes[i], &scene->camera, &options, rgba8, frame);
    for (size_t i = 0; done && i < lane_count; i++)
        if (lanes[i].competitor.program) done = bench_competitor_end(session, &lanes[i].competitor);
    if (done) report(plan, scene, render->passes, lanes, lane_count, sink);
    for (size_t i = 0; lanes && i < lane_count; i++) close_lane(&lanes[i]);
    free(lanes);
    return done;
}
