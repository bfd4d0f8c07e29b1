// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The files that were opened last, kept from one session to the next in a text of one path a line:
// $XDG_STATE_HOME/ewa/recent, or ~/.local/state/ewa/recent.
#ifndef EWA_VIEWER_SDL_RECENT_H
#define EWA_VIEWER_SDL_RECENT_H

#include "viewer/viewer.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { RECENT_FILES = 10 };

typedef struct recent_files {
    uint32_t count;
    char paths[RECENT_FILES][VIEWER_PATH_BYTES]; ///< the newest first; addresses, or paths from the root
} recent_files;

/// Reads them; none, where there is no such text.
void recent_read(recent_files *files);

/// Puts a file first, and keeps them; where that cannot be, for this session alone.
void recent_add(recent_files *files, const char *path);

#ifdef __cplusplus
}
#endif
#endif
