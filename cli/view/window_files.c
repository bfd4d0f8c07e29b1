// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files that stay open as long as a window shows them: octrees alone do, all others are read once.
#include "cli/view/window_files.h"

#ifdef _WIN32
// Nobody else can cut short what is mapped.
bool window_file_open(void *user, const char *path, ewa_file_source *file) {
    (void)user, (void)path, (void)file;
    return false;
}
#else

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/// COPC 1.0: a LAS file of version 1.4 whose first record is of user "copc".
enum { HEADER_BYTES = 375, USER_AT = HEADER_BYTES + 2, USER_BYTES = 16, HEAD_BYTES = USER_AT + USER_BYTES };

static int64_t read_at(void *user, uint64_t at_bytes, void *bytes, size_t size_bytes) {
    const int *descriptor = user;
    return pread(*descriptor, bytes, size_bytes, (off_t)at_bytes);
}

static void close_file(void *user) {
    int *descriptor = user;
    close(*descriptor);
    free(descriptor);
}

/// Whether an open file is regular and COPC.
static bool is_octree(int descriptor, uint64_t *size_bytes) {
    char head[HEAD_BYTES];
    struct stat facts;
    if (fstat(descriptor, &facts) != 0 || !S_ISREG(facts.st_mode)) return false;
    *size_bytes = (uint64_t)facts.st_size;
    return pread(descriptor, head, sizeof head, 0) == HEAD_BYTES && memcmp(head, "LASF", 4) == 0 &&
           strncmp(head + USER_AT, "copc", USER_BYTES) == 0;
}

bool window_file_open(void *user, const char *path, ewa_file_source *file) {
    (void)user;
    int *descriptor = malloc(sizeof *descriptor);
    if (!descriptor) return false;
    *descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (*descriptor < 0 || !is_octree(*descriptor, &file->size_bytes)) {
        if (*descriptor >= 0) close(*descriptor);
        free(descriptor);
        return false;
    }
    file->read_at = read_at;
    file->close = close_file;
    file->user = descriptor;
    return true;
}
#endif
