// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Films through the program ffmpeg: raw frames go to its standard input, no shell in between.
#define _POSIX_C_SOURCE 200809L
#include "video.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { MAX_WORDS = 64, PATH_BYTES = 4096, COMPLAINT_BYTES = 400 };

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

/// Looks for ffmpeg in the folders of PATH.
static bool find_program(char program[PATH_BYTES]) {
    const char *folder = getenv("PATH");
    while (folder && *folder) {
        const size_t length = strcspn(folder, ":");
        const int written =
            snprintf(program, PATH_BYTES, "%.*s%sffmpeg", (int)length, folder, length ? "/" : "");
        struct stat found;
        if (written > 0 && written < PATH_BYTES && stat(program, &found) == 0 && S_ISREG(found.st_mode) &&
            access(program, X_OK) == 0)
            return true;
        folder += length + (folder[length] == ':');
    }
    return false;
}

bool video_is_possible(void) {
    char program[PATH_BYTES];
    return find_program(program);
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
    snprintf(line->target, sizeof line->target, "file:%s", video->aside);
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

/// Starts the program with the pipe's reading end as standard input; returns an error number.
static int spawn(const char *program, command_line *line, int input, int complaints, pid_t *process) {
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    int error = posix_spawn_file_actions_init(&actions);
    if (error) return error;
    error = posix_spawnattr_init(&attributes);
    if (error) {
        posix_spawn_file_actions_destroy(&actions);
        return error;
    }
    sigset_t defaults;
    sigemptyset(&defaults);
    sigaddset(&defaults, SIGPIPE);
    sigaddset(&defaults, SIGXFSZ);
    error = posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    if (!error) error = posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    if (!error) error = posix_spawn_file_actions_adddup2(&actions, complaints, STDERR_FILENO);
    if (!error) error = posix_spawnattr_setsigdefault(&attributes, &defaults);
    if (!error) error = posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    if (!error)
        error = posix_spawn(process, program, &actions, &attributes, (char *const *)(uintptr_t)line->words,
                            environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return error;
}

bool video_start(cli_session *session, const char *path, const video_settings *settings, cli_video *video) {
    *video = (cli_video){.path = path, .descriptor = -1};
    char program[PATH_BYTES];
    if (!find_program(program)) {
        session_fail(session, "%s: ffmpeg is gone", path);
        return false;
    }
    const int length = snprintf(video->aside, sizeof video->aside, "%s.%ld.part", path, (long)getpid());
    if (length < 0 || (size_t)length >= sizeof video->aside) {
        session_fail(session, "%s: the path is too long", path);
        return false;
    }
    // Whoever started us to ignore the ends of children is not obeyed: ffmpeg's matters.
    signal(SIGCHLD, SIG_DFL);
    int ends[2];
    video->complaints = tmpfile();
    if (!video->complaints || pipe(ends) != 0) {
        session_fail(session, "%s: cannot start ffmpeg: %s", path, strerror(errno));
        video_drop(video);
        return false;
    }
    fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    fcntl(ends[1], F_SETFD, FD_CLOEXEC);
    command_line line;
    make_command_line(video, video_find_format(path), settings, &line);
    const int error = spawn(program, &line, ends[0], fileno(video->complaints), &video->process);
    close(ends[0]);
    video->descriptor = ends[1];
    video->frame_bytes = (size_t)settings->width_px * settings->height_px * 4;
    if (!error) return true;
    video->process = 0;
    session_fail(session, "%s: cannot start %s: %s", path, program, strerror(error));
    video_drop(video);
    return false;
}

/// Closes the pipe and waits; returns what waitpid() says of the end, -1 when it does not know.
static int await_end(cli_video *video) {
    if (video->descriptor >= 0) close(video->descriptor);
    video->descriptor = -1;
    int ended = -1;
    bool told = false;
    while (video->process > 0 && waitpid(video->process, &ended, 0) < 0) {
        if (errno != EINTR) {
            ended = -1;
            break;
        }
        if (session_interrupted() && !told) told = kill(video->process, SIGTERM) == 0;
    }
    video->process = 0;
    return ended;
}

/// Reports how ffmpeg ended, with the last line of what it said.
static void report_end(cli_session *session, const cli_video *video, int ended) {
    if (session_interrupted()) return;
    char said[COMPLAINT_BYTES] = "", last[COMPLAINT_BYTES] = "";
    rewind(video->complaints);
    while (fgets(said, sizeof said, video->complaints)) {
        said[strcspn(said, "\r\n")] = 0;
        if (said[0]) memcpy(last, said, sizeof last);
    }
    char how[64] = "ended early";
    if (ended > 0 && WIFEXITED(ended))
        snprintf(how, sizeof how, "failed with status %d", WEXITSTATUS(ended));
    else if (ended > 0 && WIFSIGNALED(ended))
        snprintf(how, sizeof how, "was ended by signal %d", WTERMSIG(ended));
    session_fail(session, "%s: ffmpeg %s%s%s", video->path, how, last[0] ? ": " : "", last);
}

bool video_put(cli_session *session, cli_video *video, const uint8_t *rgba8) {
    for (size_t put = 0; put < video->frame_bytes;) {
        const ssize_t written = write(video->descriptor, rgba8 + put, video->frame_bytes - put);
        if (written > 0) {
            put += (size_t)written;
        } else if (session_interrupted()) {
            return false;
        } else if (errno != EINTR) {
            // A closed pipe: ffmpeg knows why.
            report_end(session, video, await_end(video));
            return false;
        }
    }
    return true;
}

bool video_finish(cli_session *session, cli_video *video) {
    const int ended = await_end(video);
    bool done = ended == 0 && !session_interrupted();
    if (!done) {
        report_end(session, video, ended);
    } else if (rename(video->aside, video->path) != 0) {
        session_fail(session, "%s: cannot write: %s", video->path, strerror(errno));
        done = false;
    }
    if (done) video->aside[0] = 0;
    video_drop(video);
    return done;
}

void video_drop(cli_video *video) {
    if (video->process > 0) kill(video->process, SIGTERM);
    if (video->path) await_end(video);
    if (video->aside[0]) unlink(video->aside);
    if (video->complaints) fclose(video->complaints);
    *video = (cli_video){.descriptor = -1};
}
