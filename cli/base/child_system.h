// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What child.c asks of the system (child_posix.c, child_windows.c).
#ifndef EWA_CLI_BASE_CHILD_SYSTEM_H
#define EWA_CLI_BASE_CHILD_SYSTEM_H

#include "cli/base/child.h"

/// How a process ended.
typedef struct child_end {
    bool known;
    int status; ///< what it returned
    int signal; ///< which ended it; 0: none
} child_end;

/// Keeps what programs that are started get from being an open file.
void child_keep(int descriptor);

/// Asks a process to end.
bool child_ask_to_end(pid_t process);

/// Waits for the end of a process, which is asked to end once when this run is, and frees what the system knows of it.
child_end child_await(pid_t process);

/// Becomes another program, with the words of its command line, ended by NULL. Returns only when that fails, with an error
/// number; where the system has no such call, it is run and the process ends as it did.
int child_replace(const char *program, const char **words);

#endif
