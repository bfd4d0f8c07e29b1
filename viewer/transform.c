// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where things lie: moved, turned and resized by numbers or by the hand, which carries the box of what it holds. The thing is
// loaded again with its new map when the hand lets go, as a scene file would have it, so that pictures are the same.
#include "inner.h"
#include "navigate.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// Degrees that a point of the window turns; the factor of a point of the window.
static const double TURN_DEG = 0.4, DRAG_FACTOR = 1.005, RADIANS = 3.14159265358979323846 / 180;
/// The thing is looked for so many points around the pointer.
static const double REACH = 8;

static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

static const char *const tools[] = {"off", "move", "turn", "scale"};

/// The map `by` after the map `before`.
static void compose(const double by[16], const double before[16], double both[16]) {
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++) {
            both[4 * r + c] = 0;
            for (int k = 0; k < 4; k++) both[4 * r + c] += by[4 * r + k] * before[4 * k + c];
        }
}

/// Sets the part of an affine map that moves so that a place stays where it is.
static void keep_place(double map[16], const double place_world[3]) {
    for (int r = 0; r < 3; r++) {
        map[4 * r + 3] = place_world[r];
        for (int c = 0; c < 3; c++) map[4 * r + 3] -= map[4 * r + c] * place_world[c];
    }
}

// Rodrigues' rotation.
void transform_make_turn(const double axis_world[3], double angle_deg, const double place_world[3], double map[16]) {
    const double length = sqrt(axis_world[0] * axis_world[0] + axis_world[1] * axis_world[1] + axis_world[2] * axis_world[2]);
    double u[3];
    for (int c = 0; c < 3; c++) u[c] = axis_world[c] / length;
    double s = sin(angle_deg * RADIANS), k = cos(angle_deg * RADIANS);
    // Of quarters the sine and cosine are exact.
    if (fmod(angle_deg, 90) == 0) s = nearbyint(s), k = nearbyint(k);
    const double across[9] = {0, -u[2], u[1], u[2], 0, -u[0], -u[1], u[0], 0};
    memcpy(map, identity, sizeof identity);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) map[4 * r + c] = (r == c ? k : 0) + (1 - k) * u[r] * u[c] + s * across[3 * r + c];
    keep_place(map, place_world);
}

static void make_scale(double factor, const double place_world[3], double map[16]) {
    memcpy(map, identity, sizeof identity);
    for (int c = 0; c < 3; c++) map[5 * c] = factor;
    keep_place(map, place_world);
}

/// The middle of the box of an item; false: it is not there yet.
static bool find_middle(const scene_item *item, double middle_world[3]) {
    ewa_asset_info info = {.count = 0};
    if (item->asset) ewa_asset_describe(item->asset, &info);
    for (int c = 0; c < 3; c++) middle_world[c] = 0.5 * (info.bounds.low_world[c] + info.bounds.high_world[c]);
    return info.bounds.finite_count > 0;
}

/// Has an item lie where another map says.
static bool apply(viewer *v, const char *command, size_t index, const double to_world[16]) {
    if (!ewa_asset_map_is_valid(to_world)) {
        viewer_tell(v, "%s: no map would be left that can be turned back", command);
        return false;
    }
    item_load load = v->items[index].load;
    memcpy(load.to_world, to_world, sizeof load.to_world);
    return items_reload(v, index, &load);
}

static bool apply_change(viewer *v, const char *command, size_t index, const double by[16]) {
    double both[16];
    compose(by, v->items[index].load.to_world, both);
    return apply(v, command, index, both);
}

/// Takes the number of an item that is loaded, and its middle, off what a command says.
static bool take_item(viewer *v, const char *command, const char **rest, size_t *index, double middle_world[3]) {
    if (!commands_take_item(v, command, rest, index)) return false;
    if (find_middle(&v->items[*index], middle_world)) return true;
    viewer_tell(v, "%s: %s is not loaded yet", command, v->items[*index].name);
    return false;
}

static bool refuse(viewer *v, const char *command, const char *text, const char *wanted) {
    viewer_tell(v, "%s: '%s' is not %s", command, text, wanted);
    return false;
}

bool transform_move(viewer *v, const char *rest) {
    size_t index;
    double middle[3], by[16], n[3];
    char end;
    if (!take_item(v, "move", &rest, &index, middle)) return false;
    if (sscanf(rest, "%lf,%lf,%lf%c", &n[0], &n[1], &n[2], &end) != 3) return refuse(v, "move", rest, "x,y,z");
    memcpy(by, identity, sizeof identity);
    for (int c = 0; c < 3; c++) by[4 * c + 3] = n[c];
    return apply_change(v, "move", index, by);
}

bool transform_turn(viewer *v, const char *rest) {
    size_t index;
    double middle[3], by[16], axis[3], angle_deg;
    char end;
    if (!take_item(v, "rotate", &rest, &index, middle)) return false;
    const bool up = sscanf(rest, "%lf%c", &angle_deg, &end) == 1;
    memcpy(axis, v->up_world, sizeof axis);
    if (!up && sscanf(rest, "%lf %lf,%lf,%lf%c", &angle_deg, &axis[0], &axis[1], &axis[2], &end) != 4)
        return refuse(v, "rotate", rest, "degrees, or degrees and an axis x,y,z");
    transform_make_turn(axis, angle_deg, middle, by);
    return apply_change(v, "rotate", index, by);
}

bool transform_scale(viewer *v, const char *rest) {
    size_t index;
    double middle[3], by[16], factor;
    char end;
    if (!take_item(v, "scale", &rest, &index, middle)) return false;
    if (sscanf(rest, "%lf%c", &factor, &end) != 1 || !(factor > 0)) return refuse(v, "scale", rest, "a factor above 0");
    make_scale(factor, middle, by);
    return apply_change(v, "scale", index, by);
}

bool transform_holds(const viewer *v, const char *word) {
    return v->transform.tool != TRANSFORM_OFF && strcmp(word, tools[v->transform.tool]) == 0;
}

bool transform_command(viewer *v, const char *rest) {
    for (int tool = TRANSFORM_OFF; tool <= TRANSFORM_SCALE; tool++)
        if (strcmp(rest, tools[tool]) == 0) {
            // Once more puts it back.
            const transform_tool chosen = v->transform.tool == (transform_tool)tool ? TRANSFORM_OFF : (transform_tool)tool;
            commands_put_away(v);
            v->transform.tool = chosen;
            viewer_note(v, chosen ? "%s: drag something" : "%s: put away", tools[tool]);
            return true;
        }
    size_t index;
    double middle[3], m[16];
    char end;
    if (rest[0] < '0' || rest[0] > '9') return refuse(v, "transform", rest, "off, move, turn, scale or the number of something that is open");
    if (!take_item(v, "transform", &rest, &index, middle)) return false;
    memcpy(m, identity, sizeof identity);
    if (strcmp(rest, "none") != 0 &&
        sscanf(rest, "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf%c", &m[0], &m[1], &m[2], &m[3], &m[4], &m[5], &m[6], &m[7], &m[8],
               &m[9], &m[10], &m[11], &end) != 12)
        return refuse(v, "transform", rest, "none, or the three rows of a matrix, 12 numbers with commas between them");
    return apply(v, "transform", index, m);
}

bool transform_press(viewer *v, const viewer_event *event) {
    viewer_transform *t = &v->transform;
    if (!t->tool || event->button != VIEWER_LEFT || event->modifiers || t->held) return false;
    size_t index;
    double middle[3];
    if (!pick_item(v, event->x, event->y, REACH, &index, t->from_world) || !find_middle(&v->items[index], middle)) return false;
    t->held = true;
    t->item = v->items[index].id;
    t->depth = navigate_depth(&v->camera, t->from_world);
    t->x = event->x, t->y = event->y;
    memcpy(t->by, identity, sizeof identity);
    return true;
}

bool transform_find(const viewer *v, size_t *index, double low_world[3], double high_world[3]) {
    for (*index = 0; v->transform.held && *index < v->item_count; ++*index) {
        const scene_item *item = &v->items[*index];
        if (item->id != v->transform.item || !item->asset) continue;
        ewa_asset_info info;
        ewa_asset_describe(item->asset, &info);
        memcpy(low_world, info.bounds.low_world, sizeof info.bounds.low_world);
        memcpy(high_world, info.bounds.high_world, sizeof info.bounds.high_world);
        return true;
    }
    return false;
}

bool transform_drag(viewer *v, const viewer_event *event) {
    viewer_transform *t = &v->transform;
    size_t index;
    double low[3], high[3], middle[3], to_world[3];
    if (!t->held) return false;
    if (!transform_find(v, &index, low, high)) return true;
    for (int c = 0; c < 3; c++) middle[c] = 0.5 * (low[c] + high[c]);
    if (t->tool == TRANSFORM_MOVE) {
        navigate_unproject(&v->camera, event->x * v->scale, event->y * v->scale, t->depth, to_world);
        for (int c = 0; c < 3; c++) t->by[4 * c + 3] = to_world[c] - t->from_world[c];
    } else if (t->tool == TRANSFORM_TURN) {
        transform_make_turn(v->up_world, (event->x - t->x) * TURN_DEG, middle, t->by);
    } else {
        make_scale(pow(DRAG_FACTOR, t->y - event->y), middle, t->by);
    }
    viewer_mark(v);
    return true;
}

bool transform_release(viewer *v, const viewer_event *event) {
    viewer_transform *t = &v->transform;
    size_t index;
    double low[3], high[3];
    if (!t->held || event->button != VIEWER_LEFT) return false;
    const bool there = transform_find(v, &index, low, high);
    t->held = false;
    viewer_mark(v);
    if (there && memcmp(t->by, identity, sizeof identity) != 0) (void)apply_change(v, "transform", index, t->by);
    return true;
}
