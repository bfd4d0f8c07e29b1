// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Whole files in, whole files out, by POSIX calls.
#define _DEFAULT_SOURCE // realpath, madvise
#include "io/file.h"
#include "base/base.h"
#include "io/nameless.h"

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

enum {
    READ_STEP_BYTES = 1 << 16,    // first buffer for an input of unknown length; doubles when full
    WRITE_BUFFER_BYTES = 1 << 16, // pieces below this size are collected
    NAME_ATTEMPTS = 100,          // temporary names tried when others exist already
    TEMPORARY_NAME_BYTES = 64,
};

struct ewa_writer {
    ewa_context *context;
    ewa_status status; // the first failure
    int descriptor;
    bool temporary; // `written` is to be renamed to `target`
    bool nameless;  // the file has no name yet: it is gone when the process ends, however it ends
    size_t buffered_bytes;
    uint64_t flushed_bytes;
    char shown[PATH_MAX];   // the path as the caller wrote it, for messages
    char target[PATH_MAX];  // where the file belongs, links resolved
    char written[PATH_MAX]; // the file that receives the bytes
    uint8_t buffer[WRITE_BUFFER_BYTES];
};

static ewa_status fail_errno(ewa_context *context, const char *path, int error) {
    char reason[128];
    if (error == ENOLINK)
        return ewa_fail(context, EWA_ERROR_IO, "%s: is a link to a file that is not there", path);
    if (strerror_r(error, reason, sizeof reason) != 0) snprintf(reason, sizeof reason, "error %d", error);
    return ewa_fail(context, EWA_ERROR_IO, "%s: %s", path, reason);
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
        const ssize_t got = read(descriptor, bytes + size, capacity - size);
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
static bool map_file(int descriptor, const struct stat *facts, ewa_file *file) {
    if (!S_ISREG(facts->st_mode) || facts->st_size <= 0 || (uint64_t)facts->st_size > SIZE_MAX ||
        lseek(descriptor, 0, SEEK_CUR) != 0)
        return false;
    const size_t size = (size_t)facts->st_size;
    void *mapped = mmap(NULL, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (mapped == MAP_FAILED) return false;
    *file = (ewa_file){.bytes = mapped, .size_bytes = size, .capacity_bytes = size, .mapped = true};
    return true;
}

bool ewa_file_map_descriptor(int descriptor, ewa_file *file) {
    struct stat facts;
    *file = (ewa_file){0};
    return fstat(descriptor, &facts) == 0 && (facts.st_size == 0 || map_file(descriptor, &facts, file));
}

size_t ewa_file_head(const char *path, uint8_t *bytes, size_t room) {
    struct stat facts;
    const int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (descriptor < 0) return 0;
    const ssize_t got = fstat(descriptor, &facts) == 0 && S_ISREG(facts.st_mode) ? read(descriptor, bytes, room) : 0;
    close(descriptor);
    return got > 0 ? (size_t)got : 0;
}

static ewa_status read_descriptor(ewa_context *context, const char *path, int descriptor, ewa_file *file) {
    struct stat facts;
    if (fstat(descriptor, &facts) != 0) return fail_errno(context, path, errno);
    if (S_ISDIR(facts.st_mode)) return fail_errno(context, path, EISDIR);
    // Files of /proc call themselves regular and empty, and some file systems cannot map: both can be read.
    return map_file(descriptor, &facts, file) ? EWA_OK : read_stream(context, path, descriptor, file);
}

ewa_status ewa_file_map(ewa_context *context, const char *path, ewa_file *file) {
    *file = (ewa_file){0};
    if (strcmp(path, "-") == 0) return read_descriptor(context, "standard input", STDIN_FILENO, file);
    const int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY);
    if (descriptor < 0) return fail_errno(context, path, errno);
    const ewa_status status = read_descriptor(context, path, descriptor, file);
    close(descriptor);
    return status;
}

void ewa_file_unmap(ewa_context *context, ewa_file *file) {
    uint8_t *bytes = (uint8_t *)(uintptr_t)file->bytes;
    if (!file->mapped) {
        ewa_release(context, bytes, file->capacity_bytes, 1);
    } else if (file->hole_end) {
        munmap(bytes, file->hole_first);
        if (file->capacity_bytes > file->hole_end)
            munmap(bytes + file->hole_end, file->capacity_bytes - file->hole_end);
    } else {
        munmap(bytes, file->capacity_bytes);
    }
    *file = (ewa_file){0};
}

static uint64_t page_bytes(void) { return (uint64_t)sysconf(_SC_PAGESIZE); }

void ewa_file_passed(const uint8_t *bytes, uint64_t at_bytes) {
    const uint64_t whole_bytes = at_bytes / page_bytes() * page_bytes();
    // Pages of a file come back from it when they are asked for again.
    if (whole_bytes) madvise((void *)(uintptr_t)bytes, whole_bytes, MADV_DONTNEED);
}

void ewa_file_give_up(ewa_file *file, uint64_t from, uint64_t to) {
    const uint64_t page = page_bytes(), first = (from + page - 1) / page * page, end = to / page * page;
    if (!file->mapped || end <= first) return;
    munmap((void *)(uintptr_t)(file->bytes + first), end - first);
    file->hole_first = first, file->hole_end = end;
}

int ewa_file_open_pieces(const char *path, uint64_t size_bytes) {
    struct stat facts;
    const int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY);
    if (descriptor < 0) return -1;
    if (fstat(descriptor, &facts) == 0 && S_ISREG(facts.st_mode) && (uint64_t)facts.st_size == size_bytes)
        return descriptor;
    close(descriptor);
    return -1;
}

bool ewa_file_piece_map(int descriptor, uint64_t at_bytes, size_t size_bytes, ewa_file *piece,
                        const uint8_t **bytes) {
    const uint64_t before = at_bytes % page_bytes();
    *piece = (ewa_file){0};
    void *mapped =
        mmap(NULL, size_bytes + before, PROT_READ, MAP_PRIVATE, descriptor, (off_t)(at_bytes - before));
    if (mapped == MAP_FAILED) return false;
    const size_t mapped_bytes = size_bytes + before;
    *piece = (ewa_file){
        .bytes = mapped, .size_bytes = mapped_bytes, .capacity_bytes = mapped_bytes, .mapped = true};
    *bytes = piece->bytes + before;
    return true;
}

/// Bytes of a path that are its folder's, with the slash.
static int folder_bytes_of(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? (int)(slash - path) + 1 : 0;
}

/// Gives a file a name beside the target that nothing has, by `make`, which fails with EEXIST for one that is taken; returns what
/// it returned, or -1 with errno. The name is short and does not grow with the target's, so that every target that can be
/// named can be written.
static int take_name(ewa_writer *writer, int (*make)(ewa_writer *writer)) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    for (int attempt = 0; attempt < NAME_ATTEMPTS; attempt++) {
        const int length =
            snprintf(writer->written, sizeof writer->written, "%.*s.ewa-%ld-%09ld-%d.tmp",
                     folder_bytes_of(writer->target), writer->target, (long)getpid(), now.tv_nsec, attempt);
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
    return open(writer->written, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
}

static int link_nameless(ewa_writer *writer) {
    return ewa_nameless_link(writer->descriptor, writer->written);
}

/// Opens a new file in the folder of the target, without a name where the system can.
static int open_temporary(ewa_writer *writer) {
    char folder[PATH_MAX];
    const int folder_bytes = folder_bytes_of(writer->target);
    snprintf(folder, sizeof folder, "%.*s", folder_bytes ? folder_bytes : 1,
             folder_bytes ? writer->target : ".");
    const int descriptor = ewa_nameless_open(folder);
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
        return fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
    struct stat facts;
    if (stat(writer->shown, &facts) != 0) {
        if (errno != ENOENT) return -1;
        if (lstat(writer->shown, &facts) == 0) {
            errno = ENOLINK;
            return -1;
        }
        memcpy(writer->target, writer->shown, sizeof writer->target);
        writer->temporary = true;
        return open_temporary(writer);
    }
    if (!S_ISREG(facts.st_mode)) {
        memcpy(writer->written, writer->shown, sizeof writer->written);
        return open(writer->shown, O_WRONLY | O_CLOEXEC | O_NOCTTY);
    }
    // Renaming asks the folder for permission only; a file that is write-protected is meant to stay.
    if (!realpath(writer->shown, writer->target) ||
        faccessat(AT_FDCWD, writer->target, W_OK, AT_EACCESS) != 0)
        return -1;
    writer->temporary = true;
    const int descriptor = open_temporary(writer);
    if (descriptor >= 0) fchmod(descriptor, facts.st_mode & 0777);
    return descriptor;
}

ewa_status ewa_writer_open(ewa_context *context, const char *path, ewa_writer **writer) {
    *writer = NULL;
    const size_t length = strlen(path);
    if (length == 0) return fail_errno(context, "output file", ENOENT);
    if (length >= PATH_MAX) return fail_errno(context, path, ENAMETOOLONG);
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
        const ssize_t put = write(writer->descriptor, bytes, size_bytes);
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
        const ssize_t put = pwrite(writer->descriptor, bytes, size_bytes, (off_t)at_bytes);
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
    if (done->status == EWA_OK && done->temporary && fsync(done->descriptor) != 0 && errno != EINVAL)
        done->status = fail_errno(done->context, done->shown, errno);
    // Flushing takes long; who has said stop meanwhile keeps what was there before.
    if (done->status == EWA_OK) done->status = ewa_progress(done->context, "write", 1);
    name_file(done);
    // Some file systems report a full disk only now.
    const bool closed = close(done->descriptor) == 0;
    done->descriptor = -1;
    if (!closed && done->status == EWA_OK) done->status = fail_errno(done->context, done->shown, errno);
    if (done->status == EWA_OK && done->temporary) {
        if (rename(done->written, done->target) == 0)
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
    if (old->descriptor >= 0) close(old->descriptor);
    if (old->temporary && !old->nameless) unlink(old->written);
    ewa_release(old->context, old, 1, sizeof *old);
    *writer = NULL;
}
