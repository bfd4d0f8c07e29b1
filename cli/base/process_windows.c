// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a session asks of its own process, of Windows.
#define WIN32_LEAN_AND_MEAN
#include "cli/base/path.h"
#include "cli/base/session.h"

#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <stdlib.h>
#include <windows.h>

#include <psapi.h>

void process_start(void) {
    // The same bytes as elsewhere: no carriage returns, and texts of messages in UTF-8.
    _set_fmode(_O_BINARY);
    for (int stream = 0; stream < 3; stream++) _setmode(stream, _O_BINARY);
    SetConsoleOutputCP(CP_UTF8);
    // A terminal may know colours and the wiping of lines, which it has to be told to do.
    HANDLE console = GetStdHandle(STD_ERROR_HANDLE);
    DWORD mode;
    if (GetConsoleMode(console, &mode)) SetConsoleMode(console, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
}

uint64_t memory_peak_bytes(void) {
    PROCESS_MEMORY_COUNTERS counters = {.cb = sizeof counters};
    return GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof counters) ? counters.PeakWorkingSetSize : 0;
}

bool session_make_folder(cli_session *session, char folder[SESSION_FOLDER_BYTES]) {
    char parent[SESSION_FOLDER_BYTES - 40];
    const DWORD length = GetTempPathA(sizeof parent, parent);
    if (length == 0 || length >= sizeof parent) *parent = 0;
    snprintf(folder, SESSION_FOLDER_BYTES, "%sewa-%ld-%llu", parent, path_process_number(), (unsigned long long)GetTickCount64());
    if (path_make_folder(folder)) return true;
    session_fail(session, "%s: cannot create a folder for a while", folder);
    return false;
}
