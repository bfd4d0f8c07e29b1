// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One run of the program: the library's context, messages, progress, interruption, timing, exit status.
#ifndef EWA_CLI_BASE_SESSION_H
#define EWA_CLI_BASE_SESSION_H

#include "cli/base/options.h"
#include "ewa/ewa.h"

enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2 };

/// Who gets messages and progress in place of the terminal.
typedef struct session_listener {
    void *user;
    void (*message)(void *user, ewa_severity severity, const char *text);
    bool (*progress)(void *user, const char *stage, double fraction); ///< false: the run is to stop
} session_listener;

typedef struct cli_session {
    ewa_context *context;
    ewa_cloud_load_options load;      ///< how files of points are read
    const ewa_filter *filter;         ///< which of their points are taken; NULL: all
    const session_listener *listener; ///< NULL: the terminal
    const cli_process_group *group;   ///< NULL: this process alone
    const char *subject;              ///< the file that messages are about, or NULL
    ewa_file_opener *open_file;       ///< of every further context; NULL: the system opens all files
    ewa_limits limits;                ///< of every context
    ewa_named_files named_files;
    bool untrusted;
    bool quiet, verbose;
    bool reported;     ///< an error was printed
    bool repeats;      ///< what is read has been read before: what the library said of it then goes without saying
    bool progress;     ///< a bar may be drawn
    bool bar_drawn;    ///< there is one on the line
    bool stepping;     ///< the bar counts steps of the command, not of the library
    double started_s;  ///< when the session began
    double bar_time_s; ///< when the bar was last drawn
} cli_session;

/// Makes the context that the common options ask for. Returns false after reporting.
bool session_start(cli_session *session, const common_arguments *common);

/// Makes a further context whose messages go the same way; NULL after reporting.
ewa_context *session_context(cli_session *session, uint32_t thread_count, uint32_t cpu_mask);

/// Frees the context; a bar is wiped. Returns `exit_status`, or what a signal asks for.
int session_end(cli_session *session, int exit_status);

/// Prints "ewa: SUBJECT: what" and returns EXIT_FAILED.
int session_fail(cli_session *session, const char *format, ...) __attribute__((format(printf, 2, 3)));

/// Makes sure that a failed call of the library has been reported; returns whether it succeeded.
bool session_passed(cli_session *session, ewa_status status);

/// The same for a call that is known to have failed; returns EXIT_FAILED.
int session_failed(cli_session *session, ewa_status status);

/// Prints a warning, unless --quiet.
void session_warn(cli_session *session, const char *format, ...) __attribute__((format(printf, 2, 3)));

/// Prints what may surprise or help, unless --quiet.
void session_note(cli_session *session, const char *format, ...) __attribute__((format(printf, 2, 3)));

/// Prints with --verbose only.
void session_say(cli_session *session, const char *format, ...) __attribute__((format(printf, 2, 3)));

/// Whether a signal asks the run to stop; loops of the program ask between steps, the library by its
/// progress.
bool session_interrupted(void);

/// Shows that `done` of `count` steps are done ("WHAT 3/60"); false when a signal asks to stop.
bool session_step(cli_session *session, const char *what, uint64_t done, uint64_t count);

enum { SESSION_FOLDER_BYTES = 256 };

/// Makes a folder of its own in TMPDIR for files that are soon removed again, with it. False after reporting.
bool session_make_folder(cli_session *session, char folder[SESSION_FOLDER_BYTES]);

/// Makes the process one that writes the same bytes and cleans up whoever started it, and however. First of all.
void process_start(void);

/// Monotonic time in seconds.
double clock_now_s(void);

/// Largest resident memory of this process so far, in bytes.
uint64_t memory_peak_bytes(void);

#endif
