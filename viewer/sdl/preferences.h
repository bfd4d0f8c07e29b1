// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How a person likes to work, kept from one session to the next: $XDG_CONFIG_HOME/ewa/view, or ~/.config/ewa/view. What
// changes a still picture is not among it: that belongs to scene files.
#ifndef EWA_VIEWER_SDL_PREFERENCES_H
#define EWA_VIEWER_SDL_PREFERENCES_H

#include "viewer/viewer.h"

enum { PREFERENCES_BYTES = 8192 };

/// Sets what was kept; `lines`: as it is now, for preferences_write().
void preferences_read(viewer *viewer, char lines[PREFERENCES_BYTES]);

/// Keeps them, where they are not those of `lines`.
void preferences_write(const viewer *viewer, const char *lines);

#endif
