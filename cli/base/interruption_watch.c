// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What an interrupted run removes and ends, the same on all systems. Signal handlers read it: lock-free atomics only.
#include "cli/base/interruption_watch.h"
#include "cli/base/interruption.h"
#include "cli/base/path.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { MAX_FILES = 8, MAX_PROCESSES = 8 };

/// `used` is set last and cleared first.
static struct {
    atomic_bool used;
    char path[PATH_BYTES];
} files[MAX_FILES];
static _Atomic pid_t processes[MAX_PROCESSES];

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

void interruption_clean_up(void (*end_process)(pid_t process), void (*remove_file)(const char *path)) {
    for (int i = 0; i < MAX_PROCESSES; i++)
        if (processes[i]) end_process(processes[i]);
    for (int i = 0; i < MAX_FILES; i++)
        if (files[i].used) remove_file(files[i].path);
}
