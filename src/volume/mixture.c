// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Mixtures: what is checked, and how many frames a picture takes. Opaque ellipsoids and dots become a part of the surfaces first;
// normals are drawn as colours are, in a frame of their own.
#include "base/base.h"
#include "volume/gaussian_frame.h"
#include "volume/gaussian_view.h"
#include "volume/options.h"

#include <math.h>
#include <string.h>

/// Of dots: the smallest cutoff there is, so that each is listed where its dot shows.
enum { DOT_CUTOFF = 1 };

/// What is less is no alpha.
#define MIN_ALPHA 1e-6

/// A shorter mean of normals is rounding.
static const double MIN_NORMAL = 1e-5;

/// Checks what a mixture is made of, and its volumes' options.
static ewa_status check_mixture(ewa_context *context, const ewa_mixture *mixture,
                                ewa_volume_options chosen[EWA_MAX_MIXED_VOLUMES]) {
    const uint32_t count = mixture->volume_count;
    if (count > EWA_MAX_MIXED_VOLUMES)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "mixture: %u volumes, at most %d", count,
                        EWA_MAX_MIXED_VOLUMES);
    if ((count && !mixture->volumes) || (mixture->splats_count && !mixture->splats))
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "mixture: %u sets and %u volumes, and no list of them",
                        mixture->splats_count, count);
    for (uint32_t i = 0; i < mixture->splats_count; i++)
        if (!mixture->splats[i]) return ewa_fail(context, EWA_ERROR_ARGUMENT, "mixture: set %u is NULL", i);
    for (uint32_t i = 0; i < count; i++) {
        const ewa_mixed_volume *volume = &mixture->volumes[i];
        if (!volume->renderer || !volume->voxels)
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "mixture: volume %u has no renderer or no voxels",
                            i);
        if (ewa_volume_renderer_context(volume->renderer) != context)
            return ewa_fail(context, EWA_ERROR_ARGUMENT,
                            "mixture: the renderer of volume %u is of another context", i);
        for (uint32_t k = 0; k < i; k++)
            if (mixture->volumes[k].renderer == volume->renderer)
                return ewa_fail(context, EWA_ERROR_ARGUMENT,
                                "mixture: volumes %u and %u have the same renderer", k, i);
        EWA_TRY(ewa_volume_options_choose(context, volume->options, &chosen[i]));
        EWA_TRY(ewa_volume_level_check(context, volume->voxels, &chosen[i]));
    }
    return EWA_OK;
}

/// Sets up the frames of the volumes.
static ewa_status make_volumes(ewa_gaussian_job *job, const ewa_camera *camera,
                               const ewa_gaussian_options *options,
                               ewa_volume_options chosen[EWA_MAX_MIXED_VOLUMES]) {
    const uint32_t count = job->mixture->volume_count;
    ewa_buffer *room = &job->renderer->volumes;
    ewa_status status = ewa_buffer_reserve(job->renderer->context, room, count, sizeof(ewa_volume_frame));
    job->volumes = room->data;
    for (uint32_t i = 0; i < count && status == EWA_OK; i++) {
        const ewa_mixed_volume *volume = &job->mixture->volumes[i];
        chosen[i].surface_depth = options->surface_depth;
        chosen[i].surface_rgba = options->surface_rgba;
        memcpy(chosen[i].section_planes, options->section_planes, sizeof options->section_planes);
        chosen[i].section_count = options->section_count;
        status = ewa_volume_frame_make(volume->renderer, volume->voxels, camera, &chosen[i],
                                       volume->stats != NULL, &job->volumes[i]);
        if (status == EWA_OK) status = ewa_volume_frame_reserve(volume->renderer, &job->volumes[i]);
        job->volumes[i].job.target = job->target;
    }
    return status;
}

/// Draws one frame.
static ewa_status draw_frame(ewa_gaussian_job *job, const ewa_camera *camera, const ewa_gaussian_options *options,
                             const ewa_frame *frame, ewa_volume_options volumes[EWA_MAX_MIXED_VOLUMES], ewa_gaussian_stats *stats) {
    const ewa_surface_planes surface = EWA_SURFACE_PLANES_OF(options);
    job->tiles = ewa_tiles_make(camera->width_px, camera->height_px, EWA_GAUSSIAN_TILE_PX);
    job->areas = job->mixture->volume_count ? ewa_tiles_make(camera->width_px, camera->height_px, EWA_VOLUME_TILE_PX) : job->tiles;
    job->with_times = stats != NULL;
    ewa_volume_target_set(&job->target, camera, frame, &surface, options->background);
    ewa_ray_sections_make(&job->sections, camera, (const double(*)[4])options->section_planes, options->section_count);
    EWA_TRY(ewa_gaussian_job_set_views(job, camera, options, frame->depth || frame->normal));
    EWA_TRY(make_volumes(job, camera, options, volumes));
    return ewa_gaussian_job_draw(job, options->merge_px, stats);
}

/// Draws the sets of a mixture as opaque surfaces, which become those of the options.
static ewa_status draw_solids(ewa_gaussian_job *job, const ewa_camera *camera, ewa_gaussian_options *options,
                              ewa_gaussian_stats *stats) {
    enum { FLOATS = 9 }; // rgba, depth, normal, coverage
    ewa_gaussian_renderer *renderer = job->renderer;
    const size_t pixels = (size_t)camera->width_px * camera->height_px;
    EWA_TRY(ewa_buffer_reserve(renderer->context, &renderer->planes, pixels, FLOATS * sizeof(float)));
    float *rgba = renderer->planes.data;
    const bool dots = options->display == EWA_DISPLAY_POINTS;
    const ewa_gaussian_solids solids = {.view = &job->view,
                                        .dots = dots,
                                        .radius = (float)(dots ? options->dot_px / 2 : options->ellipsoid_radius),
                                        .log2_min = (float)log2(options->minimum_alpha),
                                        .width_px = camera->width_px,
                                        .rgba = rgba,
                                        .depth = rgba + 4 * pixels,
                                        .normal = rgba + 5 * pixels,
                                        .coverage = rgba + 8 * pixels};
    memset(rgba, 0, FLOATS * pixels * sizeof *rgba);
    for (size_t i = 0; i < pixels; i++)
        solids.depth[i] = options->surface_depth ? options->surface_depth[i] : INFINITY;
    if (options->surface_rgba) memcpy(rgba, options->surface_rgba, 4 * pixels * sizeof *rgba);
    if (options->surface_normal) memcpy(solids.normal, options->surface_normal, 3 * pixels * sizeof *rgba);
    for (size_t i = 0; i < pixels; i++)
        solids.coverage[i] = options->surface_coverage ? options->surface_coverage[i] : rgba[4 * i + 3];
    // Records as they are without a filter, and with room for a dot.
    ewa_gaussian_options bare = *options;
    bare.surface_depth = bare.surface_rgba = bare.surface_normal = bare.surface_coverage = NULL;
    bare.projection = dots ? EWA_PROJECTION_TRAINED : EWA_PROJECTION_EXACT;
    bare.order = EWA_ORDER_CENTER;
    bare.filter = EWA_FILTER_THICKEN;
    bare.prefilter_px2 = dots ? options->dot_px * options->dot_px / 4 : 0;
    bare.cutoff = dots ? DOT_CUTOFF : options->ellipsoid_radius;
    bare.minimum_alpha = MIN_ALPHA;
    job->solids = &solids;
    const ewa_status status = draw_frame(job, camera, &bare, &(ewa_frame){.rgba = NULL}, NULL, stats);
    job->solids = NULL;
    options->surface_depth = solids.depth;
    options->surface_rgba = solids.rgba;
    options->surface_normal = solids.normal;
    options->surface_coverage = solids.coverage;
    return status;
}

/// Planes of normals in the renderer's memory, floats for each pixel.
enum { NORMAL_FLOATS = 11 };

/// Draws the normals of a mixture that has sets over those of the surfaces, which the frame has already with its `depth`.
static ewa_status draw_normals(const ewa_gaussian_job *drawn, const ewa_camera *camera, const ewa_gaussian_options *options,
                               ewa_volume_options volumes[EWA_MAX_MIXED_VOLUMES], const float *depth, float *normal) {
    const size_t pixels = (size_t)camera->width_px * camera->height_px;
    float *mixed = drawn->renderer->planes.data, *under = mixed + 4 * pixels, *nothing = under + 4 * pixels, *opacity = nothing + pixels;
    const bool expected = options->depth == EWA_DEPTH_EXPECTED;
    ewa_gaussian_options encoded = *options;
    memset(under, 0, 5 * pixels * sizeof *under);
    memset(encoded.background, 0, sizeof encoded.background);
    for (size_t i = 0; i < pixels && options->surface_rgba; i++) {
        under[4 * i + 3] = options->surface_rgba[4 * i + 3];
        for (size_t c = 0; c < 3; c++) {
            const float own = expected && options->surface_normal ? options->surface_normal[3 * i + c] : 0;
            under[4 * i + c] = under[4 * i + 3] * (0.5f + 0.5f * own);
        }
    }
    if (options->surface_rgba) encoded.surface_rgba = under, encoded.surface_coverage = nothing;
    ewa_gaussian_job job = {.renderer = drawn->renderer, .mixture = drawn->mixture, .colors = drawn->colors, .view.normals = true};
    EWA_TRY(draw_frame(&job, camera, &encoded, &(ewa_frame){.rgba = mixed, .coverage = opacity}, volumes, NULL));
    for (size_t i = 0; i < pixels; i++) {
        // What a surface gave the depth of has its normal, to the byte.
        if (opacity[i] <= 0 || (!expected && options->surface_depth && depth[i] == options->surface_depth[i] && depth[i] < INFINITY))
            continue;
        double sum[3], squares = 0;
        for (size_t c = 0; c < 3; c++) {
            sum[c] = 2 * (double)mixed[4 * i + c] - (double)mixed[4 * i + 3];
            squares += sum[c] * sum[c];
        }
        const double size = sqrt(squares);
        for (size_t c = 0; c < 3; c++) normal[3 * i + c] = size > MIN_NORMAL ? (float)(sum[c] / size) : 0;
    }
    return EWA_OK;
}

ewa_status ewa_mixture_draw(ewa_gaussian_renderer *renderer, const ewa_mixture *mixture, const ewa_splat_colors *const *colors,
                            const ewa_camera *camera, const ewa_gaussian_options *options, const ewa_frame *frame,
                            ewa_gaussian_stats *stats) {
    if (!renderer || !mixture || !camera || !frame) return EWA_ERROR_ARGUMENT;
    ewa_context *context = renderer->context;
    const double start_s = ewa_now_s();
    ewa_gaussian_options chosen;
    ewa_volume_options volumes[EWA_MAX_MIXED_VOLUMES];
    EWA_TRY(ewa_gaussian_options_choose(context, options, &chosen));
    EWA_TRY(ewa_camera_check(context, camera));
    EWA_TRY(check_mixture(context, mixture, volumes));
    EWA_TRY(ewa_progress(context, "gaussians", 0));

    ewa_mixture sets = *mixture, rest = *mixture;
    ewa_gaussian_job job = {.renderer = renderer, .mixture = mixture, .colors = colors};
    const bool solid = chosen.display != EWA_DISPLAY_BLENDED && mixture->splats_count;
    if (solid) {
        sets.volume_count = 0, rest.splats_count = 0;
        job.mixture = &sets;
        EWA_TRY(draw_solids(&job, camera, &chosen, stats));
        job = (ewa_gaussian_job){.renderer = renderer, .mixture = &rest};
    }
    ewa_frame planes = *frame;
    const bool normals = frame->normal && job.mixture->splats_count;
    const size_t pixels = (size_t)camera->width_px * camera->height_px;
    if (normals) EWA_TRY(ewa_buffer_reserve(context, &renderer->planes, pixels, NORMAL_FLOATS * sizeof(float)));
    if (normals && !frame->depth) planes.depth = (float *)renderer->planes.data + 10 * pixels;
    EWA_TRY(draw_frame(&job, camera, &chosen, &planes, volumes, solid ? NULL : stats));
    if (normals) EWA_TRY(draw_normals(&job, camera, &chosen, volumes, planes.depth, frame->normal));
    if (stats) stats->total_s = ewa_now_s() - start_s;
    return EWA_OK;
}

ewa_status ewa_mixture_render(ewa_gaussian_renderer *renderer, const ewa_mixture *mixture, const ewa_camera *camera,
                              const ewa_gaussian_options *options, const ewa_frame *frame, ewa_gaussian_stats *stats) {
    return ewa_mixture_draw(renderer, mixture, NULL, camera, options, frame, stats);
}

ewa_status ewa_gaussian_render(ewa_gaussian_renderer *renderer, const ewa_splats *splats,
                               const ewa_camera *camera, const ewa_gaussian_options *options,
                               const ewa_frame *frame, ewa_gaussian_stats *stats) {
    if (!splats) return EWA_ERROR_ARGUMENT;
    return ewa_mixture_render(renderer, &(ewa_mixture){.splats = &splats, .splats_count = 1}, camera, options,
                              frame, stats);
}
