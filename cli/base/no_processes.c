// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The program on a host without processes (WASI): nothing is started.
#include "cli/base/child.h"

#include <errno.h>

void process_start(void) {}

uint64_t memory_peak_bytes(void) { return 0; }

bool session_make_folder(cli_session *session, char folder[SESSION_FOLDER_BYTES]) {
    folder[0] = 0;
    session_fail(session, "no folder for a while on this system");
    return false;
}

bool child_find_helper(const char *folder, const char *name, char helper[PATH_BYTES]) {
    (void)folder, (void)name;
    helper[0] = 0;
    return false;
}

int child_become(cli_session *session, const char *folder, const char *name, const char *absent,
                 const common_arguments *common) {
    (void)folder, (void)name, (void)common;
    session_fail(session, "%s", absent);
    return EXIT_FAILED;
}

bool child_pipe(int ends[2]) {
    ends[0] = ends[1] = -1;
    errno = ENOSYS;
    return false;
}

int child_spawn(const char *program, const char *const *words, const int streams[3], bool own_group,
                pid_t *process) {
    (void)program, (void)words, (void)streams, (void)own_group;
    *process = 0;
    return ENOSYS;
}

int child_start(const char *program, const char *const *words, bool listens, child_process *child) {
    (void)program, (void)words, (void)listens;
    *child = (child_process){.input = -1, .output = -1};
    return ENOSYS;
}

bool child_wait(cli_session *session, child_process *child, const char *subject, const char *name,
                bool is_early) {
    (void)session, (void)child, (void)subject, (void)name, (void)is_early;
    return false;
}

void child_drop(child_process *child) { (void)child; }
