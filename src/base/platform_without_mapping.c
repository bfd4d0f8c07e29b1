// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files that are not mapped: they are read instead.
#include "base/platform.h"

#include <errno.h>

size_t ewa_platform_map_step(void) { return 1 << 16; }

void *ewa_platform_map(int descriptor, uint64_t at_bytes, size_t size_bytes) {
    (void)descriptor, (void)at_bytes, (void)size_bytes;
    errno = ENOSYS;
    return NULL;
}

void ewa_platform_unmap(void *mapped, size_t size_bytes) { (void)mapped, (void)size_bytes; }

bool ewa_platform_unmap_part(void *first, size_t size_bytes) {
    (void)first, (void)size_bytes;
    return false;
}

void ewa_platform_forget(void *mapped, size_t size_bytes) { (void)mapped, (void)size_bytes; }
