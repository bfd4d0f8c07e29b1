// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where the camera stands: options, default views, framing.
#ifndef EWA_CLI_VIEW_H
#define EWA_CLI_VIEW_H

#include "session.h"

/// Options of the camera, first in the arguments of a command.
typedef struct view_arguments {
    common_arguments common;
    const char *camera_path;
    int64_t camera_index;
    option_vector eye, target, up;
    double fov_deg;
    double ortho_height; ///< 0: perspective
    int view;            ///< index of a named view; -1: none given
    option_size size;
} view_arguments;

extern const option_group view_options;

void view_set_defaults(view_arguments *arguments);

/// What is wrong with the options of the camera together; see command.check.
bool view_check(const view_arguments *arguments, char message[OPTION_ERROR_BYTES]);

/// Makes the camera that the options ask for, looking at a cloud whose radii are drawn times `radius_scale`.
/// Returns false after reporting.
bool view_make(cli_session *session, const view_arguments *arguments, const ewa_cloud *cloud,
               double radius_scale, ewa_camera *camera);

#endif
