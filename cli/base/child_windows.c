// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Processes by the calls of Windows; the number of a process is its handle.
#define WIN32_LEAN_AND_MEAN
#include "cli/base/child_system.h"
#include "cli/base/interruption.h"

#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <stdlib.h>
#include <string.h>
#include <windows.h>

enum { PIPE_BYTES = 1 << 16, WAIT_MS = 100, LINE_CHARACTERS = 32767 };

static HANDLE handle_of(pid_t process) { return (HANDLE)(intptr_t)process; }

/// Adds a word to a command line as the C library of the program takes it apart: backslashes count only before a quote. False
/// when there is no room.
static bool add_word(char *line, size_t *length, const char *word) {
    const char *at = word;
    const size_t room = 2 * strlen(word) + 4;
    if (room > LINE_CHARACTERS - *length) return false;
    char *to = line + *length;
    if (*length) *to++ = ' ';
    *to++ = '"';
    for (;; at++) {
        size_t slashes = strspn(at, "\\");
        at += slashes;
        if (*at == '"' || !*at) slashes *= 2;
        for (; slashes; slashes--) *to++ = '\\';
        if (!*at) break;
        if (*at == '"') *to++ = '\\';
        *to++ = *at;
    }
    *to++ = '"';
    *to = 0;
    *length = (size_t)(to - line);
    return true;
}

static int error_number(void) {
    const DWORD error = GetLastError();
    return error == ERROR_FILE_NOT_FOUND || error == ERROR_PATH_NOT_FOUND ? ENOENT : error == ERROR_ACCESS_DENIED ? EACCES : EIO;
}

/// Starts a program that gets three handles and no others.
static int create(const char *program, char *line, HANDLE streams[3], DWORD flags, HANDLE *process) {
    SIZE_T bytes = 0;
    InitializeProcThreadAttributeList(NULL, 1, 0, &bytes);
    STARTUPINFOEXA start = {.StartupInfo = {.cb = sizeof start, .dwFlags = STARTF_USESTDHANDLES, .hStdInput = streams[0],
                                            .hStdOutput = streams[1], .hStdError = streams[2]},
                            .lpAttributeList = malloc(bytes)};
    PROCESS_INFORMATION made;
    if (!start.lpAttributeList) return ENOMEM;
    int error = 0;
    if (!InitializeProcThreadAttributeList(start.lpAttributeList, 1, 0, &bytes)) {
        error = error_number();
    } else {
        if (!UpdateProcThreadAttribute(start.lpAttributeList, 0, PROC_THREAD_ATTRIBUTE_HANDLE_LIST, streams,
                                       3 * sizeof *streams, NULL, NULL) ||
            !CreateProcessA(program, line, NULL, NULL, TRUE, flags | EXTENDED_STARTUPINFO_PRESENT, NULL, NULL,
                            &start.StartupInfo, &made))
            error = error_number();
        DeleteProcThreadAttributeList(start.lpAttributeList);
    }
    free(start.lpAttributeList);
    if (error) return error;
    CloseHandle(made.hThread);
    *process = made.hProcess;
    return 0;
}

int child_spawn(const char *program, const char *const *words, const int streams[3], bool own_group, pid_t *process) {
    HANDLE given[3] = {INVALID_HANDLE_VALUE, INVALID_HANDLE_VALUE, INVALID_HANDLE_VALUE};
    char path[PATH_BYTES], *line = malloc(LINE_CHARACTERS + 1);
    size_t length = 0;
    int error = line ? 0 : ENOMEM;
    for (size_t i = 0; !error && words[i]; i++)
        if (!add_word(line, &length, words[i])) error = E2BIG;
    if (!error && !path_find_program(program, path)) error = ENOENT;
    SECURITY_ATTRIBUTES handed_on = {.nLength = sizeof handed_on, .bInheritHandle = TRUE};
    for (int i = 0; !error && i < 3; i++) {
        if (streams[i] < 0)
            given[i] = CreateFileA("NUL", GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE, &handed_on, OPEN_EXISTING, 0, NULL);
        else
            DuplicateHandle(GetCurrentProcess(), (HANDLE)_get_osfhandle(streams[i]), GetCurrentProcess(), &given[i], 0, TRUE,
                            DUPLICATE_SAME_ACCESS);
        if (given[i] == INVALID_HANDLE_VALUE) error = error_number();
    }
    HANDLE made = NULL;
    if (!error) error = create(path, line, given, own_group ? CREATE_NEW_PROCESS_GROUP : 0, &made);
    for (int i = 0; i < 3; i++)
        if (given[i] != INVALID_HANDLE_VALUE) CloseHandle(given[i]);
    free(line);
    if (error) return error;
    *process = (pid_t)(intptr_t)made;
    interruption_watch_process(*process);
    return 0;
}

int child_replace(const char *program, const char **words) {
    pid_t process;
    const int error = child_spawn(program, words, (const int[3]){0, 1, 2}, false, &process);
    if (error) return error;
    // The console tells both of Ctrl-C; the other one ends by it, and so does this one.
    WaitForSingleObject(handle_of(process), INFINITE);
    DWORD status = EXIT_FAILED;
    GetExitCodeProcess(handle_of(process), &status);
    exit((int)status);
}

void child_keep(int descriptor) {
    SetHandleInformation((HANDLE)_get_osfhandle(descriptor), HANDLE_FLAG_INHERIT, 0);
}

bool child_pipe(int ends[2]) { return _pipe(ends, PIPE_BYTES, _O_BINARY | _O_NOINHERIT) == 0; }

bool child_ask_to_end(pid_t process) { return TerminateProcess(handle_of(process), EXIT_FAILED); }

child_end child_await(pid_t process) {
    HANDLE handle = handle_of(process);
    DWORD status = 0;
    bool told = false;
    while (WaitForSingleObject(handle, WAIT_MS) == WAIT_TIMEOUT)
        if (session_interrupted() && !told) told = child_ask_to_end(process);
    const bool known = GetExitCodeProcess(handle, &status);
    CloseHandle(handle);
    return (child_end){.known = known, .status = (int)status};
}
