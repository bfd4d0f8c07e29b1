// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cameras from files: with their lens, or as poses that get one from the command line.
#ifndef EWA_CLI_INPUT_CAMERA_INPUT_H
#define EWA_CLI_INPUT_CAMERA_INPUT_H

#include "cli/base/session.h"

/// Whether a file, by its suffix (.txt, .log, .tum), holds poses without a lens.
bool camera_input_is_poses(const char *path);

/// Checks the value of --intrinsics: fx,fy,cx,cy or the name of a file; NULL does too. Returns false with
/// what is wrong in `message`.
bool camera_input_check_lens(const char *intrinsics, char message[OPTION_ERROR_BYTES]);

/// Gives a camera, whose size is set, the lens of --intrinsics; a file's has a size of its own. Says so when
/// the numbers look like those of pixel centres at whole numbers. Returns false after reporting.
bool camera_input_load_lens(cli_session *session, const char *intrinsics, ewa_camera *camera);

/// Loads camera `index` of a file; poses have the lens of `lens`. Returns false after reporting.
bool camera_input_load(cli_session *session, const char *path, uint32_t index, const ewa_camera *lens,
                       ewa_camera *camera);

/// Hands over all cameras of a file; poses have the lens of `lens`. Returns false after reporting.
bool camera_input_load_each(cli_session *session, const char *path, const ewa_camera *lens,
                            ewa_camera_callback *receive, void *user);

#endif
