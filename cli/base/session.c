// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One run of the program: the library's context, messages, progress, interruption, timing, exit status.
#include "cli/base/session.h"
#include "cli/base/interruption.h"
#include "cli/base/wording.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { BAR_COLUMNS = 40, LINE_BYTES = 2048 };

/// The bar appears after this time, so that short runs stay silent, and is redrawn in these steps.
static const double BAR_DELAY_S = 0.4, BAR_STEP_S = 0.05;

double clock_now_s(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void wipe_bar(cli_session *session) {
    if (session->bar_drawn) fputs("\r\033[K", stderr);
    session->bar_drawn = false;
}

/// Draws the bar when it is time to.
static void draw_bar(cli_session *session, const char *label, double fraction) {
    const double now_s = clock_now_s();
    if (!session->progress || now_s - session->started_s <= BAR_DELAY_S ||
        (now_s - session->bar_time_s <= BAR_STEP_S && fraction < 1))
        return;
    const double share = fraction < 0 ? 0 : fraction > 1 ? 1 : fraction;
    const int filled = (int)(share * BAR_COLUMNS);
    fprintf(stderr, "\r\033[K%-12s [", label);
    for (int i = 0; i < BAR_COLUMNS; i++) fputc(i < filled ? '#' : '.', stderr);
    fprintf(stderr, "] %3d %%", (int)(100 * share));
    session->bar_drawn = true;
    session->bar_time_s = now_s;
}

static bool on_progress(void *user, const char *stage, double fraction) {
    cli_session *session = user;
    const session_listener *listener = session->listener;
    if (listener) return listener->progress(listener->user, stage, fraction) && !session_interrupted();
    if (!session->stepping) draw_bar(session, stage, fraction);
    return !session_interrupted();
}

bool session_interrupted(void) { return interruption_signal() != 0; }

bool session_step(cli_session *session, const char *what, uint64_t done, uint64_t count) {
    char label[64];
    snprintf(label, sizeof label, "%s %llu/%llu", what, (unsigned long long)done, (unsigned long long)count);
    session->stepping = true;
    draw_bar(session, label, (double)done / (double)count);
    return !session_interrupted();
}

/// Prints one line: program, then the file unless the text begins with it, then the text.
static void print_line(cli_session *session, ewa_severity severity, const char *text) {
    wipe_bar(session);
    const char *subject = session->subject;
    const bool named = !subject || strncmp(text, subject, strlen(subject)) == 0;
    if (session->listener) {
        char line[LINE_BYTES];
        snprintf(line, sizeof line, "%s%s%s", named ? "" : subject, named ? "" : ": ", text);
        session->listener->message(session->listener->user, severity, line);
        return;
    }
    if (!process_group_leads(session->group)) {
        if (severity == EWA_SEVERITY_ERROR)
            snprintf(session->group->failure, session->group->failure_bytes, "%s%s%s", named ? "" : subject,
                     named ? "" : ": ", text);
        return;
    }
    fprintf(stderr, "ewa: %s%s%s%s\n", severity == EWA_SEVERITY_WARNING ? "warning: " : "",
            named ? "" : subject, named ? "" : ": ", text);
}

static void on_message(void *user, ewa_severity severity, const char *text) {
    cli_session *session = user;
    if (severity == EWA_SEVERITY_ERROR) session->reported = true;
    if (session->repeats && severity != EWA_SEVERITY_ERROR) return;
    char line[LINE_BYTES / 2];
    wording_of_program(text, line, sizeof line);
    print_line(session, severity, line);
}

static void print_formatted(cli_session *session, ewa_severity severity, const char *format,
                            va_list arguments) {
    char text[1024];
    vsnprintf(text, sizeof text, format, arguments);
    print_line(session, severity, text);
}

ewa_context *session_context(cli_session *session, uint32_t thread_count, uint32_t cpu_mask) {
    ewa_context_options options;
    ewa_context_options_init(&options, sizeof options);
    options.thread_count = thread_count;
    options.cpu_mask = cpu_mask;
    options.message = on_message;
    options.message_user = session;
    options.message_level = session->quiet     ? EWA_SEVERITY_ERROR
                            : session->verbose ? EWA_SEVERITY_INFO
                                               : EWA_SEVERITY_NOTE;
    options.limits = session->limits;
    options.named_files = session->named_files;
    options.untrusted = session->untrusted;
    options.progress = on_progress;
    options.progress_user = session;
    options.open_file = session->open_file;
    ewa_context *context = NULL;
    const ewa_status status = ewa_context_create(&options, &context);
    if (status != EWA_OK)
        session_fail(session, "cannot start %u worker threads: %s", thread_count,
                     status == EWA_ERROR_MEMORY ? "out of memory" : ewa_status_name(status));
    return context;
}

bool session_start(cli_session *session, const common_arguments *common) {
    *session = (cli_session){.quiet = common->quiet,
                             .verbose = common->verbose,
                             .group = common->group,
                             .limits = common->limits,
                             .named_files = (ewa_named_files)common->named_files,
                             .untrusted = common->untrusted,
                             .started_s = clock_now_s()};
    session->progress =
        process_group_leads(session->group) &&
        (common->progress == 1 || (common->progress == -1 && !common->quiet && isatty(STDERR_FILENO)));
    interruption_start();
    ewa_cloud_load_options_init(&session->load, sizeof session->load);
    session->load.keep_going = common->keep_going;
    session->load.columns = common->columns;
    session->load.heights = (ewa_picture_heights)common->heights;
    session->filter = common->filter.term_count ? &common->filter : NULL;
    session->context = session_context(session, (uint32_t)common->threads, EWA_CPU_ALL);
    return session->context != NULL;
}

int session_end(cli_session *session, int exit_status) {
    wipe_bar(session);
    ewa_context_destroy(&session->context);
    interruption_obey();
    return exit_status;
}

int session_fail(cli_session *session, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    print_formatted(session, EWA_SEVERITY_ERROR, format, arguments);
    va_end(arguments);
    session->reported = true;
    return EXIT_FAILED;
}

int session_failed(cli_session *session, ewa_status status) {
    if (session_interrupted()) return EXIT_FAILED;
    if (session->reported) return EXIT_FAILED;
    return session_fail(session, "%s", status == EWA_CANCELLED ? "given up" : ewa_status_name(status));
}

bool session_passed(cli_session *session, ewa_status status) {
    if (status != EWA_OK) session_failed(session, status);
    return status == EWA_OK;
}

void session_warn(cli_session *session, const char *format, ...) {
    if (session->quiet) return;
    va_list arguments;
    va_start(arguments, format);
    print_formatted(session, EWA_SEVERITY_WARNING, format, arguments);
    va_end(arguments);
}

void session_note(cli_session *session, const char *format, ...) {
    if (session->quiet) return;
    va_list arguments;
    va_start(arguments, format);
    print_formatted(session, EWA_SEVERITY_NOTE, format, arguments);
    va_end(arguments);
}

void session_say(cli_session *session, const char *format, ...) {
    if (!session->verbose) return;
    va_list arguments;
    va_start(arguments, format);
    print_formatted(session, EWA_SEVERITY_INFO, format, arguments);
    va_end(arguments);
}
