// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A file of its own because O_TMPFILE needs the GNU names, with which strerror_r() is another function.
#define _GNU_SOURCE
#include "io/nameless.h"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

int ewa_nameless_open(const char *folder) {
#ifdef O_TMPFILE
    // The name is given by way of /proc, which a bare chroot lacks.
    if (access("/proc/self/fd", X_OK) != 0) return -1;
    return open(folder, O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
#else
    (void)folder;
    return -1;
#endif
}

int ewa_nameless_link(int descriptor, const char *path) {
    char source[64];
    snprintf(source, sizeof source, "/proc/self/fd/%d", descriptor);
    return linkat(AT_FDCWD, source, AT_FDCWD, path, AT_SYMLINK_FOLLOW);
}
