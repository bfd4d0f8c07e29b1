// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Keys: each does what a row of actions.c says, or what a person has chosen for it, or flies while it is held. Enter first ends what is
// being drawn.
#include "inner.h"
#include "navigate.h"

#include <string.h>

/// In the order of their bits: ahead, left, back, right, down, up.
static const char fly_letters[] = "wasdqe";

void keys_handle(viewer *v, const viewer_event *event) {
    const char *letter = event->key > 0 && event->key < 128 ? strchr(fly_letters, event->key) : NULL;
    const uint32_t bit = letter ? 1u << (letter - fly_letters) : 0;
    if (event->kind == VIEWER_KEY_RELEASE) {
        v->fly_keys &= ~bit;
        return;
    }
    const uint32_t modifiers = event->modifiers & (VIEWER_CTRL | VIEWER_ALT);
    if (v->learns && event->key == VIEWER_KEY_ESCAPE) {
        v->learns = NULL;
        return;
    }
    if (v->learns) {
        const viewer_action *learned = v->learns;
        char keys[VIEWER_KEYS_BYTES];
        actions_set_key(v, learned, event->key, modifiers);
        viewer_action_keys(v, learned, keys);
        viewer_note(v, "%s: %s", learned->label, keys);
        return;
    }
    const bool plain = !modifiers;
    if (bit && plain && v->settings.navigation == NAVIGATION_FLY) {
        v->fly_keys |= bit;
        return;
    }
    if (event->key == VIEWER_KEY_ENTER && plain && (select_end(v) || measures_end(v))) return;
    const viewer_action *action;
    for (uint32_t i = 0; (action = viewer_action_at(i)); i++)
        if (actions_key(v, action).key == event->key && actions_key(v, action).modifiers == modifiers) {
            viewer_act(v, action);
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
