// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Temporary storage.
#include "io/spool.h"
#include "base/platform.h"

#include <errno.h>
#include <string.h>

struct ewa_spool {
    ewa_context *context;
    int descriptor;
    uint64_t size_bytes;
    char folder[EWA_PATH_BYTES]; ///< for messages
};

static ewa_status fail_errno(const ewa_spool *spool, int error) {
    char reason[128];
    ewa_platform_describe(error, reason, sizeof reason);
    return ewa_fail(spool->context, EWA_ERROR_IO, "temporary file in %s: %s", spool->folder, reason);
}

ewa_status ewa_spool_open(ewa_context *context, const char *beside, ewa_spool **spool) {
    *spool = NULL;
    ewa_spool *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    const char *name = ewa_platform_file_name(beside);
    const size_t length = name > beside ? (size_t)(name - beside) - 1 : 1;
    memcpy(made->folder, name > beside ? beside : ".", length < EWA_PATH_BYTES ? length : EWA_PATH_BYTES - 1);
    made->descriptor = ewa_platform_create_temporary(made->folder);
    if (made->descriptor < 0) {
        const ewa_status status = fail_errno(made, errno);
        ewa_release(context, made, 1, sizeof *made);
        return status;
    }
    *spool = made;
    return EWA_OK;
}

ewa_status ewa_spool_put(ewa_spool *spool, const void *bytes, size_t size_bytes, uint64_t *at_bytes) {
    const uint8_t *from = bytes;
    if (at_bytes) *at_bytes = spool->size_bytes;
    while (size_bytes) {
        const int64_t put = ewa_platform_write_at(spool->descriptor, from, size_bytes, spool->size_bytes);
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
        const int64_t got = ewa_platform_read_at(spool->descriptor, to, size_bytes, at_bytes);
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
    ewa_platform_close(old->descriptor);
    ewa_release(old->context, old, 1, sizeof *old);
    *spool = NULL;
}
