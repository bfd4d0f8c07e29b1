// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Zip archives of files as they are. Their dates are the first that the format knows, so that the same files make the same bytes.
//
// Based on: PKWARE, "APPNOTE.TXT - .ZIP File Format Specification", 6.3, sections 4.3 and 4.4.
#include "io/deflate.h"
#include "io/gaussian/save.h"
#include "io/gaussian/zip.h"

enum {
    LOCAL_BYTES = 30,
    ENTRY_BYTES = 46,
    END_BYTES = 22,
    VERSION = 20,
    DATE = 1 << 5 | 1, ///< the first of January 1980
};

static uint8_t *put_u16(uint8_t *to, uint32_t value) {
    to[0] = (uint8_t)value, to[1] = (uint8_t)(value >> 8);
    return to + 2;
}

/// What the head of a file and its entry in the directory have in common, from the version that is needed on.
static uint8_t *put_facts(const ewa_zip_target *archive, uint32_t file, uint8_t *to) {
    to = put_u16(put_u16(put_u16(to, VERSION), 0), 0);
    to = put_u16(put_u16(to, 0), DATE);
    to = ewa_put_u32(to, archive->files[file].checksum);
    to = ewa_put_u32(ewa_put_u32(to, archive->files[file].size_bytes), archive->files[file].size_bytes);
    return put_u16(put_u16(to, (uint32_t)strlen(archive->files[file].name)), 0);
}

ewa_status ewa_zip_put(ewa_zip_target *archive, const char *name, const void *bytes, size_t size_bytes) {
    const uint64_t at = ewa_writer_size(archive->writer);
    if (archive->count == EWA_ZIP_FILES || size_bytes > UINT32_MAX || at + size_bytes > UINT32_MAX)
        return ewa_fail(archive->context, EWA_ERROR_LIMIT, "%s: %s: a zip archive without extensions has 4 GiB at most", archive->name, name);
    const uint32_t file = archive->count++;
    archive->files[file].name = name;
    archive->files[file].checksum = ewa_crc32(0, bytes, size_bytes);
    archive->files[file].size_bytes = (uint32_t)size_bytes;
    archive->files[file].at = (uint32_t)at;
    uint8_t head[LOCAL_BYTES] = {'P', 'K', 3, 4};
    put_facts(archive, file, head + 4);
    EWA_TRY(ewa_writer_put(archive->writer, head, sizeof head));
    EWA_TRY(ewa_writer_put(archive->writer, name, strlen(name)));
    return ewa_writer_put(archive->writer, bytes, size_bytes);
}

ewa_status ewa_zip_finish(ewa_zip_target *archive) {
    const uint64_t at = ewa_writer_size(archive->writer);
    for (uint32_t file = 0; file < archive->count; file++) {
        uint8_t entry[ENTRY_BYTES] = {'P', 'K', 1, 2};
        put_facts(archive, file, put_u16(entry + 4, VERSION));
        ewa_put_u32(entry + ENTRY_BYTES - 4, archive->files[file].at);
        EWA_TRY(ewa_writer_put(archive->writer, entry, sizeof entry));
        EWA_TRY(ewa_writer_put(archive->writer, archive->files[file].name, strlen(archive->files[file].name)));
    }
    uint8_t end[END_BYTES] = {'P', 'K', 5, 6}, *to = end + 8;
    to = put_u16(put_u16(to, archive->count), archive->count);
    ewa_put_u32(ewa_put_u32(to, (uint32_t)(ewa_writer_size(archive->writer) - at)), (uint32_t)at);
    return ewa_writer_put(archive->writer, end, sizeof end);
}
