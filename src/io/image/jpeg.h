// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// JPEG, read from memory.
#ifndef EWA_SRC_JPEG_H
#define EWA_SRC_JPEG_H

#include "ewa/image.h"

/// Tells whether the bytes begin like a JPEG file.
static inline bool ewa_jpeg_recognise(const uint8_t *bytes, size_t size_bytes) {
    return size_bytes >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

/// Decodes a JPEG file, sRGB, to linear light: grey gives 1 channel, colour 3. What the decoder warns of
/// (missing data, which becomes grey) is passed on as a warning. `name` stands for the file in messages.
ewa_status ewa_jpeg_decode(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                           ewa_image *image);

#endif
