// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Writing JSON, and text files that appear whole or not at all.
#ifndef EWA_CLI_BASE_JSON_H
#define EWA_CLI_BASE_JSON_H

#include "cli/base/session.h"
#include "cli/base/temporary_file.h"

enum { JSON_MAX_DEPTH = 16 };

/// A JSON text under construction. Keys are NULL inside arrays.
typedef struct json_writer {
    FILE *file;
    int depth;
    bool filled[JSON_MAX_DEPTH]; ///< the container of that depth has a member
} json_writer;

/// Begins with the outer object.
void json_start(json_writer *json, FILE *file);
/// Ends the outer object and the last line.
void json_end(json_writer *json);
void json_object(json_writer *json, const char *key);
void json_array(json_writer *json, const char *key);
/// Ends an object ('}') or an array (']').
void json_close(json_writer *json, char bracket);
void json_text(json_writer *json, const char *key, const char *text);
/// Writes every digit that a double needs; null when it is not finite.
void json_number(json_writer *json, const char *key, double number);
void json_count(json_writer *json, const char *key, uint64_t number);
void json_flag(json_writer *json, const char *key, bool flag);
/// An array of numbers.
void json_vector(json_writer *json, const char *key, uint32_t count, const double *numbers);

/// A text file that is written under a temporary name; "-" is standard output.
typedef struct text_file {
    FILE *file;
    const char *path;
    temporary_file pending;
} text_file;

/// Returns false after reporting.
bool text_file_open(cli_session *session, text_file *text, const char *path);
/// Finishes the file; returns false after reporting, with nothing left behind.
bool text_file_close(cli_session *session, text_file *text);
/// Ends an unfinished file and leaves nothing behind.
void text_file_drop(text_file *text);

/// Flushes standard output; returns `exit_status`, EXIT_FAILED after reporting when it could not be written.
int output_flush(cli_session *session, int exit_status);

#endif
