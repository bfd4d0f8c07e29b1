// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The profile along a line: its points, the graph over the picture, and their files.
#include "inner.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Of the picture, that the graph takes; points of the window that it keeps from the edges.
static const double GRAPH_WIDTH = 0.64, GRAPH_HEIGHT = 0.4, GRAPH_MARGIN = 10, STATUS_HEIGHT = 28;

/// Of graphs in files, unless somebody says otherwise.
enum { FILE_WIDTH_PX = 1600, FILE_HEIGHT_PX = 900, MAX_SIDE_PX = 65536 };

static void drop_graph(viewer_profile *profile) {
    free(profile->graph);
    profile->graph = NULL;
}

void profile_free(viewer *v) {
    drop_graph(&v->profile);
    ewa_profile_free(&v->profile.of);
    v->profile.shown = false;
}

/// Measures the heights of the points.
static void measure_heights(viewer_profile *profile) {
    const ewa_cloud *points = profile->of.points;
    const uint64_t count = ewa_cloud_point_count(points);
    const double *heights = count ? ewa_cloud_find(points, EWA_PROFILE_HEIGHT)->data : NULL;
    profile->low_height = profile->high_height = count ? heights[0] : 0;
    for (uint64_t i = 0; i < count; i++) {
        profile->low_height = fmin(profile->low_height, heights[i]);
        profile->high_height = fmax(profile->high_height, heights[i]);
    }
}

/// Takes the profile of what is shown along the line.
bool profile_take(viewer *v) {
    viewer_profile *profile = &v->profile;
    if (loader_is_busy(v->loader)) {
        viewer_tell(v, "profile: not everything is loaded yet");
        return false;
    }
    paint_scene shown;
    viewer_scene(v, &shown);
    ewa_profile_options options;
    ewa_profile_options_init(&options, sizeof options);
    options.width_world = profile->width_world;
    ewa_scene *scene = NULL;
    ewa_profile made = {.context = NULL};
    v->probe.message[0] = 0;
    if (shown.octrees) painter_hurry(v->painter);
    if (shown.octrees) v->posted_whole = false;
    if (shown.octrees) turns_take_all(v->turns);
    ewa_status status = ewa_scene_copy(v->scene, v->probe.context, &scene);
    if (status == EWA_OK) status = ewa_scene_set_options(scene, &shown.options);
    if (status == EWA_OK)
        status = ewa_scene_profile(scene, profile->corners_world, profile->corner_count, &options, &made);
    ewa_scene_destroy(&scene);
    if (shown.octrees) turns_give_all(v->turns);
    profile_free(v);
    viewer_mark(v);
    if (status != EWA_OK) {
        viewer_tell(v, "%s", v->probe.message[0] ? v->probe.message : ewa_status_name(status));
        return false;
    }
    profile->of = made;
    profile->shown = true;
    measure_heights(profile);
    viewer_say(v, "profile %llu points length %.9g heights %.9g to %.9g",
               (unsigned long long)ewa_cloud_point_count(made.points), made.length_world, profile->low_height,
               profile->high_height);
    return true;
}

/// Reads a width; without one it stays, or is a hundredth of the scene.
static bool read_width(viewer *v, const char *text) {
    char end;
    double width_world;
    if (!*text) {
        if (!(v->profile.width_world > 0)) v->profile.width_world = 0.01 * v->reach_world;
        return true;
    }
    if (sscanf(text, "%lf%c", &width_world, &end) != 1 || !(width_world > 0 && width_world <= 1e30)) {
        viewer_tell(v, "profile: '%s' is no width", text);
        return false;
    }
    v->profile.width_world = width_world;
    return true;
}

/// Along the two places that were picked, else along the last way that was measured.
static bool take_picks(viewer *v, const char *width) {
    const ewa_measure *way = NULL;
    for (size_t i = 0; i < v->measure_count; i++)
        if (v->measure_list[i].kind == EWA_MEASURE_DISTANCE) way = &v->measure_list[i];
    const bool picked = v->picks[0].given && v->picks[1].given;
    if (!picked && !way) {
        viewer_tell(v, "profile: measure first: click, and click with Shift, or measure a way");
        return false;
    }
    if (!read_width(v, width)) return false;
    viewer_profile *profile = &v->profile;
    for (int k = 0; k < 2 && picked; k++)
        memcpy(profile->corners_world + 3 * k, v->picks[k].place_world, sizeof v->picks[k].place_world);
    if (!picked) memcpy(profile->corners_world, way->places_world, 3 * way->count * sizeof *way->places_world);
    profile->corner_count = picked ? 2 : way->count;
    return profile_take(v);
}

static bool draw_graph(viewer *v, uint32_t width_px, uint32_t height_px, double scale, uint8_t *rgba8) {
    ewa_profile_graph_options options;
    ewa_profile_graph_options_init(&options, sizeof options);
    options.pixel_scale = fmin(scale, 100);
    return ewa_profile_draw(&v->profile.of, &options, &(ewa_canvas){rgba8, width_px, height_px}) == EWA_OK;
}

/// Saves the graph or, by the suffix, the points.
static bool save(viewer *v, const char *rest) {
    char path[VIEWER_PATH_BYTES], end;
    uint32_t width_px = FILE_WIDTH_PX, height_px = FILE_HEIGHT_PX;
    // A size may stand behind; else blanks are the name's.
    const char *last = strrchr(rest, ' ');
    const bool sized = last && sscanf(last, " %ux%u%c", &width_px, &height_px, &end) == 2;
    const size_t length = sized ? (size_t)(last - rest) : strlen(rest);
    v->state.question = VIEWER_ASKS_NOTHING;
    if (v->profile.shown && !*rest) return commands_ask(v, VIEWER_ASKS_SAVE_PROFILE);
    if (!v->profile.shown || !length || length >= sizeof path || !width_px || !height_px || width_px > MAX_SIDE_PX || height_px > MAX_SIDE_PX) {
        viewer_tell(v, v->profile.shown ? "profile: '%s' is not save FILE [WxH]" : "profile: there is none to be saved", rest);
        return false;
    }
    snprintf(path, sizeof path, "%.*s", (int)length, rest);
    const char *dot = strrchr(path, '.');
    const bool picture = dot && (strcmp(dot, ".png") == 0 || strcmp(dot, ".jpg") == 0 || strcmp(dot, ".jpeg") == 0);
    v->probe.message[0] = 0;
    ewa_status status = EWA_OK;
    if (picture) {
        const size_t row_bytes = 4 * (size_t)width_px;
        uint8_t *rgba8 = malloc(row_bytes * height_px);
        status = rgba8 && draw_graph(v, width_px, height_px, 0, rgba8) ? EWA_OK : EWA_ERROR_MEMORY;
        if (status == EWA_OK)
            status = ewa_pixels_save(v->probe.context, path, width_px, height_px, 4, rgba8, row_bytes, NULL);
        free(rgba8);
    } else {
        status = ewa_cloud_save(v->profile.of.points, path, NULL);
    }
    if (status != EWA_OK)
        viewer_tell(v, "%s: the profile cannot be saved: %s", path,
                    v->probe.message[0] ? v->probe.message : ewa_status_name(status));
    else
        viewer_say(v, "profile %s", path), viewer_note(v, "profile saved: %s", path);
    return status == EWA_OK;
}

bool profile_do(viewer *v, const char *rest) {
    char word[VIEWER_TEXT_BYTES], problem[EWA_OPTION_TEXT_BYTES];
    double corners_world[3 * EWA_PROFILE_CORNERS];
    uint32_t corner_count;
    const size_t length = strcspn(rest, " ");
    const char *behind = rest + length + strspn(rest + length, " ");
    snprintf(word, sizeof word, "%.*s", (int)(length < sizeof word ? length : sizeof word - 1), rest);
    if (strcmp(word, "next") == 0) snprintf(word, sizeof word, "%s", v->profile.shown ? "off" : "picks");
    if (strcmp(word, "off") == 0) {
        profile_free(v);
        viewer_mark(v);
        return true;
    }
    if (strcmp(word, "save") == 0) return save(v, behind);
    if (strcmp(word, "picks") == 0) return take_picks(v, behind);
    if (length >= sizeof word || ewa_profile_line_read(word, corners_world, &corner_count, problem) != EWA_OK) {
        viewer_tell(v, "profile: '%s' is neither picks [WIDTH], nor save FILE, nor off, nor x,y;x,y;... [WIDTH]: %s", word,
                    length < sizeof word ? problem : "it is too long");
        return false;
    }
    if (!read_width(v, behind)) return false;
    memcpy(v->profile.corners_world, corners_world, sizeof v->profile.corners_world);
    v->profile.corner_count = corner_count;
    return profile_take(v);
}

double profile_free_width(const viewer *v) { return v->profile.shown ? 1 - GRAPH_WIDTH : 1; }

void profile_draw(viewer *v, const ewa_canvas *canvas, double scale) {
    viewer_profile *profile = &v->profile;
    const double wide = floor(GRAPH_WIDTH * canvas->width_px), high = floor(GRAPH_HEIGHT * canvas->height_px);
    const double left = canvas->width_px - wide - GRAPH_MARGIN * scale,
                 top = canvas->height_px - high - STATUS_HEIGHT * scale;
    if (wide < 1 || high < 1 || left < 0 || top < 0) return;
    const uint32_t width_px = (uint32_t)wide, height_px = (uint32_t)high;
    if (profile->graph && (profile->graph_width_px != width_px || profile->graph_height_px != height_px))
        drop_graph(profile);
    if (!profile->graph) {
        profile->graph = malloc(4 * (size_t)width_px * height_px);
        if (!profile->graph || !draw_graph(v, width_px, height_px, scale, profile->graph)) {
            drop_graph(profile);
            return;
        }
        profile->graph_width_px = width_px, profile->graph_height_px = height_px;
    }
    const uint32_t x = (uint32_t)left, y = (uint32_t)top;
    static const uint8_t rim[4] = {120, 120, 120, 255};
    const double thin = fmax(1, floor(scale));
    ewa_draw_rectangle(canvas, x - thin, y - thin, x + wide + thin, y + high + thin, rim);
    for (uint32_t row = 0; row < height_px; row++)
        memcpy(canvas->rgba8 + 4 * ((size_t)(y + row) * canvas->width_px + x),
               profile->graph + 4 * (size_t)row * width_px, 4 * (size_t)width_px);
}
