// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Calls of POSIX that WASI has as well; what differs is in platform_posix.c and platform_wasm.c.
#define _GNU_SOURCE      // O_CLOEXEC, O_NOFOLLOW
#define _DARWIN_C_SOURCE // the same on macOS
#include "base/platform.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

// ---- The machine

void ewa_platform_release(void *memory) { free(memory); }

double ewa_platform_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// ---- Names of files

bool ewa_platform_is_separator(char character) { return character == '/'; }

const char *ewa_platform_file_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

bool ewa_platform_is_absolute(const char *path) { return *path == '/'; }

static bool take_facts(const struct stat *from, ewa_platform_facts *facts) {
    *facts = (ewa_platform_facts){.regular = S_ISREG(from->st_mode),
                                  .folder = S_ISDIR(from->st_mode),
                                  .size_bytes = from->st_size > 0 ? (uint64_t)from->st_size : 0,
                                  .permissions = from->st_mode & 0777,
                                  .device = (uint64_t)from->st_dev,
                                  .number = (uint64_t)from->st_ino};
    return true;
}

bool ewa_platform_stat(const char *path, ewa_platform_facts *facts) {
    struct stat found;
    return stat(path, &found) == 0 && take_facts(&found, facts);
}

bool ewa_platform_stat_open(int descriptor, ewa_platform_facts *facts) {
    struct stat found;
    return fstat(descriptor, &found) == 0 && take_facts(&found, facts);
}

bool ewa_platform_is_link(const char *path) {
    struct stat found;
    return lstat(path, &found) == 0 && S_ISLNK(found.st_mode);
}

bool ewa_platform_may_read(const char *path) { return access(path, R_OK) == 0; }

bool ewa_platform_rename(const char *from, const char *to) { return rename(from, to) == 0; }

bool ewa_platform_remove(const char *path) { return unlink(path) == 0; }

// ---- Open files

int ewa_platform_open(const char *path, bool waits) {
    return open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY | (waits ? 0 : O_NONBLOCK));
}

int ewa_platform_open_below(const char *folder, const char *inner) {
    int at = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    for (const char *step = inner; at >= 0;) {
        const char *slash = strchr(step, '/');
        const size_t length = slash ? (size_t)(slash - step) : strlen(step);
        char name[EWA_FILE_NAME_BYTES];
        int next = -1, error = ENAMETOOLONG;
        if (length < sizeof name) {
            memcpy(name, step, length);
            name[length] = 0;
            // A pipe would make openat() wait, and a terminal would become ours.
            next = openat(at, name, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY | O_NOFOLLOW | (slash ? O_DIRECTORY : 0));
            error = errno;
        }
        close(at);
        errno = error;
        at = next;
        if (!slash) break;
        step = slash + 1;
    }
    return at;
}

int ewa_platform_create(const char *path) { return open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); }

int ewa_platform_open_device(const char *path) { return open(path, O_WRONLY | O_CLOEXEC | O_NOCTTY); }

int ewa_platform_standard_input(void) { return STDIN_FILENO; }

int64_t ewa_platform_read(int descriptor, void *bytes, size_t size_bytes) { return read(descriptor, bytes, size_bytes); }

int64_t ewa_platform_read_at(int descriptor, void *bytes, size_t size_bytes, uint64_t at_bytes) {
    return pread(descriptor, bytes, size_bytes, (off_t)at_bytes);
}

int64_t ewa_platform_write(int descriptor, const void *bytes, size_t size_bytes) {
    return write(descriptor, bytes, size_bytes);
}

int64_t ewa_platform_write_at(int descriptor, const void *bytes, size_t size_bytes, uint64_t at_bytes) {
    return pwrite(descriptor, bytes, size_bytes, (off_t)at_bytes);
}

bool ewa_platform_is_at_start(int descriptor) { return lseek(descriptor, 0, SEEK_CUR) == 0; }
