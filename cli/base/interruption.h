// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How a run ends before its time, by a signal, with nothing left behind but what was there before.
//
// The first SIGINT, SIGTERM or SIGHUP asks: the library hears of it by its progress, and the run cleans up. What does not hear
// it, such as a decoder of somebody else or a read that waits, has INTERRUPTION_GRACE_S; then the process ends by the signal. A
// second signal ends it at once. A mapped file that others cut short while it is read (SIGBUS) ends the run as a failure that
// names the file. Only the program does this: to a library the signals of a process do not belong.
#ifndef EWA_CLI_BASE_INTERRUPTION_H
#define EWA_CLI_BASE_INTERRUPTION_H

#include <sys/types.h>

#define INTERRUPTION_GRACE_S 0.2

/// Catches the signals. Whoever started the program to ignore one, as shells do in the background, is obeyed.
void interruption_start(void);

/// The signal that asks the run to stop, or 0.
int interruption_signal(void);

/// Ends the process by that signal; returns where there is none.
void interruption_obey(void);

/// Has a file removed, or a process (a group by its negative number) killed, should this process end by a signal.
void interruption_watch_file(const char *path);
void interruption_watch_process(pid_t process);

/// Takes that back; what is not watched is no mistake.
void interruption_release_file(const char *path);
void interruption_release_process(pid_t process);

#endif
