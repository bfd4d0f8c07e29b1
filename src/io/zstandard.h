// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Zstandard in one go, by libzstd, or in a library without it (EWA_WITH_ZSTD) refused.
#ifndef EWA_SRC_IO_ZSTANDARD_H
#define EWA_SRC_IO_ZSTANDARD_H

#include <stddef.h>

/// Returns the room that packing some bytes may take.
size_t ewa_zstandard_bound(size_t size_bytes);

/// Packs; `*got_bytes` of the room are written. NULL, or what is wrong. Any thread, as the next one.
const char *ewa_zstandard_pack(const void *bytes, size_t size_bytes, int level, void *packed, size_t room_bytes,
                               size_t *got_bytes);

/// Unpacks to at most the room; `*got_bytes` were. NULL, or what is wrong.
const char *ewa_zstandard_unpack(const void *packed, size_t packed_bytes, void *bytes, size_t room_bytes, size_t *got_bytes);

#endif
