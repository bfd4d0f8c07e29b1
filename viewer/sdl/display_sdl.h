// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The display that a window is on: whether there is one, how it scales, and what helps where it cannot be used.
#ifndef EWA_VIEWER_SDL_DISPLAY_H
#define EWA_VIEWER_SDL_DISPLAY_H

#include <SDL.h>

#include <stdbool.h>

/// Starts SDL; false: there is no screen. Drivers that nobody sees are taken only where a script runs and asks for them.
/// Where the X server goes away later, the program ends with status 1 after saying so.
bool display_start(bool scripted);

/// Returns SDL's units per point: what the desktop scales everything by, where SDL's units are pixels (X11).
double display_find_zoom(void);

/// Says on standard error why there is no window (NULL), or no renderer for one, and what helps. Returns the
/// exit status, 1.
int display_refuse(const char *what, const SDL_Window *window);

#endif
