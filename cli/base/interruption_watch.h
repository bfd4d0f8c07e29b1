// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What interruption_watch_file() and interruption_watch_process() have noted, for the handlers of signals.
#ifndef EWA_CLI_BASE_INTERRUPTION_WATCH_H
#define EWA_CLI_BASE_INTERRUPTION_WATCH_H

#include <sys/types.h>

/// Ends all processes that are watched, then removes all files; safe in a signal handler where the two functions are.
void interruption_clean_up(void (*end_process)(pid_t process), void (*remove_file)(const char *path));

#endif
