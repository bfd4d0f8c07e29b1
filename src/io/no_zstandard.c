// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Zstandard in a library without libzstd.
#include "io/zstandard.h"

static const char *const absent = "zstandard, which this build has not (EWA_WITH_ZSTD)";

size_t ewa_zstandard_bound(size_t size_bytes) { return size_bytes; }

const char *ewa_zstandard_pack(const void *bytes, size_t size_bytes, int level, void *packed, size_t room_bytes,
                               size_t *got_bytes) {
    (void)bytes, (void)size_bytes, (void)level, (void)packed, (void)room_bytes;
    *got_bytes = 0;
    return absent;
}

const char *ewa_zstandard_unpack(const void *packed, size_t packed_bytes, void *bytes, size_t room_bytes, size_t *got_bytes) {
    (void)packed, (void)packed_bytes, (void)bytes, (void)room_bytes;
    *got_bytes = 0;
    return absent;
}
