// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Options for pictures on points.
#include "cli/image/textured.h"

#define AT(member) offsetof(textured_arguments, member)

static const cli_option table[] = {
    {"texture", OPTION_TEXT, AT(picture), "IMAGE",
     .help = "picture to put onto the points (PNG, JPEG, OpenEXR, PFM, HDR)",
     .absent = "none: the object's own colours", .excludes = "procedure"},
    {"texture-filter", OPTION_OF(ewa_acquire_options, AT(acquire), filter)},
    {"pixel-sigma", OPTION_OF(ewa_acquire_options, AT(acquire), pixel_sigma_px)},
};

const option_group textured_options = OPTION_GROUP("Texture", table);

void textured_set_defaults(textured_arguments *arguments) {
    procedure_set_defaults(&arguments->procedure);
    ewa_acquire_options_init(&arguments->acquire, sizeof arguments->acquire);
}

bool textured_load(cli_session *session, const textured_arguments *arguments, ewa_image *picture) {
    *picture = (ewa_image){0};
    if (!arguments->picture) return true;
    session->subject = arguments->picture;
    return session_passed(session, ewa_image_load(session->context, arguments->picture, picture));
}
