// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target of COPC by nodes: any bytes may be the file.
#define _GNU_SOURCE // memfd_create
#include "fuzz_octree.h"

#include <sys/mman.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    char path[64];
    const int file = memfd_create("copc", 0);
    fuzz_require(file >= 0 && write(file, bytes, size_bytes) == (ssize_t)size_bytes, "a file in memory");
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    fuzz_octree(path, size_bytes);
    close(file);
    return 0;
}
