// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Front ends: what they are given, and what a script needs of one.
#ifndef EWA_VIEWER_FRONT_H
#define EWA_VIEWER_FRONT_H

#include "viewer.h"

#ifdef __cplusplus
extern "C" {
#endif

/// What a front end is to show.
typedef struct front_job {
    viewer_options options;
    const char *const *paths; ///< opened at the start
    size_t path_count;
    const char *script_path; ///< NULL: people do
    double started_s;        ///< when the program began, CLOCK_MONOTONIC
    bool timings;            ///< the script's times are kept, and what frames took is printed
} front_job;

/// Does what a script says without any window. Returns the exit status: 0, or 1 after saying why.
int front_script_run(const front_job *job);

/// Shows a window until it is closed or the script ends. Returns the exit status.
int front_window_run(const front_job *job);

/// How a script reaches a viewer through a front end.
typedef struct script_host {
    void *user;
    /// Lets an event happen as if a person had done it.
    void (*event)(void *user, const viewer_event *event);
    /// Handles what has happened and shows a frame; false: the window was closed.
    bool (*step)(void *user, double time_s, viewer_picture *picture);
} script_host;

/// Runs a script: one line for each event, command or check (docs/viewer.md). Returns the exit status.
int script_run(viewer *viewer, const front_job *job, const script_host *host);

#ifdef __cplusplus
}
#endif
#endif
