// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A program of somebody else that runs beside this one.
#include "cli/base/child.h"
#include "cli/base/interruption.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { COMPLAINT_BYTES = 400 };

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

bool child_find_helper(const char *folder, const char *name, char helper[PATH_MAX]) {
    const char *const places[][2] = {{"", name}, {folder, name}, {"libexec/ewa", name}};
    char own[PATH_MAX];
    const ssize_t length = readlink("/proc/self/exe", own, sizeof own - 1);
    if (length <= 0) return false;
    own[length] = 0;
    char *slash = strrchr(own, '/');
    if (!slash) return false;
    slash[1] = 0;
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        const bool beside = !places[i][0][0];
        const int made = snprintf(helper, PATH_MAX, "%s%s%s%s%s", own, beside ? "" : "../", places[i][0],
                                  beside ? "" : "/", places[i][1]);
        if (made > 0 && made < PATH_MAX && access(helper, X_OK) == 0) return true;
    }
    return false;
}

int child_become(cli_session *session, const char *folder, const char *name, const char *absent,
                 const common_arguments *common) {
    char helper[PATH_MAX];
    if (!child_find_helper(folder, name, helper)) return session_fail(session, "%s", absent);
    const char **words = calloc(common->word_count + 2, sizeof *words);
    if (!words) return session_fail(session, "out of memory");
    words[0] = helper;
    memcpy(words + 1, common->words, common->word_count * sizeof *words);
    execv(helper, (char *const *)(uintptr_t)words);
    const int error = errno;
    free(words);
    return session_fail(session, "%s: %s", helper, strerror(error));
}

bool child_pipe(int ends[2]) {
    if (pipe(ends) != 0) return false;
    fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    fcntl(ends[1], F_SETFD, FD_CLOEXEC);
    return true;
}

static void close_end(int *end) {
    if (*end >= 0) close(*end);
    *end = -1;
}

int child_start(const char *program, const char *const *words, bool listens, child_process *child) {
    *child = (child_process){.input = -1, .output = -1};
    // Whoever started us to ignore the ends of children is not obeyed: this one's matters.
    signal(SIGCHLD, SIG_DFL);
    int input[2] = {-1, -1}, output[2] = {-1, -1};
    child->complaints = tmpfile();
    int error = child->complaints && child_pipe(input) && (!listens || child_pipe(output)) ? 0 : errno;
    if (!error) {
        fcntl(fileno(child->complaints), F_SETFD, FD_CLOEXEC);
        error = child_spawn(program, words, (const int[3]){input[0], output[1], fileno(child->complaints)},
                            false, &child->process);
    }
    close_end(&input[0]);
    close_end(&output[1]);
    child->input = input[1];
    child->output = output[0];
    if (!error) return 0;
    child->process = 0;
    child_drop(child);
    return error;
}

/// Closes its standard input and waits; returns what waitpid() says of the end, -1 when it does not know.
static int await_end(child_process *child) {
    close_end(&child->input);
    int ended = -1;
    bool told = false;
    while (child->process > 0 && waitpid(child->process, &ended, 0) < 0) {
        if (errno != EINTR) {
            ended = -1;
            break;
        }
        if (session_interrupted() && !told) told = kill(child->process, SIGTERM) == 0;
    }
    if (child->process > 0) interruption_release_process(child->process);
    child->process = 0;
    return ended;
}

bool child_wait(cli_session *session, child_process *child, const char *subject, const char *name,
                bool is_early) {
    const int ended = await_end(child);
    if (session_interrupted()) return false;
    if (ended == 0 && !is_early) return true;
    char said[COMPLAINT_BYTES] = "", last[COMPLAINT_BYTES] = "", how[64] = "ended early";
    rewind(child->complaints);
    while (fgets(said, sizeof said, child->complaints)) {
        said[strcspn(said, "\r\n")] = 0;
        if (said[0]) memcpy(last, said, sizeof last);
    }
    if (ended > 0 && WIFEXITED(ended))
        snprintf(how, sizeof how, "failed with status %d", WEXITSTATUS(ended));
    else if (ended > 0 && WIFSIGNALED(ended))
        snprintf(how, sizeof how, "was ended by signal %d", WTERMSIG(ended));
    session_fail(session, "%s: %s %s%s%s", subject, name, how, last[0] ? ": " : "", last);
    return false;
}

void child_drop(child_process *child) {
    if (child->process > 0) {
        kill(child->process, SIGTERM);
        await_end(child);
    }
    // A child that was never started has no ends either: zero would be standard input.
    if (child->complaints) {
        close_end(&child->input);
        close_end(&child->output);
        fclose(child->complaints);
    }
    *child = (child_process){.input = -1, .output = -1};
}
