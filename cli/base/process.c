// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a session asks of its own process.
#define _XOPEN_SOURCE 700 // mkdtemp
#define _DARWIN_C_SOURCE  // the same on macOS, and ru_maxrss
#include "cli/base/session.h"

#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h> // mkdtemp on macOS

void process_start(void) {
    // A closed pipe or a file size limit is an error of the write that meets it, so that temporary files are removed.
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
}

uint64_t memory_peak_bytes(void) {
    struct rusage usage;
#ifdef __APPLE__
    const uint64_t unit_bytes = 1;
#else
    const uint64_t unit_bytes = 1024;
#endif
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (uint64_t)usage.ru_maxrss * unit_bytes : 0;
}

bool session_make_folder(cli_session *session, char folder[SESSION_FOLDER_BYTES]) {
    const char *parent = getenv("TMPDIR");
    snprintf(folder, SESSION_FOLDER_BYTES, "%.200s/ewa-XXXXXX", parent && *parent ? parent : "/tmp");
    if (mkdtemp(folder)) return true;
    session_fail(session, "%s: cannot create a folder for a while", folder);
    return false;
}
