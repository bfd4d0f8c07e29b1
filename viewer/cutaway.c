// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What is cut away: a box with handles, and a slab along the view.
#include "inner.h"
#include "navigate.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// A handle is under the pointer so many points away, and a slab of this share of the scene comes first.
static const double HANDLE_REACH = 10, FIRST_SLAB = 0.25, SLAB_STEP = 0.02;

static void add_plane(ewa_render_options *render, double a, double b, double c, double d) {
    if (render->section_count == EWA_MAX_SECTION_PLANES) return;
    const double plane[4] = {a, b, c, d};
    memcpy(render->section_planes[render->section_count++], plane, sizeof plane);
}

void cutaway_apply(const viewer *v, ewa_render_options *render) {
    const viewer_cutaway *s = &v->cutaway;
    for (int c = 0; c < 3 && s->box; c++) {
        add_plane(render, c == 0, c == 1, c == 2, -s->low_world[c]);
        add_plane(render, -(c == 0), -(c == 1), -(c == 2), s->high_world[c]);
    }
    const double *n = s->slab_direction;
    if (s->slab) {
        add_plane(render, n[0], n[1], n[2], -s->slab_near);
        add_plane(render, -n[0], -n[1], -n[2], s->slab_far);
    }
}

/// The box around all that is visible, a little larger.
static bool reset_box(viewer *v) {
    viewer_cutaway *s = &v->cutaway;
    if (!items_bounds(v, s->low_world, s->high_world)) return false;
    for (int c = 0; c < 3; c++) {
        s->low_world[c] -= 1e-3 * v->reach_world;
        s->high_world[c] += 1e-3 * v->reach_world;
    }
    return true;
}

/// The slab about the pivot, across the view.
static bool reset_slab(viewer *v) {
    viewer_cutaway *s = &v->cutaway;
    const double *ahead = &v->camera.world_to_camera[8];
    const double length = sqrt(ahead[0] * ahead[0] + ahead[1] * ahead[1] + ahead[2] * ahead[2]);
    double middle = 0;
    for (int c = 0; c < 3; c++) {
        s->slab_direction[c] = ahead[c] / length;
        middle += s->slab_direction[c] * v->pivot_world[c];
    }
    s->slab_near = middle - 0.5 * FIRST_SLAB * v->reach_world;
    s->slab_far = middle + 0.5 * FIRST_SLAB * v->reach_world;
    return true;
}

bool cutaway_set(viewer *v, const char *what, const char *rest) {
    viewer_cutaway *s = &v->cutaway;
    const bool box = strcmp(what, "box") == 0;
    bool *on = box ? &s->box : &s->slab;
    double n[6];
    char end;
    if (strcmp(rest, "on") == 0) {
        *on = box ? reset_box(v) : reset_slab(v);
    } else if (strcmp(rest, "off") == 0) {
        *on = false;
    } else if (box &&
               sscanf(rest, "%lf,%lf,%lf,%lf,%lf,%lf%c", &n[0], &n[1], &n[2], &n[3], &n[4], &n[5], &end) ==
                   6 &&
               n[0] <= n[3] && n[1] <= n[4] && n[2] <= n[5]) {
        memcpy(s->low_world, n, sizeof s->low_world);
        memcpy(s->high_world, n + 3, sizeof s->high_world);
        *on = true;
    } else if (!box && sscanf(rest, "%lf,%lf%c", &n[0], &n[1], &end) == 2 && n[0] <= n[1]) {
        // Distances from the eye, as the picture shows them.
        double eye[3], at = 0;
        ewa_camera_eye(&v->camera, eye);
        reset_slab(v);
        for (int c = 0; c < 3; c++) at += s->slab_direction[c] * eye[c];
        s->slab_near = at + n[0];
        s->slab_far = at + n[1];
        *on = true;
    } else {
        viewer_tell(v, "%s: '%s' is neither on, nor off, nor %s", what, rest,
                    box ? "x0,y0,z0,x1,y1,z1 from low to high" : "two distances from the eye, near and far");
        return false;
    }
    viewer_change(v);
    return true;
}

void cutaway_move_slab(viewer *v, double notches, bool thickness) {
    viewer_cutaway *s = &v->cutaway;
    if (!s->slab) return;
    const double step = notches * SLAB_STEP * v->reach_world;
    s->slab_far += step;
    s->slab_near += thickness ? -step : step;
    if (s->slab_near > s->slab_far) s->slab_near = s->slab_far = 0.5 * (s->slab_near + s->slab_far);
    viewer_change(v);
}

void cutaway_handle(const viewer *v, int handle, double place_world[3]) {
    const viewer_cutaway *s = &v->cutaway;
    for (int c = 0; c < 3; c++) place_world[c] = 0.5 * (s->low_world[c] + s->high_world[c]);
    const int axis = handle % 3;
    place_world[axis] = handle < 3 ? s->low_world[axis] : s->high_world[axis];
}

int cutaway_find_handle(const viewer *v, double x, double y) {
    int found = -1;
    double minimum = HANDLE_REACH, nearest = INFINITY;
    for (int handle = 0; handle < 6 && v->cutaway.box; handle++) {
        double place_world[3], place_px[2], depth;
        cutaway_handle(v, handle, place_world);
        if (!navigate_project(&v->camera, place_world, place_px, &depth)) continue;
        const double away = hypot(place_px[0] / v->scale - x, place_px[1] / v->scale - y);
        if (away > minimum || depth > nearest) continue;
        found = handle;
        nearest = depth;
    }
    return found;
}

void cutaway_drag(viewer *v, double x_px, double y_px) {
    viewer_cutaway *s = &v->cutaway;
    const int axis = v->handle % 3;
    double place_world[3], from_px[2], to_px[2], depth;
    cutaway_handle(v, v->handle, place_world);
    const double step = 1e-3 * v->reach_world;
    if (!navigate_project(&v->camera, place_world, from_px, &depth)) return;
    place_world[axis] += step;
    if (!navigate_project(&v->camera, place_world, to_px, &depth)) return;
    const double dx = to_px[0] - from_px[0], dy = to_px[1] - from_px[1], length2 = dx * dx + dy * dy;
    if (!(length2 > 1e-12)) return;
    const double by = step * (dx * x_px + dy * y_px) / length2;
    double *side = v->handle < 3 ? &s->low_world[axis] : &s->high_world[axis];
    *side += by;
    if (v->handle < 3)
        *side = fmin(*side, s->high_world[axis]);
    else
        *side = fmax(*side, s->low_world[axis]);
    viewer_change(v);
}
