// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Writing JSON, and text files that appear whole or not at all.
#include "cli/base/json.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Bytes of the UTF-8 character at `text`; 0 where there is none.
static int utf8_bytes(const char *text) {
    const unsigned char *c = (const unsigned char *)text;
    if (c[0] < 0x80) return 1;
    const int count = c[0] >= 0xc2 && c[0] < 0xe0   ? 2
                      : c[0] >= 0xe0 && c[0] < 0xf0 ? 3
                      : c[0] >= 0xf0 && c[0] < 0xf5 ? 4
                                                    : 0;
    for (int i = 1; i < count; i++)
        if ((c[i] & 0xc0) != 0x80) return 0;
    // Characters that have a shorter form, halves of pairs of UTF-16, and what is beyond Unicode.
    if ((c[0] == 0xe0 && c[1] < 0xa0) || (c[0] == 0xed && c[1] > 0x9f) || (c[0] == 0xf0 && c[1] < 0x90) ||
        (c[0] == 0xf4 && c[1] > 0x8f))
        return 0;
    return count;
}

/// Names of files may be any bytes, JSON is UTF-8: what is none becomes U+FFFD.
static void print_quoted(FILE *file, const char *text) {
    fputc('"', file);
    for (int bytes; *text; text += bytes) {
        const unsigned char c = (unsigned char)*text;
        bytes = utf8_bytes(text);
        if (c == '"' || c == '\\')
            fprintf(file, "\\%c", c);
        else if (c < 0x20)
            fprintf(file, "\\u%04x", c);
        else if (bytes)
            fwrite(text, 1, (size_t)bytes, file);
        else
            fputs("\xef\xbf\xbd", file), bytes = 1;
    }
    fputc('"', file);
}

/// Comma, line, indentation and key of the next member.
static void begin_member(json_writer *json, const char *key) {
    fprintf(json->file, "%s\n%*s", json->filled[json->depth] ? "," : "", 2 * json->depth, "");
    json->filled[json->depth] = true;
    if (key) {
        print_quoted(json->file, key);
        fputs(": ", json->file);
    }
}

static void print_number(FILE *file, double number) {
    if (!isfinite(number)) {
        fputs("null", file);
        return;
    }
    char text[40];
    for (int digits = 6; digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, number);
        if (strtod(text, NULL) == number) break;
    }
    fputs(text, file);
}

static void open_container(json_writer *json, char bracket) {
    fputc(bracket, json->file);
    json->filled[++json->depth] = false;
}

void json_start(json_writer *json, FILE *file) {
    *json = (json_writer){.file = file};
    open_container(json, '{');
}

void json_end(json_writer *json) {
    json_close(json, '}');
    fputc('\n', json->file);
}

void json_object(json_writer *json, const char *key) {
    begin_member(json, key);
    open_container(json, '{');
}

void json_array(json_writer *json, const char *key) {
    begin_member(json, key);
    open_container(json, '[');
}

void json_close(json_writer *json, char bracket) {
    if (json->filled[json->depth--]) fprintf(json->file, "\n%*s", 2 * json->depth, "");
    fputc(bracket, json->file);
}

void json_text(json_writer *json, const char *key, const char *text) {
    begin_member(json, key);
    print_quoted(json->file, text);
}

void json_number(json_writer *json, const char *key, double number) {
    begin_member(json, key);
    print_number(json->file, number);
}

void json_count(json_writer *json, const char *key, uint64_t number) {
    begin_member(json, key);
    fprintf(json->file, "%" PRIu64, number);
}

void json_flag(json_writer *json, const char *key, bool flag) {
    begin_member(json, key);
    fputs(flag ? "true" : "false", json->file);
}

void json_vector(json_writer *json, const char *key, uint32_t count, const double *numbers) {
    begin_member(json, key);
    fputc('[', json->file);
    for (uint32_t i = 0; i < count; i++) {
        if (i) fputs(", ", json->file);
        print_number(json->file, numbers[i]);
    }
    fputc(']', json->file);
}

bool text_file_open(cli_session *session, text_file *text, const char *path) {
    *text = (text_file){.path = path};
    if (strcmp(path, "-") == 0 || strcmp(path, "/dev/stdout") == 0) {
        text->file = stdout;
        return true;
    }
    const int error = temporary_file_choose(path, &text->pending);
    if (!error) text->file = fopen(text->pending.written, text->pending.temporary ? "wx" : "w");
    if (text->file) return true;
    session_fail(session, "%s: cannot create: %s", path, strerror(error ? error : errno));
    return false;
}

bool text_file_close(cli_session *session, text_file *text) {
    if (text->file == stdout) return output_flush(session, EXIT_DONE) == EXIT_DONE;
    errno = 0;
    const bool failed = ferror(text->file), closed = fclose(text->file) == 0;
    const int error = failed || !closed ? errno : temporary_file_commit(&text->pending);
    if (!failed && closed && !error) return true;
    session_fail(session, "%s: cannot write: %s", text->path, error ? strerror(error) : "a write failed");
    temporary_file_drop(&text->pending);
    return false;
}

void text_file_drop(text_file *text) {
    if (text->file == stdout) return;
    fclose(text->file);
    temporary_file_drop(&text->pending);
}

int output_flush(cli_session *session, int exit_status) {
    if (fflush(stdout) == 0 && !ferror(stdout)) return exit_status;
    if (errno == EPIPE) return EXIT_FAILED;
    return session_fail(session, "standard output: cannot write: %s", strerror(errno));
}
