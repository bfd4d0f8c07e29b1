// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files whose bytes the caller has, part by part.
#include "io/ranges.h"
#include "base/base.h"
#include "base/context.h"
#include "io/remote.h"

#include <stdlib.h>
#include <string.h>

enum {
    AHEAD_BYTES = 1 << 16,   // a small part comes with as many that follow: heads stand before what they are of
    GAP_BYTES = 1 << 16,     // parts that are no farther apart are read at once
    TOGETHER_BYTES = 1 << 23 // if they are no longer together
};

typedef struct held_range {
    uint64_t at_bytes;
    size_t size_bytes;
    uint8_t *bytes;
} held_range;

struct ewa_ranges {
    ewa_context *context;
    ewa_file_source source;
    ewa_remote_file *remote; ///< of a file on a server, instead of what the source reads by
    ewa_buffer held; ///< held_range
    uint32_t held_count;
    size_t path_bytes;
    char path[];
};

ewa_status ewa_ranges_open(ewa_context *context, const char *path, ewa_ranges **ranges) {
    const ewa_context_options *options = &context->options;
    ewa_file_source source = {0};
    ewa_remote_file *remote = NULL;
    *ranges = NULL;
    if (!options->open_file || !options->open_file(options->open_file_user, path, &source)) {
        if (!ewa_remote_is(path)) return EWA_OK;
        EWA_TRY(ewa_remote_open(context, path, &remote));
        source.size_bytes = ewa_remote_size_bytes(remote);
    }
    const size_t path_bytes = strlen(path) + 1, made_bytes = sizeof(ewa_ranges) + path_bytes;
    ewa_ranges *made = source.read_at || remote ? ewa_allocate_zeroed(context, made_bytes, 1) : NULL;
    if (!made) {
        if (source.close) source.close(source.user);
        const bool known = source.read_at || remote;
        ewa_remote_close(&remote);
        return known ? EWA_ERROR_MEMORY
                              : ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: was opened without a function that reads it", path);
    }
    made->context = context;
    made->source = source;
    made->remote = remote;
    made->path_bytes = path_bytes;
    memcpy(made->path, path, path_bytes);
    *ranges = made;
    return EWA_OK;
}

uint32_t ewa_ranges_count(const ewa_ranges *ranges) { return ranges->held_count; }

void ewa_ranges_let_go(ewa_ranges *ranges, uint32_t count) {
    const held_range *held = ranges->held.data;
    for (; ranges->held_count > count; ranges->held_count--) {
        const held_range *last = &held[ranges->held_count - 1];
        ewa_release(ranges->context, last->bytes, last->size_bytes, 1);
    }
}

void ewa_ranges_close(ewa_ranges **ranges) {
    ewa_ranges *old = *ranges;
    if (!old) return;
    ewa_ranges_let_go(old, 0);
    ewa_buffer_free(old->context, &old->held);
    if (old->source.close) old->source.close(old->source.user);
    ewa_remote_close(&old->remote);
    ewa_release(old->context, old, sizeof *old + old->path_bytes, 1);
    *ranges = NULL;
}

uint64_t ewa_ranges_size_bytes(const ewa_ranges *ranges) { return ranges->source.size_bytes; }

bool ewa_ranges_are_remote(const ewa_ranges *ranges) { return ranges->remote; }

static bool is_within(const ewa_ranges *ranges, uint64_t at_bytes, uint64_t size_bytes) {
    return at_bytes <= ranges->source.size_bytes && size_bytes <= ranges->source.size_bytes - at_bytes;
}

static ewa_status fail(const ewa_ranges *ranges, uint64_t from, uint64_t to, const char *why) {
    return ewa_fail(ranges->context, EWA_ERROR_IO, "%s: bytes %llu to %llu of %llu: %s", ranges->path, (unsigned long long)from,
                    (unsigned long long)to, (unsigned long long)ranges->source.size_bytes, why);
}

ewa_status ewa_ranges_read(ewa_ranges *ranges, uint64_t at_bytes, uint64_t size_bytes, uint8_t *to) {
    const ewa_file_source *source = &ranges->source;
    const uint64_t end_bytes = at_bytes + size_bytes;
    if (!is_within(ranges, at_bytes, size_bytes)) return fail(ranges, at_bytes, end_bytes, "they lie beyond the end");
    if (ranges->remote) return ewa_remote_read(ranges->remote, &(ewa_range){at_bytes, size_bytes}, &to, 1);
    for (uint64_t at = at_bytes; at < end_bytes;) {
        const uint64_t left = end_bytes - at;
        const size_t wanted = left < EWA_FILE_PIECE_BYTES ? (size_t)left : EWA_FILE_PIECE_BYTES;
        const int64_t got = source->read_at(source->user, at, to + (at - at_bytes), wanted);
        if (got < 0) return fail(ranges, at, at + wanted, "they cannot be read");
        if (got == 0) return fail(ranges, at, at + wanted, "there are none, the file is shorter than it was said to be");
        if ((uint64_t)got > wanted) return fail(ranges, at, at + wanted, "more came than were asked for");
        at += (uint64_t)got;
        EWA_TRY(ewa_progress(ranges->context, "read", (double)at / (double)source->size_bytes));
    }
    return EWA_OK;
}

const uint8_t *ewa_ranges_find(const ewa_ranges *ranges, uint64_t at_bytes, uint64_t size_bytes) {
    const held_range *held = ranges->held.data;
    for (uint32_t i = ranges->held_count; i-- > 0;)
        if (at_bytes >= held[i].at_bytes && at_bytes - held[i].at_bytes <= held[i].size_bytes &&
            size_bytes <= held[i].size_bytes - (at_bytes - held[i].at_bytes))
            return held[i].bytes + (at_bytes - held[i].at_bytes);
    return NULL;
}

/// Reads a part and holds it.
ewa_status ewa_ranges_take(ewa_ranges *ranges, uint64_t at_bytes, uint64_t size_bytes, uint8_t **bytes) {
    *bytes = NULL;
    if (size_bytes > SIZE_MAX)
        return ewa_fail(ranges->context, EWA_ERROR_MEMORY, "%s: %llu bytes are more than an address can tell", ranges->path,
                        (unsigned long long)size_bytes);
    uint8_t *taken = ewa_allocate(ranges->context, (size_t)size_bytes, 1);
    if (!taken) return EWA_ERROR_MEMORY;
    const ewa_status status = ewa_ranges_read(ranges, at_bytes, size_bytes, taken);
    if (status == EWA_OK)
        *bytes = taken;
    else
        ewa_release(ranges->context, taken, (size_t)size_bytes, 1);
    return status;
}

/// Makes room to hold a part, whose bytes are not there yet.
static ewa_status add_held(ewa_ranges *ranges, const ewa_range *part) {
    const uint64_t at_bytes = part->at_bytes, size_bytes = part->size_bytes;
    if (!is_within(ranges, at_bytes, size_bytes)) return fail(ranges, at_bytes, at_bytes + size_bytes, "they lie beyond the end");
    EWA_TRY(ewa_memory_check(ranges->context, size_bytes, "%s: bytes %llu to %llu", ranges->path, (unsigned long long)at_bytes,
                             (unsigned long long)(at_bytes + size_bytes)));
    EWA_TRY(ewa_buffer_grow(ranges->context, &ranges->held, ranges->held_count, (size_t)ranges->held_count + 1, sizeof(held_range)));
    held_range held = {at_bytes, (size_t)size_bytes, ewa_allocate(ranges->context, (size_t)size_bytes, 1)};
    if (!held.bytes) return EWA_ERROR_MEMORY;
    ((held_range *)ranges->held.data)[ranges->held_count++] = held;
    return EWA_OK;
}

/// Reads parts and holds them, those of a server several at a time; none after a failure.
static ewa_status hold(ewa_ranges *ranges, const ewa_range *parts, uint32_t count) {
    const uint32_t before = ranges->held_count;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < count && status == EWA_OK; i++) status = add_held(ranges, &parts[i]);
    const held_range *held = (const held_range *)ranges->held.data + before;
    if (ranges->remote && status == EWA_OK) {
        uint8_t **to = ewa_allocate(ranges->context, count, sizeof *to);
        status = to ? EWA_OK : EWA_ERROR_MEMORY;
        for (uint32_t i = 0; i < count && to; i++) to[i] = held[i].bytes;
        if (to) status = ewa_remote_read(ranges->remote, parts, to, count);
        ewa_release(ranges->context, to, count, sizeof *to);
    }
    for (uint32_t i = 0; i < count && status == EWA_OK && !ranges->remote; i++)
        status = ewa_ranges_read(ranges, held[i].at_bytes, held[i].size_bytes, held[i].bytes);
    if (status != EWA_OK) ewa_ranges_let_go(ranges, before);
    return status;
}

ewa_status ewa_ranges_need(ewa_ranges *ranges, uint64_t at_bytes, uint64_t size_bytes, const uint8_t **bytes) {
    *bytes = ewa_ranges_find(ranges, at_bytes, size_bytes);
    if (*bytes) return EWA_OK;
    uint64_t wanted = size_bytes;
    if (is_within(ranges, at_bytes, size_bytes) && size_bytes < AHEAD_BYTES) {
        const uint64_t left = ranges->source.size_bytes - at_bytes;
        wanted = left < AHEAD_BYTES ? left : AHEAD_BYTES;
    }
    EWA_TRY(hold(ranges, &(ewa_range){at_bytes, wanted}, 1));
    *bytes = ewa_ranges_find(ranges, at_bytes, size_bytes);
    return EWA_OK;
}

static int compare(const void *a, const void *b) {
    const ewa_range *left = a, *right = b;
    return (left->at_bytes > right->at_bytes) - (left->at_bytes < right->at_bytes);
}

ewa_status ewa_ranges_need_all(ewa_ranges *ranges, ewa_range *parts, uint32_t count) {
    uint32_t missing = 0;
    for (uint32_t i = 0; i < count; i++)
        if (!ewa_ranges_find(ranges, parts[i].at_bytes, parts[i].size_bytes)) parts[missing++] = parts[i];
    if (missing) qsort(parts, missing, sizeof *parts, compare);
    uint32_t joined = 0;
    for (uint32_t i = 0, next; i < missing; i = next) {
        const uint64_t at_bytes = parts[i].at_bytes;
        uint64_t end_bytes = at_bytes + parts[i].size_bytes;
        for (next = i + 1; next < missing; next++) {
            const uint64_t next_end_bytes = parts[next].at_bytes + parts[next].size_bytes;
            if (parts[next].at_bytes > end_bytes + GAP_BYTES || next_end_bytes - at_bytes > TOGETHER_BYTES) break;
            if (next_end_bytes > end_bytes) end_bytes = next_end_bytes;
        }
        parts[joined++] = (ewa_range){at_bytes, end_bytes - at_bytes};
    }
    return joined ? hold(ranges, parts, joined) : EWA_OK;
}
