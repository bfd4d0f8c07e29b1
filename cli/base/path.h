// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the program asks of the system about paths: UTF-8, '/' between names, on Windows also '\' (path_posix.c, path_windows.c).
#ifndef EWA_CLI_BASE_PATH_H
#define EWA_CLI_BASE_PATH_H

#include <stdbool.h>
#include <sys/types.h>

enum { PATH_BYTES = 4096 }; ///< of a path, with the 0 behind it

/// What follows the folder in a path; all of it where it names none.
const char *path_file_name(const char *path);

/// Whether there is a link of that name, wherever it leads.
bool path_is_link(const char *path);

/// Whether files may be made in a folder; else the reason is in errno.
bool path_takes_files(const char *folder);

/// Makes a folder; false with errno.
bool path_make_folder(const char *path);

/// Writes the absolute path of a file that is there and may be written, links resolved; false with errno.
bool path_resolve_writable(const char *path, char resolved[PATH_BYTES]);

/// Gives a file that is whole, and is on the disk then, another name in its folder, in place of a file that has it. Returns 0 or
/// an error number.
int path_replace(const char *written, const char *target);

/// The number of this process.
long path_process_number(void);

/// Whether a path leads to a program that may be started; on Windows ".exe" is put behind it.
bool path_is_program(char path[PATH_BYTES]);

/// Finds a program in the folders of PATH.
bool path_find_program(const char *name, char program[PATH_BYTES]);

/// Writes the folder that this program lies in, with a '/' at its end.
bool path_of_own_folder(char folder[PATH_BYTES]);

#endif
