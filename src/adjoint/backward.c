// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa_render_backward(): its arguments, and which way it takes: colours alone go back through the pipeline that draws,
// all else through the derivative in double precision.
#include "adjoint/tiles.h"
#include "base/base.h"
#include "cloud/cloud.h"
#include "surface/gather.h"
#include "surface/options.h"
#include "surface/packets.h"
#include "surface/proxy.h"

#include <string.h>

/// Fails at the first number of a plane that is not finite.
static ewa_status check_plane(ewa_context *context, const char *name, const float *plane, uint32_t components,
                              const ewa_camera *camera) {
    const size_t count = (size_t)camera->width_px * camera->height_px * components;
    for (size_t i = 0; i < count && plane; i++) {
        if (isfinite(plane[i])) continue;
        const size_t pixel = i / components;
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "gradients: number %u of the %s cotangent at pixel (%u, %u) is %g",
                        (unsigned)(i % components), name, (unsigned)(pixel % camera->width_px),
                        (unsigned)(pixel / camera->width_px), (double)plane[i]);
    }
    return EWA_OK;
}

static ewa_status check_cotangent(ewa_context *context, const ewa_frame_cotangent *cotangent,
                                  const ewa_camera *camera) {
    EWA_TRY(check_plane(context, "rgba", cotangent->rgba, 4, camera));
    EWA_TRY(check_plane(context, "depth", cotangent->depth, 1, camera));
    EWA_TRY(check_plane(context, "normal", cotangent->normal, 3, camera));
    return check_plane(context, "coverage", cotangent->coverage, 1, camera);
}

/// Whether more is wanted than colours and the picture.
static bool wants_more(const ewa_gradient *gradient) {
    return gradient->opacity || gradient->position || gradient->normal || gradient->radius || gradient->tangent_u ||
           gradient->tangent_v || gradient->camera;
}

ewa_status ewa_adjoint_backward(const ewa_cloud *cloud, const ewa_surfels_options *surfels_options,
                                double unit_coverage, const ewa_camera *camera, const ewa_render_options *options,
                                const ewa_frame_cotangent *cotangent, const ewa_gradient *gradient, uint32_t tile_px) {
    if (!cloud) return EWA_ERROR_ARGUMENT;
    ewa_context *context = ewa_cloud_context(cloud);
    if (!camera || !gradient)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "gradients: no %s", camera ? "gradient" : "camera");
    if (unit_coverage == 0) EWA_TRY(ewa_surfels_measure_unit_coverage(cloud, surfels_options, &unit_coverage));
    ewa_adjoint_job job = {.gradient = *gradient};
    EWA_TRY(ewa_reference_frame_make(cloud, surfels_options, unit_coverage, camera, options, &job.frame));
    if (job.frame.point_count > UINT32_MAX - EWA_BIN_ALIGNMENT)
        return ewa_fail(context, EWA_ERROR_LIMIT, "gradients: %llu points are more than there may be, %u",
                        (unsigned long long)job.frame.point_count, UINT32_MAX - EWA_BIN_ALIGNMENT);
    if (cotangent) {
        EWA_TRY(check_cotangent(context, cotangent, camera));
        job.cotangent = *cotangent;
    }
    job.width = wants_more(gradient) ? (job.cotangent.depth ? EWA_MOMENT_COUNT : EWA_MOMENT_DEPTH) : gradient->color ? 3 : 0;
    job.tiles = ewa_tiles_make(camera->width_px, camera->height_px, tile_px);
    return ewa_adjoint_run(&job);
}

/// Whether the pipeline goes back: from the picture that it draws, to its colours alone.
static bool goes_by_pipeline(const ewa_gradient *gradient, const ewa_reference_frame *frame) {
    return gradient->color && !wants_more(gradient) && !gradient->rgba &&
           ewa_gather_takes(&frame->options, &frame->shading);
}

/// By the pipeline, with the surfels that it draws.
static ewa_status gather_colors(const ewa_cloud *cloud, const ewa_surfels_options *surfels_options,
                                double unit_coverage, const ewa_camera *camera, const ewa_render_options *options,
                                const float *rgba, double *color) {
    ewa_context *context = ewa_cloud_context(cloud);
    ewa_surfels_options chosen;
    EWA_TRY(ewa_surfels_options_choose(context, surfels_options, &chosen));
    chosen.level_count = 1;
    ewa_surfels *surfels = NULL;
    EWA_TRY(ewa_surfels_create_kept(cloud, &chosen, &surfels));
    ewa_status status = unit_coverage == 0 ? EWA_OK : ewa_surfels_set_unit_coverage(surfels, unit_coverage);
    bool any = false;
    const ewa_gather_request request = {.surfels = surfels, .point_count = ewa_cloud_point_count(cloud),
                                        .camera = *camera, .options = *options, .rgba = rgba, .sums = color};
    memset(color, 0, request.point_count * 3 * sizeof *color);
    if (status == EWA_OK) status = ewa_gather_run(&request, &any);
    ewa_surfels_destroy(&surfels);
    if (status == EWA_OK && !any)
        ewa_adjoint_warn_unseen(context, ewa_cloud_point_count(cloud), camera->width_px, camera->height_px);
    return status;
}

ewa_status ewa_render_backward(const ewa_cloud *cloud, const ewa_surfels_options *surfels_options,
                               double unit_coverage, const ewa_camera *camera, const ewa_render_options *options,
                               const ewa_frame_cotangent *cotangent, const ewa_gradient *gradient) {
    if (cloud && camera && gradient && cotangent && cotangent->rgba) {
        ewa_reference_frame frame;
        // Whatever is wrong with the arguments is told by the same words on both roads.
        EWA_TRY(ewa_reference_frame_make(cloud, surfels_options, unit_coverage == 0 ? 1 : unit_coverage, camera,
                                         options, &frame));
        EWA_TRY(check_cotangent(frame.context, cotangent, camera));
        if (goes_by_pipeline(gradient, &frame))
            return gather_colors(cloud, surfels_options, unit_coverage, camera, &frame.options, cotangent->rgba,
                                 gradient->color);
    }
    return ewa_adjoint_backward(cloud, surfels_options, unit_coverage, camera, options, cotangent, gradient,
                                EWA_ADJOINT_TILE_PX);
}
