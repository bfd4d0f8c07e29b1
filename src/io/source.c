// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Unpacking by zlib and libbz2, step by step, with memory of the context. What the library is built without (EWA_WITH_ZLIB,
// EWA_WITH_BZIP2) is known, and refused.
#include "io/source.h"
#include "base/base.h"

#include <limits.h>
#include <string.h>
#if EWA_WITH_BZIP2
#include <bzlib.h>
#endif
#if EWA_WITH_ZLIB
#include <zlib.h>
#endif

enum {
    HEAD_BYTES = 64,         // in front of a library's memory: its size, and its alignment stays
    AUTOMATIC_WINDOW = 47,   // 15 bits, gzip or zlib by the head
    DEFLATE_RATIO = 1032,    // a match of 258 bytes takes at least two bits
    DEFLATE_HEAD_BYTES = 64, // below this the bound is not worth a thought
};

struct ewa_source {
    ewa_context *context;
    const char *name;
    ewa_packing packing;
    const uint8_t *next;
    size_t left_bytes;
    bool started;  // the library's state is there
    bool finished; // the last stream ended
    bool settling; // no further stream is begun
    bool memory;   // an allocation failed
#if EWA_WITH_ZLIB
    z_stream deflate;
#endif
#if EWA_WITH_BZIP2
    bz_stream bzip2;
#endif
};

#if EWA_WITH_ZLIB || EWA_WITH_BZIP2
static void *allocate_for_library(ewa_source *source, size_t count, size_t size_bytes) {
    if (size_bytes && count > (SIZE_MAX - HEAD_BYTES) / size_bytes) return NULL;
    const size_t all_bytes = count * size_bytes + HEAD_BYTES;
    uint8_t *memory = ewa_allocate_zeroed(source->context, all_bytes, 1);
    if (!memory) {
        source->memory = true;
        return NULL;
    }
    memcpy(memory, &all_bytes, sizeof all_bytes);
    return memory + HEAD_BYTES;
}

static void release_for_library(ewa_source *source, void *memory) {
    if (!memory) return;
    uint8_t *whole = (uint8_t *)memory - HEAD_BYTES;
    size_t all_bytes;
    memcpy(&all_bytes, whole, sizeof all_bytes);
    ewa_release(source->context, whole, all_bytes, 1);
}

static void library_release(void *user, void *memory) { release_for_library(user, memory); }
#endif

// ---- Each library: a stream begun, false when memory ran out; at most `size_bytes` > 0 bytes of it unpacked, `*got_bytes`, which may
// be none, NULL or what is wrong; its end

#if EWA_WITH_ZLIB
static void *deflate_allocate(void *user, unsigned count, unsigned size_bytes) {
    return allocate_for_library(user, count, size_bytes);
}

static bool start_deflate(ewa_source *source) {
    source->deflate = (z_stream){.zalloc = deflate_allocate, .zfree = library_release, .opaque = source};
    return inflateInit2(&source->deflate, AUTOMATIC_WINDOW) == Z_OK;
}

static const char *step_deflate(ewa_source *source, uint8_t *to, size_t size_bytes, size_t *got_bytes) {
    const uInt in = source->left_bytes < UINT_MAX ? (uInt)source->left_bytes : UINT_MAX;
    const uInt room = size_bytes < UINT_MAX ? (uInt)size_bytes : UINT_MAX;
    z_stream *stream = &source->deflate;
    stream->next_in = (Bytef *)(uintptr_t)source->next;
    stream->avail_in = in;
    stream->next_out = to;
    stream->avail_out = room;
    const int result = inflate(stream, Z_NO_FLUSH);
    source->next += in - stream->avail_in;
    source->left_bytes -= in - stream->avail_in;
    *got_bytes = room - stream->avail_out;
    source->finished = result == Z_STREAM_END;
    if (result == Z_OK || result == Z_STREAM_END) return NULL;
    return result == Z_BUF_ERROR ? "the compressed data end early" : "the compressed data are broken";
}

static void end_deflate(ewa_source *source) { inflateEnd(&source->deflate); }
#endif

#if EWA_WITH_BZIP2
static void *bzip2_allocate(void *user, int count, int size_bytes) {
    return allocate_for_library(user, (size_t)count, (size_t)size_bytes);
}

static bool start_bzip2(ewa_source *source) {
    source->bzip2 = (bz_stream){.bzalloc = bzip2_allocate, .bzfree = library_release, .opaque = source};
    return BZ2_bzDecompressInit(&source->bzip2, 0, 0) == BZ_OK;
}

static const char *step_bzip2(ewa_source *source, uint8_t *to, size_t size_bytes, size_t *got_bytes) {
    const unsigned in = source->left_bytes < UINT_MAX ? (unsigned)source->left_bytes : UINT_MAX;
    const unsigned room = size_bytes < UINT_MAX ? (unsigned)size_bytes : UINT_MAX;
    bz_stream *stream = &source->bzip2;
    stream->next_in = (char *)(uintptr_t)source->next;
    stream->avail_in = in;
    stream->next_out = (char *)to;
    stream->avail_out = room;
    const int result = BZ2_bzDecompress(stream);
    const bool stuck = stream->avail_in == in && stream->avail_out == room;
    source->next += in - stream->avail_in;
    source->left_bytes -= in - stream->avail_in;
    *got_bytes = room - stream->avail_out;
    source->finished = result == BZ_STREAM_END;
    if (result == BZ_STREAM_END || (result == BZ_OK && !stuck)) return NULL;
    return result == BZ_OK ? "the compressed data end early" : "the compressed data are broken";
}

static void end_bzip2(ewa_source *source) { BZ2_bzDecompressEnd(&source->bzip2); }
#endif

typedef struct stream_library {
    const char *absent; ///< what is said where it is not built in
    bool (*start)(ewa_source *source);
    const char *(*step)(ewa_source *source, uint8_t *to, size_t size_bytes, size_t *got_bytes);
    void (*end)(ewa_source *source);
} stream_library;

static const stream_library libraries[] = {
#if EWA_WITH_ZLIB
    [EWA_PACKING_DEFLATE] = {.start = start_deflate, .step = step_deflate, .end = end_deflate},
#else
    [EWA_PACKING_DEFLATE] = {.absent = "gzip, which this build has not (EWA_WITH_ZLIB)"},
#endif
#if EWA_WITH_BZIP2
    [EWA_PACKING_BZIP2] = {.start = start_bzip2, .step = step_bzip2, .end = end_bzip2},
#else
    [EWA_PACKING_BZIP2] = {.absent = "bzip2, which this build has not (EWA_WITH_BZIP2)"},
#endif
};

static bool start_stream(ewa_source *source) {
    source->finished = false;
    source->started = libraries[source->packing].start(source);
    return source->started;
}

static void end_stream(ewa_source *source) {
    if (source->started) libraries[source->packing].end(source);
    source->started = false;
}

/// Whether another stream begins here; anything else after the first one is left alone.
static bool next_stream_begins(const ewa_source *source) {
    const uint8_t *p = source->next;
    if (source->left_bytes < 4) return false;
    if (source->packing == EWA_PACKING_BZIP2) return p[0] == 'B' && p[1] == 'Z' && p[2] == 'h';
    return (p[0] == 0x1f && p[1] == 0x8b) || ((p[0] & 0x0f) == 8 && (256 * p[0] + p[1]) % 31 == 0);
}

static ewa_status fail(ewa_source *source, const char *what) {
    if (source->memory) return EWA_ERROR_MEMORY;
    return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: %s", source->name, what);
}

static ewa_status read_streams(ewa_source *source, uint8_t *to, size_t size_bytes, size_t *got_bytes) {
    while (*got_bytes < size_bytes) {
        if (source->finished) {
            if (source->settling || !next_stream_begins(source)) return EWA_OK;
            end_stream(source);
        }
        if (!source->started && !start_stream(source)) return fail(source, "the decompressor does not start");
        size_t got = 0;
        const char *wrong = libraries[source->packing].step(source, to + *got_bytes, size_bytes - *got_bytes, &got);
        *got_bytes += got;
        if (wrong) return fail(source, wrong);
    }
    return EWA_OK;
}

static int hex_digit(uint8_t byte) {
    if (byte >= '0' && byte <= '9') return byte - '0';
    const uint8_t lower = byte | 0x20;
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

static ewa_status read_hex(ewa_source *source, uint8_t *to, size_t size_bytes, size_t *got_bytes) {
    int high = -1;
    while (*got_bytes < size_bytes && source->left_bytes) {
        const uint8_t byte = *source->next;
        const int digit = hex_digit(byte);
        if (digit < 0 && byte != ' ' && (byte < '\t' || byte > '\r'))
            return fail(source, "a character that is no hexadecimal digit");
        source->next++;
        source->left_bytes--;
        if (digit < 0) continue;
        if (high >= 0) to[(*got_bytes)++] = (uint8_t)(16 * high + digit);
        high = high >= 0 ? -1 : digit;
    }
    return high >= 0 ? fail(source, "an odd count of hexadecimal digits") : EWA_OK;
}

ewa_status ewa_source_open(ewa_context *context, const char *name, ewa_packing packing, const uint8_t *bytes,
                           size_t size_bytes, ewa_source **source) {
    *source = NULL;
    const bool streams = packing == EWA_PACKING_DEFLATE || packing == EWA_PACKING_BZIP2;
    if (streams && libraries[packing].absent)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: %s", name, libraries[packing].absent);
    *source = ewa_allocate_zeroed(context, 1, sizeof **source);
    if (!*source) return EWA_ERROR_MEMORY;
    (*source)->context = context;
    (*source)->name = name;
    (*source)->packing = packing;
    (*source)->next = bytes;
    (*source)->left_bytes = size_bytes;
    return EWA_OK;
}

ewa_status ewa_source_read(ewa_source *source, void *to, size_t size_bytes, size_t *got_bytes) {
    *got_bytes = 0;
    if (source->packing == EWA_PACKING_HEX) return read_hex(source, to, size_bytes, got_bytes);
    if (source->packing != EWA_PACKING_NONE) return read_streams(source, to, size_bytes, got_bytes);
    *got_bytes = size_bytes < source->left_bytes ? size_bytes : source->left_bytes;
    if (*got_bytes) memcpy(to, source->next, *got_bytes);
    source->next += *got_bytes;
    source->left_bytes -= *got_bytes;
    return EWA_OK;
}

ewa_status ewa_source_settle(ewa_source *source, bool *more) {
    const bool streams = source->packing == EWA_PACKING_DEFLATE || source->packing == EWA_PACKING_BZIP2;
    uint8_t next;
    size_t got = 0;
    ewa_status status = EWA_OK;
    // What begins behind a finished stream is not looked into: it may be something else.
    source->settling = true;
    if (!streams || !source->finished) status = ewa_source_read(source, &next, 1, &got);
    *more = got > 0 || (streams && next_stream_begins(source));
    return status;
}

void ewa_source_close(ewa_source **source) {
    if (!*source) return;
    end_stream(*source);
    ewa_release((*source)->context, *source, 1, sizeof **source);
    *source = NULL;
}

uint64_t ewa_source_bound(ewa_packing packing, uint64_t size_bytes) {
    if (packing == EWA_PACKING_NONE) return size_bytes;
    if (packing == EWA_PACKING_HEX) return size_bytes / 2;
    if (packing == EWA_PACKING_BZIP2 || size_bytes > UINT64_MAX / DEFLATE_RATIO - DEFLATE_HEAD_BYTES)
        return UINT64_MAX;
    return (size_bytes + DEFLATE_HEAD_BYTES) * DEFLATE_RATIO;
}
