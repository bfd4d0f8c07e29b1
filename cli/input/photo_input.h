// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Photographs of the command line: cameras that name them, where they are, their masks.
#ifndef EWA_CLI_INPUT_PHOTO_INPUT_H
#define EWA_CLI_INPUT_PHOTO_INPUT_H

#include "cli/base/session.h"

/// Options of photographs; NULL: not given.
typedef struct photo_arguments {
    const char *cameras_path, *images_path, *masks_path;
} photo_arguments;

/// Rows of an option table; `at` is the offset of the photo_arguments in the command's arguments.
#define PHOTO_OPTIONS(at)                                                                                    \
    {"cameras", OPTION_TEXT, (at) + offsetof(photo_arguments, cameras_path), "PATH",                         \
     .help = "cameras that name their photographs: the folder of a COLMAP model, cameras.xml, transforms.json, " \
             "cameras.json"},                                                                                \
        {"images", OPTION_TEXT, (at) + offsetof(photo_arguments, images_path), "FOLDER",                     \
         .help = "where the photographs are",                                                                \
         .absent = "auto: images, ../images or ../../images of a COLMAP model, else beside the file"},       \
    {                                                                                                        \
        "masks", OPTION_TEXT, (at) + offsetof(photo_arguments, masks_path), "FOLDER",                        \
            .help = "masks of the photographs, white where these count: of NAME.jpg NAME.jpg.png or NAME.png" \
    }

/// Says in `message` what is missing for a command.
bool photo_input_check(const photo_arguments *arguments, const char *command, char message[OPTION_ERROR_BYTES]);

/// Finds the photographs; the caller destroys the list, which is NULL after a failure, which has been reported.
ewa_photo_list *photo_input_load(cli_session *session, const photo_arguments *arguments);

#endif
