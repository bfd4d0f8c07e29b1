// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sizes of memory and files as people write them: 512M, 1.5G.
#ifndef EWA_CLI_BASE_BYTES_H
#define EWA_CLI_BASE_BYTES_H

#include <stdbool.h>
#include <stdint.h>

enum { BYTES_TEXT_BYTES = 32 };

/// Reads a number with K, M, G, T or P behind it, for powers of 1024, or nothing; "B" or "iB" may follow. Fractions
/// of a byte are dropped. False: it is no such text, or 2^63 bytes or more.
bool bytes_read(const char *text, uint64_t *bytes);

/// Writes a size with the largest letter of which it is a whole number, as bytes_read() reads it.
void bytes_write(uint64_t bytes, char text[BYTES_TEXT_BYTES]);

#endif
