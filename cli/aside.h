// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A file that appears whole or not at all, for what the program writes itself and what others write for it. (The
// library's own files, src/io/file.h, do the same.)
#ifndef EWA_CLI_ASIDE_H
#define EWA_CLI_ASIDE_H

#include <limits.h>
#include <stdbool.h>
#include <sys/types.h>

/// Where the bytes of a file go until it is whole.
typedef struct aside_file {
    char target[PATH_MAX]; ///< what `written` is renamed to; behind links, which stay
    char written[PATH_MAX];
    bool temporary; ///< false: a device or a pipe, which takes the bytes as they come and is never replaced
    bool replaces;  ///< the target is there, and its mode stays
    mode_t mode;
} aside_file;

/// Chooses the place, beside the target; nothing is created. Returns 0 or an error number.
int aside_choose(const char *path, aside_file *aside);
/// Makes the whole file appear; returns 0 or an error number.
int aside_keep(aside_file *aside);
/// Leaves nothing behind; does nothing after `aside_keep`.
void aside_drop(aside_file *aside);

#endif
