// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A file that appears whole or not at all, for what the program writes itself and what others write for it. (The
// library's own files, src/io/file.h, do the same.)
#ifndef EWA_CLI_BASE_TEMPORARY_FILE_H
#define EWA_CLI_BASE_TEMPORARY_FILE_H

#include "cli/base/path.h"

#include <sys/types.h>

/// Where the bytes of a file go until it is whole.
typedef struct temporary_file {
    char target[PATH_BYTES]; ///< what `written` is renamed to; behind links, which stay
    char written[PATH_BYTES];
    bool temporary; ///< false: a device or a pipe, which takes the bytes as they come and is never replaced
    bool replaces;  ///< the target is there, and its mode stays
    mode_t mode;
} temporary_file;

/// Chooses a path in the target's folder; nothing is created. Returns 0 or an error number.
int temporary_file_choose(const char *path, temporary_file *pending);
/// Makes the whole file appear; returns 0 or an error number.
int temporary_file_commit(temporary_file *pending);
/// Leaves nothing behind; does nothing after `temporary_file_commit`.
void temporary_file_drop(temporary_file *pending);

#endif
