// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Bytes as letters.
#ifndef EWA_SRC_BASE64_H
#define EWA_SRC_BASE64_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Most bytes that so many letters stand for.
static inline size_t ewa_base64_room(size_t length) { return length / 4 * 3 + 3; }

/// Decodes letters of base64, blanks and line ends between them, '=' or nothing at the end, into `bytes`,
/// which has ewa_base64_room(length) bytes; `*size_bytes` gets how many there are. False when something else
/// is there. Based on: S. Josefsson, RFC 4648, 2006, section 4.
bool ewa_base64_decode(const char *letters, size_t length, uint8_t *bytes, size_t *size_bytes);

#endif
