// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Keys: each is a command of the language, or a step to the next of some words.
#include "inner.h"
#include "navigate.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// In the order of their bits: ahead, left, back, right, down, up.
static const char fly_letters[] = "wasdqe";

typedef struct key_row {
    int key;
    uint32_t modifiers;
    const char *command; ///< a first word "next" is a step of the setting that follows
    const char *keys, *what;
} key_row;

enum { F = VIEWER_KEY_F1 - 1 };

static const key_row rows[] = {
    {0, 0, NULL, "drag", "turn about what is under the pointer (fly: look around)"},
    {0, 0, NULL, "right drag, Shift drag", "move along"},
    {0, 0, NULL, "wheel, pinch, Ctrl drag", "nearer and farther, to what is under the pointer"},
    {0, 0, NULL, "click", "pick a point; with Shift, measure from the one before"},
    {0, 0, NULL, "double click", "bring what is there into the middle"},
    {0, 0, NULL, "W A S D Q E", "fly (navigation fly); the wheel makes it faster"},
    {0, 0, NULL, "Alt wheel", "move the slab; with Ctrl, make it thicker"},
    {'f', 0, "focus", "F", "turn about what is under the pointer, in the middle"},
    {VIEWER_KEY_LEFT, 0, "turn -5 0", "arrows", "turn by five degrees"},
    {VIEWER_KEY_RIGHT, 0, "turn 5 0", NULL, NULL},
    {VIEWER_KEY_UP, 0, "turn 0 -5", NULL, NULL},
    {VIEWER_KEY_DOWN, 0, "turn 0 5", NULL, NULL},
    {VIEWER_KEY_ENTER, 0, "view reset", "Enter", "all of it, as at first"},
    {'1', 0, "view front", "1", "from the front; with Ctrl from the back"},
    {'1', VIEWER_CTRL, "view back", NULL, NULL},
    {'3', 0, "view right", "3", "from the right; with Ctrl from the left"},
    {'3', VIEWER_CTRL, "view left", NULL, NULL},
    {'7', 0, "view top", "7", "from above; with Ctrl from below"},
    {'7', VIEWER_CTRL, "view bottom", NULL, NULL},
    {'9', 0, "view iso", "9", "from a corner"},
    {'5', 0, "ortho next", "5", "orthographic or perspective"},
    {'k', 0, "next navigation", "K", "turntable, trackball or fly"},
    {'=', 0, "zoom 1", "+ -", "nearer, farther"},
    {'+', 0, "zoom 1", NULL, NULL},
    {'-', 0, "zoom -1", NULL, NULL},
    {'s', 0, "color next", "S", "colours: the file's, then each attribute"},
    {'m', 0, "colormap next", "M", "the next colour map"},
    {'b', 0, "next color_bar", "B", "colour bar"},
    {'x', 0, "next axes", "X", "axes"},
    {'g', 0, "next scale_bar", "G", "scale bar"},
    {'l', 0, "next shading", "L", "shading: none, lambert, phong"},
    {'e', 0, "dome next", "E", "eye-dome lighting"},
    {'n', 0, "next kernel", "N", "the next kernel"},
    {'p', 0, "points next", "P", "points in place of surfels"},
    {'[', 0, "radius 0.8", "[ ]", "smaller and larger surfels"},
    {']', 0, "radius 1.25", NULL, NULL},
    {'c', 0, "box next", "C", "clip box, whose sides can be dragged"},
    {'v', 0, "slab next", "V", "slab across the view"},
    {'c', VIEWER_CTRL, "camera copy", "Ctrl C, Ctrl V", "copy the camera, paste one"},
    {'v', VIEWER_CTRL, "camera paste", NULL, NULL},
    {F + 12, 0, "shot", "F12", "save the picture; with Ctrl, without a background"},
    {F + 12, VIEWER_CTRL, "shot transparent", NULL, NULL},
    {VIEWER_KEY_ESCAPE, 0, "cancel", "Escape", "give up loading; forget picks"},
    {'\t', 0, "panels next", "Tab", "show or hide the panels"},
    {'h', 0, "help next", "H", "this help"},
    {'q', VIEWER_CTRL, "quit", "Ctrl Q", "end"},
};

const char *viewer_help_at(uint32_t index, const char **what) {
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        if (!rows[i].keys) continue;
        if (index-- > 0) continue;
        *what = rows[i].what;
        return rows[i].keys;
    }
    return NULL;
}

void keys_handle(viewer *v, const viewer_event *event) {
    const char *letter = event->key > 0 && event->key < 128 ? strchr(fly_letters, event->key) : NULL;
    const uint32_t bit = letter ? 1u << (letter - fly_letters) : 0;
    if (event->kind == VIEWER_KEY_RELEASE) {
        v->fly_keys &= ~bit;
        return;
    }
    const bool plain = !(event->modifiers & (VIEWER_CTRL | VIEWER_ALT));
    if (bit && plain && v->settings.navigation == NAVIGATION_FLY) {
        v->fly_keys |= bit;
        return;
    }
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if (rows[i].key && rows[i].key == event->key &&
            rows[i].modifiers == (event->modifiers & (VIEWER_CTRL | VIEWER_ALT))) {
            viewer_do(v, rows[i].command);
            return;
        }
}

void keys_fly(viewer *v, double seconds) {
    const double step = v->fly_speed * v->reach_world * seconds;
    const uint32_t k = v->fly_keys;
    const double by[3] = {step * ((k >> 3 & 1) - (double)(k >> 1 & 1)),
                          step * ((k >> 4 & 1) - (double)(k >> 5 & 1)),
                          step * ((k & 1) - (double)(k >> 2 & 1))};
    navigate_move(&v->camera, by);
    v->placed = true;
    viewer_change(v);
}
