// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Title, axes, scale bar and colour bar over the pictures of a command.
#include "cli/render/furnish.h"
#include "cli/base/pattern.h"

#include <math.h>
#include <string.h>

/// Luminance of a middle grey.
static const double MIDDLE_LUMINANCE = 0.18;

static bool has_any(const furnish_arguments *arguments) {
    return arguments->title || arguments->axes || arguments->scale_bar || arguments->color_bar;
}

bool furnish_check(const furnish_arguments *arguments, const char *output, char message[OPTION_ERROR_BYTES]) {
    const char *wrong = NULL;
    if (output && has_any(arguments) && path_has_suffix(output, ".exr|.pfm"))
        wrong =
            "--title, --axes, --scale-bar and --color-bar are not drawn on .exr and .pfm, which hold data; "
            "write a .png or a film";
    else if (arguments->unit && !arguments->scale_bar && !arguments->color_bar)
        wrong = "--unit needs --scale-bar or --color-bar";
    return options_fine(wrong, message);
}

/// The ink of all frames of a film, by their background: it must not change from frame to frame.
static ewa_ink steady_ink(const option_color *background) {
    float linear[4];
    option_color_linear(background, linear);
    const double alpha = (double)linear[3];
    const double luminance =
        0.2126 * (double)linear[0] + 0.7152 * (double)linear[1] + 0.0722 * (double)linear[2];
    return alpha * luminance + (1 - alpha) > MIDDLE_LUMINANCE ? EWA_INK_DARK : EWA_INK_LIGHT;
}

bool furnish_make(cli_session *session, const furnish_arguments *arguments, const frames_arguments *frames,
                  const option_color *background, const view_subject *subject, furnishing *made) {
    made->any = has_any(arguments);
    ewa_furniture_options *options = &made->options;
    ewa_furniture_options_init(options, sizeof *options);
    options->title = arguments->title;
    options->axes = arguments->axes;
    options->scale_bar = arguments->scale_bar;
    ewa_scene_info info = {.unit = NULL};
    if (subject && subject->scene) ewa_scene_describe(subject->scene, &info);
    options->unit = arguments->unit ? arguments->unit : info.unit;
    if (frames_many(frames)) options->ink = steady_ink(background);
    const option_vector *target = &frames->view.target;
    memcpy(made->middle_world, target->values, sizeof made->middle_world);
    if (!arguments->scale_bar || target->count || !subject) return true;
    return view_middle(session, &frames->view, subject, made->middle_world);
}

void furnish_color_bar(const ewa_legend *legend, furnishing *made) {
    ewa_furniture_options *options = &made->options;
    options->color_bar = true;
    options->color_label = legend->attribute;
    options->color_unit = legend->length ? options->unit : NULL;
    options->colormap = legend->colormap;
    memcpy(options->range, legend->range, sizeof options->range);
    options->categories = legend->categories;
    options->category_count = legend->category_count;
}

ewa_status furnish_draw(cli_session *session, const furnishing *made, const ewa_camera *camera,
                        const ewa_frame *frame) {
    if (!made->any) return EWA_OK;
    ewa_furniture_options options = made->options;
    const double *m = camera->world_to_camera, *at = made->middle_world;
    const double depth = m[8] * at[0] + m[9] * at[1] + m[10] * at[2] + m[11];
    const double depth_world = depth / sqrt(m[8] * m[8] + m[9] * m[9] + m[10] * m[10]);
    options.scale_depth_world = depth_world > 0 && depth_world < 1e30 ? depth_world : 0;
    const ewa_canvas canvas = {frame->rgba8, camera->width_px, camera->height_px};
    return ewa_furniture_draw(session->context, camera, &options, &canvas);
}
