// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Options for pictures on points.
#include "textured.h"

#define AT(member) offsetof(textured_arguments, member)

static const cli_option table[] = {
    {"texture", OPTION_TEXT, AT(picture), "IMAGE",
     .help = "picture to put onto the points (PNG, JPEG, OpenEXR, PFM, HDR)",
     .absent = "the object's own colours", .excludes = "procedure"},
    {"texture-filter", OPTION_CHOICE, AT(filter), NULL, "nearest|ewa|optimal",
     .help = "nearest: the pixel at the point; ewa: the mean under the surfel; optimal: the sharpest, by "
             "least squares, colours may leave [0, 1]"},
    {"pixel-sigma", OPTION_NUMBER, AT(pixel_sigma_px), "S", "[0.3, 8]",
     .help = "standard deviation of the Gaussian that stands for a pixel of the picture, in pixels"},
};

const option_group textured_options = OPTION_GROUP("Texture", table);

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
