// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Deflate in one go (RFC 1950 to 1952), and the checksum of PNG and gzip: by libdeflate, or in a library without it
// (EWA_WITH_DEFLATE) written in blocks that are not compressed, and not read. Streams that are read bit by bit are io/source.h's.
#ifndef EWA_SRC_IO_DEFLATE_H
#define EWA_SRC_IO_DEFLATE_H

#include "ewa/base.h"

typedef enum ewa_deflate_frame { EWA_DEFLATE_BARE, EWA_DEFLATE_ZLIB, EWA_DEFLATE_GZIP } ewa_deflate_frame;

/// What was packed, in memory of the context.
typedef struct ewa_deflated {
    uint8_t *bytes;
    size_t size_bytes, room_bytes;
} ewa_deflated;

/// Packs bytes; `level` is libdeflate's, 1 (fast) to 12. Free with ewa_deflated_free(); `*packed` is zeroed after a failure.
/// Errors: EWA_ERROR_MEMORY.
ewa_status ewa_deflate(ewa_context *context, ewa_deflate_frame frame, int level, const void *bytes, size_t size_bytes,
                       ewa_deflated *packed);
void ewa_deflated_free(ewa_context *context, ewa_deflated *packed);

/// Unpacks a bare stream that becomes exactly `size_bytes`. Reports nothing. Errors: EWA_ERROR_FORMAT, EWA_ERROR_MEMORY,
/// EWA_ERROR_UNSUPPORTED where the library cannot. Any thread.
ewa_status ewa_inflate(const void *packed, size_t packed_bytes, void *bytes, size_t size_bytes);

/// Continues a checksum, 0 at first. Any thread.
uint32_t ewa_crc32(uint32_t before, const void *bytes, size_t size_bytes);

#endif
