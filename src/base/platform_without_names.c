// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What Windows and WASI have not: files without a name, and permissions that a file is given.
#include "base/platform.h"

#include <errno.h>

int ewa_platform_create_nameless(const char *folder) {
    (void)folder;
    errno = ENOSYS;
    return -1;
}

int ewa_platform_name(int descriptor, const char *path) {
    (void)descriptor, (void)path;
    errno = ENOSYS;
    return -1;
}

// What a folder's rules give a new file stays.
void ewa_platform_permit(int descriptor, uint32_t permissions) { (void)descriptor, (void)permissions; }
