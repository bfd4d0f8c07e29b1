// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files that another file or a folder names: resolved, kept below the folder, opened step by step without following
// links, so that nothing can be exchanged between the check and the opening.
#include "io/referenced_file.h"
#include "base/base.h"
#include "base/platform.h"
#include "io/remote.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

static int fail(char reason[EWA_REASON_BYTES], const char *why) {
    snprintf(reason, EWA_REASON_BYTES, "%s", why);
    return -1;
}

static int fail_errno(char reason[EWA_REASON_BYTES], int error) {
    if (error == ENOENT || error == ENOTDIR) return fail(reason, "it is not there");
    if (error == ELOOP) return fail(reason, "it is a link that changes");
    ewa_platform_describe(error, reason, EWA_REASON_BYTES);
    return -1;
}

/// Joins a name to a folder, below which it must lie when links are resolved unless `anywhere`: `full`, which is `base`, '/' and
/// the rest.
static bool resolve(const char *folder, const char *name, bool anywhere, char joined[EWA_PATH_BYTES], char base[EWA_PATH_BYTES],
                    char full[EWA_PATH_BYTES], char reason[EWA_REASON_BYTES]) {
    const int length =
        ewa_platform_is_absolute(name) ? snprintf(joined, EWA_PATH_BYTES, "%s", name) : snprintf(joined, EWA_PATH_BYTES, "%s/%s", folder, name);
    if (length < 0 || length >= EWA_PATH_BYTES) return fail(reason, "its name is too long") == 0;
    if (!ewa_platform_resolve(folder, base) || !ewa_platform_resolve(joined, full)) return fail_errno(reason, errno) == 0;
    if (strcmp(base, "/") == 0) *base = 0;
    const size_t base_length = strlen(base);
    const bool below = strncmp(full, base, base_length) == 0 && full[base_length] == '/' && full[base_length + 1];
    if (!below && !anywhere)
        return fail(reason, "it is not below the folder of the file that names it; named_files anywhere opens it") == 0;
    if (!below) snprintf(base, EWA_PATH_BYTES, "%.*s", (int)strcspn(full, "/"), full); // the root, or a drive
    return true;
}

/// Opens a name in a folder.
static int open_in(const char *folder, const char *name, bool anywhere, char reason[EWA_REASON_BYTES]) {
    char joined[EWA_PATH_BYTES], base[EWA_PATH_BYTES], full[EWA_PATH_BYTES];
    if (!resolve(folder, name, anywhere, joined, base, full, reason)) return -1;
    const int opened = ewa_platform_open_below(*base ? base : "/", full + strlen(base) + 1);
    ewa_platform_facts facts;
    if (opened < 0) return fail_errno(reason, errno);
    if (ewa_platform_stat_open(opened, &facts) && facts.regular) return opened;
    ewa_platform_close(opened);
    return fail(reason, "it is no regular file");
}

/// Whether files may be opened that others name at all; else the reason.
static bool is_allowed(ewa_named_files allowed, char reason[EWA_REASON_BYTES]) {
    return allowed != EWA_NAMED_NONE ||
           fail(reason, "files that others name are not opened (named_files none)") == 0;
}

/// Writes the folder that a file lies in, "." where its path has none.
static bool folder_of(const char *path, char folder[EWA_PATH_BYTES], char reason[EWA_REASON_BYTES]) {
    const char *name = ewa_platform_file_name(path);
    const size_t length = name > path ? (size_t)(name - path) - 1 : 0;
    if (length >= EWA_PATH_BYTES) return fail(reason, "its name is too long") == 0;
    snprintf(folder, EWA_PATH_BYTES, "%.*s", (int)length, path);
    if (!length) snprintf(folder, EWA_PATH_BYTES, "%s", name > path ? "/" : ".");
    return true;
}

/// Writes a name with '/' between folders.
static void write_relative(ewa_text name, char *relative) {
    for (size_t i = 0; i < name.length; i++) relative[i] = name.chars[i] == '\\' ? '/' : name.chars[i];
    relative[name.length] = 0;
}

/// Writes what a name below a folder is to the caller of the library, who has files of its own; false: it leads out of it.
static bool join(const char *folder, const char *name, char joined[EWA_PATH_BYTES]) {
    if (strchr(name, '\\')) return false; // which some callers take for a '/'
    for (const char *part = name; part; part = strchr(part, '/') ? strchr(part, '/') + 1 : NULL)
        if (strncmp(part, "..", 2) == 0 && (!part[2] || part[2] == '/')) return false;
    const int length = snprintf(joined, EWA_PATH_BYTES, "%s/%s", folder, name);
    return *name && *name != '/' && length > 0 && length < EWA_PATH_BYTES;
}

/// Reads a name below a folder where it is a file of the caller's of the library; false: it is none, or `*status` says why not.
static bool map_source(ewa_context *context, const char *folder, const char *name, ewa_file *file, ewa_status *status) {
    char joined[EWA_PATH_BYTES];
    *status = EWA_OK;
    return join(folder, name, joined) && ewa_file_map_source(context, joined, file, status);
}

int ewa_referenced_file_open(ewa_named_files allowed, const char *path, ewa_text name, char reason[EWA_REASON_BYTES]) {
    char relative[EWA_PATH_BYTES], folder[EWA_PATH_BYTES];
    const bool anywhere = allowed == EWA_NAMED_ANYWHERE;
    if (!is_allowed(allowed, reason)) return -1;
    if (name.length == 0 || memchr(name.chars, 0, name.length)) return fail(reason, "it has no name");
    if (name.length >= sizeof relative) return fail(reason, "its name is too long");
    if (!folder_of(path, folder, reason)) return -1;
    write_relative(name, relative);
    const char *last = strrchr(relative, '/');
    const bool absolute = ewa_platform_is_absolute(relative),
               foreign = (absolute ? !anywhere : relative[0] && relative[1] == ':') || strstr(relative, "://");
    const int opened = foreign ? -1 : open_in(folder, relative, anywhere, reason);
    if (opened >= 0 || !(last || foreign)) return opened;
    char second[EWA_REASON_BYTES];
    const char *own = last ? last + 1 : relative + 2;
    const int beside = *own ? open_in(folder, own, anywhere, second) : -1;
    return beside >= 0 || !foreign ? beside
                                   : fail(reason, "its name is absolute, and it is not beside the file");
}

bool ewa_referenced_file_find(ewa_context *context, const char *path, const char *name, bool folders,
                              char found[EWA_PATH_BYTES], char reason[EWA_REASON_BYTES]) {
    char folder[EWA_PATH_BYTES], joined[EWA_PATH_BYTES], base[EWA_PATH_BYTES], full[EWA_PATH_BYTES];
    const ewa_named_files allowed = ewa_context_named_files(context);
    const bool anywhere = allowed == EWA_NAMED_ANYWHERE;
    if (!is_allowed(allowed, reason)) return false;
    if (!*name) return fail(reason, "it has no name") == 0;
    if (ewa_remote_is(name) && !anywhere) return fail(reason, "it is on a server; named_files anywhere asks it") == 0;
    if (ewa_platform_is_absolute(name) && !anywhere)
        return fail(reason, "its name is absolute; names are relative to the folder of the file that has them") == 0;
    if (ewa_remote_is(name)) return snprintf(found, EWA_PATH_BYTES, "%s", name) < EWA_PATH_BYTES || fail(reason, "its name is too long") == 0;
    if (!folder_of(path, folder, reason)) return false;
    if (join(folder, name, found) && ewa_file_is_source(context, found)) return true;
    char relative[EWA_PATH_BYTES];
    if (!resolve(folder, name, anywhere, joined, base, full, reason)) {
        // As Windows separates folders; on other systems a file may have such a name.
        if (!strchr(name, '\\') || strlen(name) >= sizeof relative) return false;
        write_relative((ewa_text){name, strlen(name)}, relative);
        name = relative;
        if (!resolve(folder, name, anywhere, joined, base, full, reason)) return false;
    }
    ewa_platform_facts facts;
    const bool good = ewa_platform_stat(full, &facts) && (facts.regular || (folders && facts.folder));
    if (!good)
        return fail(reason,
                    folders ? "it is neither a regular file nor a folder" : "it is no regular file") == 0;
    // As it was named, for messages; a file of this folder by its own name.
    const int length = snprintf(found, EWA_PATH_BYTES, "%s", ewa_platform_is_absolute(name) || ewa_platform_file_name(path) > path ? joined : name);
    return (length > 0 && length < EWA_PATH_BYTES) || fail(reason, "its name is too long") == 0;
}

bool ewa_referenced_file_relate(const char *path, const char *target, char name[EWA_PATH_BYTES],
                                char reason[EWA_REASON_BYTES]) {
    char folder[EWA_PATH_BYTES], base[EWA_PATH_BYTES], full[EWA_PATH_BYTES];
    if (!folder_of(path, folder, reason)) return false;
    if (ewa_remote_is(target)) return snprintf(name, EWA_PATH_BYTES, "%s", target) < EWA_PATH_BYTES || fail(reason, "its name is too long") == 0;
    if (!ewa_platform_resolve(folder, base) || !ewa_platform_resolve(target, full)) return fail_errno(reason, errno) == 0;
    const size_t length = strcmp(base, "/") == 0 ? 0 : strlen(base);
    if (strncmp(full, base, length) != 0 || full[length] != '/')
        return fail(reason, "it is not below the folder of the file that is to name it: write that one beside it or above") == 0;
    return snprintf(name, EWA_PATH_BYTES, "%s", full + length + 1) < EWA_PATH_BYTES ||
           fail(reason, "its name is too long") == 0;
}

/// Maps what was opened, and closes it.
static bool map_opened(ewa_context *context, int descriptor, ewa_file *file, char reason[EWA_REASON_BYTES]) {
    *file = (ewa_file){0};
    if (descriptor < 0) return false;
    const bool mapped = ewa_file_map_descriptor(context, descriptor, file);
    if (!mapped) fail(reason, "it cannot be read");
    ewa_platform_close(descriptor);
    return mapped;
}

bool ewa_referenced_file_map(ewa_context *context, const char *path, ewa_text name, ewa_file *file,
                             char reason[EWA_REASON_BYTES]) {
    const ewa_named_files allowed = ewa_context_named_files(context);
    char folder[EWA_PATH_BYTES], relative[EWA_PATH_BYTES];
    ewa_status status;
    if (allowed != EWA_NAMED_NONE && name.length < sizeof relative && !memchr(name.chars, 0, name.length) &&
        folder_of(path, folder, reason)) {
        write_relative(name, relative);
        const char *last = strrchr(relative, '/');
        if (map_source(context, folder, relative, file, &status) ||
            (last && status == EWA_OK && map_source(context, folder, last + 1, file, &status)))
            return status == EWA_OK || fail(reason, "it cannot be read") == 0;
    }
    const int descriptor = ewa_referenced_file_open(allowed, path, name, reason);
    return map_opened(context, descriptor, file, reason);
}

ewa_status ewa_referenced_file_part(ewa_context *context, const char *folder, const char *name, ewa_file *file) {
    char reason[EWA_REASON_BYTES];
    const ewa_named_files allowed = ewa_context_named_files(context);
    ewa_status status;
    *file = (ewa_file){0};
    if (allowed != EWA_NAMED_NONE && map_source(context, folder, name, file, &status)) return status;
    if (is_allowed(allowed, reason) &&
        map_opened(context, open_in(folder, name, allowed == EWA_NAMED_ANYWHERE, reason), file, reason))
        return EWA_OK;
    return ewa_fail(context, EWA_ERROR_IO, "%s/%s: %s", folder, name, reason);
}
