// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa_render_backward(): its arguments.
#include "adjoint/tiles.h"
#include "base/base.h"
#include "cloud/cloud.h"
#include "surface/proxy.h"

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
    const bool others = gradient->opacity || gradient->position || gradient->normal || gradient->radius ||
                        gradient->tangent_u || gradient->tangent_v || gradient->camera;
    job.width = others ? EWA_MOMENT_COUNT : gradient->color ? 3 : 0;
    job.tiles = ewa_tiles_make(camera->width_px, camera->height_px, tile_px);
    return ewa_adjoint_run(&job);
}

ewa_status ewa_render_backward(const ewa_cloud *cloud, const ewa_surfels_options *surfels_options,
                               double unit_coverage, const ewa_camera *camera, const ewa_render_options *options,
                               const ewa_frame_cotangent *cotangent, const ewa_gradient *gradient) {
    return ewa_adjoint_backward(cloud, surfels_options, unit_coverage, camera, options, cotangent, gradient,
                                EWA_ADJOINT_TILE_PX);
}
