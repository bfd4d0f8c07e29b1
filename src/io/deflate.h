// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A fast DEFLATE compressor for filtered pictures: Huffman codes and runs of one byte, nothing else. Its
// bytes depend on its input only, not on a library's version, and its blocks can be made side by side. Based
// on: P. Deutsch, DEFLATE Compressed Data Format Specification version 1.3, RFC 1951, 1996.
#ifndef EWA_SRC_DEFLATE_H
#define EWA_SRC_DEFLATE_H

#include <stddef.h>
#include <stdint.h>

/// Returns how many bytes ewa_deflate_block() may write for `size_bytes` bytes.
size_t ewa_deflate_bound(size_t size_bytes);

/// Compresses `size_bytes` > 0 bytes to one or more blocks that end on a byte boundary and are not the last
/// of their stream. `tokens` is scratch of `size_bytes` numbers; `out` holds ewa_deflate_bound() bytes.
/// Returns the bytes written. Any thread.
size_t ewa_deflate_block(const uint8_t *bytes, size_t size_bytes, uint16_t *tokens, uint8_t *out);

/// Writes the empty last block of a stream; returns its bytes (2).
size_t ewa_deflate_end(uint8_t *out);

#endif
