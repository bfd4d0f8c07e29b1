// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa view: the viewer's front ends and what they show.
#ifndef EWA_CLI_VIEW_WINDOW_H
#define EWA_CLI_VIEW_WINDOW_H

#include "viewer/front.h"

/// Runs the command with its parsed arguments in a front end. Returns the exit status.
int window_run(const void *arguments, int (*front)(const front_job *job));

#endif
