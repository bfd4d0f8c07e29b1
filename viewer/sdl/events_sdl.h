// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Events of SDL as the viewer takes them, and the way back, by which scripts act through the window.
#ifndef EWA_VIEWER_SDL_EVENTS_H
#define EWA_VIEWER_SDL_EVENTS_H

#include <SDL.h>

#include "viewer/viewer.h"

/// A window and what is held down over it.
typedef struct events_window {
    SDL_Window *window;
    double zoom;      ///< SDL's units per point: above 1 where the desktop scales and SDL does not
    double scale;     ///< pixels per point
    int left_px, top_px; ///< the picture's corner
    uint32_t buttons; ///< bits of the buttons whose press was given on
    uint32_t key_count;
    bool keys[SDL_NUM_SCANCODES]; ///< whose press was given on; `key_count` in all
    bool pinching;                ///< two fingers are down
} events_window;

/// Measures the picture's size in points and its scale, as VIEWER_RESIZE has them.
void events_measure(events_window *window, viewer_event *event);

/// Translates an event that happened at `time_s`. Returns false when it says nothing to a viewer. The text of
/// a dropped file is SDL's own. Windows' sizes are not measured here.
bool events_translate(events_window *window, const SDL_Event *event, double time_s, viewer_event *translated);

/// Puts what events_translate() makes `event` of into SDL's queue.
void events_push(events_window *window, const viewer_event *event);

#endif
