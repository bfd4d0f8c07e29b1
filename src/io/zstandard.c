// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Zstandard by libzstd.
#include "io/zstandard.h"

#include <zstd.h>

size_t ewa_zstandard_bound(size_t size_bytes) { return ZSTD_compressBound(size_bytes); }

static const char *check_result(size_t got, size_t *got_bytes) {
    const char *wrong = ZSTD_isError(got) ? ZSTD_getErrorName(got) : NULL;
    *got_bytes = wrong ? 0 : got;
    return wrong;
}

const char *ewa_zstandard_pack(const void *bytes, size_t size_bytes, int level, void *packed, size_t room_bytes,
                               size_t *got_bytes) {
    return check_result(ZSTD_compress(packed, room_bytes, bytes, size_bytes, level), got_bytes);
}

const char *ewa_zstandard_unpack(const void *packed, size_t packed_bytes, void *bytes, size_t room_bytes, size_t *got_bytes) {
    return check_result(ZSTD_decompress(bytes, room_bytes, packed, packed_bytes), got_bytes);
}
