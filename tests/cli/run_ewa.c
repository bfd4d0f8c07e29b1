// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Runs the program in a folder of its own and keeps what it said.
#include "run_ewa.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

run_result last_run;

static char folder[2048];

static void read_text(const char *suffix, char *text, size_t text_bytes) {
    char path[2100];
    snprintf(path, sizeof path, "%s.%s", folder, suffix);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    text[fread(text, 1, text_bytes - 1, file)] = 0;
    fclose(file);
}

static int run_list(const char *format, va_list arguments) {
    char command[8192], line[16384];
    vsnprintf(command, sizeof command, format, arguments);
    const char *program = getenv("EWA_PROGRAM");
    assert_non_null(program);
    snprintf(line, sizeof line, "cd '%s' && { ewa() { '%s' \"$@\"; }; %s\n} >'%s.out' 2>'%s.err'", folder,
             program, command, folder, folder);
    const int ended = system(line);
    last_run.exit_status = WIFEXITED(ended) ? WEXITSTATUS(ended) : 128 + WTERMSIG(ended);
    read_text("out", last_run.out, sizeof last_run.out);
    read_text("err", last_run.err, sizeof last_run.err);
    return last_run.exit_status;
}

int run(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int exit_status = run_list(format, arguments);
    va_end(arguments);
    return exit_status;
}

void run_done(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int exit_status = run_list(format, arguments);
    va_end(arguments);
    if (exit_status != 0 || last_run.err[0]) print_error("'%s' said: %s", format, last_run.err);
    assert_int_equal(exit_status, 0);
    assert_string_equal(last_run.err, "");
}

void run_fails(int exit_status, const char *said, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int ended = run_list(format, arguments);
    va_end(arguments);
    bool all = strncmp(last_run.err, "ewa: ", 5) == 0 && last_run.err[0];
    for (const char *word = said; *word;) {
        char part[256];
        const size_t length = strcspn(word, "|");
        snprintf(part, sizeof part, "%.*s", (int)length, word);
        all = all && strstr(last_run.err, part);
        word += length + (word[length] == '|');
    }
    for (const char *end = last_run.err; (end = strchr(end, '\n')) && end[1]; end++)
        all = all && strncmp(end + 1, "ewa: ", 5) == 0;
    if (!all || ended != exit_status)
        print_error("'%s' ended with %d, not %d '%s', and said: %s", format, ended, exit_status, said,
                    last_run.err);
    assert_int_equal(ended, exit_status);
    assert_true(all);
}

int scratch_enter(const char *name) {
    const char *build = getenv("EWA_BINARY_DIR");
    if (!build) return -1;
    snprintf(folder, sizeof folder, "%s/Testing/%s", build, name);
    char line[8192];
    snprintf(line, sizeof line, "rm -rf '%s' && mkdir -p '%s'", folder, folder);
    return system(line) == 0 ? 0 : -1;
}

const char *scratch_path(const char *name) {
    static char path[2560];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

void scratch_write(const char *name, const void *bytes, size_t size_bytes) {
    FILE *file = fopen(scratch_path(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size_bytes, file), size_bytes);
    assert_int_equal(fclose(file), 0);
}

void scratch_text(const char *name, const char *text) { scratch_write(name, text, strlen(text)); }

long scratch_size(const char *name) {
    FILE *file = fopen(scratch_path(name), "rb");
    if (!file) return -1;
    fseek(file, 0, SEEK_END);
    const long size = ftell(file);
    fclose(file);
    return size;
}

int scratch_count(void) {
    DIR *listing = opendir(folder);
    assert_non_null(listing);
    int count = -2; // . and ..
    while (readdir(listing)) count++;
    closedir(listing);
    return count;
}

bool scratch_same(const char *a, const char *b) {
    char first[2560];
    snprintf(first, sizeof first, "%s", scratch_path(a));
    FILE *x = fopen(first, "rb"), *y = fopen(scratch_path(b), "rb");
    assert_non_null(x);
    assert_non_null(y);
    int c, d;
    do {
        c = fgetc(x);
        d = fgetc(y);
    } while (c == d && c != EOF);
    fclose(x);
    fclose(y);
    return c == d;
}
