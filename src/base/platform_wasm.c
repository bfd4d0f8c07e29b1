// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The operating system by WASI, which a WebAssembly module is given in node, in a browser's page or by a runtime of its own:
// files are there where the host grants a folder; processes, permissions, mapping and libraries are not.
#include "base/platform.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { MAX_LINKS = 32 };

// ---- The machine

void *ewa_platform_allocate(size_t size_bytes) {
    const size_t rounded = (size_bytes + 63) & ~(size_t)63;
    return rounded < size_bytes ? NULL : aligned_alloc(64, rounded);
}

void ewa_platform_release(void *memory) { free(memory); }

// All that 32 bits can address; what the host gives is seen when it is asked for.
uint64_t ewa_platform_memory_bytes(void) { return (uint64_t)1 << 32; }

uint32_t ewa_platform_processor_count(void) { return 1; }

double ewa_platform_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

bool ewa_platform_has_library(const char *name) {
    (void)name;
    return false;
}

void ewa_platform_describe(int error, char *text, size_t room) {
    if (strerror_r(error, text, room) != 0) snprintf(text, room, "error %d", error);
}

// ---- Names of files

static bool take_facts(const struct stat *from, ewa_platform_facts *facts) {
    *facts = (ewa_platform_facts){.regular = S_ISREG(from->st_mode),
                                  .folder = S_ISDIR(from->st_mode),
                                  .size_bytes = from->st_size > 0 ? (uint64_t)from->st_size : 0,
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

bool ewa_platform_may_write(const char *path) { return access(path, W_OK) == 0; }

/// Appends names to an absolute path without links, one after the other.
static bool append(char resolved[EWA_PATH_BYTES], const char *names, int *links) {
    while (*names) {
        const size_t length = strcspn(names, "/"), before = strlen(resolved);
        const bool here = length == 0 || (length == 1 && names[0] == '.');
        if (length == 2 && names[0] == '.' && names[1] == '.') {
            char *slash = strrchr(resolved, '/');
            if (slash) *slash = 0;
        } else if (!here) {
            if (before + length + 2 > EWA_PATH_BYTES) {
                errno = ENAMETOOLONG;
                return false;
            }
            resolved[before] = '/';
            memcpy(resolved + before + 1, names, length);
            resolved[before + 1 + length] = 0;
            char target[EWA_PATH_BYTES];
            const ssize_t got = readlink(resolved, target, sizeof target - 1);
            if (got >= 0) {
                target[got] = 0;
                resolved[target[0] == '/' ? 0 : before] = 0;
                if (--*links < 0) {
                    errno = ELOOP;
                    return false;
                }
                if (!append(resolved, target, links)) return false;
            }
        }
        names += length + (names[length] == '/');
    }
    return true;
}

bool ewa_platform_resolve(const char *path, char resolved[EWA_PATH_BYTES]) {
    struct stat found;
    int links = MAX_LINKS;
    if (stat(path, &found) != 0) return false;
    resolved[0] = 0;
    if (path[0] != '/') {
        if (!getcwd(resolved, EWA_PATH_BYTES)) return false;
        if (strcmp(resolved, "/") == 0) resolved[0] = 0;
    }
    if (!append(resolved, path, &links)) return false;
    if (!resolved[0]) strcpy(resolved, "/");
    return true;
}

bool ewa_platform_rename(const char *from, const char *to) { return rename(from, to) == 0; }

bool ewa_platform_remove(const char *path) { return unlink(path) == 0; }

void ewa_platform_unique(int attempt, char words[64]) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    snprintf(words, 64, "%lld-%09ld-%d", (long long)now.tv_sec, now.tv_nsec, attempt);
}

// ---- Open files

int ewa_platform_open(const char *path, bool waits) { return open(path, O_RDONLY | (waits ? 0 : O_NONBLOCK)); }

int ewa_platform_open_below(const char *folder, const char *inner) {
    int at = open(folder, O_RDONLY | O_DIRECTORY);
    for (const char *step = inner; at >= 0;) {
        const char *slash = strchr(step, '/');
        const size_t length = slash ? (size_t)(slash - step) : strlen(step);
        char name[EWA_FILE_NAME_BYTES];
        int next = -1, error = ENAMETOOLONG;
        if (length < sizeof name) {
            memcpy(name, step, length);
            name[length] = 0;
            next = openat(at, name, O_RDONLY | O_NONBLOCK | O_NOFOLLOW | (slash ? O_DIRECTORY : 0));
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

int ewa_platform_create(const char *path) { return open(path, O_WRONLY | O_CREAT | O_EXCL, 0666); }

int ewa_platform_create_nameless(const char *folder) {
    (void)folder;
    errno = ENOSYS;
    return -1;
}

int ewa_platform_name(int descriptor, const char *path) {
    (void)descriptor, (void)path;
    errno = ENOSYS;
    return -1;
}

int ewa_platform_create_temporary(const char *folder) {
    char words[64], name[EWA_PATH_BYTES];
    ewa_platform_unique(0, words);
    if (snprintf(name, sizeof name, "%s/.ewa-spool-%s", folder, words) >= (int)sizeof name) {
        errno = ENAMETOOLONG;
        return -1;
    }
    const int descriptor = open(name, O_RDWR | O_CREAT | O_EXCL, 0600);
    if (descriptor >= 0) unlink(name);
    return descriptor;
}

int ewa_platform_open_device(const char *path) { return open(path, O_WRONLY); }

int ewa_platform_standard_input(void) { return STDIN_FILENO; }

// It cannot be duplicated; closing it does nothing.
int ewa_platform_standard_output(void) { return STDOUT_FILENO; }

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

bool ewa_platform_flush(int descriptor) { return fsync(descriptor) == 0 || errno == EINVAL || errno == ENOTSUP; }

void ewa_platform_permit(int descriptor, uint32_t permissions) { (void)descriptor, (void)permissions; }

bool ewa_platform_close(int descriptor) { return descriptor <= STDERR_FILENO || close(descriptor) == 0; }

// ---- Mapping

size_t ewa_platform_map_step(void) { return 1 << 16; }

void *ewa_platform_map(int descriptor, uint64_t at_bytes, size_t size_bytes) {
    (void)descriptor, (void)at_bytes, (void)size_bytes;
    errno = ENOSYS;
    return NULL;
}

void ewa_platform_unmap(void *mapped, size_t size_bytes) { (void)mapped, (void)size_bytes; }

bool ewa_platform_unmap_part(void *first, size_t size_bytes) {
    (void)first, (void)size_bytes;
    return false;
}

void ewa_platform_forget(void *mapped, size_t size_bytes) { (void)mapped, (void)size_bytes; }
