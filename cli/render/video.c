// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Films through the program ffmpeg: raw frames go to its standard input, no shell in between.
#include "cli/render/video.h"
#include "cli/base/path.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

enum { MAX_WORDS = 64 };

struct video_format {
    const char *suffix, *muxer, *codec;
    const char *further[6]; ///< further words, ended by NULL
    double crf_best, crf_worst;
    bool alpha;
};

static const video_format formats[] = {
    {.suffix = ".mp4",
     .muxer = "mp4",
     .codec = "libx264",
     .further = {"-movflags", "+faststart"},
     .crf_best = 10,
     .crf_worst = 42},
    {.suffix = ".mkv", .muxer = "matroska", .codec = "libx264", .crf_best = 10, .crf_worst = 42},
    {.suffix = ".webm",
     .muxer = "webm",
     .codec = "libvpx-vp9",
     .further = {"-b:v", "0", "-row-mt", "1"},
     .crf_best = 18,
     .crf_worst = 62,
     .alpha = true},
    {.suffix = ".gif", .muxer = "gif"},
};

/// One palette for the whole film.
static const char GIF_FILTER[] = "split[a][b];[a]palettegen[p];[b][p]paletteuse";

/// Studio range of BT.709, which players take for granted; both codecs halve the colours' resolution, so an
/// odd side gets one more row or column.
static const char YUV_FILTER[] =
    "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=black@0,scale=out_color_matrix=bt709:out_range=tv";

const video_format *video_find_format(const char *path) {
    const size_t length = strlen(path);
    for (size_t i = 0; i < sizeof formats / sizeof formats[0]; i++) {
        const size_t suffix_length = strlen(formats[i].suffix);
        if (length > suffix_length && strcasecmp(path + length - suffix_length, formats[i].suffix) == 0)
            return &formats[i];
    }
    return NULL;
}

bool video_has_alpha(const video_format *format) { return format->alpha; }

bool video_has_quality(const video_format *format) { return format->codec != NULL; }

bool video_is_possible(void) {
    char program[PATH_BYTES];
    return path_find_program("ffmpeg", program);
}

/// Texts of the words that are made up, and the words of ffmpeg's command line.
typedef struct command_line {
    char size[32], rate[32], crf[32], target[PATH_BYTES + 8];
    const char *words[MAX_WORDS];
    size_t count;
} command_line;

static void add_words(command_line *line, size_t count, const char *const *words) {
    for (size_t i = 0; i < count && words[i] && line->count + 1 < MAX_WORDS; i++)
        line->words[line->count++] = words[i];
    line->words[line->count] = NULL;
}

#define ADD(line, ...)                                                                                       \
    add_words(line, sizeof((const char *[]){__VA_ARGS__}) / sizeof(char *), (const char *[]){__VA_ARGS__})

static void make_command_line(const cli_video *video, const video_format *format,
                              const video_settings *settings, command_line *line) {
    line->count = 0;
    snprintf(line->size, sizeof line->size, "%ux%u", settings->width_px, settings->height_px);
    snprintf(line->rate, sizeof line->rate, "%.6g", settings->frames_per_s);
    snprintf(line->crf, sizeof line->crf, "%.0f",
             format->crf_worst + (format->crf_best - format->crf_worst) * settings->quality / 100);
    // The protocol is named so that a colon in the path does not name another.
    snprintf(line->target, sizeof line->target, "file:%s", video->pending.written);
    ADD(line, "ffmpeg", "-hide_banner", "-loglevel", "error", "-nostdin", "-y", "-f", "rawvideo",
        "-pixel_format", settings->opaque ? "rgb0" : "rgba", "-video_size", line->size, "-framerate",
        line->rate, "-i", "pipe:0", "-an");
    if (format->codec) {
        ADD(line, "-c:v", format->codec, "-crf", line->crf, "-vf", YUV_FILTER, "-pix_fmt",
            settings->opaque ? "yuv420p" : "yuva420p", "-colorspace", "bt709", "-color_primaries", "bt709",
            "-color_trc", "iec61966-2-1", "-color_range", "tv");
        add_words(line, sizeof format->further / sizeof format->further[0], format->further);
    } else {
        ADD(line, "-filter_complex", GIF_FILTER);
    }
    ADD(line, "-f", format->muxer, line->target);
}

bool video_start(cli_session *session, const char *path, const video_settings *settings, cli_video *video) {
    *video = (cli_video){.path = path};
    char program[PATH_BYTES];
    if (!path_find_program("ffmpeg", program)) {
        session_fail(session, "%s: ffmpeg is gone", path);
        return false;
    }
    const int refused = temporary_file_choose(path, &video->pending);
    if (refused) {
        session_fail(session, "%s: cannot create: %s", path, strerror(refused));
        return false;
    }
    command_line line;
    make_command_line(video, video_find_format(path), settings, &line);
    const int error = child_start(program, line.words, false, &video->ffmpeg);
    video->frame_bytes = (size_t)settings->width_px * settings->height_px * 4;
    if (!error) return true;
    session_fail(session, "%s: cannot start %s: %s", path, program, strerror(error));
    return false;
}

bool video_put(cli_session *session, cli_video *video, const uint8_t *rgba8) {
    for (size_t put = 0; put < video->frame_bytes;) {
        const ssize_t written = write(video->ffmpeg.input, rgba8 + put, video->frame_bytes - put);
        if (written > 0) {
            put += (size_t)written;
        } else if (session_interrupted()) {
            return false;
        } else if (errno != EINTR) {
            // A closed pipe: ffmpeg knows why.
            child_wait(session, &video->ffmpeg, video->path, "ffmpeg", true);
            return false;
        }
    }
    return true;
}

bool video_finish(cli_session *session, cli_video *video) {
    const bool done = child_wait(session, &video->ffmpeg, video->path, "ffmpeg", false);
    const int error = done ? temporary_file_commit(&video->pending) : 0;
    if (error) session_fail(session, "%s: cannot write: %s", video->path, strerror(error));
    video_drop(video);
    return done && !error;
}

void video_drop(cli_video *video) {
    child_drop(&video->ffmpeg);
    temporary_file_drop(&video->pending);
    *video = (cli_video){.path = NULL};
}
