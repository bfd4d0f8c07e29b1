// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files that a mesh file references. A file from elsewhere may name anything on this machine; only regular
// files below its own folder are opened.
#ifndef EWA_SRC_IO_MESH_REFERENCED_FILE_H
#define EWA_SRC_IO_MESH_REFERENCED_FILE_H

#include "io/file.h"
#include "io/text.h"

enum { EWA_REASON_BYTES = 128 };

/// Maps the file that `name` means in the file at `path`. Backslashes are separators; a name that is
/// absolute, has a drive or a scheme, or leads to nothing is tried once more as its last part, beside `path`.
/// The file must lie below the folder of `path` when links and ".." are resolved, and be a regular one.
/// False, with `reason` in words, when there is none; nothing is reported.
bool ewa_referenced_file_map(const char *path, ewa_text name, ewa_file *file, char reason[EWA_REASON_BYTES]);

/// Opens such a file for reading; -1 with `reason`.
int ewa_referenced_file_open(const char *path, ewa_text name, char reason[EWA_REASON_BYTES]);

#endif
