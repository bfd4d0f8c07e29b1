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
        const double *axis = s->axes_world + 3 * c;
        add_plane(render, axis[0], axis[1], axis[2], -s->low_world[c]);
        add_plane(render, 0 - axis[0], 0 - axis[1], 0 - axis[2], s->high_world[c]);
    }
    const double *n = s->slab_direction;
    if (s->slab) {
        add_plane(render, n[0], n[1], n[2], -s->slab_near);
        add_plane(render, -n[0], -n[1], -n[2], s->slab_far);
    }
}

static const double axes_of_world[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

/// The box along axes around all that is visible, a little larger.
static bool reset_box(viewer *v, const double axes_world[9]) {
    viewer_cutaway *s = &v->cutaway;
    double low[3], high[3];
    if (!items_bounds(v, low, high)) return false;
    memcpy(s->axes_world, axes_world, sizeof s->axes_world);
    for (int c = 0; c < 3; c++) {
        const double *axis = axes_world + 3 * c;
        s->low_world[c] = -1e-3 * v->reach_world, s->high_world[c] = 1e-3 * v->reach_world;
        for (int r = 0; r < 3; r++) { // the corners that are farthest along the axis
            s->low_world[c] += axis[r] * (axis[r] > 0 ? low[r] : high[r]);
            s->high_world[c] += axis[r] * (axis[r] > 0 ? high[r] : low[r]);
        }
    }
    return true;
}

/// The box along the axes of the picture.
static bool reset_box_to_view(viewer *v) {
    double axes[9];
    for (int c = 0; c < 3; c++) {
        const double *m = v->camera.world_to_camera + 4 * c, length = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
        for (int r = 0; r < 3; r++) axes[3 * c + r] = m[r] / length;
    }
    return reset_box(v, axes);
}

/// Puts a place that is told along the box's axes into the world.
static void place_of(const viewer_cutaway *s, const double at[3], double place_world[3]) {
    for (int r = 0; r < 3; r++)
        place_world[r] = s->axes_world[r] * at[0] + s->axes_world[3 + r] * at[1] + s->axes_world[6 + r] * at[2];
}

void cutaway_turn(viewer *v, const double axis_world[3], double angle_deg) {
    viewer_cutaway *s = &v->cutaway;
    static const double origin[3] = {0, 0, 0};
    double middle[3], middle_world[3], turn[16];
    for (int c = 0; c < 3; c++) middle[c] = 0.5 * (s->low_world[c] + s->high_world[c]);
    place_of(s, middle, middle_world);
    transform_make_turn(axis_world, angle_deg, origin, turn);
    for (int c = 0; c < 3; c++) {
        double *axis = s->axes_world + 3 * c, turned[3], length = 0, at = 0;
        for (int r = 0; r < 3; r++) turned[r] = turn[4 * r] * axis[0] + turn[4 * r + 1] * axis[1] + turn[4 * r + 2] * axis[2];
        for (int r = 0; r < 3; r++) length += turned[r] * turned[r]; // which many turns would change
        for (int r = 0; r < 3; r++) axis[r] = turned[r] / sqrt(length), at += axis[r] * middle_world[r];
        const double half = 0.5 * (s->high_world[c] - s->low_world[c]);
        s->low_world[c] = at - half, s->high_world[c] = at + half;
    }
    viewer_change(v);
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// "DEGREES", about what is up, or "DEGREES x,y,z".
static bool turn_box(viewer *v, const char *text) {
    double angle_deg, axis[3];
    char end;
    memcpy(axis, v->up_world, sizeof axis);
    const bool up = sscanf(text, "%lf%c", &angle_deg, &end) == 1;
    const bool fine = up || sscanf(text, "%lf %lf,%lf,%lf%c", &angle_deg, &axis[0], &axis[1], &axis[2], &end) == 4;
    if (!v->cutaway.box || !fine || !isfinite(angle_deg) || !isnormal(dot(axis, axis))) {
        viewer_tell(v, "box: %s", v->cutaway.box ? "turn is followed by degrees, or degrees and an axis x,y,z" : "there is none to be turned");
        return false;
    }
    cutaway_turn(v, axis, angle_deg);
    return true;
}

/// Whether two planes bound what lies between them.
static bool are_opposite(const double a[4], const double b[4]) {
    return a[0] == -b[0] && a[1] == -b[1] && a[2] == -b[2] && -a[3] <= b[3];
}

void cutaway_take(viewer *v) {
    enum { BOX_PLANES = 6, SLAB_PLANES = 2 };
    static const double TOLERANCE = 1e-9;
    viewer_cutaway *s = &v->cutaway;
    double(*planes)[4] = v->render.section_planes;
    uint32_t *count = &v->render.section_count, taken = 0;
    bool box = *count >= BOX_PLANES && !s->box;
    for (int c = 0; c < 3 && box; c++) {
        box = are_opposite(planes[2 * c], planes[2 * c + 1]);
        for (int k = 0; k <= c; k++) box = box && fabs(dot(planes[2 * c], planes[2 * k]) - (c == k)) < TOLERANCE;
    }
    for (int c = 0; c < 3 && box; c++) {
        memcpy(s->axes_world + 3 * c, planes[2 * c], 3 * sizeof(double));
        s->low_world[c] = -planes[2 * c][3], s->high_world[c] = planes[2 * c + 1][3];
    }
    if (box) s->box = true, taken = BOX_PLANES;
    const double(*slab)[4] = (const double(*)[4])planes + taken;
    if (*count == taken + SLAB_PLANES && !s->slab && are_opposite(slab[0], slab[1]) && fabs(dot(slab[0], slab[0]) - 1) < TOLERANCE) {
        memcpy(s->slab_direction, slab[0], sizeof s->slab_direction);
        s->slab_near = -slab[0][3], s->slab_far = slab[1][3];
        s->slab = true, taken += SLAB_PLANES;
    }
    *count -= taken;
    memmove(planes, planes + taken, *count * sizeof *planes);
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
        *on = box ? reset_box(v, axes_of_world) : reset_slab(v);
    } else if (box && strcmp(rest, "view") == 0) {
        *on = reset_box_to_view(v);
    } else if (box && strncmp(rest, "turn ", 5) == 0) {
        return turn_box(v, rest + 5);
    } else if (strcmp(rest, "off") == 0) {
        *on = false;
    } else if (box &&
               sscanf(rest, "%lf,%lf,%lf,%lf,%lf,%lf%c", &n[0], &n[1], &n[2], &n[3], &n[4], &n[5], &end) ==
                   6 &&
               n[0] <= n[3] && n[1] <= n[4] && n[2] <= n[5]) {
        memcpy(s->axes_world, axes_of_world, sizeof s->axes_world);
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
                    box ? "view, nor turn DEGREES [x,y,z], nor x0,y0,z0,x1,y1,z1 from low to high" : "two distances from the eye, near and far");
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
    double at[3];
    for (int c = 0; c < 3; c++) at[c] = 0.5 * (s->low_world[c] + s->high_world[c]);
    const int axis = handle % 3;
    at[axis] = handle < 3 ? s->low_world[axis] : s->high_world[axis];
    place_of(s, at, place_world);
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
    for (int r = 0; r < 3; r++) place_world[r] += step * s->axes_world[3 * axis + r];
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
