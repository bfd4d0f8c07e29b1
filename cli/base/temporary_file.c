// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A file that appears whole or not at all.
#include "cli/base/temporary_file.h"
#include "cli/base/interruption.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

int temporary_file_choose(const char *path, temporary_file *pending) {
    *pending = (temporary_file){.temporary = true};
    if (strlen(path) >= PATH_BYTES) return ENAMETOOLONG;
    struct stat facts;
    if (stat(path, &facts) != 0) {
        if (errno != ENOENT) return errno;
        if (path_is_link(path)) return ENOENT; // a link that leads nowhere
        strcpy(pending->target, path);
    } else if (!S_ISREG(facts.st_mode)) {
        pending->temporary = false;
        strcpy(pending->written, path);
        return S_ISDIR(facts.st_mode) ? EISDIR : 0;
    } else {
        // Renaming asks the folder for permission only; a file that is write-protected is meant to stay.
        if (!path_resolve_writable(path, pending->target)) return errno;
        pending->replaces = true;
        pending->mode = facts.st_mode & 0777;
    }
    // Short, so that every target that can be named can be written.
    const int folder_bytes = (int)(path_file_name(pending->target) - pending->target);
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    const int length = snprintf(pending->written, sizeof pending->written, "%.*s.ewa-%ld-%09ld.tmp",
                                folder_bytes, pending->target, path_process_number(), now.tv_nsec);
    if (length < 0 || (size_t)length >= sizeof pending->written) return ENAMETOOLONG;
    interruption_watch_file(pending->written);
    return 0;
}

int temporary_file_commit(temporary_file *pending) {
    if (!pending->temporary) return 0;
    if (pending->replaces && chmod(pending->written, pending->mode) != 0) return errno;
    const int error = path_replace(pending->written, pending->target);
    if (error) return error;
    interruption_release_file(pending->written);
    pending->temporary = false;
    return 0;
}

void temporary_file_drop(temporary_file *pending) {
    if (pending->temporary && pending->written[0]) {
        unlink(pending->written);
        interruption_release_file(pending->written);
    }
    pending->temporary = false;
}
