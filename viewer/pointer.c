// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The pointer: what is pressed stays under the hand.
#include "inner.h"
#include "navigate.h"

#include <math.h>
#include <string.h>

/// Degrees a point of the window turns; the factor of a notch of the wheel and of a point of a zooming drag.
static const double TURN_DEG = 0.4, NOTCH = 0.85, DRAG_FACTOR = 0.99;
/// Events farther away are none.
static const double MAX_POINTS = 1e6;
/// A press that moves less is a click.
static const double CLICK_REACH = 4;
/// The wheel turns about the same place while it goes on within this time.
static const double WHEEL_S = 0.5;
/// The surface is looked for so many points around the pointer.
static const double HOVER_REACH = 24;

/// The user has taken the camera: loading does not move it any more.
static void take_camera(viewer *v) {
    v->placed = true;
    v->animated = false;
}

/// Makes what is under the pointer the pivot; nothing there: the last one stays.
static void set_pivot(viewer *v, double x, double y) {
    double place_world[3];
    if (pick_surface(v, x, y, HOVER_REACH, place_world))
        memcpy(v->pivot_world, place_world, sizeof place_world);
}

static drag_kind choose_drag(const viewer *v, int button, uint32_t modifiers) {
    if (button == VIEWER_MIDDLE || (button == VIEWER_LEFT && modifiers & VIEWER_SHIFT)) return DRAG_PAN;
    if (button == VIEWER_RIGHT) return DRAG_PAN;
    if (modifiers & VIEWER_CTRL) return DRAG_ZOOM;
    return v->settings.navigation == NAVIGATION_FLY ? DRAG_LOOK : DRAG_ORBIT;
}

static void press(viewer *v, const viewer_event *event) {
    if (v->button || select_press(v, event) || transform_press(v, event)) return; // a second button does not disturb the first
    v->button = event->button;
    v->press_x = v->x = event->x, v->press_y = v->y = event->y;
    v->moved = false;
    v->wheel_held = false;
    v->handle = event->button == VIEWER_LEFT ? cutaway_find_handle(v, event->x, event->y) : -1;
    v->drag = v->handle >= 0 ? (event->modifiers & VIEWER_CTRL ? DRAG_TURN_BOX : DRAG_HANDLE) : choose_drag(v, event->button, event->modifiers);
    if (v->handle >= 0 || v->drag == DRAG_LOOK) return;
    set_pivot(v, event->x, event->y);
    const double depth = navigate_depth(&v->camera, v->pivot_world);
    v->drag_depth = depth > 0 ? depth : v->reach_world;
}

static void drag(viewer *v, double x, double y) {
    const double dx = x - v->x, dy = y - v->y;
    const bool trackball = v->settings.navigation == NAVIGATION_TRACKBALL;
    if (v->handle < 0) take_camera(v);
    switch (v->drag) {
    case DRAG_ORBIT:
        navigate_orbit(&v->camera, v->pivot_world, trackball ? NULL : v->up_world, dx * TURN_DEG,
                       dy * TURN_DEG);
        break;
    case DRAG_LOOK:
        navigate_look(&v->camera, v->up_world, dx * TURN_DEG, dy * TURN_DEG);
        break;
    case DRAG_PAN:
        navigate_pan(&v->camera, v->drag_depth, dx * v->scale, dy * v->scale);
        break;
    case DRAG_ZOOM:
        navigate_zoom(&v->camera, v->pivot_world, pow(DRAG_FACTOR, -dy));
        break;
    case DRAG_HANDLE:
        cutaway_drag(v, dx * v->scale, dy * v->scale);
        break;
    case DRAG_TURN_BOX:
        cutaway_turn(v, v->up_world, dx * TURN_DEG);
        break;
    case DRAG_NONE:
        break;
    }
    viewer_change(v);
}

static void move(viewer *v, const viewer_event *event) {
    if (select_move(v, event) || transform_drag(v, event)) return;
    const bool far = hypot(event->x - v->press_x, event->y - v->press_y) >= CLICK_REACH;
    if (hypot(event->x - v->x, event->y - v->y) > 0 && !v->button) v->wheel_held = false;
    if (v->button && !v->moved && !far) return; // the hand trembles
    if (v->button) v->moved = true;
    if (v->button && (event->x != v->x || event->y != v->y)) drag(v, event->x, event->y);
    v->x = event->x, v->y = event->y;
}

/// Brings what was clicked twice into the middle, at its distance.
static void recenter(viewer *v, double x, double y) {
    double place_world[3];
    if (!pick_surface(v, x, y, HOVER_REACH, place_world)) return;
    memcpy(v->pivot_world, place_world, sizeof place_world);
    ewa_camera to = v->camera;
    navigate_center(&to, place_world);
    v->placed = true;
    viewer_go(v, &to);
}

static void release(viewer *v, const viewer_event *event) {
    if (select_release(v, event) || transform_release(v, event)) return;
    if (event->button != v->button) return;
    const bool clicked = !v->moved && v->button == VIEWER_LEFT;
    v->button = 0;
    v->drag = DRAG_NONE;
    if (!clicked || v->handle >= 0 || measures_click(v, event)) return;
    const bool follows = v->measures && v->picks[0].given && !v->picks[1].given;
    const bool second = follows || event->modifiers & VIEWER_SHIFT;
    if (event->clicks >= 2 && !v->measures)
        recenter(v, event->x, event->y);
    else if (!pick_point(v, event->x, event->y, second) && !second)
        pick_clear(v);
}

/// Scales the distance to what is under the pointer.
static void zoom(viewer *v, double x, double y, double factor) {
    if (!(factor > 0) || !isfinite(factor)) return;
    if (!v->wheel_held || v->now_s - v->wheel_s > WHEEL_S) {
        double place_world[3];
        if (!pick_surface(v, x, y, HOVER_REACH, place_world)) {
            // Nothing there: what lies behind the pointer at the pivot's distance.
            const double depth = navigate_depth(&v->camera, v->pivot_world);
            navigate_unproject(&v->camera, x * v->scale, y * v->scale, depth > 0 ? depth : v->reach_world,
                               place_world);
        }
        memcpy(v->wheel_world, place_world, sizeof place_world);
        v->wheel_held = true;
    }
    v->wheel_s = v->now_s;
    take_camera(v);
    navigate_zoom(&v->camera, v->wheel_world, factor);
    viewer_change(v);
}

static void wheel(viewer *v, const viewer_event *event) {
    if (!isfinite(event->amount)) return;
    const double notches = fmin(fmax(event->amount, -20), 20);
    if (event->modifiers & VIEWER_ALT)
        cutaway_move_slab(v, notches, event->modifiers & VIEWER_CTRL);
    else if (v->settings.navigation == NAVIGATION_FLY && v->fly_keys)
        v->fly_speed *= pow(NOTCH, -notches);
    else
        zoom(v, event->x, event->y, pow(NOTCH, notches));
}

void pointer_handle(viewer *v, const viewer_event *event) {
    // No screen is as large; what is no number would put the camera nowhere.
    const bool placed = fabs(event->x) <= MAX_POINTS && fabs(event->y) <= MAX_POINTS;
    if (event->kind != VIEWER_LEAVE && !placed) return;
    switch (event->kind) {
    case VIEWER_MOVE:
        move(v, event);
        break;
    case VIEWER_PRESS:
        if (!v->history.depth) history_begin(v); // from here to the release is one step
        press(v, event);
        break;
    case VIEWER_RELEASE:
        release(v, event);
        if (!v->button) history_end(v);
        break;
    case VIEWER_WHEEL:
        history_begin(v);
        wheel(v, event);
        history_end(v);
        break;
    case VIEWER_PINCH:
        if (event->amount > 0.01 && event->amount < 100) zoom(v, event->x, event->y, 1 / event->amount);
        break;
    default: // the hand is elsewhere
        v->button = 0;
        v->drag = DRAG_NONE;
        v->transform.held = false;
        history_end(v);
    }
}
