// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files that people try and that hold neither points nor triangles, or none that can be read.
#ifndef EWA_SRC_IO_FOREIGN_H
#define EWA_SRC_IO_FOREIGN_H

#include <stddef.h>
#include <stdint.h>

/// Says what bytes are, and what to do, in words that follow "NAME: "; NULL: that is not known. Any thread.
const char *ewa_foreign_kind(const uint8_t *bytes, size_t size_bytes);

#endif
