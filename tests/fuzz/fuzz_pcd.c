// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target of the PCD reader: any bytes may be given, to be read whole and in pieces, with and without
// stepping over what is damaged.
#include "fuzz_cloud.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    fuzz_cloud(&ewa_format_pcd, "input.pcd", bytes, size_bytes);
    return 0;
}
