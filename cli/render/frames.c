// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Many pictures of one cloud: turntables and camera paths, numbered files and films.
#include "cli/render/frames.h"
#include "cli/base/pattern.h"
#include "cli/input/camera_input.h"
#include "cli/render/video.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const cli_option frames_table[] = {
    {"turntable", OPTION_INTEGER, offsetof(frames_arguments, turntable), "N", "[1, 1000000]",
     .help =
         "N frames of one turn about the up axis through --target, starting at the view that the options of "
         "the camera give. Without --eye and --camera, the distance is such that all is in every frame",
     .absent = "none: one picture", .excludes = "path"},
    {"path", OPTION_TEXT, offsetof(frames_arguments, path_file), "FILE",
     .help = "one frame for each camera of a file, in its order, or keyframe of a scene file; formats as --camera",
     .excludes = "camera camera-index eye target up ortho view azimuth elevation"},
    {"frames", OPTION_FRAMES, offsetof(frames_arguments, part), "N|A-B|I/N",
     .help =
         "N frames (1 to 1000000) on a smooth way through the cameras of --path, which are evenly spaced in "
         "time; A-B or I/N: only a part of the film, frames A to B, or every Nth from frame I - 1 (part I of "
         "N), with the numbers and the bytes of the whole. A number and a part may both be given, each by "
         "its own --frames",
     .absent = "all: the cameras as they are, all frames", .needs = "turntable path"},
    {"skip-existing", OPTION_FLAG, offsetof(frames_arguments, skip_existing),
     .help = "leave out frames whose files are all there", .needs = "turntable path"},
    {"loop", OPTION_FLAG, offsetof(frames_arguments, loop),
     .help = "with --frames: the way goes on from the last camera to the first", .needs = "frames"},
    {"fps", OPTION_NUMBER, offsetof(frames_arguments, frames_per_s), "F", "(0, 1000]",
     .help = "frames per second of a film", .absent = "auto: 30"},
    {"quality", OPTION_INTEGER, offsetof(frames_arguments, quality), "Q", "[0, 100]",
     .help = "quality of a film or a JPEG, from 0 (small) to 100 (good)", .absent = "auto: 75, of JPEG 95"},
};

const option_group frames_options = OPTION_GROUP("Frames", frames_table);

void frames_set_defaults(frames_arguments *arguments) {
    view_set_defaults(&arguments->view);
    arguments->quality = -1;
}

bool frames_many(const frames_arguments *arguments) { return arguments->turntable || arguments->path_file; }

/// What is wrong with the output of several frames or one; NULL: nothing.
static const char *check_output(const frames_arguments *arguments, const char *output, bool opaque) {
    const video_format *film = video_find_format(output);
    const bool jpeg = output && path_has_suffix(output, ".jpg|.jpeg");
    if (!film && arguments->frames_per_s > 0) return "--fps is for films: -o FILE.mp4, .webm, .mkv or .gif";
    if (!film && !jpeg && arguments->quality >= 0) return "--quality is for films (.mp4, .webm, .mkv) and JPEG (.jpg)";
    if (film && arguments->skip_existing) return "--skip-existing is for numbered files, not for films";
    if (film && arguments->part.kind == PART_ROBIN)
        return "--frames I/N: a film of every Nth frame jumps; say A-B, or write numbered files";
    if (film && !video_has_quality(film) && arguments->quality >= 0)
        return "--quality: .gif has one quality only";
    if (film && !frames_many(arguments)) return "--output: a film needs --turntable or --path";
    if (film && !video_has_alpha(film) && !opaque)
        return "--background: this film has no transparency; .webm has, and so have numbered pictures";
    if (jpeg && !opaque)
        return "--background: JPEG has no transparency; .png has";
    if (!film && frames_many(arguments) && !pattern_is_numbered(output))
        return "--output: frames go to a film (.mp4, .webm, .mkv, .gif) or to numbered files: one %d, %4d or "
               "%04d in the name, %% for a percent sign";
    return NULL;
}

/// What is wrong with --frames; false then.
static bool check_part(const frames_arguments *arguments, char message[OPTION_ERROR_BYTES]) {
    const film_part *part = &arguments->part;
    const int64_t count = arguments->path_file ? part->count : arguments->turntable;
    char problem[PART_ERROR_BYTES];
    if (part->count && !arguments->path_file) {
        snprintf(message, OPTION_ERROR_BYTES,
                 "--frames N needs --path; a part of a turntable is A-B, such as %" PRId64 "-%" PRId64
                 " for one frame, or I/N",
                 part->count, part->count);
        return false;
    }
    if (arguments->loop && !part->count) return options_fine("--loop needs --frames N", message);
    if (count && part_is_beyond(part, (uint64_t)count, problem)) {
        snprintf(message, OPTION_ERROR_BYTES, "--frames: %s", problem);
        return false;
    }
    return true;
}

bool frames_check(const frames_arguments *arguments, const char *output, bool opaque,
                  char message[OPTION_ERROR_BYTES]) {
    const bool poses = arguments->path_file && camera_input_is_poses(arguments->path_file);
    const char *wrong = check_output(arguments, output, opaque);
    if (!wrong && arguments->path_file && !poses && arguments->view.fov_deg > 0)
        wrong = "--path and --fov exclude each other, but for poses (.txt, .log, .tum): the file has lenses";
    return options_fine(wrong, message) && check_part(arguments, message) &&
           view_check(&arguments->view, poses, message);
}

/// Makes room for the cameras of all frames; false after reporting.
static bool allocate(cli_session *session, frame_cameras *frames) {
    frames->cameras = calloc(frames->count, sizeof *frames->cameras);
    if (!frames->cameras) session_fail(session, "out of memory for %zu cameras", frames->count);
    return frames->cameras != NULL;
}

static bool make_turntable(cli_session *session, const frames_arguments *arguments,
                           const view_subject *subject, frame_cameras *frames) {
    const size_t count = frames->count;
    ewa_camera first;
    view_turn turn;
    if (!allocate(session, frames) || !view_make(session, &arguments->view, subject, &first, &turn))
        return false;
    ewa_status status = EWA_OK;
    for (size_t i = 0; i < count && status == EWA_OK; i++) {
        frames->cameras[i] = first;
        status = ewa_camera_orbit(&frames->cameras[i], turn.pivot_world, turn.axis_world,
                                  360 * (double)i / (double)count);
    }
    return session_passed(session, status);
}

/// Cameras as they come from a file.
typedef struct camera_keys {
    ewa_camera *cameras;
    size_t count, capacity;
    bool full; // out of memory
} camera_keys;

static void take_key(void *user, uint32_t index, const ewa_camera *camera) {
    (void)index;
    camera_keys *keys = user;
    if (keys->count == keys->capacity && !keys->full) {
        const size_t capacity = keys->capacity ? 2 * keys->capacity : 64;
        ewa_camera *larger = realloc(keys->cameras, capacity * sizeof *larger);
        keys->full = !larger;
        if (!larger) return;
        keys->cameras = larger;
        keys->capacity = capacity;
    }
    if (!keys->full) keys->cameras[keys->count++] = *camera;
}

/// Puts frames on the smooth way through the keys.
static ewa_status interpolate(cli_session *session, const frames_arguments *arguments,
                              const camera_keys *keys, frame_cameras *frames) {
    ewa_camera_path *path = NULL;
    ewa_status status =
        ewa_camera_path_create(session->context, keys->cameras, keys->count, arguments->loop, &path);
    // A loop's last frame is the one before the first.
    const double length = (double)keys->count - !arguments->loop;
    const double steps = arguments->loop ? (double)frames->count : (double)frames->count - 1;
    for (size_t i = 0; i < frames->count && status == EWA_OK; i++)
        status = ewa_camera_path_at(path, i ? length * (double)i / steps : 0, &frames->cameras[i]);
    ewa_camera_path_destroy(&path);
    return status;
}

/// Loads the cameras of --path, scaled to --size. Returns false after reporting.
static bool load_keys(cli_session *session, const frames_arguments *arguments, camera_keys *keys) {
    const char *path = arguments->path_file;
    ewa_camera lens;
    if (!view_load_lens(session, &arguments->view, path, &lens) ||
        !camera_input_load_each(session, path, &lens, take_key, keys))
        return false;
    if (keys->full) session_fail(session, "%s: out of memory for the cameras", path);
    session->subject = path;
    ewa_status status = keys->full ? EWA_ERROR_MEMORY : EWA_OK;
    for (size_t i = 0; i < keys->count && status == EWA_OK; i++) {
        view_resize(&keys->cameras[i], &arguments->view.size);
        status = ewa_camera_check(session->context, &keys->cameras[i]);
    }
    return session_passed(session, status);
}

static bool make_path(cli_session *session, const frames_arguments *arguments, frame_cameras *frames) {
    camera_keys keys = {.count = 0};
    bool done = load_keys(session, arguments, &keys);
    if (done && arguments->part.count) {
        frames->count = (size_t)arguments->part.count;
        done = allocate(session, frames);
        const ewa_status status = done ? interpolate(session, arguments, &keys, frames) : EWA_OK;
        if (status != EWA_OK) session_failed(session, status);
        done = done && status == EWA_OK;
        free(keys.cameras);
    } else {
        frames->cameras = keys.cameras;
        frames->count = keys.count;
    }
    session->subject = NULL;
    return done;
}

bool frames_plan(cli_session *session, const frames_arguments *arguments, frames_exist *exist,
                 const void *user, frame_cameras *frames) {
    const film_part *part = &arguments->part;
    *frames = (frame_cameras){.count = arguments->turntable ? (size_t)arguments->turntable : 1};
    if (arguments->path_file && !make_path(session, arguments, frames)) return false;
    char problem[PART_ERROR_BYTES];
    frames->beyond = part_is_beyond(part, frames->count, problem);
    if (frames->beyond) {
        session_fail(session, "--frames: %s", problem);
        return false;
    }
    frames->chosen = calloc(frames->count, sizeof *frames->chosen);
    if (!frames->chosen) {
        session_fail(session, "out of memory for %zu frames", frames->count);
        return false;
    }
    size_t there_count = 0;
    for (size_t i = 0; i < frames->count; i++) {
        if (!part_has(part, i)) continue;
        const bool there = arguments->skip_existing && exist(user, i);
        there_count += there;
        if (!there) frames->chosen[frames->chosen_count++] = i;
    }
    if (there_count)
        session_say(session, "%zu of %zu frames are there and left out", there_count,
                    there_count + frames->chosen_count);
    if (!there_count && !frames->chosen_count)
        session_note(session, "part %" PRIu64 " of %" PRIu64 " has no frames: the film has %zu", part->index,
                     part->parts, frames->count);
    return true;
}

bool frames_make(cli_session *session, const frames_arguments *arguments, const view_subject *subject,
                 frame_cameras *frames) {
    if (arguments->path_file) return true; // the plan has them
    if (arguments->turntable) return make_turntable(session, arguments, subject, frames);
    return allocate(session, frames) && view_make(session, &arguments->view, subject, frames->cameras, NULL);
}

void frames_free(frame_cameras *frames) {
    free(frames->cameras);
    free(frames->chosen);
    *frames = (frame_cameras){.count = 0};
}

bool frames_save(cli_session *session, const char *path, const frame_cameras *frames, bool many) {
    session->subject = path;
    const ewa_status status =
        many ? ewa_camera_save_list(session->context, frames->cameras, frames->count, path)
             : ewa_camera_save(session->context, frames->cameras, path);
    if (status != EWA_OK) session_failed(session, status);
    session->subject = NULL;
    return status == EWA_OK;
}
