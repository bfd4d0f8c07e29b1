// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A selection of points, Gaussians and voxels, by what is drawn around them on the picture, by a box, by classes; what is hidden or
// kept of it.
#include "inner.h"
#include "navigate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Points of a selection that are marked, at most; of an outline that is drawn, points of the window from one corner to the next.
enum { MAX_MARKS = 20000 };
static const double CORNER_STEP = 3;

void select_clear(viewer *v) {
    viewer_selection *s = &v->selection;
    free(s->places_world);
    *s = (viewer_selection){.tool = s->tool};
    viewer_mark(v);
}

/// Keeps some places to be marked, behind those that are kept already.
static void keep_places(viewer_selection *s, const ewa_cloud *points) {
    const uint64_t count = points ? ewa_cloud_point_count(points) : 0;
    const uint64_t step = count / MAX_MARKS + 1, kept = count ? (count - 1) / step + 1 : 0;
    const ewa_attribute *position = kept ? ewa_cloud_find(points, EWA_POSITION) : NULL;
    double *larger = position ? realloc(s->places_world, 3 * (s->place_count + kept) * sizeof *larger) : NULL;
    if (!larger) return; // fewer are marked
    s->places_world = larger;
    double origin[3];
    ewa_cloud_origin(points, origin);
    for (uint64_t i = 0; i < kept; i++) {
        double *place = larger + 3 * s->place_count++;
        ewa_attribute_read_f64(position, i * step, 1, place);
        for (int c = 0; c < 3; c++) place[c] += origin[c];
    }
}

/// Counts what is selected, but of octrees, which would have to be read, and says so.
static bool finish(viewer *v) {
    viewer_selection *s = &v->selection;
    ewa_scene_info info;
    ewa_scene_describe(v->scene, &info);
    s->given = true;
    ewa_cloud *points = NULL, *centers = NULL;
    ewa_status status = info.surfaces && !info.octrees ? cut_take_points(v, &points) : EWA_OK;
    if (status == EWA_OK && (info.gaussians || info.volumes)) status = cut_take_centers(v, MAX_MARKS, &centers, &s->center_count);
    if (points) s->count = ewa_cloud_point_count(points);
    keep_places(s, points);
    keep_places(s, centers);
    ewa_cloud_destroy(&points);
    ewa_cloud_destroy(&centers);
    if (status != EWA_OK) {
        viewer_tell(v, "select: %s", v->probe.message[0] ? v->probe.message : ewa_status_name(status));
        select_clear(v);
        return false;
    }
    const char *others = info.gaussians && info.volumes ? "Gaussians and voxels" : info.gaussians ? "Gaussians" : "voxels";
    if (info.octrees)
        viewer_say(v, "select what is in the outline; octrees are counted when they are cut");
    else if (!info.gaussians && !info.volumes)
        viewer_say(v, "select %llu points", (unsigned long long)s->count);
    else if (!info.surfaces)
        viewer_say(v, "select %llu %s", (unsigned long long)s->center_count, others);
    else
        viewer_say(v, "select %llu points, %llu %s", (unsigned long long)s->count, (unsigned long long)s->center_count, others);
    viewer_note(v, "%s", v->said); // in place of what the tool asked for
    viewer_mark(v);
    return true;
}

/// Selects what is behind an outline in points of the window.
static bool take_outline(viewer *v, const double *outline, uint32_t corner_count) {
    double *outline_px = malloc(2 * (size_t)corner_count * sizeof *outline_px);
    ewa_status status = outline_px ? EWA_OK : EWA_ERROR_MEMORY;
    for (uint32_t i = 0; outline_px && i < 2 * corner_count; i++) outline_px[i] = outline[i] * v->scale;
    select_clear(v);
    if (status == EWA_OK) status = ewa_region_set_outline(&v->selection.region, &v->camera, outline_px, corner_count);
    free(outline_px);
    if (status == EWA_OK) return finish(v);
    viewer_tell(v, "select: an outline has at least three corners, which are finite");
    return false;
}

static bool take_rectangle(viewer *v, const double corners[4]) {
    const double outline[8] = {corners[0], corners[1], corners[2], corners[1], corners[2], corners[3], corners[0], corners[3]};
    return take_outline(v, outline, 4);
}

/// Reads numbers that blanks or commas part; returns how many, SIZE_MAX: something else stands there.
static size_t read_numbers(const char *text, size_t maximum, double *numbers) {
    size_t count = 0;
    while (*text) {
        char *end;
        const double number = strtod(text, &end);
        if (end == text || count == maximum || !isfinite(number)) return SIZE_MAX;
        numbers[count++] = number;
        text = end + strspn(end, " ,");
    }
    return count;
}

static bool take_classes(viewer *v, const char *text) {
    ewa_region region = {.has_classes = true};
    char word[64];
    for (int used; sscanf(text, " %63[^,]%n", word, &used) == 1; text += text[used] == ',' ? used + 1 : used) {
        char *end;
        const unsigned long number = strtoul(word, &end, 10);
        uint32_t code = number < EWA_REGION_CLASSES ? (uint32_t)number : EWA_REGION_CLASSES;
        if ((*end && !ewa_class_find(word, &code)) || code >= EWA_REGION_CLASSES) {
            viewer_tell(v, "select: '%s' is no class", word);
            return false;
        }
        region.classes[code / 32] |= (uint32_t)1 << code % 32;
    }
    select_clear(v);
    v->selection.region = region;
    return finish(v);
}

static bool take_box(viewer *v, const char *text) {
    double box_world[6], axes_world[9] = {0};
    if (strcmp(text, "clip") == 0 && v->cutaway.box) {
        memcpy(box_world, v->cutaway.low_world, sizeof v->cutaway.low_world);
        memcpy(box_world + 3, v->cutaway.high_world, sizeof v->cutaway.high_world);
        memcpy(axes_world, v->cutaway.axes_world, sizeof axes_world);
    } else if (read_numbers(text, 6, box_world) != 6) {
        viewer_tell(v, "select: '%s' is neither x0,y0,z0,x1,y1,z1 nor clip, the clip box", text);
        return false;
    }
    select_clear(v);
    v->selection.region.has_box = true;
    memcpy(v->selection.region.box_world, box_world, sizeof box_world);
    memcpy(v->selection.region.box_axes_world, axes_world, sizeof axes_world);
    return finish(v);
}

/// In the order of select_tool.
static const char *const tools[] = {"off", "rectangle", "lasso", "polygon"};

bool select_holds(const viewer *v, const char *word) {
    return v->selection.tool != SELECT_OFF && strcmp(word, tools[v->selection.tool]) == 0;
}

static bool set_tool(viewer *v, const char *word) {
    for (int k = 0; k < 4; k++)
        if (strcmp(word, tools[k]) == 0) {
            // A second time, it is put away.
            const select_tool tool = (int)v->selection.tool == k ? SELECT_OFF : (select_tool)k;
            commands_put_away(v);
            v->selection.tool = tool;
            viewer_note(v, v->selection.tool ? "select: draw a %s around what is meant" : "select: %s", tools[v->selection.tool]);
            return true;
        }
    return false;
}

bool select_command(viewer *v, const char *rest) {
    const size_t length = strcspn(rest, " ");
    const char *behind = rest + length + strspn(rest + length, " ");
    double numbers[2 * SELECT_CORNERS];
    if (strcmp(rest, "none") == 0) {
        select_clear(v);
        return true;
    }
    if (set_tool(v, rest)) return true;
    if (strncmp(rest, "class ", 6) == 0) return take_classes(v, behind);
    if (strncmp(rest, "box ", 4) == 0) return take_box(v, behind);
    const size_t count = read_numbers(behind, 2 * SELECT_CORNERS, numbers);
    if (strncmp(rest, "rectangle ", 10) == 0 && count == 4) return take_rectangle(v, numbers);
    if (strncmp(rest, "polygon ", 8) == 0 && count != SIZE_MAX && count >= 6 && count % 2 == 0)
        return take_outline(v, numbers, (uint32_t)count / 2);
    viewer_tell(v,
                "select: '%s' is none of rectangle [X Y X Y], polygon [X Y X Y X Y...], lasso, off, box x0,y0,z0,x1,y1,z1|clip, "
                "class CODE,..., none",
                rest);
    return false;
}

/// Adds the selection to what hides points.
static bool add_region(viewer *v, const char *command, bool kept) {
    ewa_scene_options *base = &v->base;
    if (!v->selection.given) {
        viewer_tell(v, "%s: nothing is selected", command);
        return false;
    }
    if (base->region_count == EWA_MAX_REGIONS) {
        viewer_tell(v, "%s: there are %d already; unhide shows all again", command, EWA_MAX_REGIONS);
        return false;
    }
    base->regions[base->region_count] = v->selection.region;
    base->regions[base->region_count++].kept = kept;
    select_clear(v);
    items_refresh(v);
    viewer_change(v);
    return true;
}

bool select_hide(viewer *v, const char *rest) {
    (void)rest;
    return add_region(v, "hide", false);
}

bool select_keep(viewer *v, const char *rest) {
    (void)rest;
    return add_region(v, "keep", true);
}

bool select_unhide(viewer *v, const char *rest) {
    (void)rest;
    v->base.region_count = 0;
    items_refresh(v);
    viewer_change(v);
    return true;
}

/// Adds a corner to what is being drawn.
static void add_corner(viewer_selection *s, double x, double y) {
    if (s->corner_count == SELECT_CORNERS) return;
    s->corners[2 * s->corner_count] = x;
    s->corners[2 * s->corner_count++ + 1] = y;
}

/// Selects what is in the outline that was drawn, unless it has too few corners.
static void close_outline(viewer *v) {
    viewer_selection *s = &v->selection;
    double corners[2 * SELECT_CORNERS];
    const uint32_t count = s->corner_count;
    if (!s->tool || count < (s->tool == SELECT_RECTANGLE ? 2u : 3u)) return;
    memcpy(corners, s->corners, 2 * count * sizeof *corners);
    s->corner_count = 0;
    if (s->tool == SELECT_RECTANGLE)
        take_rectangle(v, corners);
    else
        take_outline(v, corners, count);
}

bool select_press(viewer *v, const viewer_event *event) {
    viewer_selection *s = &v->selection;
    if (!s->tool || event->button != VIEWER_LEFT || event->modifiers) return false;
    if (s->tool != SELECT_POLYGON) s->corner_count = 0;
    s->pressed = true;
    add_corner(s, event->x, event->y);
    if (s->tool == SELECT_POLYGON && event->clicks >= 2) close_outline(v);
    viewer_mark(v);
    return true;
}

bool select_end(viewer *v) {
    if (v->selection.tool != SELECT_POLYGON || v->selection.corner_count < 3) return false;
    close_outline(v);
    viewer_mark(v);
    return true;
}

bool select_move(viewer *v, const viewer_event *event) {
    viewer_selection *s = &v->selection;
    if (!s->pressed || s->tool == SELECT_POLYGON) return false;
    const double *last = s->corners + 2 * (s->corner_count - 1);
    if (s->tool == SELECT_RECTANGLE) s->corner_count = 1;
    if (s->tool == SELECT_RECTANGLE || hypot(event->x - last[0], event->y - last[1]) >= CORNER_STEP)
        add_corner(s, event->x, event->y);
    viewer_mark(v);
    return true;
}

bool select_release(viewer *v, const viewer_event *event) {
    viewer_selection *s = &v->selection;
    if (!s->pressed || event->button != VIEWER_LEFT) return false;
    s->pressed = false;
    if (s->tool != SELECT_POLYGON) close_outline(v);
    return true;
}
