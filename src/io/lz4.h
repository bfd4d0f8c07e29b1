// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Blocks of LZ4, as VTK's XML files have them.
#ifndef EWA_SRC_IO_LZ4_H
#define EWA_SRC_IO_LZ4_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Unpacks a block into exactly `to_bytes` bytes; false when it is broken or does not hold as many.
bool ewa_lz4_unpack(const uint8_t *from, size_t from_bytes, uint8_t *to, size_t to_bytes);

#endif
