// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pairs of pictures and depths with their cameras.
#ifndef EWA_CLI_INPUT_WARP_SOURCES_H
#define EWA_CLI_INPUT_WARP_SOURCES_H

#include "cli/base/session.h"

enum { WARP_MAX_SOURCES = 16 };

/// Options that say what the pictures are, first in the arguments of a command.
typedef struct source_arguments {
    common_arguments common;  // first
    const char *camera_paths; ///< separated by commas
    const char *intrinsics;   ///< fx,fy,cx,cy or a file
    option_vector camera_indices;
    int depth_kind;
    double depth_scale; ///< 0: by the kind of file
    double baseline_world, disparity_offset_px;
} source_arguments;

extern const option_group source_options;

void sources_set_defaults(source_arguments *arguments);

/// See command.check.
bool sources_check(const source_arguments *arguments, char message[OPTION_ERROR_BYTES]);

/// Pictures in memory.
typedef struct warp_sources {
    ewa_depth_image images[WARP_MAX_SOURCES];
    ewa_image colors[WARP_MAX_SOURCES], depths[WARP_MAX_SOURCES];
    uint32_t count;
} warp_sources;

/// Loads the pairs of the operands. Returns false after reporting; free in any case.
bool sources_load(cli_session *session, const source_arguments *arguments, warp_sources *sources);
void sources_free(warp_sources *sources);

#endif
