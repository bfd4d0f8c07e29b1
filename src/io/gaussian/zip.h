// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files in a zip archive, stored or deflated, by name; archives of stored ones.
#ifndef EWA_SRC_ZIP_H
#define EWA_SRC_ZIP_H

#include "io/gaussian/gaussian.h"

struct ewa_writer;

/// A file of an archive. Zero-initialised means: nothing held.
typedef struct ewa_zip_file {
    const uint8_t *bytes;
    size_t size_bytes;
    uint8_t *unpacked; ///< what `bytes` are in, or NULL: they are in the archive
} ewa_zip_file;

/// Whether bytes are a zip archive that lists a file.
bool ewa_zip_has(const uint8_t *bytes, size_t size_bytes, const char *name);

/// Takes a file of at most `max_bytes` out of an archive, also from a folder in it; free with ewa_zip_close(). Errors:
/// EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_zip_open(const ewa_gaussian_source *archive, const char *name, uint32_t max_bytes, ewa_zip_file *file);
void ewa_zip_close(ewa_context *context, ewa_zip_file *file);

/// Appends a file to an archive that is written, not packed, for what comes here is. Errors: EWA_ERROR_LIMIT (4 GiB),
/// EWA_ERROR_IO.
enum { EWA_ZIP_FILES = 8 };
typedef struct ewa_zip_target {
    ewa_context *context;
    const char *name; ///< stands for the archive in messages
    struct ewa_writer *writer;
    uint32_t count; ///< of the files so far
    struct {
        const char *name; ///< of a file; not copied
        uint32_t checksum, size_bytes, at;
    } files[EWA_ZIP_FILES];
} ewa_zip_target;
ewa_status ewa_zip_put(ewa_zip_target *archive, const char *name, const void *bytes, size_t size_bytes);

/// Ends an archive with its directory. Errors: EWA_ERROR_IO.
ewa_status ewa_zip_finish(ewa_zip_target *archive);

#endif
