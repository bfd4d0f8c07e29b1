// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Checked options and images of warping.
#include "warp/warp_options.h"
#include "base/base.h"
#include "base/options.h"

#include <math.h>
#include <string.h>
#include <strings.h>

/// Limits of z: squares and cubes of what is within are floats.
#define MIN_DEPTH 1e-9
#define MAX_DEPTH 1e12

/// Limit of focal lengths, principal points and scales, and the inverse of the smallest one.
static const double MAX_CAMERA = 1e6;

void ewa_depth_image_init(ewa_depth_image *image) {
    if (!image) return;
    memset(image, 0, sizeof *image);
    ewa_camera_init(&image->camera);
    image->depth_scale = 1;
    image->color_channel_count = 3;
    image->color_type = EWA_U8;
}

double ewa_depth_file_scale(const char *path, ewa_depth_kind kind) {
    const size_t length = path ? strlen(path) : 0;
    const bool png = length > 4 && strcasecmp(path + length - 4, ".png") == 0;
    return png && kind != EWA_DEPTH_DISPARITY ? 1000 : 1;
}

#define AT(member) offsetof(ewa_warp_options, member)

static const ewa_option option_rows[] = {
    {"cutoff", EWA_OPTION_F64, AT(cutoff), 0, 4, EWA_OPTION_ABOVE, .initial = 3,
     .help = "standard deviations at which a kernel ends"},
    {"radius_spacings", EWA_OPTION_F64, AT(radius_spacings), 0.5, 10, .initial = 1.14,
     .help = "support radius of a splat in units of the distance to its neighbours"},
    {"depth_jump", EWA_OPTION_F64, AT(depth_jump), 0, 1, EWA_OPTION_ABOVE, .initial = 0.02,
     .help = "depths of neighbours that differ by more than this share are on different surfaces, unless "
             "they continue a plane"},
    {"depth_noise", EWA_OPTION_F64, AT(depth_noise), 0, 1e6,
     .help =
         "steps of a sensor's depths at distance 1, growing with its square: depths that differ by little "
         "more are averaged over 5 x 5 pixels. 0.0036 for a first Kinect in metres; 0: taken as they are"},
    {"drop_flying", EWA_OPTION_BOOL, AT(drop_flying), .initial = true,
     .help = "leave out samples that hang between two surfaces"},
    {"nearest_world", EWA_OPTION_F64, AT(nearest_world), MIN_DEPTH, MAX_DEPTH, .initial = 1e-6,
     .unit = "world", .help = "nearer depths are left out"},
    {"farthest_world", EWA_OPTION_F64, AT(farthest_world), MIN_DEPTH, MAX_DEPTH, .initial = 1e9,
     .unit = "world", .help = "farther depths are left out"},
};

const ewa_option_table ewa_warp_options_table = EWA_OPTION_TABLE(ewa_warp_options, option_rows);

void ewa_warp_options_init(ewa_warp_options *options, size_t struct_size) {
    ewa_options_init(&ewa_warp_options_table, options, struct_size);
}

void ewa_warp_render_options_init(ewa_render_options *options, size_t struct_size) {
    ewa_render_options_init(options, struct_size);
    if (!options || struct_size <= offsetof(ewa_render_options, shading)) return;
    options->shading = EWA_SHADING_NONE;
    options->prefilter_px = 0.25;
}

ewa_status ewa_warp_options_choose(ewa_context *context, const ewa_warp_options *given,
                                   ewa_warp_options *chosen) {
    ewa_warp_options_init(chosen, sizeof *chosen);
    EWA_TRY(ewa_options_take(context, &ewa_warp_options_table, given, chosen));
    if (!(chosen->nearest_world < chosen->farthest_world))
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "ewa_warp_options: farthest_world is %g, not above %g",
                        chosen->farthest_world, chosen->nearest_world);
    return EWA_OK;
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
    bool fits = scale >= 1 / MAX_CAMERA && scale <= MAX_CAMERA;
    for (int i = 0; i < 2; i++)
        fits =
            fits && focal[i] >= 1 / MAX_CAMERA && focal[i] <= MAX_CAMERA && fabs(principal[i]) <= MAX_CAMERA;
    for (int r = 0; r < 3; r++) fits = fits && fabs(m[4 * r + 3]) <= MAX_DEPTH;
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
    if (!(image->depth_scale > 0 && image->depth_scale <= MAX_DEPTH))
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "depth image %u: depth_scale is %g, allowed is (0, %g]",
                        number, image->depth_scale, MAX_DEPTH);
    if (image->kind != EWA_DEPTH_DISPARITY) return EWA_OK;
    if (!(image->baseline_world > 0 && image->baseline_world <= MAX_DEPTH))
        return ewa_fail(context, EWA_ERROR_ARGUMENT,
                        "depth image %u: baseline_world is %g, allowed is (0, %g]", number,
                        image->baseline_world, MAX_DEPTH);
    if (!(fabs(image->disparity_offset_px) <= MAX_DEPTH))
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
    *chosen = *given;
    EWA_TRY(ewa_camera_check(context, &chosen->camera));
    EWA_TRY(check_lens(context, number, &chosen->camera));
    const size_t width = chosen->camera.width_px;
    const bool known = chosen->depth_type == EWA_U16 || chosen->depth_type == EWA_F32;
    if (chosen->depth_stride_bytes == 0 && known)
        chosen->depth_stride_bytes = width * ewa_type_bytes(chosen->depth_type);
    const bool known_color = chosen->color_type == EWA_U8 || chosen->color_type == EWA_F32;
    if (chosen->color_stride_bytes == 0 && known_color)
        chosen->color_stride_bytes = width * chosen->color_channel_count * ewa_type_bytes(chosen->color_type);
    EWA_TRY(check_depth(context, number, chosen));
    return check_color(context, number, chosen);
}
