// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A file that appears whole or not at all.
#define _DEFAULT_SOURCE // realpath
#include "aside.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

int aside_choose(const char *path, aside_file *aside) {
    *aside = (aside_file){.temporary = true};
    if (strlen(path) >= PATH_MAX) return ENAMETOOLONG;
    struct stat facts;
    if (stat(path, &facts) != 0) {
        if (errno != ENOENT) return errno;
        strcpy(aside->target, path);
    } else if (!S_ISREG(facts.st_mode)) {
        aside->temporary = false;
        strcpy(aside->written, path);
        return S_ISDIR(facts.st_mode) ? EISDIR : 0;
    } else {
        // Renaming asks the folder for permission only; a file that is write-protected is meant to stay.
        if (!realpath(path, aside->target) || faccessat(AT_FDCWD, aside->target, W_OK, AT_EACCESS) != 0)
            return errno;
        aside->replaces = true;
        aside->mode = facts.st_mode & 0777;
    }
    // Short, so that every target that can be named can be written.
    const char *slash = strrchr(aside->target, '/');
    const int folder_bytes = slash ? (int)(slash - aside->target) + 1 : 0;
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    const int length = snprintf(aside->written, sizeof aside->written, "%.*s.ewa-%ld-%09ld.tmp", folder_bytes,
                                aside->target, (long)getpid(), now.tv_nsec);
    return length < 0 || (size_t)length >= sizeof aside->written ? ENAMETOOLONG : 0;
}

int aside_keep(aside_file *aside) {
    if (!aside->temporary) return 0;
    if (aside->replaces && chmod(aside->written, aside->mode) != 0) return errno;
    if (rename(aside->written, aside->target) != 0) return errno;
    aside->temporary = false;
    return 0;
}

void aside_drop(aside_file *aside) {
    if (aside->temporary && aside->written[0]) unlink(aside->written);
    aside->temporary = false;
}
