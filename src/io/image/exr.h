// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// OpenEXR, by OpenEXRCore.
#ifndef EWA_SRC_EXR_H
#define EWA_SRC_EXR_H

#include "ewa/io.h"

#include <string.h>

/// Tells whether the bytes begin like an OpenEXR file.
static inline bool ewa_exr_recognise(const uint8_t *bytes, size_t size_bytes) {
    return size_bytes >= 4 && memcmp(bytes, "\x76\x2f\x31\x01", 4) == 0;
}

/// Decodes the first part of an OpenEXR file (scan lines, or the largest level of tiles): R G B and A where
/// there is one, else its channels in the file's (alphabetical) order, at most 16. The image is the data
/// window. Errors: EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED (deep data, subsampled channels, several parts packed by DWA),
/// EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_exr_decode(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                          ewa_image *image);

/// Writes scan lines, ZIP compressed. `options` may not be NULL.
ewa_status ewa_exr_save(const ewa_image *image, const char *path, const ewa_image_save_options *options);

#endif
