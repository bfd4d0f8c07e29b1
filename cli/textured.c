// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Options for pictures on points.
#include "textured.h"

#define AT(member) offsetof(textured_arguments, member)

static const cli_option table[] = {
    {.key = "texture",
     .kind = OPTION_TEXT,
     .offset = AT(picture),
     .value = "IMAGE",
     .absent = "the object's own colours",
     .help = "picture to put onto the points (PNG, JPEG, OpenEXR, PFM, HDR)",
     .excludes = "procedure"},
    {.key = "texture-filter",
     .kind = OPTION_CHOICE,
     .offset = AT(filter),
     .range = "nearest|ewa|optimal",
     .help = "nearest: the pixel at the point; ewa: the mean under the surfel; optimal: the sharpest, by "
             "least squares, colours may leave [0, 1]"},
    {.key = "pixel-sigma",
     .kind = OPTION_NUMBER,
     .offset = AT(pixel_sigma_px),
     .value = "S",
     .range = "[0.3, 8]",
     .help = "standard deviation of the Gaussian that stands for a pixel of the picture, in pixels"},
};

const option_group textured_options = {"Texture", table, sizeof table / sizeof table[0]};

void textured_set_defaults(textured_arguments *arguments) {
    procedure_set_defaults(&arguments->procedure);
    ewa_acquire_options options;
    ewa_acquire_options_init(&options, sizeof options);
    arguments->filter = (int)options.filter;
    arguments->pixel_sigma_px = options.pixel_sigma_px;
}

bool textured_load(cli_session *session, const textured_arguments *arguments, ewa_image *picture) {
    *picture = (ewa_image){0};
    if (!arguments->picture) return true;
    session->subject = arguments->picture;
    const ewa_status status = ewa_image_load(session->context, arguments->picture, picture);
    if (status != EWA_OK) session_failed(session, status);
    return status == EWA_OK;
}
