// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files that a mesh file references. A file from elsewhere may name anything on this machine; only regular
// files below its own folder are opened.
#ifndef EWA_SRC_IO_MESH_REFERENCED_FILE_H
#define EWA_SRC_IO_MESH_REFERENCED_FILE_H

#include "io/file.h"
#include "io/text.h"

enum { EWA_REASON_BYTES = 128, EWA_PATH_BYTES = 4096 };

/// Maps the file that `name` means in the file at `path`. Backslashes are separators; a name that is
/// absolute, has a drive or a scheme, or leads to nothing is tried once more as its last part, beside `path`.
/// The file must lie below the folder of `path` when links and ".." are resolved, and be a regular one.
/// False, with `reason` in words, when there is none; nothing is reported.
bool ewa_referenced_file_map(const char *path, ewa_text name, ewa_file *file, char reason[EWA_REASON_BYTES]);

/// Writes the path of what `name` means in the file at `path`: a regular file, or with `folders` a folder, below the
/// folder of `path` when links and ".." are resolved; nothing else is tried. False with `reason`; nothing is reported.
bool ewa_referenced_file_find(const char *path, const char *name, bool folders, char found[EWA_PATH_BYTES],
                              char reason[EWA_REASON_BYTES]);

/// Writes the name that the file at `path`, which need not be there yet, has for a target below its folder. False with
/// `reason`.
bool ewa_referenced_file_relate(const char *path, const char *target, char name[EWA_PATH_BYTES],
                                char reason[EWA_REASON_BYTES]);

/// Opens such a file for reading; -1 with `reason`.
int ewa_referenced_file_open(const char *path, ewa_text name, char reason[EWA_REASON_BYTES]);

#endif
