// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files that stay open as long as a window shows them.
#ifndef EWA_CLI_VIEW_WINDOW_FILES_H
#define EWA_CLI_VIEW_WINDOW_FILES_H

#include "ewa/ewa.h"

/// Opens COPC files to be read piece by piece, as ewa_context_options.open_file: what others cut short is then an error of what
/// is read of it and not the end of the window, as it would be of mapped memory. `user` is NULL. Other files are the system's.
bool window_file_open(void *user, const char *path, ewa_file_source *file);

#endif
