// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Ends by what a console sends: Ctrl-C, Ctrl-Break, the window's end, the end of the session. The system calls the handler in a
// thread of its own. A mapped file cannot be cut short by others there.
#define WIN32_LEAN_AND_MEAN
#include "cli/base/interruption.h"
#include "cli/base/interruption_watch.h"

#include <signal.h>
#include <stdatomic.h>
#include <stdint.h>
#include <windows.h>

static atomic_int caught_signal;

static void end_process(pid_t process) { TerminateProcess((HANDLE)(intptr_t)process, 1); }

static void remove_file(const char *path) { DeleteFileA(path); }

/// As the system itself ends a program that does not listen.
static void end_now(void) { TerminateProcess(GetCurrentProcess(), (UINT)STATUS_CONTROL_C_EXIT); }

static BOOL WINAPI catch_event(DWORD event) {
    const int number = event == CTRL_C_EVENT || event == CTRL_BREAK_EVENT ? SIGINT : SIGTERM;
    if (atomic_exchange(&caught_signal, number) == 0) Sleep((DWORD)(INTERRUPTION_GRACE_S * 1e3));
    interruption_clean_up(end_process, remove_file);
    end_now();
    return TRUE;
}

void interruption_start(void) { SetConsoleCtrlHandler(catch_event, TRUE); }

int interruption_signal(void) { return caught_signal; }

void interruption_obey(void) {
    if (caught_signal) end_now();
}
