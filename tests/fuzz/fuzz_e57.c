// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target of the E57 reader. Changed bytes would all end at the pages' checksums: they are made to fit
// first, but for files whose minor version, which nobody looks at, is odd.
#include "fuzz_cloud.h"

#include "io/e57/e57.h"

static void fit_checksums(uint8_t *bytes, size_t size_bytes) {
    enum { PAGE_BYTES = 1024, PAYLOAD_BYTES = PAGE_BYTES - EWA_E57_CHECKSUM_BYTES };
    for (size_t page = 0; page + PAGE_BYTES <= size_bytes; page += PAGE_BYTES) {
        const uint32_t checksum = ewa_e57_checksum(bytes + page, PAYLOAD_BYTES, false);
        for (int i = 0; i < EWA_E57_CHECKSUM_BYTES; i++)
            bytes[page + PAYLOAD_BYTES + i] = (uint8_t)(checksum >> (24 - 8 * i));
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    uint8_t *fitted = malloc(size_bytes + !size_bytes);
    fuzz_require(fitted != NULL, "memory");
    memcpy(fitted, bytes, size_bytes);
    if (size_bytes < 13 || !(bytes[12] & 1)) fit_checksums(fitted, size_bytes);
    fuzz_cloud(&ewa_format_e57, "input.e57", fitted, size_bytes);
    free(fitted);
    return 0;
}
