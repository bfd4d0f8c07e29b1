// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which frames have a derivative, and their splats.
#include "reference/adjoint_frame.h"
#include "base/base.h"
#include "cloud/cloud.h"
#include "reference/contour.h"
#include "surface/options.h"

enum { READ_POINTS = 64 };

/// Says what of the options has no derivative.
static ewa_status check_options(ewa_context *context, const ewa_render_options *options) {
    static const char *const kernels[] = {"perspective", "affine", "source", "circular", "raycast"};
    if (options->kernel != EWA_KERNEL_PERSPECTIVE && options->kernel != EWA_KERNEL_AFFINE)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED,
                        "gradients: kernel is %s, and only perspective and affine have a derivative here",
                        kernels[options->kernel]);
    if (options->passes != 3)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "gradients: passes is %u, must be 3", options->passes);
    if (options->point_size_px > 0)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "gradients: point_size_px is %g, must be 0",
                        options->point_size_px);
    if (options->shading == EWA_SHADING_PHONG)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "gradients: shading is phong, must be none or lambert");
    if (options->eye_dome > 0)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "gradients: eye_dome is %g, must be 0", options->eye_dome);
    if (options->supersampling > 1)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "gradients: supersampling is %u, must be 1, which 0 counts as",
                        options->supersampling);
    if (options->level > 0 || options->budget_s > 0)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "gradients: level is %u and budget_s %g, must be 0",
                        options->level, options->budget_s);
    return EWA_OK;
}

ewa_status ewa_reference_frame_make(const ewa_cloud *cloud, const ewa_surfels_options *surfels_options,
                                    double unit_coverage, const ewa_camera *camera, const ewa_render_options *options,
                                    ewa_reference_frame *frame) {
    ewa_context *context = ewa_cloud_context(cloud);
    *frame = (ewa_reference_frame){.context = context, .point_count = ewa_cloud_point_count(cloud)};
    if (!(unit_coverage > 0) || !isfinite(unit_coverage))
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "gradients: unit_coverage is %g, must be positive", unit_coverage);
    ewa_surfels_options chosen;
    EWA_TRY(ewa_surfels_options_choose(context, surfels_options, &chosen));
    EWA_TRY(ewa_render_options_choose(context, options, &frame->options));
    EWA_TRY(check_options(context, &frame->options));
    EWA_TRY(ewa_camera_check(context, camera));
    EWA_TRY(ewa_surfel_reader_open(cloud, &chosen, &frame->reader));
    ewa_reference_view_make(camera, chosen.cutoff, &frame->options, &frame->view);
    ewa_bounds box;
    ewa_position_measure(context, frame->reader.position, frame->point_count, &box);
    ewa_reference_view_place(camera, frame->reader.origin_world, &box, &frame->view);
    ewa_shading_setup_make(&frame->options, &frame->shading);
    frame->resolve = (ewa_reference_resolve){
        &frame->view, &frame->options, &frame->shading, unit_coverage,
        ewa_reference_layering_of(&frame->options, &frame->reader, frame->point_count)};
    ewa_reference_view_contours(&frame->options, frame->resolve.layering.transparent, &frame->view);
    return EWA_OK;
}

void ewa_reference_frame_project(const ewa_reference_frame *frame, uint64_t first, uint64_t count, ewa_surfel *surfels,
                                 ewa_reference_splat *splats) {
    bool drawable[READ_POINTS];
    for (uint64_t done = 0; done < count; done += READ_POINTS) {
        const uint64_t here = count - done < READ_POINTS ? count - done : READ_POINTS;
        ewa_surfel_read(&frame->reader, first + done, here, surfels + done, drawable);
        for (uint64_t i = 0; i < here; i++) {
            splats[done + i].drawn = false;
            if (drawable[i]) ewa_reference_project(&frame->view, &surfels[done + i], &splats[done + i]);
        }
    }
}

bool ewa_reference_fragment_make(const ewa_reference_frame *frame, const ewa_reference_splat *splat, uint64_t index,
                                 double x_px, double y_px, ewa_reference_fragment *fragment) {
    *fragment = (ewa_reference_fragment){.splat = splat, .index = index, .layer = EWA_NO_LAYER};
    const double F = frame->view.cutoff;
    return ewa_reference_sample_at(&frame->view, splat, x_px, y_px, &fragment->sample) &&
           fragment->sample.distance2 < F * F;
}
