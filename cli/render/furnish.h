// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Title, axes, scale bar and colour bar over the pictures of a command.
#ifndef EWA_CLI_RENDER_FURNISH_H
#define EWA_CLI_RENDER_FURNISH_H

#include "cli/render/frames.h"

/// Options of the furniture.
typedef struct furnish_arguments {
    const char *title, *unit;
    bool axes, scale_bar, color_bar;
} furnish_arguments;

/// Rows for the table of a command that has furnish_arguments at `offset`.
#define FURNISH_OPTIONS(offset)                                                                              \
    {"title", OPTION_TEXT, (offset) + offsetof(furnish_arguments, title), "TEXT",                            \
     .help = "write a line over the top of the picture; this and what follows: not with .exr and .pfm, "     \
             "which hold data"},                                                                             \
        {"axes", OPTION_FLAG, (offset) + offsetof(furnish_arguments, axes),                                  \
         .help = "show how the world's axes lie, in the lower left corner"},                                 \
        {"scale-bar", OPTION_FLAG, (offset) + offsetof(furnish_arguments, scale_bar),                        \
         .help = "show a length, in the lower right corner; of a perspective picture at the distance of "    \
                 "--target, else of the middle, which it says"},                                             \
    {                                                                                                        \
        "unit", OPTION_TEXT, (offset) + offsetof(furnish_arguments, unit), "UNIT",                           \
            .help = "of the file's lengths, for the scale bar and a colour bar of x, y or z; m turns into "  \
                    "mm, cm and km",                                                                         \
            .absent = "auto: as the files' reference systems say"                                                                                 \
    }

/// Says in `message` what is wrong with the options and the output, NULL for a window; see command.check.
bool furnish_check(const furnish_arguments *arguments, const char *output, char message[OPTION_ERROR_BYTES]);

/// What is put over each frame.
typedef struct furnishing {
    ewa_furniture_options options;
    bool any;
    double middle_world[3]; ///< where the scale bar of a perspective camera holds
} furnishing;

/// Prepares what the options ask for, for pictures of `subject` (NULL: of what is about the origin) on a background.
/// The arguments stay as long as the furnishing. Returns false after reporting.
bool furnish_make(cli_session *session, const furnish_arguments *arguments, const frames_arguments *frames,
                  const option_color *background, const view_subject *subject, furnishing *made);

/// Says what the colour bar means by a legend, which stays as long as the furnishing.
void furnish_color_bar(const ewa_legend *legend, furnishing *made);

/// Draws it over a frame's 8-bit picture; the status of the library.
ewa_status furnish_draw(cli_session *session, const furnishing *made, const ewa_camera *camera,
                        const ewa_frame *frame);

#endif
