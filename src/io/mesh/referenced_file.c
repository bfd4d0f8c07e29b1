// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files that another file names: resolved, kept below the folder, opened step by step without following
// links, so that nothing can be exchanged between the check and the opening.
#define _XOPEN_SOURCE 700 // realpath
#include "io/mesh/referenced_file.h"
#include "base/base.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static int fail(char reason[EWA_REASON_BYTES], const char *why) {
    snprintf(reason, EWA_REASON_BYTES, "%s", why);
    return -1;
}

static int fail_errno(char reason[EWA_REASON_BYTES], int error) {
    if (error == ENOENT || error == ENOTDIR) return fail(reason, "it is not there");
    if (error == ELOOP) return fail(reason, "it is a link that changes");
    if (strerror_r(error, reason, EWA_REASON_BYTES) != 0)
        snprintf(reason, EWA_REASON_BYTES, "error %d", error);
    return -1;
}

/// Opens `inner`, which has no links in it, from a folder on, one name after the other.
static int open_steps(const char *folder, const char *inner, char reason[EWA_REASON_BYTES]) {
    int at = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    for (const char *step = inner; at >= 0;) {
        const char *slash = strchr(step, '/');
        const size_t length = slash ? (size_t)(slash - step) : strlen(step);
        char name[NAME_MAX + 1];
        if (length > NAME_MAX) {
            close(at);
            errno = ENAMETOOLONG;
            at = -1;
            break;
        }
        memcpy(name, step, length);
        name[length] = 0;
        // A pipe would make open() wait, and a terminal would become ours.
        const int flags =
            O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | (slash ? O_DIRECTORY : 0);
        const int next = openat(at, name, flags), error = errno;
        close(at);
        errno = error;
        at = next;
        if (!slash) break;
        step = slash + 1;
    }
    return at < 0 ? fail_errno(reason, errno) : at;
}

/// Joins a relative name to a folder, below which it must lie when links are resolved: `full`, within `base`.
static bool resolve_below(const char *folder, const char *name, char joined[PATH_MAX], char base[PATH_MAX],
                          char full[PATH_MAX], char reason[EWA_REASON_BYTES]) {
    const int length = snprintf(joined, PATH_MAX, "%s/%s", folder, name);
    if (length < 0 || length >= PATH_MAX) return fail(reason, "its name is too long") == 0;
    if (!realpath(folder, base) || !realpath(joined, full)) return fail_errno(reason, errno) == 0;
    const size_t base_length = strcmp(base, "/") == 0 ? 0 : strlen(base);
    if (strncmp(full, base, base_length) != 0 || full[base_length] != '/' || !full[base_length + 1])
        return fail(reason, "it is not below the folder of the file that names it") == 0;
    return true;
}

/// Opens a relative name below a folder.
static int open_below(const char *folder, const char *name, char reason[EWA_REASON_BYTES]) {
    char joined[PATH_MAX], base[PATH_MAX], full[PATH_MAX];
    if (!resolve_below(folder, name, joined, base, full, reason)) return -1;
    const int opened = open_steps(base, full + (strcmp(base, "/") == 0 ? 0 : strlen(base)) + 1, reason);
    struct stat facts;
    if (opened < 0) return -1;
    if (fstat(opened, &facts) == 0 && S_ISREG(facts.st_mode)) return opened;
    close(opened);
    return fail(reason, "it is no regular file");
}

/// Writes the folder that a file lies in, "." where its path has none.
static bool folder_of(const char *path, char folder[PATH_MAX], char reason[EWA_REASON_BYTES]) {
    const char *slash = strrchr(path, '/');
    const size_t length = slash ? (size_t)(slash - path) : 0;
    if (length >= PATH_MAX) return fail(reason, "its name is too long") == 0;
    snprintf(folder, PATH_MAX, "%.*s", (int)length, path);
    if (!length) snprintf(folder, PATH_MAX, "%s", slash ? "/" : ".");
    return true;
}

int ewa_referenced_file_open(const char *path, ewa_text name, char reason[EWA_REASON_BYTES]) {
    char relative[PATH_MAX], folder[PATH_MAX];
    if (name.length == 0 || memchr(name.chars, 0, name.length)) return fail(reason, "it has no name");
    if (name.length >= sizeof relative) return fail(reason, "its name is too long");
    if (!folder_of(path, folder, reason)) return -1;
    for (size_t i = 0; i < name.length; i++) relative[i] = name.chars[i] == '\\' ? '/' : name.chars[i];
    relative[name.length] = 0;
    const char *last = strrchr(relative, '/');
    const bool foreign = relative[0] == '/' || (relative[0] && relative[1] == ':') || strstr(relative, "://");
    const int opened = foreign ? fail(reason, "its name is absolute") : open_below(folder, relative, reason);
    if (opened >= 0 || !(last || foreign)) return opened;
    char second[EWA_REASON_BYTES];
    const char *own = last ? last + 1 : relative + 2;
    const int beside = *own ? open_below(folder, own, second) : -1;
    return beside >= 0 || !foreign ? beside
                                   : fail(reason, "its name is absolute, and it is not beside the file");
}

bool ewa_referenced_file_find(const char *path, const char *name, bool folders, char found[EWA_PATH_BYTES],
                              char reason[EWA_REASON_BYTES]) {
    char folder[PATH_MAX], joined[PATH_MAX], base[PATH_MAX], full[PATH_MAX];
    if (!*name || *name == '/') return fail(reason, *name ? "its name is absolute" : "it has no name") == 0;
    if (!folder_of(path, folder, reason) || !resolve_below(folder, name, joined, base, full, reason))
        return false;
    struct stat facts;
    const bool good =
        stat(full, &facts) == 0 && (S_ISREG(facts.st_mode) || (folders && S_ISDIR(facts.st_mode)));
    if (!good)
        return fail(reason,
                    folders ? "it is neither a regular file nor a folder" : "it is no regular file") == 0;
    // As it was named, for messages; a file of this folder by its own name.
    const int length = snprintf(found, EWA_PATH_BYTES, "%s", strchr(path, '/') ? joined : name);
    return (length > 0 && length < EWA_PATH_BYTES) || fail(reason, "its name is too long") == 0;
}

bool ewa_referenced_file_relate(const char *path, const char *target, char name[EWA_PATH_BYTES],
                                char reason[EWA_REASON_BYTES]) {
    char folder[PATH_MAX], base[PATH_MAX], full[PATH_MAX];
    if (!folder_of(path, folder, reason)) return false;
    if (!realpath(folder, base) || !realpath(target, full)) return fail_errno(reason, errno) == 0;
    const size_t length = strcmp(base, "/") == 0 ? 0 : strlen(base);
    if (strncmp(full, base, length) != 0 || full[length] != '/')
        return fail(reason, "it is not below the folder of the file that is to name it") == 0;
    return snprintf(name, EWA_PATH_BYTES, "%s", full + length + 1) < EWA_PATH_BYTES ||
           fail(reason, "its name is too long") == 0;
}

bool ewa_referenced_file_map(const char *path, ewa_text name, ewa_file *file, char reason[EWA_REASON_BYTES]) {
    *file = (ewa_file){0};
    const int descriptor = ewa_referenced_file_open(path, name, reason);
    if (descriptor < 0) return false;
    const bool mapped = ewa_file_map_descriptor(descriptor, file);
    if (!mapped) fail(reason, "it cannot be mapped");
    close(descriptor);
    return mapped;
}
