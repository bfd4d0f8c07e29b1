// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files in a zip archive: found by the directory at its end.
//
// Based on: PKWARE, "APPNOTE.TXT - .ZIP File Format Specification", 6.3, sections 4.3 and 4.4.
#include "io/gaussian/zip.h"
#include "io/deflate.h"


enum {
    END_BYTES = 22,
    END_SIGNATURE = 0x06054b50,
    MAX_COMMENT_BYTES = 65535,
    ENTRY_BYTES = 46,
    ENTRY_SIGNATURE = 0x02014b50,
    LOCAL_BYTES = 30,
    LOCAL_SIGNATURE = 0x04034b50,
    STORED = 0,
    DEFLATED = 8,
    MAX_RATIO = 1032, ///< of deflate
};

/// What the directory says of a file.
typedef struct zip_entry {
    uint32_t method, flags, packed_bytes, whole_bytes, local_at;
} zip_entry;

/// Finds the directory: `count` entries from byte `at` on. False when there is none.
static bool find_directory(const uint8_t *bytes, size_t size_bytes, uint32_t *at, uint32_t *count) {
    if (size_bytes < END_BYTES) return false;
    const size_t last = size_bytes - END_BYTES;
    for (size_t back = 0; back <= last && back <= MAX_COMMENT_BYTES; back++) {
        const uint8_t *end = bytes + last - back;
        if (ewa_bytes_u32(end) != END_SIGNATURE) continue;
        *count = ewa_file_u16(end + 10);
        *at = ewa_bytes_u32(end + 16);
        return *at <= last - back;
    }
    return false;
}

/// Whether an entry's name is the wanted one, in whatever folder.
static bool is_named(const uint8_t *name, size_t length, const char *wanted) {
    const size_t wanted_length = strlen(wanted);
    return length >= wanted_length && memcmp(name + length - wanted_length, wanted, wanted_length) == 0 &&
           (length == wanted_length || name[length - wanted_length - 1] == '/');
}

static bool find_entry(const uint8_t *bytes, size_t size_bytes, const char *wanted, zip_entry *found) {
    uint32_t first, count;
    if (!find_directory(bytes, size_bytes, &first, &count)) return false;
    size_t at = first;
    for (uint32_t i = 0; i < count && size_bytes - at >= ENTRY_BYTES; i++) {
        const uint8_t *entry = bytes + at;
        const size_t name_bytes = ewa_file_u16(entry + 28),
                     all_bytes =
                         ENTRY_BYTES + name_bytes + ewa_file_u16(entry + 30) + ewa_file_u16(entry + 32);
        if (ewa_bytes_u32(entry) != ENTRY_SIGNATURE || all_bytes > size_bytes - at) return false;
        if (is_named(entry + ENTRY_BYTES, name_bytes, wanted)) {
            *found = (zip_entry){.flags = ewa_file_u16(entry + 8),
                                 .method = ewa_file_u16(entry + 10),
                                 .packed_bytes = ewa_bytes_u32(entry + 20),
                                 .whole_bytes = ewa_bytes_u32(entry + 24),
                                 .local_at = ewa_bytes_u32(entry + 42)};
            return true;
        }
        at += all_bytes;
    }
    return false;
}

bool ewa_zip_has(const uint8_t *bytes, size_t size_bytes, const char *name) {
    zip_entry entry;
    return size_bytes >= 4 && memcmp(bytes, "PK", 2) == 0 && find_entry(bytes, size_bytes, name, &entry);
}

static ewa_status inflate_file(const ewa_gaussian_source *archive, const char *name, uint32_t max_bytes, const uint8_t *packed,
                               const zip_entry *entry, ewa_zip_file *file) {
    if (entry->whole_bytes / MAX_RATIO > entry->packed_bytes)
        return ewa_fail(archive->context, EWA_ERROR_FORMAT, "%s: %s: %u bytes do not unpack to %u",
                        archive->name, name, entry->packed_bytes, entry->whole_bytes);
    if (entry->whole_bytes > max_bytes)
        return ewa_fail(archive->context, EWA_ERROR_LIMIT, "%s: %s: %u bytes, more than it may have (%u)", archive->name, name,
                        entry->whole_bytes, max_bytes);
    EWA_TRY(ewa_memory_check(archive->context, entry->whole_bytes, "%s: %s unpacked", archive->name, name));
    file->size_bytes = entry->whole_bytes;
    file->bytes = file->unpacked = ewa_allocate(archive->context, file->size_bytes, 1);
    ewa_status status = file->unpacked ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) {
        status = ewa_inflate(packed, entry->packed_bytes, file->unpacked, file->size_bytes);
        if (status != EWA_OK)
            status = ewa_fail(archive->context, status, "%s: %s: %s", archive->name, name,
                              status == EWA_ERROR_MEMORY        ? "no memory for the decompressor"
                              : status == EWA_ERROR_UNSUPPORTED ? "it is packed, which this build cannot unpack (EWA_WITH_DEFLATE)"
                                                                : "the compressed data are broken");
    }
    if (status != EWA_OK) ewa_zip_close(archive->context, file);
    return status;
}

ewa_status ewa_zip_open(const ewa_gaussian_source *archive, const char *name, uint32_t max_bytes, ewa_zip_file *file) {
    *file = (ewa_zip_file){.bytes = NULL};
    zip_entry entry;
    if (!find_entry(archive->bytes, archive->size_bytes, name, &entry))
        return ewa_fail(archive->context, EWA_ERROR_FORMAT, "%s: the archive has no file %s", archive->name,
                        name);
    const size_t size_bytes = archive->size_bytes, at = entry.local_at;
    if (at > size_bytes || size_bytes - at < LOCAL_BYTES ||
        ewa_bytes_u32(archive->bytes + at) != LOCAL_SIGNATURE)
        return ewa_fail(archive->context, EWA_ERROR_FORMAT, "%s: %s is not where the directory says",
                        archive->name, name);
    const uint8_t *local = archive->bytes + at;
    const size_t data_at = at + LOCAL_BYTES + ewa_file_u16(local + 26) + ewa_file_u16(local + 28);
    if (data_at > size_bytes || entry.packed_bytes > size_bytes - data_at)
        return ewa_fail(archive->context, EWA_ERROR_FORMAT, "%s: %s ends behind the archive", archive->name,
                        name);
    if (entry.flags & 1 || (entry.method != STORED && entry.method != DEFLATED))
        return ewa_fail(archive->context, EWA_ERROR_UNSUPPORTED,
                        "%s: %s is encrypted, or packed by method %u; 0 and 8 are read", archive->name, name,
                        entry.method);
    if (entry.method == DEFLATED) return inflate_file(archive, name, max_bytes, archive->bytes + data_at, &entry, file);
    *file = (ewa_zip_file){.bytes = archive->bytes + data_at, .size_bytes = entry.packed_bytes};
    return EWA_OK;
}

void ewa_zip_close(ewa_context *context, ewa_zip_file *file) {
    ewa_release(context, file->unpacked, file->size_bytes, 1);
    *file = (ewa_zip_file){.bytes = NULL};
}
