// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Many pictures of one cloud: turntables and camera paths, numbered files and films.
#ifndef EWA_CLI_RENDER_FRAMES_H
#define EWA_CLI_RENDER_FRAMES_H

#include "cli/render/view.h"

/// Options of the frames, first in the arguments of a command that has them.
typedef struct frames_arguments {
    view_arguments view; // first: it begins with the common arguments
    int64_t turntable;   ///< frames; 0: not asked for
    const char *path_file;
    film_part part; ///< its count: frames on the way through the cameras; 0: the cameras as they are
    bool loop;
    bool skip_existing;
    double frames_per_s; ///< 0: not given
    int64_t quality;     ///< -1: not given
} frames_arguments;

extern const option_group frames_options;

void frames_set_defaults(frames_arguments *arguments);

/// Whether several pictures are asked for.
bool frames_many(const frames_arguments *arguments);

/// What is wrong with the options of camera and frames together and with the output, a numbered file or a
/// film when there are several; see command.check.
bool frames_check(const frames_arguments *arguments, const char *output, bool opaque,
                  char message[OPTION_ERROR_BYTES]);

/// The frames of a film, one when a single picture is asked for, and which of them this run draws.
typedef struct frame_cameras {
    ewa_camera *cameras; ///< of all frames, so that a part is drawn as the whole film is
    size_t count;        ///< of the whole film
    size_t *chosen;      ///< numbers of the frames that are drawn, rising
    size_t chosen_count;
    bool beyond; ///< the part lies beyond the film's end: wrong usage
} frame_cameras;

/// Whether the files of frame `index` are there; false where one is not.
typedef bool frames_exist(const void *user, size_t index);

/// Counts the frames before anything large is read, and chooses those of the part, with --skip-existing those
/// that are not there already. Returns false after reporting; free in any case.
bool frames_plan(cli_session *session, const frames_arguments *arguments, frames_exist *exist,
                 const void *user, frame_cameras *frames);

/// Makes the cameras that the options ask for; `frames` is planned. Returns false after reporting.
bool frames_make(cli_session *session, const frames_arguments *arguments, const view_subject *subject,
                 frame_cameras *frames);
void frames_free(frame_cameras *frames);

/// Writes the cameras to a file: one, or a list when `many`. Returns false after reporting.
bool frames_save(cli_session *session, const char *path, const frame_cameras *frames, bool many);

#endif
