// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target of the reader of pictures with heights in their colours.
#include "fuzz_rows.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    return try_rows(&ewa_format_terrain, bytes, size_bytes);
}
