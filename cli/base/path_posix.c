// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Paths by the calls of POSIX, as far as WASI has them.
#define _DEFAULT_SOURCE // realpath, lstat
#include "cli/base/path.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

_Static_assert(PATH_BYTES >= PATH_MAX, "realpath() fills that much");

const char *path_file_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

bool path_is_link(const char *path) {
    struct stat found;
    return lstat(path, &found) == 0 && S_ISLNK(found.st_mode);
}

bool path_takes_files(const char *folder) { return access(folder, W_OK | X_OK) == 0; }

bool path_make_folder(const char *path) { return mkdir(path, 0777) == 0; }

bool path_resolve_writable(const char *path, char resolved[PATH_BYTES]) {
    return realpath(path, resolved) && faccessat(AT_FDCWD, resolved, W_OK, AT_EACCESS) == 0;
}

int path_replace(const char *written, const char *target) {
    const int descriptor = open(written, O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return errno;
    // The name is to lead to whole bytes after a power cut, too.
    const int unsafe = fsync(descriptor) != 0 && errno != EINVAL ? errno : 0;
    close(descriptor);
    if (unsafe) return unsafe;
    return rename(written, target) == 0 ? 0 : errno;
}

long path_process_number(void) { return (long)getpid(); }

bool path_is_program(char path[PATH_BYTES]) {
    struct stat found;
    return stat(path, &found) == 0 && S_ISREG(found.st_mode) && access(path, X_OK) == 0;
}

bool path_find_program(const char *name, char program[PATH_BYTES]) {
    const char *folder = getenv("PATH");
    while (folder && *folder) {
        const size_t length = strcspn(folder, ":");
        const int written = snprintf(program, PATH_BYTES, "%.*s%s%s", (int)length, folder, length ? "/" : "", name);
        if (written > 0 && written < PATH_BYTES && path_is_program(program)) return true;
        folder += length + (folder[length] == ':');
    }
    return false;
}

bool path_of_own_folder(char folder[PATH_BYTES]) {
    const ssize_t length = readlink("/proc/self/exe", folder, PATH_BYTES - 1);
    if (length <= 0) return false;
    folder[length] = 0;
    char *slash = strrchr(folder, '/');
    if (slash) slash[1] = 0;
    return slash != NULL;
}
