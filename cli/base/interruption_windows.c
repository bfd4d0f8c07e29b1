// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Ends by what a console sends: Ctrl-C, Ctrl-Break, the window's end, the end of the session. The system calls the handler in a
// thread of its own. A mapped file cannot be cut short by others there.
#define WIN32_LEAN_AND_MEAN
#include "cli/base/interruption.h"
#include "cli/base/path.h"

#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <windows.h>

enum { MAX_FILES = 8, MAX_PROCESSES = 8 };

/// What the handler sees; `used` is set last and cleared first.
static struct {
    atomic_bool used;
    char path[PATH_BYTES];
} files[MAX_FILES];
static _Atomic pid_t processes[MAX_PROCESSES];
static atomic_int caught_signal;

static void clean_up(void) {
    for (int i = 0; i < MAX_PROCESSES; i++)
        if (processes[i]) TerminateProcess((HANDLE)(intptr_t)processes[i], 1);
    for (int i = 0; i < MAX_FILES; i++)
        if (files[i].used) DeleteFileA(files[i].path);
}

/// As the system itself ends a program that does not listen.
static void end_now(void) { TerminateProcess(GetCurrentProcess(), (UINT)STATUS_CONTROL_C_EXIT); }

static BOOL WINAPI catch_event(DWORD event) {
    const int number = event == CTRL_C_EVENT || event == CTRL_BREAK_EVENT ? SIGINT : SIGTERM;
    if (atomic_exchange(&caught_signal, number) == 0) Sleep((DWORD)(INTERRUPTION_GRACE_S * 1e3));
    clean_up();
    end_now();
    return TRUE;
}

void interruption_start(void) { SetConsoleCtrlHandler(catch_event, TRUE); }

int interruption_signal(void) { return caught_signal; }

void interruption_obey(void) {
    if (caught_signal) end_now();
}

void interruption_watch_file(const char *path) {
    for (int i = 0; i < MAX_FILES; i++) {
        if (files[i].used) continue;
        snprintf(files[i].path, sizeof files[i].path, "%s", path);
        files[i].used = true;
        return;
    }
}

void interruption_release_file(const char *path) {
    for (int i = 0; i < MAX_FILES; i++)
        if (files[i].used && strcmp(files[i].path, path) == 0) files[i].used = false;
}

void interruption_watch_process(pid_t process) {
    for (int i = 0; i < MAX_PROCESSES; i++) {
        if (processes[i]) continue;
        processes[i] = process;
        return;
    }
}

void interruption_release_process(pid_t process) {
    for (int i = 0; i < MAX_PROCESSES; i++)
        if (processes[i] == process) processes[i] = 0;
}
