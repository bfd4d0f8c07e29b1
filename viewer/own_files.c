// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files of our own: of colours and transfer functions that are not saved, and texts of cameras for a moment. They go when the viewer
// does. Each viewer holds a lock beside its files, so that those of one that was killed are known, and taken away at the next start.
#define _DARWIN_C_SOURCE // flock() on macOS
#include "inner.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { NAME_ATTEMPTS = 100, FOLDER_BYTES = 200 };

static void find_folder(char folder[FOLDER_BYTES]) {
    const char *named = getenv("TMPDIR");
    snprintf(folder, FOLDER_BYTES, "%s", named && *named && strlen(named) < FOLDER_BYTES ? named : "/tmp");
}

#if defined(_WIN32) || defined(__wasi__) // what is open cannot be locked by name, or nobody else is there
static bool hold(int file) { return file >= 0; }

void own_files_clean(void) {}
#else
#include <sys/file.h>

/// Locks a file unless another viewer does, or has just taken it away. The lock goes with the descriptor, however the program ends.
static bool hold(int file) {
    struct stat facts;
    return flock(file, LOCK_EX | LOCK_NB) == 0 && fstat(file, &facts) == 0 && facts.st_nlink > 0;
}

/// The length of the name of a lock without its end; 0: it is none.
static size_t stem_length(const char *name) {
    long long second;
    int attempt, length = 0;
    if (sscanf(name, "ewa-view-%lld-%d.lock%n", &second, &attempt, &length) != 2) return 0;
    return length > 0 && !name[length] ? (size_t)length - strlen(".lock") : 0;
}

/// Takes away the files that begin as a lock does.
static void remove_files(int folder, const char *stem, size_t length) {
    const int again = openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *list = again >= 0 ? fdopendir(again) : NULL;
    if (!list && again >= 0) close(again);
    const struct dirent *entry;
    while (list && (entry = readdir(list)))
        if (strncmp(entry->d_name, stem, length) == 0 && entry->d_name[length] == '-') unlinkat(folder, entry->d_name, 0);
    if (list) closedir(list);
}

void own_files_clean(void) {
    char path[FOLDER_BYTES];
    find_folder(path);
    DIR *list = opendir(path);
    const struct dirent *entry;
    while (list && (entry = readdir(list))) {
        const size_t length = stem_length(entry->d_name);
        const int folder = dirfd(list);
        const int file = length ? openat(folder, entry->d_name, O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK) : -1;
        struct stat facts;
        if (file < 0) continue;
        if (fstat(file, &facts) == 0 && S_ISREG(facts.st_mode) && facts.st_uid == geteuid() && hold(file)) {
            remove_files(folder, entry->d_name, length);
            unlinkat(folder, entry->d_name, 0);
        }
        close(file);
    }
    if (list) closedir(list);
}
#endif

/// Finds the beginning of the names of this viewer's files, and holds the lock beside them.
static bool begin(own_files *own) {
    char folder[FOLDER_BYTES], path[OWN_PATH_BYTES];
    find_folder(folder);
    errno = EEXIST;
    for (int attempt = 0; attempt < NAME_ATTEMPTS && (errno == EEXIST || errno == EWOULDBLOCK); attempt++) {
        snprintf(own->stem, sizeof own->stem, "%s/ewa-view-%lld-%d", folder, (long long)time(NULL), attempt);
        snprintf(path, sizeof path, "%s.lock", own->stem);
        own->lock = open(path, O_RDWR | O_CREAT | O_EXCL, 0600);
        if (own->lock < 0) continue;
        if (hold(own->lock)) return true;
        close(own->lock); // one that cleans has it, and takes it away
        errno = EEXIST;
    }
    own->stem[0] = 0;
    return false;
}

bool own_files_make(viewer *v, const char *word, const char *suffix, char path[OWN_PATH_BYTES]) {
    own_files *own = &v->own;
    path[0] = 0;
    bool done = own->stem[0] || begin(own);
    char **larger = done ? realloc(own->paths, (own->count + 1) * sizeof *larger) : NULL;
    if (larger) own->paths = larger;
    int file = -1;
    if (larger) {
        snprintf(path, OWN_PATH_BYTES, "%s-%s-%u%s", own->stem, word, own->made_count++, suffix);
        file = open(path, O_WRONLY | O_CREAT | O_EXCL, 0600);
    }
    char *kept = file >= 0 ? strdup(path) : NULL;
    if (kept) own->paths[own->count++] = kept;
    if (file >= 0) close(file);
    if (file >= 0 && !kept) unlink(path);
    if (!kept) viewer_tell(v, "a temporary file cannot be made: %s", strerror(errno));
    return kept != NULL;
}

void own_files_drop(viewer *v, const char *path) {
    own_files *own = &v->own;
    for (size_t i = 0; i < own->count; i++)
        if (strcmp(path, own->paths[i]) == 0) {
            unlink(path);
            free(own->paths[i]);
            own->paths[i] = own->paths[--own->count];
            return;
        }
}

bool own_files_has(const viewer *v, const char *path) {
    bool has = false;
    for (size_t i = 0; i < v->own.count; i++) has = has || strcmp(path, v->own.paths[i]) == 0;
    return has;
}

void own_files_remove(viewer *v) {
    own_files *own = &v->own;
    for (size_t i = 0; i < own->count; i++) {
        unlink(own->paths[i]);
        free(own->paths[i]);
    }
    free(own->paths);
    if (own->stem[0]) {
        char path[OWN_PATH_BYTES];
        snprintf(path, sizeof path, "%s.lock", own->stem);
        unlink(path);
        close(own->lock);
    }
    *own = (own_files){.paths = NULL};
}
