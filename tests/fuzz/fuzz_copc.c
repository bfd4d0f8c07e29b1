// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target of COPC by nodes: any bytes may be the file, or what a caller reads them from, part by part.
#define _GNU_SOURCE // memfd_create
#include "fuzz_octree.h"

#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

typedef struct given {
    const uint8_t *bytes;
    size_t size_bytes;
} given;

static int64_t read_given(void *user, uint64_t at_bytes, void *to, size_t size_bytes) {
    const given *g = user;
    fuzz_require(at_bytes <= g->size_bytes && size_bytes <= g->size_bytes - at_bytes, "reads within the file");
    memcpy(to, g->bytes + at_bytes, size_bytes);
    return (int64_t)size_bytes;
}

static bool open_given(void *user, const char *path, ewa_file_source *source) {
    if (strcmp(path, "given") != 0) return false;
    *source = (ewa_file_source){((const given *)user)->size_bytes, read_given, NULL, user};
    return true;
}

/// The same tree, of which parts are read.
static ewa_status read_parts(const uint8_t *bytes, size_t size_bytes) {
    int errors = 0;
    given g = {bytes, size_bytes};
    ewa_context_options options = fuzz_context_options(1, 1 << 22, &errors);
    options.open_file = open_given;
    options.open_file_user = &g;
    return fuzz_octree_by(fuzz_context_of(&options), &errors, "given", size_bytes);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    char path[64];
    const int file = memfd_create("copc", 0);
    fuzz_require(file >= 0 && write(file, bytes, size_bytes) == (ssize_t)size_bytes, "a file in memory");
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    const ewa_status whole = fuzz_octree(path, size_bytes), parts = read_parts(bytes, size_bytes);
    fuzz_require((whole == EWA_OK) == (parts == EWA_OK), "the same tree by parts");
    close(file);
    return 0;
}
