// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Eye-dome lighting as a pass over the finished picture: where it comes from, and its memory.
#include "surface/eye_dome.h"
#include "surface/semantics.h"

#include <string.h>

/// Sets the pass up from `drawn`'s depth and rgba, which is over nothing, to the colours of `frame`; takes room for
/// keys.
static ewa_status set_dome(ewa_context *context, ewa_eye_dome_pass *pass, const ewa_camera *camera,
                           double strength, const float background[4], const ewa_frame *drawn,
                           const ewa_frame *frame) {
    static const double LOG2_E = 1.44269504088896341;
    const size_t width = camera->width_px, height = camera->height_px;
    const size_t key_stride =
        (width + 2 * EWA_EYE_DOME_REACH + 2 * (EWA_BLOCK_LANES - 1)) / EWA_BLOCK_LANES * EWA_BLOCK_LANES;
    EWA_TRY(ewa_buffer_reserve(context, &pass->keys, (height + 2 * EWA_EYE_DOME_REACH) * key_stride,
                               sizeof(float)));
    pass->eye_dome = (ewa_eye_dome){
        .width_px = camera->width_px,
        .height_px = camera->height_px,
        .orthographic = camera->projection == EWA_ORTHOGRAPHIC,
        .inverse_height = (float)(camera->fy_px / camera->height_px),
        .exponent = (float)(-LOG2_E * EWA_EYE_DOME_GAIN * strength / EWA_EYE_DOME_PAIRS),
        .depth = drawn->depth,
        .surfaces = drawn->rgba,
        .keys = pass->keys.data,
        .key_stride = key_stride,
        .rgba8 = frame->rgba8,
        .rgba = frame->rgba,
    };
    for (int c = 0; c < 4; c++)
        pass->eye_dome.background[c] = c < 3 ? background[c] * background[3] : background[3];
    return EWA_OK;
}

ewa_status ewa_eye_dome_pass_start(ewa_context *context, ewa_eye_dome_pass *pass, const ewa_camera *camera,
                                   const ewa_frame *frame, ewa_render_options *options, ewa_frame *drawn) {
    const size_t pixel_count = (size_t)camera->width_px * camera->height_px;
    if (!frame->depth) EWA_TRY(ewa_buffer_reserve(context, &pass->depth, pixel_count, sizeof(float)));
    if (!frame->rgba) EWA_TRY(ewa_buffer_reserve(context, &pass->surfaces, 4 * pixel_count, sizeof(float)));
    *drawn = *frame;
    drawn->rgba8 = NULL;
    if (!drawn->depth) drawn->depth = pass->depth.data;
    if (!drawn->rgba) drawn->rgba = pass->surfaces.data;
    ewa_status status = set_dome(context, pass, camera, options->eye_dome, options->background, drawn, frame);
    memset(options->background, 0, sizeof options->background);
    return status;
}

static void fill_keys(void *data, uint32_t row, uint32_t worker) {
    (void)worker;
    const ewa_eye_dome_pass *pass = data;
    pass->kernels->eye_dome_keys(&pass->eye_dome, row);
}

static void shade_row(void *data, uint32_t row, uint32_t worker) {
    (void)worker;
    const ewa_eye_dome_pass *pass = data;
    pass->kernels->eye_dome_shade(&pass->eye_dome, row);
}

void ewa_eye_dome_pass_finish(ewa_context *context, ewa_eye_dome_pass *pass) {
    ewa_parallel(context, fill_keys, pass, pass->eye_dome.height_px + 2 * EWA_EYE_DOME_REACH);
    ewa_parallel(context, shade_row, pass, pass->eye_dome.height_px);
}

void ewa_eye_dome_pass_free(ewa_context *context, ewa_eye_dome_pass *pass) {
    ewa_buffer_free(context, &pass->keys);
    ewa_buffer_free(context, &pass->depth);
    ewa_buffer_free(context, &pass->surfaces);
}

ewa_status ewa_eye_dome_apply(ewa_context *context, const ewa_camera *camera, double strength,
                              const float background[4], const ewa_frame *frame) {
    ewa_eye_dome_pass pass = {.kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_pipeline_kernels)};
    const ewa_status status = set_dome(context, &pass, camera, strength, background, frame, frame);
    if (status == EWA_OK) ewa_eye_dome_pass_finish(context, &pass);
    ewa_eye_dome_pass_free(context, &pass);
    return status;
}
