// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The containers of SPZ: one gzip stream up to version 3, one zstd stream for each kind of number from version 4
// on. Sizes are checked against what the header says before anything is made for it.
#include "base/unpacking.h"
#include "io/gaussian/spz.h"
#include "io/source.h"
#include "io/zstandard.h"


/// How much smaller than its content a stream of centres is taken to be at most; what the format's own library
/// believes.
enum { MAX_RATIO = 1024 };

uint32_t ewa_spz_stream_bytes(const ewa_spz_header *header, uint32_t stream) {
    switch (stream) {
    case EWA_SPZ_CENTERS:
        return header->version == 1 ? 6 : 9;
    case EWA_SPZ_OPACITIES:
        return 1;
    case EWA_SPZ_COLORS:
    case EWA_SPZ_SCALES:
        return 3;
    case EWA_SPZ_ROTATIONS:
        return header->version < 3 ? 3 : 4;
    default:
        return 3 * (ewa_sh_count(header->sh_degree) - 1);
    }
}

static ewa_status check_header(const ewa_gaussian_source *source, const ewa_spz_header *header) {
    if (header->version < 1 || header->version > 4)
        return ewa_fail(source->context, EWA_ERROR_UNSUPPORTED, "%s: SPZ of version %u; 1 to 4 are read",
                        source->name, header->version);
    if (header->sh_degree > EWA_MAX_SH_DEGREE)
        return ewa_fail(source->context, EWA_ERROR_UNSUPPORTED,
                        "%s: SPZ: spherical harmonics of degree %u; 0 to %d are read", source->name,
                        header->sh_degree, EWA_MAX_SH_DEGREE);
    if (header->fraction_bits > 24)
        return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: SPZ: %u bits of fraction in numbers of 24",
                        source->name, header->fraction_bits);
    return EWA_OK;
}

static void read_header(const uint8_t *bytes, ewa_spz_header *header) {
    *header = (ewa_spz_header){.version = ewa_bytes_u32(bytes + 4),
                               .count = ewa_bytes_u32(bytes + 8),
                               .sh_degree = bytes[12],
                               .fraction_bits = bytes[13],
                               .flags = bytes[14],
                               .stream_count = bytes[15]};
}

/// Bytes per Gaussian of all streams.
static uint64_t all_bytes(const ewa_spz_header *header) {
    uint64_t each = 0;
    for (uint32_t k = 0; k < EWA_SPZ_STREAMS; k++) each += ewa_spz_stream_bytes(header, k);
    return each;
}

/// Places the streams one after the other; fails when there cannot be more than `max_count` Gaussians.
static ewa_status place_streams(const ewa_gaussian_source *source, const ewa_spz_header *header,
                                uint64_t max_count, size_t at[EWA_SPZ_STREAMS], size_t *size_bytes) {
    const uint64_t each = all_bytes(header), all = each * header->count;
    if (header->count > max_count)
        return ewa_fail(source->context, EWA_ERROR_FORMAT,
                        "%s: SPZ: %u Gaussians take %llu bytes, which a file of %zu cannot hold",
                        source->name, header->count, (unsigned long long)all, source->size_bytes);
    EWA_TRY(ewa_memory_check_unpacked(source->context, source->size_bytes, EWA_UNPACKED_RATIO, all,
                                      "%s: SPZ: %u Gaussians of %llu bytes", source->name, header->count,
                                      (unsigned long long)each));
    *size_bytes = 0;
    for (uint32_t k = 0; k < EWA_SPZ_STREAMS; k++) {
        at[k] = *size_bytes;
        *size_bytes += (size_t)ewa_spz_stream_bytes(header, k) * header->count;
    }
    return EWA_OK;
}

/// Warns of records that may change what the numbers mean.
static void warn_of_extensions(const ewa_gaussian_source *source) {
    ewa_report(source->context, EWA_SEVERITY_WARNING, "%s: SPZ: extensions of a vendor are not looked at",
               source->name);
}

// ---- versions 1 to 3

static ewa_status unpack_gzip(const ewa_gaussian_source *source, ewa_spz_header *header, uint8_t **bytes,
                              size_t *size_bytes, size_t at[EWA_SPZ_STREAMS]) {
    ewa_source *packed = NULL;
    uint8_t head[EWA_SPZ_HEAD_BYTES];
    size_t got = 0;
    ewa_status status = ewa_source_open(source->context, source->name, EWA_PACKING_DEFLATE, source->bytes,
                                        source->size_bytes, &packed);
    if (status == EWA_OK) status = ewa_source_read(packed, head, sizeof head, &got);
    if (status == EWA_OK && (got < sizeof head || ewa_bytes_u32(head) != EWA_SPZ_MAGIC))
        status =
            ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: SPZ: the file ends in its header", source->name);
    if (status == EWA_OK) {
        read_header(head, header);
        status = check_header(source, header);
    }
    if (status == EWA_OK && header->version > 3)
        status = ewa_fail(source->context, EWA_ERROR_FORMAT,
                          "%s: SPZ of version 4 packed as one of version 3", source->name);
    if (status == EWA_OK)
        status = place_streams(source, header,
                               ewa_source_bound(EWA_PACKING_DEFLATE, source->size_bytes) / all_bytes(header),
                               at, size_bytes);
    if (status == EWA_OK) {
        *bytes = ewa_allocate(source->context, *size_bytes, 1);
        status = *bytes ? ewa_source_read(packed, *bytes, *size_bytes, &got) : EWA_ERROR_MEMORY;
    }
    if (status == EWA_OK && got < *size_bytes)
        status = ewa_fail(source->context, EWA_ERROR_FORMAT,
                          "%s: SPZ: the file ends early: %u Gaussians take %zu bytes, %zu are there",
                          source->name, header->count, *size_bytes, got);
    bool more = false;
    if (status == EWA_OK) status = ewa_source_settle(packed, &more);
    if (status == EWA_OK && header->flags & EWA_SPZ_EXTENDED) warn_of_extensions(source);
    ewa_source_close(&packed);
    return status;
}

// ---- version 4

/// Walks the extensions; `*axes` gets the coordinate system if one names it.
static ewa_status read_extensions(const ewa_gaussian_source *source, const ewa_spz_header *header,
                                  uint32_t *axes) {
    size_t at = EWA_SPZ_OPEN_BYTES;
    bool others = false;
    while (at < header->table_at) {
        const size_t left = header->table_at - at;
        const uint32_t length = left >= 8 ? ewa_bytes_u32(source->bytes + at + 4) : 0;
        if (left < 8 || length > left - 8)
            return ewa_fail(source->context, EWA_ERROR_FORMAT,
                            "%s: SPZ: an extension at byte %zu ends behind its place", source->name, at);
        if (ewa_bytes_u32(source->bytes + at) == EWA_SPZ_AXES && length >= 4)
            *axes = ewa_bytes_u32(source->bytes + at + 8);
        else
            others = true;
        at += 8 + (size_t)length;
    }
    if (others) warn_of_extensions(source);
    return EWA_OK;
}

/// Unpacks one stream, whose entry of the table is at `entry`; `*from` is stepped over it.
static ewa_status unpack_stream(const ewa_gaussian_source *source, uint32_t number, const uint8_t *entry,
                                uint64_t *from, uint8_t *to, size_t size_bytes) {
    const uint64_t packed = ewa_bytes_u32(entry) | (uint64_t)ewa_bytes_u32(entry + 4) << 32,
                   whole = ewa_bytes_u32(entry + 8) | (uint64_t)ewa_bytes_u32(entry + 12) << 32;
    if (whole != size_bytes || packed > source->size_bytes - *from)
        return ewa_fail(
            source->context, EWA_ERROR_FORMAT,
            "%s: SPZ: stream %u of %llu bytes, %llu unpacked, at byte %llu; %zu unpacked are wanted",
            source->name, number, (unsigned long long)packed, (unsigned long long)whole,
            (unsigned long long)*from, size_bytes);
    size_t got = 0;
    const char *wrong = ewa_zstandard_unpack(source->bytes + *from, (size_t)packed, to, size_bytes, &got);
    *from += packed;
    if (!wrong && got == size_bytes) return EWA_OK;
    return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: SPZ: stream %u: %s", source->name, number,
                    wrong ? wrong : "the compressed data end early");
}

static ewa_status unpack_zstd(const ewa_gaussian_source *source, ewa_spz_header *header, uint32_t *axes,
                              uint8_t **bytes, size_t *size_bytes, size_t at[EWA_SPZ_STREAMS]) {
    if (source->size_bytes < EWA_SPZ_OPEN_BYTES)
        return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: SPZ: the file ends in its header",
                        source->name);
    read_header(source->bytes, header);
    header->table_at = ewa_bytes_u32(source->bytes + 16);
    EWA_TRY(check_header(source, header));
    const uint32_t streams = header->sh_degree ? EWA_SPZ_STREAMS : EWA_SPZ_STREAMS - 1;
    if (header->version < 4)
        return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: SPZ of version %u that is not packed",
                        source->name, header->version);
    if (header->stream_count != streams || header->table_at < EWA_SPZ_OPEN_BYTES ||
        header->table_at > source->size_bytes || source->size_bytes - header->table_at < 16u * streams)
        return ewa_fail(
            source->context, EWA_ERROR_FORMAT,
            "%s: SPZ: a table of %u streams at byte %u; %u streams are wanted in a file of %zu bytes",
            source->name, header->stream_count, header->table_at, streams, source->size_bytes);
    if (header->flags & EWA_SPZ_EXTENDED) EWA_TRY(read_extensions(source, header, axes));
    EWA_TRY(place_streams(source, header,
                          (uint64_t)source->size_bytes * MAX_RATIO /
                              ewa_spz_stream_bytes(header, EWA_SPZ_CENTERS),
                          at, size_bytes));
    *bytes = ewa_allocate(source->context, *size_bytes, 1);
    if (!*bytes) return EWA_ERROR_MEMORY;
    uint64_t from = header->table_at + 16u * streams;
    for (uint32_t k = 0; k < streams; k++)
        EWA_TRY(unpack_stream(source, k, source->bytes + header->table_at + 16 * (size_t)k, &from,
                              *bytes + at[k], (size_t)ewa_spz_stream_bytes(header, k) * header->count));
    return EWA_OK;
}

ewa_status ewa_spz_unpack(const ewa_gaussian_source *source, ewa_spz_header *header, uint32_t *axes,
                          uint8_t **bytes, size_t *size_bytes, size_t at[EWA_SPZ_STREAMS]) {
    *bytes = NULL;
    *size_bytes = 0;
    *axes = 0;
    const bool open = source->size_bytes >= 4 && ewa_bytes_u32(source->bytes) == EWA_SPZ_MAGIC;
    const ewa_status status = open ? unpack_zstd(source, header, axes, bytes, size_bytes, at)
                                   : unpack_gzip(source, header, bytes, size_bytes, at);
    if (status == EWA_OK) return EWA_OK;
    ewa_release(source->context, *bytes, *size_bytes, 1);
    *bytes = NULL;
    return status;
}
