// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Photographs of the command line.
#include "cli/input/photo_input.h"

#include <stdio.h>

bool photo_input_check(const photo_arguments *arguments, const char *command, char message[OPTION_ERROR_BYTES]) {
    if (!arguments->cameras_path)
        snprintf(message, OPTION_ERROR_BYTES, "%s: no cameras; say --cameras PATH", command);
    return arguments->cameras_path;
}

ewa_photo_list *photo_input_load(cli_session *session, const photo_arguments *arguments) {
    ewa_photo_list *list = NULL;
    const char *subject = session->subject;
    session->subject = arguments->cameras_path;
    bool done = session_passed(
        session, ewa_photo_list_load(session->context, arguments->cameras_path, arguments->images_path, &list));
    session->subject = arguments->masks_path;
    if (done && arguments->masks_path)
        done = session_passed(session, ewa_photo_list_find_masks(list, arguments->masks_path));
    session->subject = subject;
    if (!done) ewa_photo_list_destroy(&list);
    return list;
}
