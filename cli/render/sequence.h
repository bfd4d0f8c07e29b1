// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Drawing one picture or many with one renderer, into files, numbered files or a film.
#ifndef EWA_CLI_RENDER_SEQUENCE_H
#define EWA_CLI_RENDER_SEQUENCE_H

#include "cli/render/picture.h"
#include "cli/render/render_report.h"

/// Where the pictures go.
typedef struct sequence_output {
    const picture_paths *paths; ///< numbered ones have the place of their number
    bool numbered;
    const char *film;   ///< NULL: none
    const char *source; ///< what messages call the place that the frames' cameras come from; NULL: not said
    double frames_per_s;
    int quality; ///< of the film, 0 to 100
    bool opaque; ///< alpha says nothing
} sequence_output;

/// Where the pictures of a command go whose --output is `output`, over an opaque background or none.
sequence_output sequence_output_of(const frames_arguments *frames, const char *output, const picture_paths *paths,
                                   bool opaque);

/// Says in `message` which of the paths has no place for a number; returns false then.
bool sequence_check_paths(const picture_paths *paths, char message[OPTION_ERROR_BYTES]);

/// Whether all files of a frame are there; `user`: the numbered picture_paths. For frames_plan().
bool sequence_exists(const void *user, size_t index);

/// What draws a frame: fills the planes and the statistics; the status of the library.
typedef struct frame_painter {
    ewa_status (*paint)(void *user, const ewa_camera *camera, const ewa_frame *frame,
                        ewa_render_stats *stats);
    void *user;
} frame_painter;

/// Draws the frames that are chosen and writes them; warns of frames that show nothing. Returns false after
/// reporting; whole files stay, which a message counts, a film is removed then.
bool sequence_draw(cli_session *session, const sequence_output *output, const frame_cameras *frames,
                   const frame_painter *painter, render_report *report);

#endif
