// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Temporary storage by POSIX calls: the file loses its name as soon as it is open.
#include "io/spool.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct ewa_spool {
    ewa_context *context;
    int descriptor;
    uint64_t size_bytes;
    char folder[PATH_MAX]; ///< for messages
};

static ewa_status fail_errno(const ewa_spool *spool, int error) {
    char reason[128];
    if (strerror_r(error, reason, sizeof reason) != 0) snprintf(reason, sizeof reason, "error %d", error);
    return ewa_fail(spool->context, EWA_ERROR_IO, "temporary file in %s: %s", spool->folder, reason);
}

ewa_status ewa_spool_open(ewa_context *context, const char *beside, ewa_spool **spool) {
    static const char pattern[] = "/.ewa-spool-XXXXXX";
    *spool = NULL;
    ewa_spool *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    const char *slash = strrchr(beside, '/');
    const size_t length = slash ? (size_t)(slash - beside) : 1;
    memcpy(made->folder, slash ? beside : ".", length < PATH_MAX ? length : PATH_MAX - 1);
    char name[PATH_MAX + sizeof pattern];
    snprintf(name, sizeof name, "%s%s", made->folder, pattern);
    made->descriptor = mkstemp(name);
    if (made->descriptor < 0) {
        const ewa_status status = fail_errno(made, errno);
        ewa_release(context, made, 1, sizeof *made);
        return status;
    }
    fcntl(made->descriptor, F_SETFD, FD_CLOEXEC);
    unlink(name);
    *spool = made;
    return EWA_OK;
}

ewa_status ewa_spool_put(ewa_spool *spool, const void *bytes, size_t size_bytes, uint64_t *at_bytes) {
    const uint8_t *from = bytes;
    if (at_bytes) *at_bytes = spool->size_bytes;
    while (size_bytes) {
        const ssize_t put = pwrite(spool->descriptor, from, size_bytes, (off_t)spool->size_bytes);
        if (put < 0) {
            if (errno == EINTR) continue;
            return fail_errno(spool, errno);
        }
        from += put;
        size_bytes -= (size_t)put;
        spool->size_bytes += (uint64_t)put;
    }
    return EWA_OK;
}

ewa_status ewa_spool_get(ewa_spool *spool, uint64_t at_bytes, void *bytes, size_t size_bytes) {
    uint8_t *to = bytes;
    while (size_bytes) {
        const ssize_t got = pread(spool->descriptor, to, size_bytes, (off_t)at_bytes);
        if (got == 0)
            return ewa_fail(spool->context, EWA_ERROR_IO, "temporary file in %s: too short", spool->folder);
        if (got < 0) {
            if (errno == EINTR) continue;
            return fail_errno(spool, errno);
        }
        to += got;
        at_bytes += (uint64_t)got;
        size_bytes -= (size_t)got;
    }
    return EWA_OK;
}

uint64_t ewa_spool_size(const ewa_spool *spool) { return spool->size_bytes; }

void ewa_spool_close(ewa_spool **spool) {
    if (!spool || !*spool) return;
    ewa_spool *old = *spool;
    close(old->descriptor);
    ewa_release(old->context, old, 1, sizeof *old);
    *spool = NULL;
}
