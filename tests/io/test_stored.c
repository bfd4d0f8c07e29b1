// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a library without libdeflate writes: read back by zlib, whatever the size, and with libdeflate's checksum.
#define ewa_deflate      stored_deflate
#define ewa_deflated_free stored_free
#define ewa_inflate      stored_inflate
#define ewa_crc32        stored_crc32
#include "io/no_deflate.c"
#undef ewa_crc32

#include "check.h"

#include <stdlib.h>
#include <zlib.h>

uint32_t ewa_crc32(uint32_t before, const void *bytes, size_t size_bytes);

static const size_t sizes[] = {0, 1, 5552, 5553, 65534, 65535, 65536, 65537, 131070, 300001};
enum { SIZES = sizeof sizes / sizeof sizes[0], MAX_BYTES = 300001 };

static uint8_t *make_bytes(void) {
    uint8_t *bytes = malloc(MAX_BYTES);
    assert_non_null(bytes);
    for (size_t i = 0; i < MAX_BYTES; i++) bytes[i] = i < 140000 ? 255 : (uint8_t)(i * 2654435761u >> 24);
    return bytes;
}

/// Its own reader takes the whole stream only, and none that is compressed.
static void check_bare(const ewa_deflated *packed, const uint8_t *bytes, size_t size_bytes, uint8_t *back) {
    memset(back, 0, MAX_BYTES);
    assert_int_equal(stored_inflate(packed->bytes, packed->size_bytes, back, size_bytes), EWA_OK);
    assert_memory_equal(back, bytes, size_bytes);
    assert_int_equal(stored_inflate(packed->bytes, packed->size_bytes, back, size_bytes + 1), EWA_ERROR_FORMAT);
    if (size_bytes)
        assert_int_equal(stored_inflate(packed->bytes, packed->size_bytes, back, size_bytes - 1), EWA_ERROR_FORMAT);
    const size_t step = packed->size_bytes > 100 ? packed->size_bytes / 97 : 1;
    for (size_t cut = 0; cut < packed->size_bytes; cut += step)
        assert_int_equal(stored_inflate(packed->bytes, cut, back, size_bytes), EWA_ERROR_FORMAT);
    assert_int_equal(stored_inflate("\x03\x00    ", 6, back, 0), EWA_ERROR_UNSUPPORTED);
}

TEST(reads_back) {
    static const int windows[] = {[EWA_DEFLATE_BARE] = -15, [EWA_DEFLATE_ZLIB] = 15, [EWA_DEFLATE_GZIP] = 31};
    OWNED(ewa_context_destroy) ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(NULL, &context), EWA_OK);
    OWNED(check_free) uint8_t *bytes = make_bytes(), *back = malloc(MAX_BYTES);
    assert_non_null(back);
    for (int frame = EWA_DEFLATE_BARE; frame <= EWA_DEFLATE_GZIP; frame++) {
        for (int i = 0; i < SIZES; i++) {
            ewa_deflated packed;
            assert_int_equal(stored_deflate(context, (ewa_deflate_frame)frame, 1, bytes, sizes[i], &packed), EWA_OK);
            assert_true(packed.size_bytes <= packed.room_bytes);
            z_stream stream = {.next_in = packed.bytes, .avail_in = (uInt)packed.size_bytes, .next_out = back,
                               .avail_out = MAX_BYTES};
            assert_int_equal(inflateInit2(&stream, windows[frame]), Z_OK);
            assert_int_equal(inflate(&stream, Z_FINISH), Z_STREAM_END);
            assert_int_equal(stream.avail_in, 0);
            assert_int_equal(stream.total_out, sizes[i]);
            assert_memory_equal(back, bytes, sizes[i]);
            inflateEnd(&stream);
            if (frame == EWA_DEFLATE_BARE) check_bare(&packed, bytes, sizes[i], back);
            stored_free(context, &packed);
        }
    }
}

TEST(checksum_is_the_same) {
    OWNED(check_free) uint8_t *bytes = make_bytes();
    for (int i = 0; i < SIZES; i++) assert_int_equal(stored_crc32(0, bytes, sizes[i]), ewa_crc32(0, bytes, sizes[i]));
    assert_int_equal(stored_crc32(stored_crc32(0, bytes, 1000), bytes + 1000, 2000), ewa_crc32(0, bytes, 3000));
    assert_int_equal(stored_crc32(0, "123456789", 9), 0xcbf43926u);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
