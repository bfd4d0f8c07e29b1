// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A program of somebody else that runs beside this one: started without a shell, fed, listened to, waited for.
#ifndef EWA_CLI_BASE_CHILD_H
#define EWA_CLI_BASE_CHILD_H

#include "cli/base/path.h"
#include "cli/base/session.h"

#include <sys/types.h>

/// Zero-initialised and ended there is none.
typedef struct child_process {
    pid_t process;    ///< 0: none runs; on Windows a handle
    int input;        ///< its standard input; -1: closed
    int output;       ///< its standard output; -1: nobody listens
    FILE *complaints; ///< its standard error
} child_process;

/// Finds a helper of this program beside it, in the folder of the build's tree where it is built, or where it is
/// installed.
bool child_find_helper(const char *folder, const char *name, char helper[PATH_BYTES]);

/// Becomes a helper of this program, with the words of the command line that `common` has. Returns only when that
/// fails, after reporting, which of a helper that is not there `absent` does: an exit status.
int child_become(cli_session *session, const char *folder, const char *name, const char *absent,
                 const common_arguments *common);

/// A pipe that no child inherits but by `child_spawn`; false with errno.
bool child_pipe(int ends[2]);

/// Starts a program, found as a shell finds it, with three standard streams (the second -1: what it prints is
/// dropped), for who waits in a way of his own. With `own_group` it heads a process group, so that all of it can
/// be ended. Returns an error number.
int child_spawn(const char *program, const char *const *words, const int streams[3], bool own_group,
                pid_t *process);

/// Starts a program, found as a shell finds it, with the words of its command line, ended by NULL. Without
/// `listens`, what it prints is dropped. Returns an error number; then there is nothing to end.
int child_start(const char *program, const char *const *words, bool listens, child_process *child);

/// Closes its standard input and waits; an interrupt of this program ends it. Returns whether it succeeded and
/// was to end now; else reports "SUBJECT: NAME failed with status 1: the last line of its standard error".
bool child_wait(cli_session *session, child_process *child, const char *subject, const char *name,
                bool is_early);

/// Ends it and frees what is left of it, whether it was waited for or not.
void child_drop(child_process *child);

#endif
