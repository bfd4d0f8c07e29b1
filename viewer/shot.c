// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What leaves the viewer: pictures of any size, cameras.
#include "inner.h"
#include "navigate.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/// Notes where a file is that was saved.
static void note_file(viewer *v, const char *what, const char *path) {
    char folder[VIEWER_TEXT_BYTES];
    if (path[0] != '/' && getcwd(folder, sizeof folder))
        viewer_note(v, "%s saved: %s/%s", what, folder, path);
    else
        viewer_note(v, "%s saved: %s", what, path);
}

/// Draws a scene that is prepared, in a camera of any size, with the same look.
static ewa_status draw_scene(viewer *v, paint_scene *scene, const ewa_camera *camera, ewa_ink ink, uint8_t *rgba8) {
    const double larger = (double)camera->height_px / scene->camera.height_px;
    ewa_render_options *render = &scene->options.render;
    const double point_size_px = larger * render->point_size_px;
    if (render->point_size_px > 0) render->point_size_px = point_size_px < 1 ? 1 : point_size_px > 256 ? 256 : point_size_px;
    scene->options.lod.load_s = v->lod.load_s; // time is the window's matter: all is read that the picture needs
    scene->camera = *camera;
    const ewa_status status = paint_scene_draw(&v->probe, scene, &(ewa_frame){.rgba8 = rgba8}, NULL);
    if (status == EWA_OK) overlay_draw(v, &scene->camera, ink, true, rgba8);
    return status;
}

ewa_status shot_draw(viewer *v, const ewa_camera *camera, ewa_ink ink, uint8_t *rgba8) {
    paint_scene scene;
    viewer_scene(v, &scene);
    scene.options.many_frames = true;
    return draw_scene(v, &scene, camera, ink, rgba8);
}

static bool save_picture(viewer *v, const char *path, uint32_t width_px, uint32_t height_px, bool transparent) {
    paint_scene scene;
    viewer_scene(v, &scene);
    ewa_camera camera = scene.camera;
    ewa_camera_resize(&camera, EWA_RESIZE_HEIGHT, width_px, height_px);
    for (int c = 0; c < 4 && transparent; c++) scene.options.render.background[c] = 0;
    uint8_t *rgba8 = malloc(4 * (size_t)width_px * height_px);
    ewa_status status = rgba8 ? draw_scene(v, &scene, &camera, v->furniture.ink, rgba8) : EWA_ERROR_MEMORY;
    // Opaque ones have three channels, as those of the program: they are the same file.
    const uint32_t channel_count = scene.options.render.background[3] == 1 ? 3 : 4;
    for (size_t i = 0; status == EWA_OK && channel_count == 3 && i < (size_t)width_px * height_px; i++)
        memmove(rgba8 + 3 * i, rgba8 + 4 * i, 3);
    if (status == EWA_OK)
        status = ewa_pixels_save(v->probe.context, path, width_px, height_px, channel_count, rgba8, channel_count * (size_t)width_px, NULL);
    free(rgba8);
    if (status != EWA_OK)
        viewer_tell(v, "%s: the picture cannot be saved: %s", path,
                    v->probe.message[0] ? v->probe.message : ewa_status_name(status));
    else
        viewer_say(v, "shot %s %ux%u", path, width_px, height_px);
    if (status == EWA_OK) note_file(v, "picture", path);
    return status == EWA_OK;
}

/// A name that is not taken yet.
static bool choose_name(char path[VIEWER_PATH_BYTES]) {
    for (int i = 1; i < 10000; i++) {
        snprintf(path, VIEWER_PATH_BYTES, "ewa-%04d.png", i);
        if (access(path, F_OK) != 0) return true;
    }
    return false;
}

bool shot_command(viewer *v, const char *rest) {
    char path[VIEWER_PATH_BYTES], word[VIEWER_PATH_BYTES];
    uint32_t width_px = v->camera.width_px, height_px = v->camera.height_px;
    bool transparent = false, named = false;
    path[0] = 0;
    for (int used = 0; sscanf(rest, "%4095s%n", word, &used) == 1; rest += used) {
        unsigned wide, high;
        char end;
        if (strcmp(word, "transparent") == 0) {
            transparent = true;
        } else if (sscanf(word, "%ux%u%c", &wide, &high, &end) == 2) {
            if (!wide || !high || wide > 65536 || high > 65536) {
                viewer_tell(v, "shot: %s is not a size from 1x1 to 65536x65536", word);
                return false;
            }
            width_px = wide, height_px = high;
        } else {
            snprintf(path, sizeof path, "%s", word);
            named = true;
        }
    }
    if (!named && !choose_name(path)) {
        viewer_tell(v, "shot: there are pictures ewa-0001.png to ewa-9999.png already");
        return false;
    }
    return save_picture(v, path, width_px, height_px, transparent);
}

/// Reads a whole file of text that fits.
static bool read_text(const char *path, char *text, size_t text_bytes) {
    FILE *file = fopen(path, "r");
    if (!file) return false;
    const size_t got = fread(text, 1, text_bytes - 1, file);
    text[got] = 0;
    return fclose(file) == 0 && got > 0;
}

/// Writes or reads the camera's file through the library, whose format it is.
static bool save_camera(viewer *v, const char *path) {
    const ewa_status status = ewa_camera_save(v->probe.context, &v->camera, path);
    if (status != EWA_OK)
        viewer_tell(v, "%s: the camera cannot be saved: %s", path,
                    v->probe.message[0] ? v->probe.message : ewa_status_name(status));
    return status == EWA_OK;
}

static bool load_camera(viewer *v, const char *path, const char *name) {
    ewa_camera camera;
    const ewa_status status = ewa_camera_load(v->probe.context, path, 0, &camera);
    if (status != EWA_OK) {
        viewer_tell(v, "%s: no camera can be read: %s", name,
                    v->probe.message[0] ? v->probe.message : ewa_status_name(status));
        return false;
    }
    ewa_camera_resize(&camera, EWA_RESIZE_HEIGHT, v->camera.width_px, v->camera.height_px);
    v->placed = true;
    v->animated = false;
    v->camera = camera;
    viewer_change(v);
    return true;
}

static bool copy_camera(viewer *v) {
    char path[OWN_PATH_BYTES];
    if (!own_files_make(v, "camera", "", path)) return false;
    const bool done = save_camera(v, path) && read_text(path, v->clipboard, sizeof v->clipboard);
    own_files_drop(v, path);
    if (done && v->services.clipboard_set) v->services.clipboard_set(v->services.user, v->clipboard);
    if (done) viewer_note(v, "camera copied, as the JSON that --camera reads");
    return done;
}

static bool paste_camera(viewer *v) {
    char path[OWN_PATH_BYTES], text[4 * VIEWER_TEXT_BYTES];
    snprintf(text, sizeof text, "%s", v->clipboard);
    if (v->services.clipboard_get && !v->services.clipboard_get(v->services.user, text, sizeof text))
        text[0] = 0;
    if (!text[0]) {
        viewer_tell(v, "camera: there is no text to paste");
        return false;
    }
    if (!own_files_make(v, "camera", "", path)) return false;
    FILE *file = fopen(path, "w");
    bool done = file && fputs(text, file) >= 0;
    if (file) done = fclose(file) == 0 && done;
    done = done && load_camera(v, path, "the text that was copied");
    own_files_drop(v, path);
    if (done) viewer_note(v, "camera pasted");
    return done;
}

bool shot_scene(viewer *v, const char *rest) {
    const char *path = rest + 5;
    if (strncmp(rest, "save ", 5) != 0 || !*path) {
        viewer_tell(v, "scene: '%s' is not save FILE.json", rest);
        return false;
    }
    if (loader_is_busy(v->loader)) {
        viewer_tell(v, "%s: not everything is loaded yet", path);
        return false;
    }
    for (size_t i = 0; i < v->item_count; i++) {
        if (photos_is_changed(v, i)) {
            viewer_tell(v, "%s: the colours of %s are in no file yet: photos %zu save FILE.ply", path, v->items[i].name, i);
            return false;
        }
        if (transfers_is_changed(v, i)) {
            viewer_tell(v, "%s: the transfer function of %s is in no file yet: transfer %zu save FILE.json", path, v->items[i].name, i);
            return false;
        }
    }
    paint_scene shown;
    viewer_scene(v, &shown);
    shown.options.lod.load_s = v->lod.load_s; // time is the window's matter
    ewa_scene *scene = NULL;
    v->probe.message[0] = 0;
    ewa_status status = ewa_scene_copy(v->scene, v->probe.context, &scene);
    if (status == EWA_OK) status = ewa_scene_set_options(scene, &shown.options);
    if (status == EWA_OK) status = ewa_scene_set_measures(scene, v->measure_list, (uint32_t)v->measure_count);
    if (status == EWA_OK) status = ewa_scene_set_keyframes(scene, v->film.keys, v->film.key_count);
    if (status == EWA_OK) status = ewa_scene_save(scene, &v->camera, path);
    ewa_scene_destroy(&scene);
    if (status != EWA_OK)
        viewer_tell(v, "%s: the scene cannot be saved: %s", path,
                    v->probe.message[0] ? v->probe.message : ewa_status_name(status));
    else
        viewer_say(v, "scene %s", path);
    if (status == EWA_OK) note_file(v, "scene", path);
    return status == EWA_OK;
}

bool shot_camera(viewer *v, const char *rest) {
    if (strcmp(rest, "copy") == 0) return copy_camera(v);
    if (strcmp(rest, "paste") == 0) return paste_camera(v);
    if (strncmp(rest, "save ", 5) == 0) {
        const bool done = save_camera(v, rest + 5);
        if (done) note_file(v, "camera", rest + 5);
        return done;
    }
    if (strncmp(rest, "load ", 5) == 0) return load_camera(v, rest + 5, rest + 5);
    viewer_tell(v, "camera: '%s' is not copy, paste, save FILE or load FILE", rest);
    return false;
}
