// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The program on a host without signals (WASI): nothing interrupts it.
#include "cli/base/interruption.h"

void interruption_start(void) {}

int interruption_signal(void) { return 0; }

void interruption_obey(void) {}

void interruption_watch_file(const char *path) { (void)path; }

void interruption_watch_process(pid_t process) { (void)process; }

void interruption_release_file(const char *path) { (void)path; }

void interruption_release_process(pid_t process) { (void)process; }
