// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Base64 (RFC 4648): bytes in texts.
#ifndef EWA_SRC_BASE64_H
#define EWA_SRC_BASE64_H

#include <stddef.h>
#include <stdint.h>

/// Maximum number of bytes that so many letters encode.
static inline size_t ewa_base64_room(size_t text_bytes) { return text_bytes / 4 * 3 + 3; }

/// Decodes a text, without its first `skipped_bytes` bytes, into at most `room` bytes; returns how many.
/// Blanks count for nothing, padding ends one text and begins another behind it, anything else ends all, a
/// lone digit too. `*used_bytes` (may be NULL) gets how much of the text was read: all of it when all is
/// well.
size_t ewa_base64_read(const char *text, size_t text_bytes, size_t skipped_bytes, uint8_t *to, size_t room,
                       size_t *used_bytes);

#endif
