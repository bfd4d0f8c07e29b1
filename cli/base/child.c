// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A program of somebody else that runs beside this one.
#include "cli/base/child.h"
#include "cli/base/child_system.h"
#include "cli/base/interruption.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { COMPLAINT_BYTES = 400 };

bool child_find_helper(const char *folder, const char *name, char helper[PATH_BYTES]) {
    const char *const places[][2] = {{"", name}, {folder, name}, {"libexec/ewa", name}};
    char own[PATH_BYTES];
    if (!path_of_own_folder(own)) return false;
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        const bool beside = !places[i][0][0];
        const int made = snprintf(helper, PATH_BYTES, "%s%s%s%s%s", own, beside ? "" : "../", places[i][0],
                                  beside ? "" : "/", places[i][1]);
        if (made > 0 && made < PATH_BYTES && path_is_program(helper)) return true;
    }
    return false;
}

int child_become(cli_session *session, const char *folder, const char *name, const char *absent,
                 const common_arguments *common) {
    char helper[PATH_BYTES];
    if (!child_find_helper(folder, name, helper)) return session_fail(session, "%s", absent);
    const char **words = calloc(common->word_count + 2, sizeof *words);
    if (!words) return session_fail(session, "out of memory");
    words[0] = helper;
    memcpy(words + 1, common->words, common->word_count * sizeof *words);
    const int error = child_replace(helper, words);
    free(words);
    return session_fail(session, "%s: %s", helper, strerror(error));
}

static void close_end(int *end) {
    if (*end >= 0) close(*end);
    *end = -1;
}

int child_start(const char *program, const char *const *words, bool listens, child_process *child) {
    *child = (child_process){.input = -1, .output = -1};
    int input[2] = {-1, -1}, output[2] = {-1, -1};
    child->complaints = tmpfile();
    int error = child->complaints && child_pipe(input) && (!listens || child_pipe(output)) ? 0 : errno;
    if (!error) {
        child_keep(fileno(child->complaints));
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

/// Closes its standard input and waits.
static child_end await_end(child_process *child) {
    close_end(&child->input);
    child_end ended = {.known = false};
    if (child->process > 0) {
        ended = child_await(child->process);
        interruption_release_process(child->process);
    }
    child->process = 0;
    return ended;
}

bool child_wait(cli_session *session, child_process *child, const char *subject, const char *name,
                bool is_early) {
    const child_end ended = await_end(child);
    if (session_interrupted()) return false;
    if (ended.known && !ended.status && !ended.signal && !is_early) return true;
    char said[COMPLAINT_BYTES] = "", last[COMPLAINT_BYTES] = "", how[64] = "ended early";
    rewind(child->complaints);
    while (fgets(said, sizeof said, child->complaints)) {
        said[strcspn(said, "\r\n")] = 0;
        if (said[0]) memcpy(last, said, sizeof last);
    }
    if (ended.signal)
        snprintf(how, sizeof how, "was ended by signal %d", ended.signal);
    else if (ended.status)
        snprintf(how, sizeof how, "failed with status %d", ended.status);
    session_fail(session, "%s: %s %s%s%s", subject, name, how, last[0] ? ": " : "", last);
    return false;
}

void child_drop(child_process *child) {
    if (child->process > 0) {
        child_ask_to_end(child->process);
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
