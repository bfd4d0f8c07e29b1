// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Drawing one picture or many with one renderer, into files, numbered files or a film.
#include "sequence.h"
#include "pattern.h"
#include "video.h"

#include <stdio.h>
#include <string.h>

/// The files of one frame.
typedef struct frame_files {
    picture_paths paths;
    char color[1024];
} frame_files;

bool sequence_check_paths(const picture_paths *paths, char message[OPTION_ERROR_BYTES]) {
    const char *const all[] = {paths->color, paths->depth, paths->normal, paths->coverage};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        if (!all[i] || !all[i][0] || pattern_is_numbered(all[i])) continue;
        snprintf(
            message, OPTION_ERROR_BYTES,
            "'%.200s': frames need numbered files: one %%d, %%4d or %%04d in the name, %%%% for a percent "
            "sign",
            all[i]);
        return false;
    }
    return true;
}

/// Names the files of frame `index`; false after reporting.
static bool number_files(cli_session *session, const picture_paths *paths, size_t index, frame_files *files) {
    files->paths.color = paths->color ? files->color : NULL;
    const char *const from[] = {paths->color, paths->depth, paths->normal, paths->coverage};
    char *const to[] = {files->color, files->paths.depth, files->paths.normal, files->paths.coverage};
    for (size_t i = 0; i < sizeof from / sizeof from[0]; i++) {
        if (from[i] && !pattern_expand(from[i], index, sizeof files->color, to[i])) {
            session_fail(session, "%.200s: the path is too long", from[i]);
            return false;
        }
    }
    return true;
}

_Static_assert(sizeof((frame_files){0}.color) == sizeof((frame_files){0}.paths.depth),
               "number_files() takes all for one size");

bool sequence_check(cli_session *session, const picture_paths *paths) {
    frame_files files;
    return number_files(session, paths, 0, &files) && picture_check_paths(session, &files.paths);
}

/// Draws and writes frame `index`; false after reporting.
static bool draw_frame(cli_session *session, const sequence_output *output, const frame_cameras *frames,
                       size_t index, ewa_renderer *renderer, const ewa_surfels *surfels,
                       const ewa_render_options *options, cli_picture *picture, cli_video *video,
                       render_report *report) {
    const ewa_camera *camera = &frames->cameras[index];
    frame_files files = {.paths = *output->paths};
    if (output->numbered && !number_files(session, output->paths, index, &files)) return false;
    session->subject = NULL;
    ewa_render_stats stats = {.splat_count = 0};
    const double started_s = clock_now_s();
    const ewa_status status = ewa_render(renderer, surfels, camera, options, &picture->frame, &stats);
    const double drawn_s = clock_now_s();
    if (status != EWA_OK) {
        session_failed(session, status);
        return false;
    }
    return (!output->film || video_put(session, video, picture->rgba8)) &&
           picture_save(session, &files.paths, camera, output->opaque, picture) &&
           render_report_add(session, report, index, frames->count, &stats, drawn_s - started_s,
                             clock_now_s() - drawn_s);
}

/// Whether all frames have one size, which a film needs; false after reporting.
static bool check_sizes(cli_session *session, const char *film, const frame_cameras *frames) {
    const ewa_camera *first = frames->cameras;
    for (size_t i = 1; i < frames->count; i++) {
        const ewa_camera *camera = &frames->cameras[i];
        if (camera->width_px == first->width_px && camera->height_px == first->height_px) continue;
        session_fail(session,
                     "%s: a film has one size, but frame 0 has %u x %u pixels and frame %zu has %u x %u; "
                     "--size WxH makes them the same",
                     film, first->width_px, first->height_px, i, camera->width_px, camera->height_px);
        return false;
    }
    return true;
}

/// Draws all frames with what is made; false after reporting.
static bool draw_frames(cli_session *session, const sequence_output *output, const frame_cameras *frames,
                        ewa_renderer *renderer, const ewa_surfels *surfels, const ewa_render_options *options,
                        cli_video *video, render_report *report) {
    cli_picture picture = {.rgba8 = NULL};
    bool done = true;
    for (size_t i = 0; i < frames->count && done; i++) {
        const ewa_camera *camera = &frames->cameras[i], *last = i ? camera - 1 : NULL;
        if (!last || camera->width_px != last->width_px || camera->height_px != last->height_px) {
            picture_free(&picture);
            done = picture_make(session, output->paths, camera, &picture);
        }
        done = done &&
               draw_frame(session, output, frames, i, renderer, surfels, options, &picture, video, report) &&
               (!output->numbered || session_step(session, "frame", i + 1, frames->count));
    }
    picture_free(&picture);
    return done;
}

bool sequence_draw(cli_session *session, const sequence_output *output, const frame_cameras *frames,
                   const ewa_surfels *surfels, const ewa_render_options *options, render_report *report) {
    const video_settings settings = {.width_px = frames->cameras->width_px,
                                     .height_px = frames->cameras->height_px,
                                     .frames_per_s = output->frames_per_s,
                                     .quality = output->quality,
                                     .opaque = output->opaque};
    ewa_renderer *renderer = NULL;
    cli_video video = {.process = 0};
    const ewa_status status = ewa_renderer_create(session->context, &renderer);
    if (status != EWA_OK) session_failed(session, status);
    bool done = status == EWA_OK &&
                (!output->film || (check_sizes(session, output->film, frames) &&
                                   video_start(session, output->film, &settings, &video))) &&
                draw_frames(session, output, frames, renderer, surfels, options, &video, report);
    if (done && output->film) {
        const double started_s = clock_now_s();
        done = video_finish(session, &video);
        report->write_s += clock_now_s() - started_s;
    }
    video_drop(&video);
    ewa_renderer_destroy(&renderer);
    return done;
}
