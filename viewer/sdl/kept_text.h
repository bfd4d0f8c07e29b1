// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Texts of lines that are kept from one session to the next, where desktops keep them (XDG Base Directory Specification).
#ifndef EWA_VIEWER_SDL_KEPT_TEXT_H
#define EWA_VIEWER_SDL_KEPT_TEXT_H

#include "viewer/viewer.h"

#ifdef __cplusplus
extern "C" {
#endif

/// A text: `name` in the folder ewa of the folder that the environment's `variable` names, else of `usual` in the home.
typedef struct kept_text {
    const char *variable, *usual, *name;
} kept_text;

/// Gives its lines, one after another, without their ends, until `line` returns false. A text that is not there has none;
/// what is longer than a path, or has no end, is none of ours and ends it.
void kept_text_read(const kept_text *text, bool (*line)(void *user, const char *line), void *user);

/// Writes it anew: into another file that takes its name, so that it is never half a text. Where that cannot be, nothing is
/// kept.
void kept_text_write(const kept_text *text, const char *lines);

#ifdef __cplusplus
}
#endif
#endif
