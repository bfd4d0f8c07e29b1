// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// WebP, read from memory and written to it.
#ifndef EWA_SRC_WEBP_H
#define EWA_SRC_WEBP_H

#include "ewa/image.h"

#include <string.h>

/// Tells whether the bytes begin like a WebP file.
static inline bool ewa_webp_recognise(const uint8_t *bytes, size_t size_bytes) {
    return size_bytes >= 12 && memcmp(bytes, "RIFF", 4) == 0 && memcmp(bytes + 8, "WEBP", 4) == 0;
}

/// Decodes a still WebP picture, sRGB, to linear light: 3 channels, with alpha 4, premultiplied unless
/// `straight`. `name` stands for the file in messages. Errors: EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED
/// (animations), EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_webp_decode(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                           bool straight, ewa_image *image);

/// Reads the size from the header. Errors: EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED (animations).
ewa_status ewa_webp_look(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes, uint32_t *width_px,
                         uint32_t *height_px);

/// Decodes to bytes as they are, red green blue alpha, rows from the top: `*codes` of `*code_bytes` for
/// ewa_release(). Errors: EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_webp_decode_codes(ewa_context *context, const char *name, const uint8_t *bytes,
                                 size_t size_bytes, uint32_t *width_px, uint32_t *height_px, uint8_t **codes,
                                 size_t *code_bytes);

/// A file in memory. Zero-initialised means: nothing held.
typedef struct ewa_webp {
    ewa_context *context;
    uint8_t *bytes;
    size_t size_bytes, room_bytes;
} ewa_webp;

/// Encodes bytes, red green blue alpha, rows from the top, so that ewa_webp_decode_codes() gives all of them; free with
/// ewa_webp_free(). `*webp` holds nothing after a failure. Errors: EWA_ERROR_LIMIT (a side of over 16383 pixels),
/// EWA_ERROR_MEMORY, EWA_ERROR_UNSUPPORTED.
ewa_status ewa_webp_encode_codes(ewa_context *context, const char *name, uint32_t width_px, uint32_t height_px, const uint8_t *codes,
                                 ewa_webp *webp);
void ewa_webp_free(ewa_webp *webp);

#endif
