// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The operating system by POSIX calls: Linux and macOS.
#define _GNU_SOURCE       // O_TMPFILE, madvise
#define _DARWIN_C_SOURCE  // the same there
#include "base/platform.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { HUGE_PAGE_BYTES = 1 << 21 };

// ---- The machine

void *ewa_platform_allocate(size_t size_bytes) {
    // Large blocks start on huge pages: filling fresh memory by pages of 4 KiB costs more than any copy into
    // it. Rounding up wastes at most half.
    const size_t alignment = size_bytes >= HUGE_PAGE_BYTES ? HUGE_PAGE_BYTES : 64;
    const size_t rounded = (size_bytes + alignment - 1) & ~(alignment - 1);
    void *memory = rounded < size_bytes ? NULL : aligned_alloc(alignment, rounded);
#if defined(MADV_HUGEPAGE)
    if (memory && alignment == HUGE_PAGE_BYTES) madvise(memory, rounded, MADV_HUGEPAGE);
#endif
    return memory;
}

uint64_t ewa_platform_memory_bytes(void) {
    const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
    return pages > 0 && page_bytes > 0 ? (uint64_t)pages * (uint64_t)page_bytes : (uint64_t)1 << 34;
}

uint32_t ewa_platform_processor_count(void) {
    const long processors = sysconf(_SC_NPROCESSORS_ONLN);
    return processors < 1 ? 1 : (uint32_t)processors;
}

bool ewa_platform_has_library(const char *name) {
    void *library = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
    if (library) dlclose(library);
    return library != NULL;
}

void *ewa_platform_open_library(const char *name) { return dlopen(name, RTLD_NOW | RTLD_LOCAL); }

void *ewa_platform_find_function(void *library, const char *name) { return dlsym(library, name); }

static const char *posix_text(int result, const char *text) { return result == 0 ? text : NULL; }
static const char *gnu_text(const char *result, const char *text) {
    (void)text;
    return result;
}

void ewa_platform_describe(int error, char *text, size_t room) {
    // Two functions have this name, by the C library.
    char own[128];
    const char *words =
        _Generic(strerror_r(error, own, sizeof own), int : posix_text, char * : gnu_text)(strerror_r(error, own, sizeof own), own);
    if (words)
        snprintf(text, room, "%s", words);
    else
        snprintf(text, room, "error %d", error);
}

// ---- Names of files

bool ewa_platform_may_write(const char *path) { return faccessat(AT_FDCWD, path, W_OK, AT_EACCESS) == 0; }

bool ewa_platform_resolve(const char *path, char resolved[EWA_PATH_BYTES]) {
    char *found = realpath(path, NULL);
    if (!found) return false;
    const bool fits = strlen(found) < EWA_PATH_BYTES;
    if (fits)
        strcpy(resolved, found);
    else
        errno = ENAMETOOLONG;
    free(found);
    return fits;
}

void ewa_platform_unique(int attempt, char words[64]) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    snprintf(words, 64, "%ld-%09ld-%d", (long)getpid(), now.tv_nsec, attempt);
}

// ---- Open files

int ewa_platform_create_nameless(const char *folder) {
#ifdef O_TMPFILE
    // The name is given by way of /proc, which a bare chroot lacks.
    if (access("/proc/self/fd", X_OK) != 0) return -1;
    return open(folder, O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
#else
    (void)folder;
    errno = ENOSYS;
    return -1;
#endif
}

int ewa_platform_name(int descriptor, const char *path) {
    char source[64];
    snprintf(source, sizeof source, "/proc/self/fd/%d", descriptor);
    return linkat(AT_FDCWD, source, AT_FDCWD, path, AT_SYMLINK_FOLLOW);
}

int ewa_platform_create_temporary(const char *folder) {
    static const char pattern[] = "/.ewa-spool-XXXXXX";
    char name[EWA_PATH_BYTES + sizeof pattern];
    snprintf(name, sizeof name, "%s%s", folder, pattern);
    const int descriptor = mkstemp(name);
    if (descriptor < 0) return -1;
    fcntl(descriptor, F_SETFD, FD_CLOEXEC);
    unlink(name);
    return descriptor;
}

int ewa_platform_standard_output(void) { return fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0); }

// What is no file, such as a device, answers EINVAL and has nothing to wait for.
bool ewa_platform_flush(int descriptor) { return fsync(descriptor) == 0 || errno == EINVAL; }

void ewa_platform_permit(int descriptor, uint32_t permissions) { (void)!fchmod(descriptor, (mode_t)permissions); }

bool ewa_platform_close(int descriptor) { return close(descriptor) == 0; }

// ---- Mapping (else platform_without_mapping.c)

#ifndef EWA_NO_MMAP
size_t ewa_platform_map_step(void) { return (size_t)sysconf(_SC_PAGESIZE); }

void *ewa_platform_map(int descriptor, uint64_t at_bytes, size_t size_bytes) {
    void *mapped = mmap(NULL, size_bytes, PROT_READ, MAP_PRIVATE, descriptor, (off_t)at_bytes);
    return mapped == MAP_FAILED ? NULL : mapped;
}

void ewa_platform_unmap(void *mapped, size_t size_bytes) { munmap(mapped, size_bytes); }

bool ewa_platform_unmap_part(void *first, size_t size_bytes) { return munmap(first, size_bytes) == 0; }

// Pages of a file come back from it when they are asked for again.
void ewa_platform_forget(void *mapped, size_t size_bytes) { madvise(mapped, size_bytes, MADV_DONTNEED); }
#endif
