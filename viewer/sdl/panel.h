// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The panels over the picture: what is loaded, settings, progress, messages, results, help. They say what a
// person does there as lines of the viewer's commands.
#ifndef EWA_VIEWER_SDL_PANEL_H
#define EWA_VIEWER_SDL_PANEL_H

#include <SDL.h>

#include "recent.h"
#include "viewer/viewer.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct panel panel;

/// What the panels say of the picture beneath.
typedef struct panel_facts {
    viewer_picture picture;
    double frames_per_s; ///< while something moves; else 0
    double scale;        ///< pixels per point
    double now_s;        ///< the clock of viewer_state.message_s
    const recent_files *recent; ///< NULL: none
} panel_facts;

/// What bars and panels take of the window: the picture is right of them and below.
typedef struct panel_insets {
    int left_px, top_px;
} panel_insets;

/// Measures what they take of a window of so many pixels, at `scale` pixels per point, as `state` has them.
void panel_measure(const viewer_state *state, double width_px, double height_px, double scale, panel_insets *insets);

/// Makes panels that are drawn by `renderer` in `window`, which outlive them. One at a time: Dear ImGui has a
/// current context. NULL: no memory. The caller destroys it.
panel *panel_create(SDL_Window *window, SDL_Renderer *renderer);
void panel_destroy(panel **panel);

/// Gives the panels an event, which happens at a time of the clock of `panel_facts`. Returns true when it is theirs and the viewer must not see it.
bool panel_event(panel *panel, viewer *shown, const SDL_Event *event, double now_s);

/// Draws the panels over what is there; nothing is presented.
void panel_draw(panel *panel, viewer *shown, const panel_facts *facts);

/// When they are to be drawn again though nothing has happened, seconds; infinite: never.
double panel_spare_s(const panel *panel);

#ifdef __cplusplus
}
#endif
#endif
