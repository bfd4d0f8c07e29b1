// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files on servers: what is known of them, and the parts of them that are kept.
#include "io/remote.h"
#include "base/base.h"
#include "base/context.h"
#include "io/http.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

enum {
    FIRST_BYTES = 1 << 16,    // of a file, when it is opened: heads of all formats, and whole small files
    KEPT_BYTES = 1 << 26,     // of parts, at most
    PIECE_BYTES = 1 << 22,    // asked for at once
    PARTS_AT_ONCE = 64,
    KNOWN_FILES = 64,         // also of those that are not there
};

/// What was found out about a file stays true for so long, while it is not open.
static const double KNOWN_S = 5;

typedef struct ewa_remote ewa_remote;

typedef struct kept_part {
    ewa_range range;
    uint8_t *bytes;
    uint64_t used; ///< when, by a count of uses
} kept_part;

struct ewa_remote_file {
    ewa_remote *remote;
    char *address;
    uint32_t open_count;
    double asked_s;
    ewa_status status;                      ///< of the first request
    char reason[EWA_HTTP_REASON_BYTES]; ///< of its failure
    uint64_t size_bytes;
    char tag[EWA_HTTP_TAG_BYTES];
    uint8_t *whole;   ///< all of it, of a server that gives no parts
    ewa_buffer parts; ///< kept_part
    uint32_t part_count;
};

struct ewa_remote {
    ewa_context *context;
    ewa_http *transfer;
    ewa_remote_file *files[KNOWN_FILES];
    uint64_t use_count, kept_bytes;
};

bool ewa_remote_is(const char *path) { return strncasecmp(path, "http://", 7) == 0 || strncasecmp(path, "https://", 8) == 0; }

// ---- What is kept

static void drop_part(ewa_remote_file *file, uint32_t index) {
    kept_part *parts = file->parts.data;
    ewa_release(file->remote->context, parts[index].bytes, (size_t)parts[index].range.size_bytes, 1);
    file->remote->kept_bytes -= parts[index].range.size_bytes;
    parts[index] = parts[--file->part_count];
}

/// Drops the part that was not used for the longest time; false where there is none.
static bool drop_oldest(ewa_remote *remote) {
    ewa_remote_file *of = NULL;
    uint32_t oldest = 0;
    uint64_t used = UINT64_MAX;
    for (int f = 0; f < KNOWN_FILES; f++) {
        ewa_remote_file *file = remote->files[f];
        for (uint32_t i = 0; file && i < file->part_count; i++)
            if (((kept_part *)file->parts.data)[i].used < used) {
                of = file;
                oldest = i;
                used = ((kept_part *)file->parts.data)[i].used;
            }
    }
    if (of) drop_part(of, oldest);
    return of;
}

/// Keeps a copy of a part, where there is memory for it.
static void keep(ewa_remote_file *file, const ewa_range *range, const uint8_t *bytes) {
    ewa_remote *remote = file->remote;
    ewa_context *context = remote->context;
    if (range->size_bytes > KEPT_BYTES / 4) return;
    while (remote->kept_bytes + range->size_bytes > KEPT_BYTES)
        if (!drop_oldest(remote)) return;
    // What is kept is never what makes memory too little for something else.
    if (ewa_memory_left(context) / 8 < KEPT_BYTES) return;
    if (ewa_buffer_grow(context, &file->parts, file->part_count, (size_t)file->part_count + 1, sizeof(kept_part)) != EWA_OK) return;
    uint8_t *copy = ewa_allocate(context, (size_t)range->size_bytes, 1);
    if (!copy) return;
    memcpy(copy, bytes, (size_t)range->size_bytes);
    ((kept_part *)file->parts.data)[file->part_count++] = (kept_part){*range, copy, ++remote->use_count};
    remote->kept_bytes += range->size_bytes;
}

/// Copies what is held of a part, from its begin up to the first byte that is not; returns how much, and in `*missing_bytes` how many
/// bytes follow of which none is held.
static uint64_t copy_kept(ewa_remote_file *file, const ewa_range *wanted, uint8_t *to, uint64_t *missing_bytes) {
    *missing_bytes = 0;
    if (file->whole) {
        memcpy(to, file->whole + wanted->at_bytes, (size_t)wanted->size_bytes);
        return wanted->size_bytes;
    }
    for (uint64_t done = 0;;) {
        kept_part *parts = file->parts.data;
        const uint64_t at = wanted->at_bytes + done, left = wanted->size_bytes - done;
        *missing_bytes = left;
        for (uint32_t i = 0; i < file->part_count && *missing_bytes; i++) {
            const uint64_t first = parts[i].range.at_bytes, end = first + parts[i].range.size_bytes;
            if (first > at && first - at < *missing_bytes) *missing_bytes = first - at;
            if (first > at || end <= at) continue;
            const uint64_t bytes = end - at < left ? end - at : left;
            memcpy(to + done, parts[i].bytes + (at - first), (size_t)bytes);
            parts[i].used = ++file->remote->use_count;
            done += bytes;
            *missing_bytes = 0;
        }
        if (*missing_bytes || done == wanted->size_bytes) return done;
    }
}

static void forget(ewa_remote_file *file) {
    ewa_context *context = file->remote->context;
    while (file->part_count) drop_part(file, file->part_count - 1);
    ewa_buffer_free(context, &file->parts);
    ewa_release(context, file->whole, (size_t)file->size_bytes, 1);
    ewa_release(context, file->address, strlen(file->address) + 1, 1);
    ewa_release(context, file, 1, sizeof *file);
}

static void end_remote(ewa_remote **remote) {
    ewa_remote *old = *remote;
    if (!old) return;
    for (int i = 0; i < KNOWN_FILES; i++)
        if (old->files[i]) forget(old->files[i]);
    ewa_http_destroy(&old->transfer);
    ewa_release(old->context, old, 1, sizeof *old);
    *remote = NULL;
}

/// Makes what a context has for its files on servers.
static ewa_status begin_remote(ewa_context *context) {
    if (context->remote) return EWA_OK;
    ewa_remote *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    const ewa_status status = ewa_http_create(context, &made->transfer);
    if (status == EWA_OK) {
        context->remote = made;
        context->end_remote = end_remote;
    } else {
        end_remote(&made);
    }
    return status;
}

// ---- Opening

/// Asks for the begin of a file.
static ewa_status ask(ewa_remote_file *file) {
    ewa_remote *remote = file->remote;
    uint8_t *first = ewa_allocate(remote->context, FIRST_BYTES, 1);
    if (!first) return EWA_ERROR_MEMORY;
    ewa_http_part part = {.at_bytes = 0, .size_bytes = FIRST_BYTES, .to = first};
    ewa_http_read(remote->transfer, file->address, &part, 1);
    if (part.status == EWA_OK && part.file_bytes == EWA_HTTP_SIZE_UNKNOWN) {
        part.status = EWA_ERROR_IO;
        snprintf(part.reason, sizeof part.reason, "the server does not say how long it is");
    }
    file->asked_s = ewa_now_s();
    file->status = part.status;
    memcpy(file->reason, part.reason, sizeof file->reason);
    if (part.status == EWA_OK) {
        file->size_bytes = part.file_bytes;
        file->whole = part.whole;
        memcpy(file->tag, part.tag, sizeof file->tag);
        if (part.got_bytes) keep(file, &(ewa_range){0, part.got_bytes}, first);
    }
    ewa_release(remote->context, first, FIRST_BYTES, 1);
    // These say nothing about the file.
    return part.status == EWA_ERROR_MEMORY || part.status == EWA_CANCELLED ? part.status : EWA_OK;
}

/// The place of a file that is known; NULL: it is not known, or was asked for too long ago, and then its place is free.
static ewa_remote_file **find(ewa_remote *remote, const char *path) {
    ewa_remote_file **found = NULL;
    for (int i = 0; i < KNOWN_FILES; i++) {
        ewa_remote_file *file = remote->files[i];
        if (!file) continue;
        if (!file->open_count && ewa_now_s() - file->asked_s > KNOWN_S) {
            forget(file);
            remote->files[i] = NULL;
        } else if (strcmp(file->address, path) == 0) {
            found = &remote->files[i];
        }
    }
    return found;
}

/// A place for one more, of which those that are not open give up theirs.
static ewa_remote_file **find_place(ewa_remote *remote) {
    ewa_remote_file **oldest = NULL;
    for (int i = 0; i < KNOWN_FILES; i++) {
        ewa_remote_file **at = &remote->files[i];
        if (!*at) return at;
        if (!(*at)->open_count && (!oldest || (*at)->asked_s < (*oldest)->asked_s)) oldest = at;
    }
    if (oldest) {
        forget(*oldest);
        *oldest = NULL;
    }
    return oldest;
}

static ewa_status add(ewa_remote *remote, const char *path, ewa_remote_file **added) {
    ewa_context *context = remote->context;
    ewa_remote_file **place = find_place(remote);
    if (!place) return ewa_fail(context, EWA_ERROR_LIMIT, "%s: more than %d files on servers are open", path, KNOWN_FILES);
    const size_t address_bytes = strlen(path) + 1;
    ewa_remote_file *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    char *address = made ? ewa_allocate(context, address_bytes, 1) : NULL;
    if (!address) {
        ewa_release(context, made, 1, sizeof *made);
        return EWA_ERROR_MEMORY;
    }
    memcpy(address, path, address_bytes);
    made->remote = remote;
    made->address = address;
    const ewa_status status = ask(made);
    if (status == EWA_OK)
        *place = *added = made;
    else
        forget(made);
    return status;
}

/// Whether an address is one that may be asked for.
static ewa_status check(ewa_context *context, const char *path) {
    if (context->options.untrusted)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: no servers are asked for untrusted inputs", path);
    const char *host = strstr(path, "://") + 3;
    if (memchr(host, '@', strcspn(host, "/?#")))
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: an address with a user's name in it is not asked for", path);
    // A folder that is no more than a server's name would be a part of whatever stands behind it.
    if (host[strcspn(host, "/?#")] != '/' || *host == '/')
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: the address names a server and no file", path);
    return EWA_OK;
}

ewa_status ewa_remote_open(ewa_context *context, const char *path, ewa_remote_file **file) {
    *file = NULL;
    EWA_TRY(check(context, path));
    EWA_TRY(begin_remote(context));
    ewa_remote_file **known = find(context->remote, path), *found = known ? *known : NULL;
    if (!found) EWA_TRY(add(context->remote, path, &found));
    if (found->status != EWA_OK) return ewa_fail(context, found->status, "%s: %s", path, found->reason);
    found->open_count++;
    *file = found;
    return EWA_OK;
}

void ewa_remote_close(ewa_remote_file **file) {
    if (*file) (*file)->open_count--;
    *file = NULL;
}

uint64_t ewa_remote_size_bytes(const ewa_remote_file *file) { return file->size_bytes; }

// ---- Reading

/// Looks whether a part that came is of the file that was opened.
static ewa_status check_part(const ewa_remote_file *file, const ewa_http_part *part) {
    ewa_context *context = file->remote->context;
    if (part->status == EWA_ERROR_MEMORY || part->status == EWA_CANCELLED) return part->status;
    const char *why = part->status != EWA_OK ? part->reason : NULL;
    const bool changed = part->whole || part->file_bytes != file->size_bytes || strcmp(part->tag, file->tag) != 0;
    if (!why && changed) why = "it has changed on the server since it was opened";
    if (!why && part->got_bytes < part->size_bytes) why = "the server sends fewer than there are";
    if (!why) return EWA_OK;
    return ewa_fail(context, part->status != EWA_OK ? part->status : EWA_ERROR_IO, "%s: bytes %llu to %llu of %llu: %s", file->address,
                    (unsigned long long)part->at_bytes, (unsigned long long)(part->at_bytes + part->size_bytes),
                    (unsigned long long)file->size_bytes, why);
}

/// Asks for parts, and keeps them.
static ewa_status fetch(ewa_remote_file *file, ewa_http_part *parts, uint32_t count) {
    ewa_status status = EWA_OK;
    ewa_http_read(file->remote->transfer, file->address, parts, count);
    // What was given up because another failed comes after that one.
    for (int given_up = 0; given_up < 2; given_up++)
        for (uint32_t i = 0; i < count && status == EWA_OK; i++)
            if ((parts[i].status == EWA_CANCELLED) == given_up) status = check_part(file, &parts[i]);
    for (uint32_t i = 0; i < count; i++) {
        if (parts[i].whole) ewa_release(file->remote->context, parts[i].whole, (size_t)parts[i].file_bytes, 1);
        if (status == EWA_OK) keep(file, &(ewa_range){parts[i].at_bytes, parts[i].size_bytes}, parts[i].to);
    }
    return status;
}

ewa_status ewa_remote_read(ewa_remote_file *file, const ewa_range *parts, uint8_t *const *to, uint32_t count) {
    ewa_http_part wanted[PARTS_AT_ONCE];
    uint32_t wanted_count = 0;
    memset(wanted, 0, sizeof wanted);
    for (uint32_t i = 0; i < count; i++)
        for (uint64_t done = 0; done < parts[i].size_bytes;) {
            const ewa_range rest = {parts[i].at_bytes + done, parts[i].size_bytes - done};
            uint64_t missing_bytes;
            const uint64_t held_bytes = copy_kept(file, &rest, to[i] + done, &missing_bytes);
            done += held_bytes;
            if (!missing_bytes) continue;
            const size_t bytes = (size_t)(missing_bytes < PIECE_BYTES ? missing_bytes : PIECE_BYTES);
            wanted[wanted_count++] = (ewa_http_part){.at_bytes = parts[i].at_bytes + done, .size_bytes = bytes, .to = to[i] + done};
            done += bytes;
            if (wanted_count < PARTS_AT_ONCE) continue;
            EWA_TRY(fetch(file, wanted, wanted_count));
            wanted_count = 0;
        }
    return wanted_count ? fetch(file, wanted, wanted_count) : EWA_OK;
}
