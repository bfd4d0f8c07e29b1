// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files that get their name when they are whole: nothing is left of them when the process is killed before.
#ifndef EWA_SRC_NAMELESS_H
#define EWA_SRC_NAMELESS_H

/// Opens a file without a name in `folder` for writing, closed on exec; returns its descriptor, or -1 where the
/// system, or the file system, has no such files.
int ewa_nameless_open(const char *folder);

/// Gives the file of `descriptor` the name `path`, in the folder it was opened in; returns 0, or -1 with errno, which is EEXIST
/// when the name is taken.
int ewa_nameless_link(int descriptor, const char *path);

#endif
