// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Films through the program ffmpeg.
#ifndef EWA_CLI_RENDER_VIDEO_H
#define EWA_CLI_RENDER_VIDEO_H

#include "cli/base/child.h"
#include "cli/base/temporary_file.h"

enum { VIDEO_FRAMES_PER_S = 30, VIDEO_QUALITY = 75 }; ///< where nobody says

typedef struct video_format video_format;

/// The format that a path's suffix asks for: .mp4 and .mkv (H.264), .webm (VP9), .gif; NULL: no film.
const video_format *video_find_format(const char *path);

/// Whether a format keeps transparency, and whether it has a quality to choose.
bool video_has_alpha(const video_format *format);
bool video_has_quality(const video_format *format);

/// Whether ffmpeg is there.
bool video_is_possible(void);

/// A film that is being written, under a temporary name.
typedef struct cli_video {
    const char *path;
    temporary_file pending;
    child_process ffmpeg;
    size_t frame_bytes;
} cli_video;

typedef struct video_settings {
    uint32_t width_px, height_px;
    double frames_per_s;
    int quality; ///< 0 (small) to 100 (good)
    bool opaque; ///< alpha says nothing
} video_settings;

/// Starts ffmpeg; false after reporting. Ends with video_finish() or video_drop().
bool video_start(cli_session *session, const char *path, const video_settings *settings, cli_video *video);

/// Hands over a frame: RGBA, 8 bits, straight alpha, rows from the top. False after reporting.
bool video_put(cli_session *session, cli_video *video, const uint8_t *rgba8);

/// Waits for ffmpeg and gives the film its name; false after reporting, with nothing left behind.
bool video_finish(cli_session *session, cli_video *video);

/// Ends ffmpeg and removes what it wrote; does nothing after video_finish() and for a zeroed video.
void video_drop(cli_video *video);

#endif
