// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Drawing one picture or many with one renderer, into files, numbered files or a film.
#include "cli/render/sequence.h"
#include "cli/base/pattern.h"
#include "cli/render/video.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

/// Frames that are written at the same time, at most: each holds its planes. Of a film alone one goes to ffmpeg while the next
/// is drawn.
enum { MAX_SLOTS = 8, FILM_SLOTS = 2 };

/// The files of one frame.
typedef struct frame_files {
    picture_paths paths;
    char color[1024];
} frame_files;

sequence_output sequence_output_of(const frames_arguments *frames, const char *output,
                                   const picture_paths *paths, bool opaque) {
    return (sequence_output){
        .paths = paths,
        .numbered = frames_many(frames),
        .film = video_find_format(output) ? output : NULL,
        .source = frames->path_file ? frames->path_file : frames->view.camera_path,
        .frames_per_s = frames->frames_per_s > 0 ? frames->frames_per_s : VIDEO_FRAMES_PER_S,
        .quality = frames->quality >= 0 ? (int)frames->quality : VIDEO_QUALITY,
        .opaque = opaque,
    };
}

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

/// Names the files of frame `index`; returns NULL, or the path that is too long then.
static const char *number_files(const picture_paths *paths, size_t index, frame_files *files) {
    files->paths.color = paths->color ? files->color : NULL;
    const char *const from[] = {paths->color, paths->depth, paths->normal, paths->coverage};
    char *const to[] = {files->color, files->paths.depth, files->paths.normal, files->paths.coverage};
    for (size_t i = 0; i < sizeof from / sizeof from[0]; i++) {
        if (from[i] && !pattern_expand(from[i], index, sizeof files->color, to[i])) return from[i];
    }
    return NULL;
}

_Static_assert(sizeof((frame_files){0}.color) == sizeof((frame_files){0}.paths.depth),
               "number_files() takes all for one size");

/// A file that is there and not empty; whole, as files appear here. Others may have made an empty one to hold its
/// place.
static bool is_there(const char *path) {
    struct stat facts;
    return stat(path, &facts) == 0 && S_ISREG(facts.st_mode) && facts.st_size > 0;
}

bool sequence_exists(const void *user, size_t index) {
    const picture_paths *paths = user;
    frame_files files = {.paths = *paths};
    if (number_files(paths, index, &files)) return false; // which the drawing reports
    const char *const all[] = {files.paths.color, files.paths.depth, files.paths.normal,
                               files.paths.coverage};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        if (all[i] && all[i][0] && !is_there(all[i])) return false;
    return true;
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

/// Whose turn it is to go to ffmpeg, which takes frames in their order from whatever thread.
typedef struct film_queue {
    cli_video video;
    pthread_mutex_t mutex;
    pthread_cond_t moved;
    size_t next;  ///< place of the frame that goes next
    bool stopped; ///< one could not: none after it does
} film_queue;

/// A frame on its way: drawn by the main thread, written by one of its own. Everything that writing touches
/// is of the context of the slot.
typedef struct frame_slot {
    cli_session *session, own; ///< the program's, or its own beside a thread
    film_queue *film;          ///< NULL: no film
    cli_picture picture;
    frame_files files;
    const ewa_camera *camera;
    pthread_t thread;
    bool busy, threaded; ///< a frame has to be collected; by waiting for the thread
    bool saved, opaque;
    size_t place, index; ///< of the frame, among those that are drawn, and in the film
    double render_s, write_s;
    ewa_render_stats stats;
} frame_slot;

/// All that the drawing of a sequence works on.
typedef struct sequence {
    cli_session *session;
    const sequence_output *output;
    const frame_cameras *frames;
    const frame_painter *painter;
    film_queue film;
    frame_slot slots[MAX_SLOTS];
    size_t slot_count;
    render_report *report;
    bool *written;                   ///< of each frame that is drawn: its files are there
    size_t empty_count, first_empty; ///< frames that show nothing
    bool mute;                       ///< another process writes the frames
    char subject[1024];              ///< names the frame that is drawn
} sequence;

/// Waits until the frames before one are with ffmpeg; false when one of them could not be.
static bool await_turn(film_queue *film, size_t place) {
    pthread_mutex_lock(&film->mutex);
    while (film->next != place && !film->stopped) pthread_cond_wait(&film->moved, &film->mutex);
    const bool stopped = film->stopped;
    pthread_mutex_unlock(&film->mutex);
    return !stopped;
}

/// Lets the next frame go, or none.
static void end_turn(film_queue *film, bool put) {
    pthread_mutex_lock(&film->mutex);
    film->next++;
    film->stopped |= !put;
    pthread_cond_broadcast(&film->moved);
    pthread_mutex_unlock(&film->mutex);
}

/// Hands the frame of a slot to ffmpeg, if its files could be written.
static void put_in_turn(frame_slot *slot) {
    slot->saved = await_turn(slot->film, slot->place) && slot->saved;
    const double started_s = clock_now_s();
    slot->saved = slot->saved && video_put(slot->session, &slot->film->video, slot->picture.rgba8);
    slot->write_s += clock_now_s() - started_s;
    end_turn(slot->film, slot->saved);
}

/// The thread of a slot.
static void *save_slot(void *data) {
    frame_slot *slot = data;
    const double started_s = clock_now_s();
    slot->saved = picture_save(slot->session, &slot->files.paths, slot->camera, slot->opaque, &slot->picture);
    slot->write_s = clock_now_s() - started_s;
    if (slot->film) put_in_turn(slot);
    return NULL;
}

/// Waits until the frame of a slot is written and takes note of it; false when it could not be.
static bool collect_slot(sequence *all, frame_slot *slot) {
    if (!slot->busy) return true;
    if (slot->threaded) pthread_join(slot->thread, NULL);
    slot->busy = false;
    all->written[slot->place] = slot->saved;
    if (slot->saved && slot->stats.splat_count > 0 && slot->stats.drawn_count == 0 && all->empty_count++ == 0)
        all->first_empty = slot->index;
    return slot->saved &&
           render_report_add(all->session, all->report, slot->place, all->frames->chosen_count, &slot->stats,
                             slot->render_s, slot->write_s) &&
           (!all->output->numbered ||
            session_step(all->session, "frame", slot->place + 1, all->frames->chosen_count));
}

/// Starts writing what a slot holds.
static void start_saving(sequence *all, frame_slot *slot) {
    slot->busy = true;
    slot->threaded = all->slot_count > 1 && pthread_create(&slot->thread, NULL, save_slot, slot) == 0;
    if (!slot->threaded) save_slot(slot);
}

/// Draws the frame at `place` of those chosen and hands it to a slot; false after reporting.
static bool draw_frame(sequence *all, size_t place) {
    const size_t index = all->frames->chosen[place];
    frame_slot *slot = &all->slots[place % all->slot_count];
    const ewa_camera *camera = &all->frames->cameras[index], *last = slot->camera;
    if (!collect_slot(all, slot)) return false;
    slot->camera = camera;
    const char *source = all->output->source;
    snprintf(all->subject, sizeof all->subject, "%s%sframe %zu", source ? source : "", source ? ": " : "",
             index);
    all->session->subject = all->frames->count > 1 ? all->subject
                            : source               ? source
                                                   : all->output->paths->color;
    slot->session->subject = all->session->subject;
    if (!last || camera->width_px != last->width_px || camera->height_px != last->height_px) {
        picture_free(&slot->picture);
        if (!picture_make(slot->session, all->output->paths, camera, &slot->picture)) return false;
    }
    slot->place = place;
    slot->index = index;
    slot->files.paths = *all->output->paths;
    const char *too_long =
        all->output->numbered ? number_files(all->output->paths, index, &slot->files) : NULL;
    if (too_long) {
        session_fail(all->session, "%.200s: the path is too long", too_long);
        return false;
    }
    const double started_s = clock_now_s();
    const ewa_status status =
        all->painter->paint(all->painter->user, camera, &slot->picture.frame, &slot->stats);
    slot->render_s = clock_now_s() - started_s;
    if (!session_passed(all->session, status)) return false;
    all->session->subject = slot->session->subject = NULL;
    if (all->mute) return all->written[place] = true;
    start_saving(all, slot);
    return true;
}

/// Makes the slots: one picture is written by all workers, many by one each. False after reporting.
static bool make_slots(sequence *all) {
    const picture_paths *paths = all->output->paths;
    const bool writes = paths->color || paths->depth[0] || paths->normal[0] || paths->coverage[0];
    size_t workers = writes ? ewa_context_worker_count(all->session->context) : 1;
    if (all->output->film && workers < FILM_SLOTS) workers = FILM_SLOTS;
    const size_t count = all->frames->chosen_count, wanted = count < workers ? count : workers;
    all->slot_count = wanted < MAX_SLOTS ? wanted : MAX_SLOTS;
    for (size_t i = 0; i < all->slot_count; i++) {
        frame_slot *slot = &all->slots[i];
        slot->session = all->session;
        slot->opaque = all->output->opaque;
        slot->film = all->output->film ? &all->film : NULL;
        if (all->slot_count == 1) continue;
        slot->session = &slot->own;
        slot->own = *all->session;
        // Its messages wipe the bar that the main thread may have drawn.
        slot->own.bar_drawn = all->session->progress;
        slot->own.progress = false;
        slot->own.context = session_context(&slot->own, 1, EWA_CPU_ALL);
        if (!slot->own.context) return false;
    }
    return true;
}

static void free_slots(sequence *all) {
    for (size_t i = 0; i < MAX_SLOTS; i++) {
        frame_slot *slot = &all->slots[i];
        picture_free(&slot->picture);
        ewa_context_destroy(&slot->own.context);
    }
}

static bool draw_all(sequence *all) {
    bool done = true;
    const size_t count = all->frames->chosen_count;
    for (size_t i = 0; i < count && done; i++) done = draw_frame(all, i);
    // In the order of the frames, whether or not one failed.
    for (size_t i = 0; i < MAX_SLOTS; i++)
        done = collect_slot(all, &all->slots[(count + i) % all->slot_count]) && done;
    return done;
}

/// Says which frames of an unfinished sequence are there: whoever goes on need not draw them again.
static void report_written(const sequence *all) {
    char ranges[256] = "";
    const size_t *numbers = all->frames->chosen, drawn_count = all->frames->chosen_count;
    size_t count = 0, used = 0;
    for (size_t i = 0; i < drawn_count;) {
        size_t end = i;
        while (end < drawn_count && all->written[end] && numbers[end] - numbers[i] == end - i) end++;
        count += end - i;
        if (end > i && used < sizeof ranges)
            used +=
                (size_t)snprintf(ranges + used, sizeof ranges - used, end - i > 1 ? "%s%zu to %zu" : "%s%zu",
                                 used ? ", " : "", numbers[i], numbers[end - 1]);
        i = end > i ? end : i + 1;
    }
    all->session->subject = NULL;
    if (count)
        session_note(all->session, "of %zu frames, %zu are written and stay: %s", drawn_count, count, ranges);
    else
        session_note(all->session, "none of %zu frames is written", drawn_count);
}

/// Warns of pictures that show nothing of what there is.
static void report_empty(const sequence *all) {
    const unsigned long long splat_count = all->report->stats.splat_count;
    all->session->subject = NULL;
    if (all->empty_count && all->frames->count > 1)
        session_warn(
            all->session,
            "%zu of %zu frames, the first is %zu, show nothing: their cameras see none of the %llu splats",
            all->empty_count, all->frames->chosen_count, all->first_empty, splat_count);
    else if (all->empty_count)
        session_warn(all->session, "the picture shows nothing: the camera sees none of the %llu splats",
                     splat_count);
}

bool sequence_draw(cli_session *session, const sequence_output *output, const frame_cameras *frames,
                   const frame_painter *painter, render_report *report) {
    if (frames->chosen_count == 0) return true;
    const video_settings settings = {.width_px = frames->cameras->width_px,
                                     .height_px = frames->cameras->height_px,
                                     .frames_per_s = output->frames_per_s,
                                     .quality = output->quality,
                                     .opaque = output->opaque};
    sequence all = {.session = session,
                    .output = output,
                    .frames = frames,
                    .painter = painter,
                    .report = report,
                    .mute =
                        process_group_shares_cloud(session->group) && !process_group_leads(session->group),
                    .film = {.mutex = PTHREAD_MUTEX_INITIALIZER, .moved = PTHREAD_COND_INITIALIZER}};
    all.written = calloc(frames->chosen_count, sizeof *all.written);
    if (!all.written) session_fail(session, "out of memory for %zu frames", frames->chosen_count);
    bool done = all.written && make_slots(&all) &&
                (!output->film || all.mute ||
                 (check_sizes(session, output->film, frames) &&
                  video_start(session, output->film, &settings, &all.film.video))) &&
                draw_all(&all);
    if (done && output->film && !all.mute) {
        const double started_s = clock_now_s();
        done = video_finish(session, &all.film.video);
        report->write_s += clock_now_s() - started_s;
    }
    video_drop(&all.film.video);
    free_slots(&all);
    if (all.written && !done && output->numbered && !output->film) report_written(&all);
    if (done) report_empty(&all);
    free(all.written);
    return done;
}
