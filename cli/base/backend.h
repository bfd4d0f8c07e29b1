// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What draws the frames: the option, and what is said of it.
#ifndef EWA_CLI_BASE_BACKEND_H
#define EWA_CLI_BASE_BACKEND_H

#include "cli/base/json.h"

/// The option --backend, an int in the order of ewa_backend_kind.
#define BACKEND_OPTION(at)                                                                                   \
    {                                                                                                        \
        "backend", OPTION_CHOICE, at, NULL, "cpu|gl|gl-raster|auto",                                         \
            .help = "what draws: the processor; OpenGL's compute programs, which draw the same bytes on a "  \
                    "device that is exact ('ewa info --gpu'); its raster pipeline, which is close to them; " \
                    "auto: the faster of cpu and gl, where that is exact and no software"                    \
    }

/// Warns where what was asked for is slower than the processor: OpenGL by software.
void backend_warn(cli_session *session, int backend, const ewa_renderer *renderer);

/// Adds to an object what drew.
void backend_write(json_writer *json, const ewa_renderer_info *info);

/// Prints what graphics processor there is; `json` NULL: as text. False after reporting.
bool backend_print_gpu(cli_session *session, json_writer *json);

#endif
