// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The panels' parts, each laid out by a file of its own, and what they share. Sizes are in pixels.
#ifndef EWA_VIEWER_SDL_PANEL_PARTS_H
#define EWA_VIEWER_SDL_PANEL_PARTS_H

#include <imgui.h>
#include <time.h>

#include "panel.h"

/// Numbers that a hand is changing: what the viewer says of them comes later.
struct panel_edit {
    ImGuiID id; ///< of the widget; 0: none
    double numbers[4];
    uint32_t noted_count; ///< notes whose text was asked for
};

/// A file or a folder in a list.
struct panel_entry {
    char *name;
    bool folder;
    uint64_t size_bytes;
    time_t changed_s;
};

/// The dialog for files: what it shows, and what was typed.
struct panel_files {
    bool shown, focus;     ///< focus: the name is to be typed into
    viewer_question asked; ///< it was opened for
    int kind;              ///< of the files that are listed
    char folder[VIEWER_PATH_BYTES], name[VIEWER_PATH_BYTES];
    char confirmed[VIEWER_PATH_BYTES]; ///< a file that is there and may be replaced
    char problem[VIEWER_NAME_BYTES];   ///< what is wrong with the folder or the name
    panel_entry *entries;              ///< folders first, in the order of their names
    size_t count, room;
};

/// What the parts need to lay themselves out.
struct panel_page {
    ::viewer *viewer;
    const panel_facts *facts;
    viewer_state state;
    panel_edit *edit;
    panel_files *files;
    bool escape; ///< was pressed for what is asked
    float unit;          ///< pixels per point
    float width, height; ///< of the window
    float left, top;     ///< corner of the picture, right of the panel and below the bars
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

/// Points: heights of the bar of menus and of the bar of buttons, width of the panel at the side.
constexpr float panel_menus_points = 24, panel_buttons_points = 36, panel_side_points = 300;

/// Of windows that stay where they are.
constexpr ImGuiWindowFlags panel_fixed_flags =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoFocusOnAppearing |
    ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav;

/// Rows of the words that `words` separates by bars; choosing one says `command` with the word, and `rest` behind.
void panel_words(const panel_page *page, const char *command, const char *words, const char *now, const char *rest);
/// Draws an icon in the square whose corner is given.
void panel_icon(const panel_page *page, viewer_icon icon, ImVec2 corner, float side, ImU32 color);

/// A row with a recent file. Returns whether it was chosen and is opened.
bool panel_recent(const panel_page *page, uint32_t index, bool in_menu);
/// The dialog for what the viewer asks.
void panel_question(panel_page *page);
void panel_files_free(panel_files *files);

/// Menus, buttons, figures of the picture.
void panel_bars(panel_page *page);
/// What is loaded, what was picked, settings.
void panel_scene(panel_page *page);
/// The transfer function of a volume.
void panel_transfer(panel_page *page, int index, const viewer_item *item);
/// The settings that the viewer names.
void panel_settings(panel_page *page);
/// Progress, messages, notes.
void panel_notes(panel_page *page);
void panel_help(panel_page *page);

/// The side of the window that is left free around panels.
inline float panel_margin(const panel_page *page) { return 8 * page->unit; }

#endif
