// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Keyframes, and films on the smooth way through them: frames are drawn one at a time between two pictures of the window, each
// as a picture that is saved, so that the window goes on and the film can be given up.
#include "inner.h"
#include "navigate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/// Frames from one keyframe to the next where nobody says.
enum { FRAMES_PER_KEY = 60, MAX_FRAMES = 1000000, MAX_SIDE_PX = 65536 };

/// Luminance of a middle grey.
static const float MIDDLE_LUMINANCE = 0.18f;

static const char TOO_FEW[] = "a film goes through two keyframes at least: keyframe add";

static bool take_number(viewer *v, const char *text, uint32_t *index) {
    char *end;
    const unsigned long number = strtoul(text, &end, 10);
    *index = (uint32_t)number;
    if (*text >= '0' && *text <= '9' && !*end && number < v->film.key_count) return true;
    viewer_tell(v, "keyframe: '%s' is not the number of a keyframe", text);
    return false;
}

static bool add_key(viewer *v) {
    viewer_film *film = &v->film;
    if (film->key_count == EWA_MAX_KEYFRAMES) {
        viewer_tell(v, "keyframe: there are %d already", EWA_MAX_KEYFRAMES);
        return false;
    }
    film->keys[film->key_count++] = v->camera;
    film->at = film->key_count - 1;
    viewer_note(v, "keyframe %u", film->key_count);
    return true;
}

static bool delete_keys(viewer *v, const char *word) {
    viewer_film *film = &v->film;
    uint32_t index = 0;
    if (strcmp(word, "all") == 0) {
        film->key_count = 0;
        return true;
    }
    if (!take_number(v, word, &index)) return false;
    film->key_count--;
    memmove(&film->keys[index], &film->keys[index + 1], (film->key_count - index) * sizeof film->keys[0]);
    return true;
}

/// Writes the keyframes as --path of the program reads them.
static bool save_keys(viewer *v, const char *path) {
    const ewa_status status = ewa_camera_save_list(v->probe.context, v->film.keys, v->film.key_count, path);
    if (status != EWA_OK)
        viewer_tell(v, "%s: the keyframes cannot be saved: %s", path, ewa_status_name(status));
    else
        viewer_say(v, "keyframes %u %s", v->film.key_count, path);
    return status == EWA_OK;
}

/// Makes the way through the keyframes in a size of the picture.
static ewa_status make_way(viewer *v, uint32_t width_px, uint32_t height_px, ewa_camera_path **way) {
    ewa_camera keys[EWA_MAX_KEYFRAMES];
    for (uint32_t i = 0; i < v->film.key_count; i++) {
        keys[i] = v->film.keys[i];
        ewa_camera_resize(&keys[i], EWA_RESIZE_HEIGHT, width_px, height_px);
    }
    v->probe.message[0] = 0;
    return ewa_camera_path_create(v->probe.context, keys, v->film.key_count, false, way);
}

bool film_look(viewer *v, double at) {
    viewer_film *film = &v->film;
    const double last = film->key_count ? (double)film->key_count - 1 : 0;
    ewa_camera_path *way = NULL;
    film->at = at < last ? at : last;
    if (make_way(v, v->camera.width_px, v->camera.height_px, &way) == EWA_OK) (void)ewa_camera_path_at(way, film->at, &v->camera);
    ewa_camera_path_destroy(&way);
    viewer_change(v);
    return film->at < last;
}

/// Looks from a keyframe, on the way there, or from a place between two of them.
static bool go_to(viewer *v, const char *text) {
    char end;
    double at;
    if (sscanf(text, "%lf%c", &at, &end) != 1 || !(at >= 0 && v->film.key_count && at <= v->film.key_count - 1)) {
        viewer_tell(v, "keyframe: '%s' is neither a keyframe nor between two", text);
        return false;
    }
    v->placed = true;
    v->animated = false;
    if (at != floor(at)) {
        (void)film_look(v, at);
        return true;
    }
    ewa_camera to = v->film.keys[(uint32_t)at];
    ewa_camera_resize(&to, EWA_RESIZE_HEIGHT, v->camera.width_px, v->camera.height_px);
    v->film.at = at;
    viewer_go(v, &to);
    return true;
}

/// Has the camera travel through the keyframes; again: it stays where it is.
static bool preview(viewer *v) {
    const bool stops = v->animated && v->film.previews;
    if (v->film.key_count < 2) {
        viewer_tell(v, "film: %s", TOO_FEW);
        return false;
    }
    v->placed = true;
    v->film.previews = v->animated = !stops;
    v->animation_s = v->now_s;
    viewer_change(v);
    return true;
}

bool film_keyframe(viewer *v, const char *rest) {
    if (v->film.active) {
        viewer_tell(v, "keyframe: a film is being made of them");
        return false;
    }
    if (strcmp(rest, "add") == 0) return add_key(v);
    if (strncmp(rest, "delete ", 7) == 0) return delete_keys(v, rest + 7);
    if (strncmp(rest, "save ", 5) == 0 && v->film.key_count) return save_keys(v, rest + 5);
    if (strncmp(rest, "go ", 3) == 0) return go_to(v, rest + 3);
    viewer_tell(v, "keyframe: '%s' is none of add, go N, delete N|all, and, where there are some, save FILE.json", rest);
    return false;
}

static void end(viewer *v, bool whole) {
    viewer_film *film = &v->film;
    const viewer_services *services = &v->services;
    const bool done = services->film_end(services->user, whole) && whole;
    film->active = false;
    ewa_camera_path_destroy(&film->way);
    free(film->rgba8);
    film->rgba8 = NULL;
    if (done) {
        viewer_say(v, "film %s %u %ux%u", film->path, film->count, film->width_px, film->height_px);
        viewer_note(v, "film saved: %s", film->path);
    } else {
        viewer_tell(v, "%s: the film %s", film->path, whole ? "cannot be finished" : "was given up");
    }
}

void film_step(viewer *v) {
    viewer_film *film = &v->film;
    if (!film->active) return;
    ewa_camera camera;
    const double length = (double)film->key_count - 1;
    ewa_status status = ewa_camera_path_at(film->way, film->frame ? length * (double)film->frame / ((double)film->count - 1) : 0, &camera);
    if (status == EWA_OK) status = shot_draw(v, &camera, film->ink, film->rgba8);
    if (status != EWA_OK || !v->services.film_put(v->services.user, film->rgba8))
        end(v, false);
    else if (++film->frame == film->count)
        end(v, true);
}

void film_free(viewer *v) {
    if (v->film.active) end(v, false);
}

/// One ink for all frames, which must not change from one to the next.
static ewa_ink steady_ink(const viewer *v) {
    if (v->furniture.ink != EWA_INK_AUTO) return v->furniture.ink;
    const float *c = v->render.background, luminance = 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
    return c[3] * luminance + (1 - c[3]) > MIDDLE_LUMINANCE ? EWA_INK_DARK : EWA_INK_LIGHT;
}

static bool choose_name(char path[VIEWER_PATH_BYTES]) {
    for (int i = 1; i < 10000; i++) {
        snprintf(path, VIEWER_PATH_BYTES, "ewa-%04d.mp4", i);
        if (access(path, F_OK) != 0) return true;
    }
    return false;
}

static bool begin(viewer *v) {
    viewer_film *film = &v->film;
    film->frame = 0;
    film->ink = steady_ink(v);
    film->rgba8 = malloc(4 * (size_t)film->width_px * film->height_px);
    ewa_status status = film->rgba8 ? make_way(v, film->width_px, film->height_px, &film->way) : EWA_ERROR_MEMORY;
    const viewer_services *services = &v->services;
    film->active = status == EWA_OK && services->film_begin(services->user, film->path, film->width_px, film->height_px,
                                                            v->render.background[3] == 1);
    if (film->active) return true;
    ewa_camera_path_destroy(&film->way);
    free(film->rgba8);
    film->rgba8 = NULL;
    viewer_tell(v, "%s: the film cannot be begun%s%s", film->path, status != EWA_OK ? ": " : "",
                status != EWA_OK ? v->probe.message[0] ? v->probe.message : ewa_status_name(status) : "");
    return false;
}

bool film_command(viewer *v, const char *rest) {
    viewer_film *film = &v->film;
    if (strcmp(rest, "stop") == 0) {
        film_free(v);
        return true;
    }
    if (strcmp(rest, "preview") == 0) return preview(v);
    if (film->active || !v->services.film_begin || film->key_count < 2) {
        viewer_tell(v, "film: %s", film->active             ? "one is being made"
                                   : film->key_count < 2    ? TOO_FEW
                                                            : "films are not made here");
        return false;
    }
    film->path[0] = 0;
    film->count = FRAMES_PER_KEY * (film->key_count - 1) + 1;
    film->width_px = v->camera.width_px, film->height_px = v->camera.height_px;
    char word[VIEWER_PATH_BYTES], after;
    for (int used = 0; sscanf(rest, "%4095s%n", word, &used) == 1; rest += used) {
        unsigned a, b;
        if (sscanf(word, "%ux%u%c", &a, &b, &after) == 2)
            film->width_px = a, film->height_px = b;
        else if (sscanf(word, "%u%c", &a, &after) == 1)
            film->count = a;
        else { // names may have spaces
            const size_t length = strlen(film->path);
            snprintf(film->path + length, sizeof film->path - length, "%s%s", length ? " " : "", word);
        }
    }
    if (film->count < 2 || film->count > MAX_FRAMES || !film->width_px || !film->height_px || film->width_px > MAX_SIDE_PX ||
        film->height_px > MAX_SIDE_PX) {
        viewer_tell(v, "film: 2 to %d frames of at most %d x %d pixels, not %u of %u x %u", MAX_FRAMES, MAX_SIDE_PX, MAX_SIDE_PX,
                    film->count, film->width_px, film->height_px);
        return false;
    }
    if (!film->path[0] && !choose_name(film->path)) {
        viewer_tell(v, "film: there are films ewa-0001.mp4 to ewa-9999.mp4 already");
        return false;
    }
    if (!begin(v)) return false;
    while (v->waits && film->active) film_step(v);
    return true;
}
