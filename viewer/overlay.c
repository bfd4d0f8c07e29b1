// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What stands over the picture: furniture, the box with its handles, picks and measures.
#include "inner.h"
#include "navigate.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const uint8_t DARK[4] = {20, 22, 26, 255}, MARK[4] = {255, 196, 0, 255}, EDGE[4] = {80, 160, 255, 255},
                     FAR_EDGE[4] = {80, 160, 255, 110};

/// A picture that is drawn over.
typedef struct overlay {
    ewa_canvas canvas;
    const ewa_camera *camera;
    double scale; ///< pixels per point of this picture
} overlay;

static bool place(const overlay *o, const double place_world[3], double place_px[2]) {
    double depth;
    return navigate_project(o->camera, place_world, place_px, &depth);
}

/// A line of some points of width, with a dark rim so that it shows on any ground. What crosses the eye's
/// plane is left out.
static void draw_edge(const overlay *o, const double a_world[3], const double b_world[3], double width,
                      const uint8_t rgba[4]) {
    double a[2], b[2];
    if (!place(o, a_world, a) || !place(o, b_world, b)) return;
    const uint8_t rim[4] = {DARK[0], DARK[1], DARK[2], (uint8_t)(rgba[3] * 3 / 5)};
    ewa_draw_line(&o->canvas, a[0], a[1], b[0], b[1], (width + 1.5) * o->scale, rim);
    ewa_draw_line(&o->canvas, a[0], a[1], b[0], b[1], width * o->scale, rgba);
}

static void draw_dot(const overlay *o, const double place_world[3], double size, const uint8_t rgba[4]) {
    double p[2];
    if (!place(o, place_world, p)) return;
    ewa_draw_line(&o->canvas, p[0], p[1], p[0], p[1], (size + 3) * o->scale, DARK);
    ewa_draw_line(&o->canvas, p[0], p[1], p[0], p[1], size * o->scale, rgba);
}

static void draw_label(const overlay *o, const double place_world[3], const char *text) {
    double p[2];
    if (!place(o, place_world, p)) return;
    const ewa_text_style style = {.height_px = fmin(fmax(14 * o->scale, 8), 1000),
                                  .rgba = {255, 255, 255, 255},
                                  .halo_px = 2 * o->scale,
                                  .halo_rgba = {DARK[0], DARK[1], DARK[2], 230},
                                  .anchor = EWA_TEXT_LEFT_MIDDLE};
    ewa_draw_text(&o->canvas, text, p[0] + 10 * o->scale, p[1] - 10 * o->scale, &style);
}

/// The edges of a box after a map.
static void draw_edges(const overlay *o, const double low[3], const double high[3], const double map[16], const uint8_t rgba[4]) {
    for (int axis = 0; axis < 3; axis++)
        for (int k = 0; k < 4; k++) { // the four along each axis
            const int b = (axis + 1) % 3, c = (axis + 2) % 3;
            double ends[2][3], ends_world[2][3];
            ends[0][axis] = low[axis], ends[1][axis] = high[axis];
            ends[0][b] = ends[1][b] = k & 1 ? high[b] : low[b];
            ends[0][c] = ends[1][c] = k & 2 ? high[c] : low[c];
            for (int e = 0; e < 2; e++)
                for (int r = 0; r < 3; r++)
                    ends_world[e][r] = map[4 * r] * ends[e][0] + map[4 * r + 1] * ends[e][1] + map[4 * r + 2] * ends[e][2] + map[4 * r + 3];
            draw_edge(o, ends_world[0], ends_world[1], 1.5, rgba);
        }
}

static void draw_box(const overlay *o, const viewer *v) {
    const double *a = v->cutaway.axes_world;
    const double along_axes[16] = {a[0], a[3], a[6], 0, a[1], a[4], a[7], 0, a[2], a[5], a[8], 0, 0, 0, 0, 1};
    draw_edges(o, v->cutaway.low_world, v->cutaway.high_world, along_axes, FAR_EDGE);
    for (int handle = 0; handle < 6; handle++) {
        double middle[3];
        cutaway_handle(v, handle, middle);
        draw_dot(o, middle, 9, EDGE);
    }
}

/// The wall in which the profile's line stands, from its lowest to its highest point.
static void draw_profile_wall(const overlay *o, const viewer *v) {
    const viewer_profile *profile = &v->profile;
    const double *up = profile->of.up_world;
    double before[2][3];
    for (uint32_t i = 0; i < profile->corner_count; i++) {
        const double *corner = profile->corners_world + 3 * i;
        const double at = corner[0] * up[0] + corner[1] * up[1] + corner[2] * up[2];
        double wall[2][3];
        for (int c = 0; c < 3; c++) {
            wall[0][c] = corner[c] + (profile->low_height - at) * up[c];
            wall[1][c] = corner[c] + (profile->high_height - at) * up[c];
        }
        draw_edge(o, wall[0], wall[1], 1.5, MARK);
        for (int k = 0; k < 2 && i; k++) draw_edge(o, before[k], wall[k], 2, MARK);
        memcpy(before, wall, sizeof before);
    }
}

/// What is selected, and the outline that is being drawn.
static void draw_selection(const overlay *o, const viewer *v) {
    const viewer_selection *s = &v->selection;
    for (uint64_t i = 0; i < s->place_count; i++) {
        double p[2];
        if (!place(o, s->places_world + 3 * i, p)) continue;
        ewa_draw_line(&o->canvas, p[0], p[1], p[0], p[1], 2 * o->scale, MARK);
    }
    double outline[2 * SELECT_CORNERS];
    uint32_t count = s->corner_count;
    memcpy(outline, s->corners, 2 * count * sizeof *outline);
    if (s->tool == SELECT_RECTANGLE && count == 2) {
        const double rectangle[8] = {outline[0], outline[1], outline[2], outline[1],
                                     outline[2], outline[3], outline[0], outline[3]};
        memcpy(outline, rectangle, sizeof rectangle);
        count = 4;
    }
    for (uint32_t i = 0; i < count; i++) {
        const double *a = outline + 2 * i, *b = outline + 2 * ((i + 1) % count);
        ewa_draw_line(&o->canvas, a[0] * o->scale, a[1] * o->scale, b[0] * o->scale, b[1] * o->scale, 3 * o->scale, DARK);
        ewa_draw_line(&o->canvas, a[0] * o->scale, a[1] * o->scale, b[0] * o->scale, b[1] * o->scale, 1.5 * o->scale, MARK);
    }
}

static void draw_measure(const overlay *o, const viewer *v, const ewa_measure *measure) {
    const bool closed = measure->kind == EWA_MEASURE_AREA && measure->count > 2;
    double middle[3] = {0};
    char text[VIEWER_NAME_BYTES];
    for (uint32_t i = 0; i < measure->count; i++) {
        const double *from = measure->places_world + 3 * i, *to = measure->places_world + 3 * ((i + 1) % measure->count);
        if (i + 1 < measure->count || closed) draw_edge(o, from, to, 2, MARK);
        draw_dot(o, from, 6, MARK);
        for (int c = 0; c < 3; c++) middle[c] += from[c] / measure->count;
    }
    measures_value(v, measure, text);
    if (measure->count > 1 || measure->kind == EWA_MEASURE_NOTE) draw_label(o, measure->kind == EWA_MEASURE_ANGLE ? measure->places_world + 3 : middle, text);
}

static void draw_picks(const overlay *o, const viewer *v) {
    const viewer_pick *a = &v->picks[0], *b = &v->picks[1];
    char text[64];
    if (a->given && b->given) {
        double middle[3], distance2 = 0;
        for (int c = 0; c < 3; c++) {
            const double d = b->place_world[c] - a->place_world[c];
            middle[c] = a->place_world[c] + 0.5 * d;
            distance2 += d * d;
        }
        draw_edge(o, a->place_world, b->place_world, 2, MARK);
        measures_write(v, text, sizeof text, sqrt(distance2), 6, 1);
        draw_label(o, middle, text);
    }
    if (a->given) draw_dot(o, a->place_world, 7, MARK);
    if (b->given) draw_dot(o, b->place_world, 7, MARK);
    if (a->given && !b->given && a->item != SIZE_MAX) {
        snprintf(text, sizeof text, "%llu", (unsigned long long)a->point);
        draw_label(o, a->place_world, text);
    }
}

/// Whether an item has colours that a bar can tell.
static bool has_bar(const scene_item *item) { return item->visible && !ewa_coloring_is_own(item->coloring.attribute); }

bool overlay_has_color_bar(const viewer *v) {
    bool has = false;
    for (size_t i = 0; i < v->item_count; i++) has = has || has_bar(&v->items[i]);
    return has;
}

/// The colour bar is that of the first visible cloud that is coloured by an attribute.
static void set_color_bar(const viewer *v, ewa_category categories[VIEWER_MAX_CLASSES],
                          ewa_furniture_options *furniture) {
    furniture->color_bar = false;
    for (size_t i = 0; i < v->item_count; i++) {
        const scene_item *item = &v->items[i];
        if (!has_bar(item)) continue;
        furniture->color_bar = true;
        const viewer_coloring *coloring = &item->coloring;
        const bool chosen = coloring->map != EWA_COLORING_AUTO && coloring->map != EWA_COLORING_CLASSES;
        furniture->colormap = chosen ? (ewa_colormap)(coloring->map - EWA_COLORING_VIRIDIS) : EWA_COLORMAP_VIRIDIS;
        memcpy(furniture->range, coloring->range, sizeof furniture->range);
        furniture->color_label = coloring->attribute;
        furniture->color_unit = coloring->length ? v->unit : NULL;
        for (uint32_t k = 0; k < coloring->class_count; k++) {
            const viewer_class *from = &coloring->classes[k];
            categories[k] = (ewa_category){.value = from->value, .name = from->name[0] ? from->name : NULL};
            memcpy(categories[k].srgb, from->srgb, sizeof from->srgb);
        }
        furniture->categories = coloring->class_count ? categories : NULL;
        furniture->category_count = coloring->class_count;
        return;
    }
}

void overlay_draw(viewer *v, const ewa_camera *camera, ewa_ink ink, bool saved, uint8_t *rgba8) {
    const overlay o = {{rgba8, camera->width_px, camera->height_px},
                       camera,
                       v->scale * camera->height_px / v->camera.height_px};
    if (v->cutaway.box && !saved) draw_box(&o, v);
    size_t held;
    double low[3], high[3];
    if (!saved && transform_find(v, &held, low, high)) draw_edges(&o, low, high, v->transform.by, EDGE);
    if (v->profile.shown) draw_profile_wall(&o, v);
    draw_selection(&o, v);
    for (size_t i = 0; i < v->measure_count; i++) draw_measure(&o, v, &v->measure_list[i]);
    if (v->measures_kind && v->measuring.count) draw_measure(&o, v, &v->measuring);
    draw_picks(&o, v);
    ewa_furniture_options furniture = v->furniture;
    if (!furniture.unit) furniture.unit = v->unit;
    furniture.ink = ink;
    ewa_category categories[VIEWER_MAX_CLASSES];
    if (furniture.color_bar) set_color_bar(v, categories, &furniture);
    const double depth = navigate_depth(camera, v->pivot_world);
    furniture.scale_depth_world = depth > 0 && depth < 1e30 ? depth : 0;
    furniture.pixel_scale = saved ? 0 : fmin(o.scale, 100);
    ewa_furniture_draw(v->probe.context, camera, &furniture, &o.canvas);
    if (v->profile.shown) profile_draw(v, &o.canvas, o.scale);
}
