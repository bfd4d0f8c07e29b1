// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Deflate in a library without libdeflate: what is written is stored, block by block, which every reader takes, and only that is
// read. Based on: RFC
// 1951, section 3.2.4; RFC 1950, sections 2.2 and 9; RFC 1952, section 2.3.
#include "base/base.h"
#include "io/deflate.h"

#include <string.h>

enum {
    BLOCK_BYTES = 65535,
    BLOCK_HEAD_BYTES = 5,
    MAX_FRAME_BYTES = 18, // of gzip, head and tail
    ADLER_MODULUS = 65521,
    ADLER_RUN = 5552, // bytes whose sums fit 32 bits
};

static uint32_t adler_sum(const uint8_t *bytes, size_t size_bytes) {
    uint32_t a = 1, b = 0;
    while (size_bytes) {
        const size_t run = size_bytes < ADLER_RUN ? size_bytes : ADLER_RUN;
        for (size_t i = 0; i < run; i++) b += a += bytes[i];
        a %= ADLER_MODULUS, b %= ADLER_MODULUS;
        bytes += run, size_bytes -= run;
    }
    return b << 16 | a;
}

static uint8_t *put_u32(uint8_t *to, uint32_t value, bool big_endian) {
    for (int i = 0; i < 4; i++) *to++ = (uint8_t)(value >> (big_endian ? 24 - 8 * i : 8 * i));
    return to;
}

static uint8_t *put_blocks(uint8_t *to, const uint8_t *bytes, size_t size_bytes) {
    do {
        const size_t size = size_bytes < BLOCK_BYTES ? size_bytes : BLOCK_BYTES;
        *to++ = size == size_bytes; // whether it is the last
        *to++ = (uint8_t)size, *to++ = (uint8_t)(size >> 8);
        *to++ = (uint8_t)~size, *to++ = (uint8_t)(~size >> 8);
        if (size) memcpy(to, bytes, size);
        to += size, bytes += size, size_bytes -= size;
    } while (size_bytes);
    return to;
}

ewa_status ewa_deflate(ewa_context *context, ewa_deflate_frame frame, int level, const void *bytes, size_t size_bytes,
                       ewa_deflated *packed) {
    static const uint8_t zlib_head[2] = {0x78, 0x01}, gzip_head[10] = {0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255};
    (void)level;
    *packed = (ewa_deflated){0};
    const size_t room = size_bytes + (size_bytes / BLOCK_BYTES + 1) * BLOCK_HEAD_BYTES + MAX_FRAME_BYTES;
    uint8_t *made = ewa_allocate(context, room, 1), *to = made;
    if (!made) return EWA_ERROR_MEMORY;
    if (frame == EWA_DEFLATE_ZLIB) memcpy(to, zlib_head, sizeof zlib_head), to += sizeof zlib_head;
    if (frame == EWA_DEFLATE_GZIP) memcpy(to, gzip_head, sizeof gzip_head), to += sizeof gzip_head;
    to = put_blocks(to, bytes, size_bytes);
    if (frame == EWA_DEFLATE_ZLIB) to = put_u32(to, adler_sum(bytes, size_bytes), true);
    if (frame == EWA_DEFLATE_GZIP) to = put_u32(put_u32(to, ewa_crc32(0, bytes, size_bytes), false), (uint32_t)size_bytes, false);
    *packed = (ewa_deflated){made, (size_t)(to - made), room};
    return EWA_OK;
}

void ewa_deflated_free(ewa_context *context, ewa_deflated *packed) {
    ewa_release(context, packed->bytes, packed->room_bytes, 1);
    *packed = (ewa_deflated){0};
}

ewa_status ewa_inflate(const void *packed, size_t packed_bytes, void *bytes, size_t size_bytes) {
    const uint8_t *from = packed, *end = from + packed_bytes;
    uint8_t *to = bytes;
    for (bool last = false; !last;) {
        if (end - from < BLOCK_HEAD_BYTES) return EWA_ERROR_FORMAT;
        if (from[0] & 6) return EWA_ERROR_UNSUPPORTED;
        const size_t size = from[1] | (size_t)from[2] << 8, check = from[3] | (size_t)from[4] << 8;
        last = from[0] & 1;
        from += BLOCK_HEAD_BYTES;
        if ((size ^ check) != BLOCK_BYTES || size > (size_t)(end - from) || size > size_bytes) return EWA_ERROR_FORMAT;
        if (size) memcpy(to, from, size);
        from += size, to += size, size_bytes -= size;
    }
    return size_bytes ? EWA_ERROR_FORMAT : EWA_OK;
}

uint32_t ewa_crc32(uint32_t before, const void *bytes, size_t size_bytes) {
    // Of four bits each.
    static const uint32_t table[16] = {0x00000000, 0x1db71064, 0x3b6e20c8, 0x26d930ac, 0x76dc4190, 0x6b6b51f4,
                                       0x4db26158, 0x5005713c, 0xedb88320, 0xf00f9344, 0xd6d6a3e8, 0xcb61b38c,
                                       0x9b64c2b0, 0x86d3d2d4, 0xa00ae278, 0xbdbdf21c};
    const uint8_t *at = bytes;
    uint32_t rest = ~before;
    for (size_t i = 0; i < size_bytes; i++) {
        rest ^= at[i];
        rest = rest >> 4 ^ table[rest & 15];
        rest = rest >> 4 ^ table[rest & 15];
    }
    return ~rest;
}
