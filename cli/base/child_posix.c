// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Processes by the calls of POSIX.
#include "cli/base/child_system.h"
#include "cli/base/interruption.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

int child_spawn(const char *program, const char *const *words, const int streams[3], bool own_group,
                pid_t *process) {
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    int error = posix_spawn_file_actions_init(&actions);
    if (error) return error;
    error = posix_spawnattr_init(&attributes);
    if (error) {
        posix_spawn_file_actions_destroy(&actions);
        return error;
    }
    // Whoever started us to ignore the ends of children is not obeyed: this one's matters.
    signal(SIGCHLD, SIG_DFL);
    sigset_t defaults;
    sigemptyset(&defaults);
    sigaddset(&defaults, SIGPIPE);
    sigaddset(&defaults, SIGXFSZ);
    error = posix_spawn_file_actions_adddup2(&actions, streams[0], STDIN_FILENO);
    if (!error)
        error = streams[1] < 0
                    ? posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0)
                    : posix_spawn_file_actions_adddup2(&actions, streams[1], STDOUT_FILENO);
    if (!error) error = posix_spawn_file_actions_adddup2(&actions, streams[2], STDERR_FILENO);
    if (!error) error = posix_spawnattr_setsigdefault(&attributes, &defaults);
    if (!error) error = posix_spawnattr_setpgroup(&attributes, 0);
    const short own_signals = POSIX_SPAWN_SETSIGDEF;
    if (!error)
        error = posix_spawnattr_setflags(&attributes, own_group ? (short)(own_signals | POSIX_SPAWN_SETPGROUP)
                                                                : own_signals);
    if (!error)
        error =
            posix_spawnp(process, program, &actions, &attributes, (char *const *)(uintptr_t)words, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (!error) interruption_watch_process(own_group ? -*process : *process);
    return error;
}

int child_replace(const char *program, const char **words) {
    execv(program, (char *const *)(uintptr_t)words);
    return errno;
}

void child_keep(int descriptor) { fcntl(descriptor, F_SETFD, FD_CLOEXEC); }

bool child_pipe(int ends[2]) {
    if (pipe(ends) != 0) return false;
    child_keep(ends[0]);
    child_keep(ends[1]);
    return true;
}

bool child_ask_to_end(pid_t process) { return kill(process, SIGTERM) == 0; }

child_end child_await(pid_t process) {
    int ended;
    bool told = false;
    while (waitpid(process, &ended, 0) < 0) {
        if (errno != EINTR) return (child_end){.known = false};
        if (session_interrupted() && !told) told = child_ask_to_end(process);
    }
    return (child_end){.known = true,
                       .status = WIFEXITED(ended) ? WEXITSTATUS(ended) : 0,
                       .signal = WIFSIGNALED(ended) ? WTERMSIG(ended) : 0};
}
