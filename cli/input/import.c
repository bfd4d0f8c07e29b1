// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Rare formats of meshes, by a helper program: started, watched, ended.
#include "cli/input/import.h"

#include "cli/base/child.h"
#include "cli/base/interruption.h"

#include <errno.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/wait.h>
#include <unistd.h>

enum { ERROR_BYTES = 512, STEP_BYTES = 1 << 16, POLL_MS = 100 };
/// With this a child of posix_spawn() ends whose program cannot be started, where its parent was not told so.
enum { NOT_STARTED = 127 };

static const import_limits usual_limits = {
    .wall_s = 120, .cpu_s = 60, .memory_bytes = (uint64_t)4 << 30, .output_bytes = (uint64_t)4 << 30};

bool import_is_named(const char *path) {
    static const char *const suffixes[] = {".fbx", ".dae", ".3ds", ".3mf",  ".amf", ".ase", ".blend",
                                           ".dxf", ".lwo", ".x",   ".ms3d", ".x3d", ".wrl"};
    const char *suffix = strrchr(path, '.');
    for (size_t i = 0; suffix && i < sizeof suffixes / sizeof suffixes[0]; i++)
        if (strcasecmp(suffix, suffixes[i]) == 0) return true;
    return false;
}

/// A helper that runs.
typedef struct import_child {
    pid_t pid;
    int output, errors; ///< ends of pipes that it writes into
    uint8_t *bytes;
    size_t size_bytes, capacity_bytes;
    char error[ERROR_BYTES];
    size_t error_bytes;
} import_child;

/// Starts the helper with nothing to read, and pipes for what it says. False with errno.
static bool start(const char *helper, const char *path, const import_limits *limits, import_child *child) {
    int input[2] = {-1, -1}, output[2] = {-1, -1}, errors[2] = {-1, -1};
    int error = child_pipe(input) && child_pipe(output) && child_pipe(errors) ? 0 : errno;
    if (!error) {
        // An input that is at its end: not /dev/null, which some containers do not have or have as a file.
        close(input[1]);
        input[1] = -1;
        char memory[32], seconds[32], named[32];
        snprintf(memory, sizeof memory, "%llu", (unsigned long long)limits->memory_bytes);
        snprintf(seconds, sizeof seconds, "%u", limits->cpu_s);
        snprintf(named, sizeof named, "%d", (int)limits->named_files);
        const char *const words[] = {helper, memory, seconds, path, named, NULL};
        error = child_spawn(helper, words, (const int[3]){input[0], output[1], errors[1]}, true, &child->pid);
    }
    if (!error) {
        child->output = output[0];
        child->errors = errors[0];
        output[0] = errors[0] = -1;
    }
    const int ends[] = {input[0], input[1], output[0], output[1], errors[0], errors[1]};
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++)
        if (ends[i] >= 0) close(ends[i]);
    errno = error;
    return !error;
}

/// Takes what has come on one of the pipes; 0 at its end, -1 when there is too much or no memory.
static int take(import_child *child, bool is_output, const import_limits *limits) {
    char rest[ERROR_BYTES];
    if (!is_output) { // the first words say what is wrong
        const size_t room = sizeof child->error - 1 - child->error_bytes;
        const ssize_t got =
            read(child->errors, room ? child->error + child->error_bytes : rest, room ? room : sizeof rest);
        if (got > 0 && room) child->error_bytes += (size_t)got;
        return got > 0 || (got < 0 && errno == EINTR);
    }
    if (child->capacity_bytes - child->size_bytes < STEP_BYTES) {
        const size_t larger = child->capacity_bytes ? 2 * child->capacity_bytes : 4 * (size_t)STEP_BYTES;
        uint8_t *moved = realloc(child->bytes, larger);
        if (!moved) return -1;
        child->bytes = moved;
        child->capacity_bytes = larger;
    }
    const ssize_t got = read(child->output, child->bytes + child->size_bytes, STEP_BYTES);
    if (got > 0) child->size_bytes += (size_t)got;
    if (child->size_bytes > limits->output_bytes) return -1;
    return got > 0 || (got < 0 && errno == EINTR);
}

/// Reads both pipes to their ends; NULL, or why that was given up.
static const char *collect(import_child *child, const import_limits *limits) {
    const double deadline_s = clock_now_s() + limits->wall_s;
    struct pollfd waiting[2] = {{child->output, POLLIN, 0}, {child->errors, POLLIN, 0}};
    while (waiting[0].fd >= 0 || waiting[1].fd >= 0) {
        if (session_interrupted()) return "interrupted";
        if (clock_now_s() > deadline_s) return "it takes too long";
        if (poll(waiting, 2, POLL_MS) < 0 && errno != EINTR) return "it cannot be listened to";
        for (int i = 0; i < 2; i++) {
            if (waiting[i].fd < 0 || !(waiting[i].revents & (POLLIN | POLLHUP | POLLERR))) continue;
            const int more = take(child, i == 0, limits);
            if (more < 0) return "it gives too much";
            if (more == 0) waiting[i].fd = -1;
        }
    }
    return NULL;
}

/// Says how the helper ended; true when that is well.
static bool conclude(cli_session *session, const char *helper, const char *path, const import_child *child, int state) {
    if (WIFEXITED(state) && WEXITSTATUS(state) == 0) return true;
    if (WIFSIGNALED(state) && WTERMSIG(state) == SIGXCPU)
        session_fail(session, "%s: the import helper takes too long", path);
    else if (WIFSIGNALED(state))
        session_fail(session, "%s: the import helper died (signal %d); the file is broken or hostile", path,
                     WTERMSIG(state));
    else if (child->error_bytes)
        session_fail(session, "%s: %s", path, child->error);
    else if (WEXITSTATUS(state) == NOT_STARTED)
        session_fail(session, "%s: the import helper %s cannot be started (status %d)", path, helper, NOT_STARTED);
    else
        session_fail(session, "%s: the import helper failed (status %d)", path, WEXITSTATUS(state));
    return false;
}

bool import_run(cli_session *session, const char *helper, const char *path, const import_limits *limits,
                uint8_t **bytes, size_t *size_bytes) {
    import_child child = {.pid = -1};
    *bytes = NULL;
    *size_bytes = 0;
    if (!start(helper, path, limits, &child)) {
        session_fail(session, "%s: the import helper %s cannot be started: %s", path, helper,
                     strerror(errno));
        return false;
    }
    const char *given_up = collect(&child, limits);
    if (given_up) kill(-child.pid, SIGKILL);
    int state = 0;
    // A helper that has closed its pipes may still go on.
    const double deadline_s = clock_now_s() + limits->wall_s;
    for (pid_t ended = 0; (ended = waitpid(child.pid, &state, given_up ? 0 : WNOHANG)) != child.pid;) {
        if (ended < 0 && errno != EINTR) break;
        if (!given_up && (clock_now_s() > deadline_s || session_interrupted())) {
            given_up = "it takes too long";
            kill(-child.pid, SIGKILL);
        }
        if (!given_up) poll(NULL, 0, 1);
    }
    interruption_release_process(-child.pid);
    close(child.output);
    close(child.errors);
    child.error[child.error_bytes] = 0;
    for (size_t i = 0; i < child.error_bytes; i++)
        if ((unsigned char)child.error[i] < ' ') child.error[i] = i + 1 < child.error_bytes ? ' ' : 0;
    bool done = !given_up;
    if (given_up)
        session_fail(session, "%s: the import helper was ended: %s", path, given_up);
    else
        done = conclude(session, helper, path, &child, state);
    if (done && child.error_bytes) session_warn(session, "%s: %s", path, child.error);
    if (!done) {
        free(child.bytes);
        return false;
    }
    *bytes = child.bytes;
    *size_bytes = child.size_bytes;
    return true;
}

bool import_load(cli_session *session, const char *path, uint32_t wanted, ewa_model *model) {
    char helper[PATH_BYTES];
    *model = (ewa_model){.points = NULL};
    if (session->untrusted) {
        session_fail(session, "%s: this format is read by a helper program, which --untrusted does not start", path);
        return false;
    }
    if (!child_find_helper("import", "ewa-import", helper)) {
        session_fail(session,
                     "%s: this format is read by the helper program ewa-import, which is not installed (it "
                     "is built where Assimp is found)",
                     path);
        return false;
    }
    uint8_t *bytes;
    size_t size_bytes;
    import_limits limits = usual_limits;
    const uint64_t memory_bytes = session->limits.max_memory_bytes;
    limits.named_files = session->named_files;
    if (memory_bytes && memory_bytes < limits.memory_bytes) limits.memory_bytes = memory_bytes;
    if (memory_bytes && memory_bytes < limits.output_bytes) limits.output_bytes = memory_bytes;
    if (!import_run(session, helper, path, &limits, &bytes, &size_bytes)) return false;
    const ewa_status status =
        ewa_model_load_memory(session->context, bytes, size_bytes, path, path, wanted, NULL, model);
    free(bytes);
    return session_passed(session, status);
}
