// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The panels' parts, each laid out by a file of its own, and what they share. Sizes are in pixels.
#ifndef EWA_VIEWER_SDL_PANEL_PARTS_H
#define EWA_VIEWER_SDL_PANEL_PARTS_H

#include <imgui.h>

#include "panel.h"

/// Numbers that a hand is changing: what the viewer says of them comes later.
struct panel_edit {
    ImGuiID id; ///< of the widget; 0: none
    double numbers[4];
};

/// What the parts need to lay themselves out.
struct panel_page {
    ::viewer *viewer;
    const panel_facts *facts;
    viewer_state state;
    panel_edit *edit;
    float unit;          ///< pixels per point
    float width, height; ///< of the window
    double spare_s;      ///< least time until a part changes by itself
};

/// Says a command of the viewer's.
bool panel_say(const panel_page *page, const char *format, ...) __attribute__((format(printf, 2, 3)));

/// Text without decorations at the left of a widget that takes the rest of the line.
void panel_label(const panel_page *page, const char *text);

/// Numbers of a widget that is drawn next, whose label is `label`: the viewer's, or the hand's.
void panel_edit_begin(panel_page *page, const char *label, int count, double *numbers);
/// Keeps the hand's numbers after the widget. Returns whether they are to be said: at each change, or, unless
/// `live`, when the hand lets go.
bool panel_edit_end(panel_page *page, const char *label, int count, const double *numbers, bool changed,
                    bool live);

/// What is loaded, and views.
void panel_scene(panel_page *page);
/// The settings that the viewer names.
void panel_settings(panel_page *page);
/// Progress, messages, results, the line below.
void panel_notes(panel_page *page);
void panel_help(panel_page *page);

/// The side of the window that is left free around panels.
inline float panel_margin(const panel_page *page) { return 8 * page->unit; }

#endif
