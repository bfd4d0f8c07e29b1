// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Deflate by libdeflate.
#include "io/deflate.h"
#include "base/base.h"

#include <libdeflate.h>

static size_t bound(struct libdeflate_compressor *compressor, ewa_deflate_frame frame, size_t size_bytes) {
    return frame == EWA_DEFLATE_ZLIB   ? libdeflate_zlib_compress_bound(compressor, size_bytes)
           : frame == EWA_DEFLATE_GZIP ? libdeflate_gzip_compress_bound(compressor, size_bytes)
                                       : libdeflate_deflate_compress_bound(compressor, size_bytes);
}

ewa_status ewa_deflate(ewa_context *context, ewa_deflate_frame frame, int level, const void *bytes, size_t size_bytes,
                       ewa_deflated *packed) {
    *packed = (ewa_deflated){0};
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(level);
    if (!compressor) return ewa_fail(context, EWA_ERROR_MEMORY, "no memory for the compressor");
    const size_t room = bound(compressor, frame, size_bytes);
    uint8_t *to = ewa_allocate(context, room, 1);
    // Never fails where there is room for the bound.
    if (to)
        *packed = (ewa_deflated){to,
                                 frame == EWA_DEFLATE_ZLIB ? libdeflate_zlib_compress(compressor, bytes, size_bytes, to, room)
                                 : frame == EWA_DEFLATE_GZIP
                                     ? libdeflate_gzip_compress(compressor, bytes, size_bytes, to, room)
                                     : libdeflate_deflate_compress(compressor, bytes, size_bytes, to, room),
                                 room};
    libdeflate_free_compressor(compressor);
    return to ? EWA_OK : EWA_ERROR_MEMORY;
}

void ewa_deflated_free(ewa_context *context, ewa_deflated *packed) {
    ewa_release(context, packed->bytes, packed->room_bytes, 1);
    *packed = (ewa_deflated){0};
}

ewa_status ewa_inflate(const void *packed, size_t packed_bytes, void *bytes, size_t size_bytes) {
    struct libdeflate_decompressor *decompressor = libdeflate_alloc_decompressor();
    if (!decompressor) return EWA_ERROR_MEMORY;
    // Without a place for how many came, all have to come.
    const bool whole =
        libdeflate_deflate_decompress(decompressor, packed, packed_bytes, bytes, size_bytes, NULL) == LIBDEFLATE_SUCCESS;
    libdeflate_free_decompressor(decompressor);
    return whole ? EWA_OK : EWA_ERROR_FORMAT;
}

// For NULL the library's own starts anew.
uint32_t ewa_crc32(uint32_t before, const void *bytes, size_t size_bytes) {
    return size_bytes ? libdeflate_crc32(before, bytes, size_bytes) : before;
}
