// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files in a zip archive, stored or deflated, by name.
#ifndef EWA_SRC_ZIP_H
#define EWA_SRC_ZIP_H

#include "io/gaussian/gaussian.h"

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

#endif
