// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Whole files in, whole files out.
#include "io/file.h"
#include "base/base.h"
#include "base/context.h"
#include "base/platform.h"
#include "io/ranges.h"
#include "io/http.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

enum {
    READ_STEP_BYTES = 1 << 16,    // first buffer for an input of unknown length; doubles when full
    WRITE_BUFFER_BYTES = 1 << 16, // pieces below this size are collected
    NAME_ATTEMPTS = 100,          // temporary names tried when others exist already
};

struct ewa_writer {
    ewa_context *context;
    ewa_status status; // the first failure
    int descriptor;
    bool temporary; // `written` is to be renamed to `target`
    bool nameless;  // the file has no name yet: it is gone when the process ends, however it ends
    size_t buffered_bytes;
    uint64_t flushed_bytes;
    char shown[EWA_PATH_BYTES];   // the path as the caller wrote it, for messages
    char target[EWA_PATH_BYTES];  // where the file belongs, links resolved
    char written[EWA_PATH_BYTES]; // the file that receives the bytes
    uint8_t buffer[WRITE_BUFFER_BYTES];
};

static ewa_status fail_errno(ewa_context *context, const char *path, int error) {
    char reason[128];
    if (error == ENOLINK)
        return ewa_fail(context, EWA_ERROR_IO, "%s: is a link to a file that is not there", path);
    ewa_platform_describe(error, reason, sizeof reason);
    const char *advice = "";
    if (error == ENOENT && strstr(path, "://") && strncmp(path, "http", 4) != 0)
        advice = "; of addresses, those with http:// and https:// are read";
    else if (error == ENOENT && strpbrk(path, "*?"))
        advice = "; * and ? stand for other letters where a shell expands them: not within quotes";
    return ewa_fail(context, EWA_ERROR_IO, "%s: %s%s", path, reason, advice);
}

/// Reads a stream to its end into memory of the allocator that doubles as it fills.
static ewa_status read_stream(ewa_context *context, const char *path, int descriptor, ewa_file *file) {
    uint8_t *bytes = NULL;
    size_t size = 0, capacity = 0;
    ewa_status status = EWA_OK;
    for (;;) {
        if (size == capacity) {
            const size_t larger = capacity ? 2 * capacity : READ_STEP_BYTES;
            status = ewa_memory_check(context, larger, "%s: more than %zu bytes", path, size);
            uint8_t *moved = status == EWA_OK ? ewa_allocate(context, larger, 1) : NULL;
            if (!moved) {
                if (status == EWA_OK) status = EWA_ERROR_MEMORY;
                break;
            }
            if (size) memcpy(moved, bytes, size);
            ewa_release(context, bytes, capacity, 1);
            bytes = moved;
            capacity = larger;
        }
        const int64_t got = ewa_platform_read(descriptor, bytes + size, capacity - size);
        if (got == 0) break;
        if (got < 0) {
            // A signal may want what waits for a pipe to be given up.
            status = errno == EINTR ? ewa_progress(context, "read", 0) : fail_errno(context, path, errno);
            if (status == EWA_OK) continue;
            break;
        }
        size += (size_t)got;
    }
    if (status != EWA_OK)
        ewa_release(context, bytes, capacity, 1);
    else
        *file = (ewa_file){.bytes = bytes, .size_bytes = size, .capacity_bytes = capacity};
    return status;
}

/// Maps a regular file that is not empty.
static bool map_file(int descriptor, const ewa_platform_facts *facts, ewa_file *file) {
    if (!facts->regular || facts->size_bytes == 0 || facts->size_bytes > SIZE_MAX || !ewa_platform_is_at_start(descriptor))
        return false;
    const size_t size = (size_t)facts->size_bytes;
    void *mapped = ewa_platform_map(descriptor, 0, size);
    if (!mapped) return false;
    *file = (ewa_file){.bytes = mapped, .size_bytes = size, .capacity_bytes = size, .mapped = true};
    return true;
}

bool ewa_file_map_descriptor(ewa_context *context, int descriptor, ewa_file *file) {
    ewa_platform_facts facts;
    *file = (ewa_file){0};
    if (!ewa_platform_stat_open(descriptor, &facts)) return false;
    if (facts.size_bytes == 0 || map_file(descriptor, &facts, file)) return true;
    ewa_failures_hush(context, true);
    const ewa_status status = read_stream(context, "file", descriptor, file);
    ewa_failures_hush(context, false);
    return status == EWA_OK;
}

/// Reads a file of the caller's as a whole.
static ewa_status read_whole(ewa_context *context, ewa_ranges *ranges, const char *path, ewa_file *file) {
    const uint64_t size_bytes = ewa_ranges_size_bytes(ranges);
    uint8_t *bytes = NULL;
    if (ewa_ranges_are_remote(ranges) && size_bytes > EWA_HTTP_WHOLE_BYTES)
        return ewa_fail(context, EWA_ERROR_LIMIT,
                        "%s: %llu bytes on a server; what is read as a whole may have 1 GiB: download it, or have an octree made of it",
                        path, (unsigned long long)size_bytes);
    EWA_TRY(ewa_memory_check(context, size_bytes, "%s", path));
    if (size_bytes) EWA_TRY(ewa_ranges_take(ranges, 0, size_bytes, &bytes));
    *file = (ewa_file){.bytes = bytes, .size_bytes = (size_t)size_bytes, .capacity_bytes = (size_t)size_bytes};
    return EWA_OK;
}

/// What is kept, if it is of that path.
static ewa_kept_file *kept_at(const ewa_context *context, const char *path) {
    ewa_kept_file *kept = context->kept_file;
    return kept && strcmp(kept->path, path) == 0 ? kept : NULL;
}

void ewa_file_keep_begin(ewa_context *context, ewa_kept_file *kept, const char *path) {
    *kept = (ewa_kept_file){.outer = context->kept_file, .path = path};
    context->kept_file = kept;
}

void ewa_file_keep_end(ewa_context *context, ewa_kept_file *kept) {
    context->kept_file = kept->outer;
    ewa_file_unmap(context, &kept->file);
}

bool ewa_file_map_source(ewa_context *context, const char *path, ewa_file *file, ewa_status *status) {
    ewa_kept_file *kept = kept_at(context, path);
    *file = (ewa_file){0};
    *status = EWA_OK;
    if (kept && kept->file.bytes && !kept->mapped) {
        *file = kept->file;
        kept->mapped = true;
        return true;
    }
    ewa_ranges *ranges;
    *status = ewa_ranges_open(context, path, &ranges);
    if (!ranges) return *status != EWA_OK;
    *status = read_whole(context, ranges, path, file);
    ewa_ranges_close(&ranges);
    if (*status == EWA_OK && kept && !kept->file.bytes) kept->file = *file, kept->mapped = true;
    return true;
}

bool ewa_file_is_source(ewa_context *context, const char *path) {
    ewa_ranges *ranges;
    ewa_failures_hush(context, true);
    const bool opened = ewa_ranges_open(context, path, &ranges) == EWA_OK && ranges;
    ewa_failures_hush(context, false);
    ewa_ranges_close(&ranges);
    return opened;
}

bool ewa_file_may_read(ewa_context *context, const char *path) {
    ewa_platform_facts facts;
    if (strcmp(path, "-") == 0) return false;
    return ewa_file_is_source(context, path) || (ewa_platform_stat(path, &facts) && facts.regular && ewa_platform_may_read(path));
}

/// Reads the head of a file of the caller's; returns how many bytes it has.
static size_t read_head(ewa_context *context, ewa_ranges *ranges, uint8_t head[EWA_FILE_HEAD_BYTES]) {
    const uint64_t size_bytes = ewa_ranges_size_bytes(ranges);
    const size_t there = size_bytes < EWA_FILE_HEAD_BYTES ? (size_t)size_bytes : EWA_FILE_HEAD_BYTES;
    ewa_failures_hush(context, true);
    const ewa_status status = ewa_ranges_read(ranges, 0, there, head);
    ewa_failures_hush(context, false);
    return status == EWA_OK ? there : 0;
}

size_t ewa_file_head(ewa_context *context, const char *path, uint8_t *bytes, size_t room) {
    ewa_platform_facts facts;
    ewa_kept_file read = {.path = path}, *kept = context ? kept_at(context, path) : NULL;
    ewa_ranges *ranges = NULL;
    if (!kept) kept = &read;
    if (context && !kept->head_bytes) {
        ewa_failures_hush(context, true);
        const ewa_status status = ewa_ranges_open(context, path, &ranges);
        ewa_failures_hush(context, false);
        if (status != EWA_OK) return 0;
        if (ranges) kept->head_bytes = read_head(context, ranges, kept->head);
        const bool opened = ranges;
        ewa_ranges_close(&ranges);
        if (opened && !kept->head_bytes) return 0;
    }
    if (kept->head_bytes) {
        const size_t there = kept->head_bytes < room ? kept->head_bytes : room;
        memcpy(bytes, kept->head, there);
        return there;
    }
    const int descriptor = ewa_platform_open(path, false);
    if (descriptor < 0) return 0;
    const int64_t got =
        ewa_platform_stat_open(descriptor, &facts) && facts.regular ? ewa_platform_read(descriptor, bytes, room) : 0;
    ewa_platform_close(descriptor);
    return got > 0 ? (size_t)got : 0;
}

static ewa_status read_descriptor(ewa_context *context, const char *path, int descriptor, ewa_file *file) {
    ewa_platform_facts facts;
    if (!ewa_platform_stat_open(descriptor, &facts)) return fail_errno(context, path, errno);
    if (facts.folder) return fail_errno(context, path, EISDIR);
    // Files of /proc call themselves regular and empty, and some file systems cannot map: both can be read.
    return map_file(descriptor, &facts, file) ? EWA_OK : read_stream(context, path, descriptor, file);
}

ewa_status ewa_file_map(ewa_context *context, const char *path, ewa_file *file) {
    *file = (ewa_file){0};
    if (strcmp(path, "-") == 0) return read_descriptor(context, "standard input", ewa_platform_standard_input(), file);
    ewa_status status;
    if (ewa_file_map_source(context, path, file, &status)) return status;
    const int descriptor = ewa_platform_open(path, true);
    if (descriptor < 0) return fail_errno(context, path, errno);
    status = read_descriptor(context, path, descriptor, file);
    ewa_platform_close(descriptor);
    return status;
}

void ewa_file_unmap(ewa_context *context, ewa_file *file) {
    uint8_t *bytes = (uint8_t *)(uintptr_t)file->bytes;
    ewa_kept_file *kept = context->kept_file;
    if (kept && bytes && kept->file.bytes == bytes) {
        kept->mapped = false;
    } else if (!file->mapped) {
        ewa_release(context, bytes, file->capacity_bytes, 1);
    } else if (file->hole_end) {
        ewa_platform_unmap(bytes, file->hole_first);
        if (file->capacity_bytes > file->hole_end)
            ewa_platform_unmap(bytes + file->hole_end, file->capacity_bytes - file->hole_end);
    } else {
        ewa_platform_unmap(bytes, file->capacity_bytes);
    }
    *file = (ewa_file){0};
}

void ewa_file_passed(const uint8_t *bytes, uint64_t at_bytes) {
    const uint64_t step = ewa_platform_map_step(), whole_bytes = at_bytes / step * step;
    if (whole_bytes) ewa_platform_forget((void *)(uintptr_t)bytes, (size_t)whole_bytes);
}

void ewa_file_give_up(ewa_file *file, uint64_t from, uint64_t to) {
    const uint64_t step = ewa_platform_map_step(), first = (from + step - 1) / step * step, end = to / step * step;
    if (!file->mapped || end <= first ||
        !ewa_platform_unmap_part((void *)(uintptr_t)(file->bytes + first), (size_t)(end - first)))
        return;
    file->hole_first = (size_t)first, file->hole_end = (size_t)end;
}

int ewa_file_open_pieces(const char *path, uint64_t size_bytes) {
    ewa_platform_facts facts;
    const int descriptor = ewa_platform_open(path, true);
    if (descriptor < 0) return -1;
    if (ewa_platform_stat_open(descriptor, &facts) && facts.regular && facts.size_bytes == size_bytes) return descriptor;
    ewa_platform_close(descriptor);
    return -1;
}

bool ewa_file_piece_map(int descriptor, uint64_t at_bytes, size_t size_bytes, ewa_file *piece,
                        const uint8_t **bytes) {
    const size_t before = (size_t)(at_bytes % ewa_platform_map_step()), mapped_bytes = size_bytes + before;
    *piece = (ewa_file){0};
    void *mapped = ewa_platform_map(descriptor, at_bytes - before, mapped_bytes);
    if (!mapped) return false;
    *piece = (ewa_file){
        .bytes = mapped, .size_bytes = mapped_bytes, .capacity_bytes = mapped_bytes, .mapped = true};
    *bytes = piece->bytes + before;
    return true;
}

/// Bytes of a path that are its folder's, with the slash.
static int folder_bytes_of(const char *path) { return (int)(ewa_platform_file_name(path) - path); }

/// Gives a file a name beside the target that nothing has, by `make`, which fails with EEXIST for one that is taken; returns what
/// it returned, or -1 with errno. The name is short and does not grow with the target's, so that every target that can be
/// named can be written.
static int take_name(ewa_writer *writer, int (*make)(ewa_writer *writer)) {
    for (int attempt = 0; attempt < NAME_ATTEMPTS; attempt++) {
        char words[64];
        ewa_platform_unique(attempt, words);
        const int length = snprintf(writer->written, sizeof writer->written, "%.*s.ewa-%s.tmp",
                                    folder_bytes_of(writer->target), writer->target, words);
        if (length < 0 || (size_t)length >= sizeof writer->written) {
            errno = ENAMETOOLONG;
            return -1;
        }
        const int made = make(writer);
        if (made >= 0 || errno != EEXIST) return made;
    }
    return -1;
}

static int create_named(ewa_writer *writer) {
    return ewa_platform_create(writer->written);
}

static int link_nameless(ewa_writer *writer) {
    return ewa_platform_name(writer->descriptor, writer->written);
}

/// Opens a new file in the folder of the target, without a name where the system can.
static int open_temporary(ewa_writer *writer) {
    char folder[EWA_PATH_BYTES];
    const int folder_bytes = folder_bytes_of(writer->target);
    snprintf(folder, sizeof folder, "%.*s", folder_bytes ? folder_bytes : 1,
             folder_bytes ? writer->target : ".");
    const int descriptor = ewa_platform_create_nameless(folder);
    writer->nameless = descriptor >= 0;
    return descriptor >= 0 ? descriptor : take_name(writer, create_named);
}

/// Gives the file a name, so that it can be renamed.
static void name_file(ewa_writer *writer) {
    if (!writer->nameless || writer->status != EWA_OK) return;
    if (take_name(writer, link_nameless) < 0)
        writer->status = fail_errno(writer->context, writer->shown, errno);
    else
        writer->nameless = false;
}

/// Finds out what the target is and opens the file that receives the bytes; returns its descriptor or -1 with
/// errno.
static int open_output(ewa_writer *writer) {
    if (strcmp(writer->shown, "-") == 0 || strcmp(writer->shown, "/dev/stdout") == 0)
        return ewa_platform_standard_output();
    ewa_platform_facts facts;
    if (!ewa_platform_stat(writer->shown, &facts)) {
        if (errno != ENOENT) return -1;
        if (ewa_platform_is_link(writer->shown)) {
            errno = ENOLINK;
            return -1;
        }
        memcpy(writer->target, writer->shown, sizeof writer->target);
        writer->temporary = true;
        return open_temporary(writer);
    }
    if (!facts.regular) {
        memcpy(writer->written, writer->shown, sizeof writer->written);
        return ewa_platform_open_device(writer->shown);
    }
    // Renaming asks the folder for permission only; a file that is write-protected is meant to stay.
    if (!ewa_platform_resolve(writer->shown, writer->target) || !ewa_platform_may_write(writer->target)) return -1;
    writer->temporary = true;
    const int descriptor = open_temporary(writer);
    if (descriptor >= 0) ewa_platform_permit(descriptor, facts.permissions);
    return descriptor;
}

ewa_status ewa_writer_open(ewa_context *context, const char *path, ewa_writer **writer) {
    *writer = NULL;
    const size_t length = strlen(path);
    if (length == 0) return fail_errno(context, "output file", ENOENT);
    if (length >= EWA_PATH_BYTES) return fail_errno(context, path, ENAMETOOLONG);
    ewa_writer *made = ewa_allocate(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->status = EWA_OK;
    made->temporary = made->nameless = false;
    made->buffered_bytes = 0;
    made->flushed_bytes = 0;
    memcpy(made->shown, path, length + 1);
    made->descriptor = open_output(made);
    if (made->descriptor < 0) {
        const ewa_status status = fail_errno(context, path, errno);
        ewa_release(context, made, 1, sizeof *made);
        return status;
    }
    *writer = made;
    return EWA_OK;
}

static ewa_status write_all(ewa_writer *writer, const uint8_t *bytes, size_t size_bytes) {
    while (size_bytes && writer->status == EWA_OK) {
        const int64_t put = ewa_platform_write(writer->descriptor, bytes, size_bytes);
        if (put < 0) {
            if (errno != EINTR) writer->status = fail_errno(writer->context, writer->shown, errno);
            continue;
        }
        bytes += put;
        size_bytes -= (size_t)put;
        writer->flushed_bytes += (uint64_t)put;
    }
    return writer->status;
}

static ewa_status flush(ewa_writer *writer) {
    const size_t size_bytes = writer->buffered_bytes;
    writer->buffered_bytes = 0;
    return write_all(writer, writer->buffer, size_bytes);
}

ewa_status ewa_writer_put(ewa_writer *writer, const void *data, size_t size_bytes) {
    if (writer->status != EWA_OK || size_bytes == 0) return writer->status;
    if (size_bytes > sizeof writer->buffer - writer->buffered_bytes && flush(writer) != EWA_OK)
        return writer->status;
    if (size_bytes >= sizeof writer->buffer) return write_all(writer, data, size_bytes);
    memcpy(writer->buffer + writer->buffered_bytes, data, size_bytes);
    writer->buffered_bytes += size_bytes;
    return EWA_OK;
}

uint64_t ewa_writer_size(const ewa_writer *writer) { return writer->flushed_bytes + writer->buffered_bytes; }

bool ewa_writer_can_patch(const ewa_writer *writer) { return writer->temporary; }

ewa_status ewa_writer_patch(ewa_writer *writer, uint64_t at_bytes, const void *data, size_t size_bytes) {
    if (writer->status != EWA_OK || flush(writer) != EWA_OK) return writer->status;
    if (!ewa_writer_can_patch(writer))
        return writer->status = ewa_fail(writer->context, EWA_ERROR_IO,
                                         "%s: no place to go back to: write to a file", writer->shown);
    const uint8_t *bytes = data;
    while (size_bytes) {
        const int64_t put = ewa_platform_write_at(writer->descriptor, bytes, size_bytes, at_bytes);
        if (put < 0) {
            if (errno == EINTR) continue;
            return writer->status = fail_errno(writer->context, writer->shown, errno);
        }
        bytes += put;
        at_bytes += (uint64_t)put;
        size_bytes -= (size_t)put;
    }
    return EWA_OK;
}

ewa_status ewa_writer_commit(ewa_writer **writer) {
    ewa_writer *done = *writer;
    if (done->status == EWA_OK) flush(done);
    // The name is to lead to whole bytes after a power cut, too.
    if (done->status == EWA_OK && done->temporary && !ewa_platform_flush(done->descriptor))
        done->status = fail_errno(done->context, done->shown, errno);
    // Flushing takes long; who has said stop meanwhile keeps what was there before.
    if (done->status == EWA_OK) done->status = ewa_progress(done->context, "write", 1);
    name_file(done);
    // Some file systems report a full disk only now.
    const bool closed = ewa_platform_close(done->descriptor);
    done->descriptor = -1;
    if (!closed && done->status == EWA_OK) done->status = fail_errno(done->context, done->shown, errno);
    if (done->status == EWA_OK && done->temporary) {
        if (ewa_platform_rename(done->written, done->target))
            done->temporary = false;
        else
            done->status = fail_errno(done->context, done->shown, errno);
    }
    const ewa_status status = done->status;
    ewa_writer_abort(writer);
    return status;
}

void ewa_writer_abort(ewa_writer **writer) {
    if (!*writer) return;
    ewa_writer *old = *writer;
    if (old->descriptor >= 0) ewa_platform_close(old->descriptor);
    if (old->temporary && !old->nameless) ewa_platform_remove(old->written);
    ewa_release(old->context, old, 1, sizeof *old);
    *writer = NULL;
}
