// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Runs the program in a folder of its own and keeps what it said.
#ifndef EWA_TESTS_RUN_EWA_H
#define EWA_TESTS_RUN_EWA_H

#include "check.h"

/// What a shell command printed and how it ended; texts are cut to their buffers.
typedef struct run_result {
    int exit_status;
    char out[1 << 17], err[1 << 14];
} run_result;

/// The last result; each run overwrites it.
extern run_result last_run;

/// Runs a shell command, in which "ewa" is the program under test, in the scratch folder. Returns the exit
/// status.
int run(const char *format, ...) __attribute__((format(printf, 1, 2)));

/// Runs a command that has to succeed without a word on standard error.
void run_done(const char *format, ...) __attribute__((format(printf, 1, 2)));

/// Runs a command that has to end with `exit_status` and say all of the words in `said` (separated by '|') on
/// standard error, in lines that begin with "ewa: ".
void run_fails(int exit_status, const char *said, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/// Makes the scratch folder `name` empty and the working folder of later runs; for cmocka's setup.
int scratch_enter(const char *name);

/// Path of a file in the scratch folder; valid until the next call.
const char *scratch_path(const char *name);

/// Writes a file into the scratch folder.
void scratch_write(const char *name, const void *bytes, size_t size_bytes);
/// The same from a text.
void scratch_text(const char *name, const char *text);

/// Size of a file in the scratch folder; -1 when there is none.
long scratch_size(const char *name);

/// Number of entries in the scratch folder.
int scratch_count(void);

/// Whether two files of the scratch folder have the same bytes.
bool scratch_same(const char *a, const char *b);

#endif
