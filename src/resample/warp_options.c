// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Checked options and images of warping.
#include "resample/warp_options.h"
#include "base/base.h"

#include <math.h>
#include <string.h>

/// Limits of z: squares and cubes of what is within are floats.
static const double LEAST_DEPTH = 1e-9, MOST_DEPTH = 1e12;

/// Limit of focal lengths, principal points and scales, and the inverse of the least one.
static const double MOST_CAMERA = 1e6;

void ewa_depth_image_init(ewa_depth_image *image, size_t struct_size) {
    if (!image || struct_size < sizeof *image) return;
    memset(image, 0, struct_size);
    image->struct_size = struct_size;
    ewa_camera_init(&image->camera, sizeof image->camera);
    image->depth_scale = 1;
    image->color_channel_count = 3;
    image->color_type = EWA_U8;
}

void ewa_warp_options_init(ewa_warp_options *options, size_t struct_size) {
    if (!options || struct_size < sizeof *options) return;
    memset(options, 0, struct_size);
    options->struct_size = struct_size;
    options->cutoff = 3;
    options->radius_spacings = 1.14;
    options->depth_jump = 0.02;
    options->drop_flying = true;
    options->nearest_world = 1e-6;
    options->farthest_world = 1e9;
}

void ewa_warp_render_options_init(ewa_render_options *options, size_t struct_size) {
    if (!options || struct_size < sizeof *options) return;
    ewa_render_options_init(options, struct_size);
    options->shading = EWA_SHADING_NONE;
    options->prefilter_px = 0.25;
}

static ewa_status check_range(ewa_context *context, const char *name, double value, double low, bool low_open,
                              double high) {
    if (low_open ? value > low && value <= high : value >= low && value <= high) return EWA_OK;
    return ewa_fail(context, EWA_ERROR_ARGUMENT, "warp options: %s is %g, allowed is %s%g, %g]", name, value,
                    low_open ? "(" : "[", low, high);
}

ewa_status ewa_warp_options_choose(ewa_context *context, const ewa_warp_options *given,
                                   ewa_warp_options *chosen) {
    ewa_warp_options_init(chosen, sizeof *chosen);
    if (!given) return EWA_OK;
    if (given->struct_size != sizeof *chosen)
        return ewa_fail(context, EWA_ERROR_ARGUMENT,
                        "warp options: struct_size is %zu instead of %zu; ewa_warp_options_init() sets it",
                        given->struct_size, sizeof *chosen);
    *chosen = *given;
    ewa_status status = check_range(context, "cutoff", chosen->cutoff, 0, true, 4);
    if (status == EWA_OK)
        status = check_range(context, "radius_spacings", chosen->radius_spacings, 0.5, false, 10);
    if (status == EWA_OK) status = check_range(context, "depth_jump", chosen->depth_jump, 0, true, 1);
    if (status == EWA_OK)
        status = check_range(context, "depth_noise", chosen->depth_noise, 0, false, MOST_DEPTH);
    if (status == EWA_OK)
        status = check_range(context, "nearest_world", chosen->nearest_world, LEAST_DEPTH, false, MOST_DEPTH);
    if (status == EWA_OK)
        status = check_range(context, "farthest_world", chosen->farthest_world, chosen->nearest_world, true,
                             MOST_DEPTH);
    return status;
}

static ewa_status fail_image(ewa_context *context, uint32_t number, const char *what) {
    return ewa_fail(context, EWA_ERROR_ARGUMENT, "depth image %u: %s", number, what);
}

/// Checks that a source camera's numbers and their products are floats.
static ewa_status check_lens(ewa_context *context, uint32_t number, const ewa_camera *camera) {
    if (camera->projection != EWA_PERSPECTIVE)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED,
                        "depth image %u: the camera is orthographic; depth images need a perspective one",
                        number);
    const double *m = camera->world_to_camera;
    const double scale = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    const double focal[2] = {camera->fx_px, camera->fy_px}, principal[2] = {camera->cx_px, camera->cy_px};
    bool fits = scale >= 1 / MOST_CAMERA && scale <= MOST_CAMERA;
    for (int i = 0; i < 2; i++)
        fits = fits && focal[i] >= 1 / MOST_CAMERA && focal[i] <= MOST_CAMERA &&
               fabs(principal[i]) <= MOST_CAMERA;
    for (int r = 0; r < 3; r++) fits = fits && fabs(m[4 * r + 3]) <= MOST_DEPTH;
    if (fits) return EWA_OK;
    return ewa_fail(context, EWA_ERROR_UNSUPPORTED,
                    "depth image %u: focal lengths, principal point, scale or place of the camera are too "
                    "large or too small",
                    number);
}

static ewa_status check_depth(ewa_context *context, uint32_t number, const ewa_depth_image *image) {
    if (!image->depth) return fail_image(context, number, "no depth");
    if (image->depth_type != EWA_U16 && image->depth_type != EWA_F32)
        return fail_image(context, number, "depth_type is neither EWA_U16 nor EWA_F32");
    if (image->depth_stride_bytes / ewa_type_bytes(image->depth_type) < image->camera.width_px)
        return fail_image(context, number, "depth_stride_bytes is less than a row");
    if ((int)image->kind < 0 || image->kind > EWA_DEPTH_DISPARITY)
        return fail_image(context, number, "kind is none of EWA_DEPTH_*");
    if (!(image->depth_scale > 0 && image->depth_scale <= MOST_DEPTH))
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "depth image %u: depth_scale is %g, allowed is (0, %g]",
                        number, image->depth_scale, MOST_DEPTH);
    if (image->kind != EWA_DEPTH_DISPARITY) return EWA_OK;
    if (!(image->baseline_world > 0 && image->baseline_world <= MOST_DEPTH))
        return ewa_fail(context, EWA_ERROR_ARGUMENT,
                        "depth image %u: baseline_world is %g, allowed is (0, %g]", number,
                        image->baseline_world, MOST_DEPTH);
    if (!(fabs(image->disparity_offset_px) <= MOST_DEPTH))
        return fail_image(context, number, "disparity_offset_px is no number of pixels");
    return EWA_OK;
}

static ewa_status check_color(ewa_context *context, uint32_t number, const ewa_depth_image *image) {
    if (!image->color) return EWA_OK;
    if (image->color_type != EWA_U8 && image->color_type != EWA_F32)
        return fail_image(context, number, "color_type is neither EWA_U8 nor EWA_F32");
    const uint32_t channels = image->color_channel_count;
    if (channels != 1 && channels != 3 && channels != 4)
        return ewa_fail(context, EWA_ERROR_ARGUMENT,
                        "depth image %u: color_channel_count is %u, allowed are 1, 3 and 4", number,
                        channels);
    if (image->color_stride_bytes / ewa_type_bytes(image->color_type) / channels < image->camera.width_px)
        return fail_image(context, number, "color_stride_bytes is less than a row");
    return EWA_OK;
}

ewa_status ewa_depth_image_choose(ewa_context *context, uint32_t number, const ewa_depth_image *given,
                                  ewa_depth_image *chosen) {
    if (given->struct_size != sizeof *chosen)
        return fail_image(context, number, "struct_size is not that of ewa_depth_image_init()");
    *chosen = *given;
    ewa_status status = ewa_camera_check(context, &chosen->camera);
    if (status == EWA_OK) status = check_lens(context, number, &chosen->camera);
    if (status != EWA_OK) return status;
    const size_t width = chosen->camera.width_px;
    const bool known = chosen->depth_type == EWA_U16 || chosen->depth_type == EWA_F32;
    if (chosen->depth_stride_bytes == 0 && known)
        chosen->depth_stride_bytes = width * ewa_type_bytes(chosen->depth_type);
    const bool known_color = chosen->color_type == EWA_U8 || chosen->color_type == EWA_F32;
    if (chosen->color_stride_bytes == 0 && known_color)
        chosen->color_stride_bytes = width * chosen->color_channel_count * ewa_type_bytes(chosen->color_type);
    status = check_depth(context, number, chosen);
    return status != EWA_OK ? status : check_color(context, number, chosen);
}
