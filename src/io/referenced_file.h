// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The one way to files that a file or a folder names. A file from elsewhere may name anything on this machine; only regular
// files are opened, and only where the context's named_files lets them be. Test `opens` finds other ways.
#ifndef EWA_SRC_IO_REFERENCED_FILE_H
#define EWA_SRC_IO_REFERENCED_FILE_H

#include "base/platform.h"
#include "io/file.h"
#include "io/text.h"

enum { EWA_REASON_BYTES = 160 };

/// Maps the file that `name` means in the file at `path`. Backslashes are separators; a name that is
/// absolute, has a drive or a scheme, or leads to nothing is tried once more as its last part, beside `path`.
/// By EWA_NAMED_BELOW the file must lie below the folder of `path` when links and ".." are resolved.
/// False, with `reason` in words, when there is none; nothing is reported.
bool ewa_referenced_file_map(ewa_context *context, const char *path, ewa_text name, ewa_file *file,
                             char reason[EWA_REASON_BYTES]);

/// Opens such a file where `allowed` lets it be; -1 with `reason`.
int ewa_referenced_file_open(ewa_named_files allowed, const char *path, ewa_text name, char reason[EWA_REASON_BYTES]);

/// Maps a part of a folder, `name` relative to it, which nothing else is tried for. Errors: EWA_ERROR_IO with the message
/// "FOLDER/NAME: reason".
ewa_status ewa_referenced_file_part(ewa_context *context, const char *folder, const char *name, ewa_file *file);

/// Writes the path of what `name` means in the file at `path`: a regular file, or with `folders` a folder, where
/// named_files lets it be, or an address on a server where that is EWA_NAMED_ANYWHERE; nothing else is tried. False with `reason`; nothing is reported.
bool ewa_referenced_file_find(ewa_context *context, const char *path, const char *name, bool folders,
                              char found[EWA_PATH_BYTES], char reason[EWA_REASON_BYTES]);

/// Writes the name that the file at `path`, which need not be there yet, has for a target below its folder, or on a server. False with
/// `reason`.
bool ewa_referenced_file_relate(const char *path, const char *target, char name[EWA_PATH_BYTES],
                                char reason[EWA_REASON_BYTES]);

#endif
