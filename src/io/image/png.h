// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// PNG, the inner side: from and to memory. Writing is ewa_png_save() of ewa/io.h.
#ifndef EWA_SRC_PNG_H
#define EWA_SRC_PNG_H

#include "ewa/image.h"

#include <string.h>

/// Tells whether the bytes begin like a PNG file.
static inline bool ewa_png_recognise(const uint8_t *bytes, size_t size_bytes) {
    return size_bytes >= 8 && memcmp(bytes, "\x89PNG\r\n\x1a\n", 8) == 0;
}

/// Decodes a PNG file of 8 or 16 bits, sRGB, to linear light: grey gives 1 channel, RGB 3, anything with
/// alpha (grey or palette too) 4, premultiplied unless `straight`. `name` stands for the file in messages.
ewa_status ewa_png_decode(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                          bool straight, ewa_image *image);

/// Decodes a grey PNG file of 8 or 16 bits to its numbers, one channel; the largest of 16 bits to infinity.
ewa_status ewa_png_decode_numbers(ewa_context *context, const char *name, const uint8_t *bytes,
                                  size_t size_bytes, ewa_image *image);

/// Decodes a PNG file to its codes as they are, red green blue alpha of 8 bits; the caller releases `*code_bytes`
/// bytes.
ewa_status ewa_png_decode_codes(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                                uint32_t *width_px, uint32_t *height_px, uint8_t **codes, size_t *code_bytes);

/// Reads the size from the head of a PNG file.
ewa_status ewa_png_size(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                        uint32_t *width_px, uint32_t *height_px);

#endif
