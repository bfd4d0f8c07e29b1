// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Ends by signals. Handlers call nothing but what POSIX lets them, and setitimer(), a plain system call.
#define _DEFAULT_SOURCE // setitimer, SA_SIGINFO
#include "cli/base/interruption.h"
#include "cli/base/interruption_watch.h"

#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <unistd.h>

enum { LINE_BYTES = PATH_MAX + 128 };

static volatile sig_atomic_t caught_signal;

static void end_process(pid_t process) { kill(process, SIGKILL); }

static void remove_file(const char *path) { unlink(path); }

/// Leaves nothing behind. What the library writes has no name yet, or is removed by it.
static void clean_up(void) { interruption_clean_up(end_process, remove_file); }

static void end_by(int number) {
    signal(number, SIG_DFL);
    raise(number);
}

static void catch_signal(int number) {
    caught_signal = number;
    const struct itimerval grace = {.it_value.tv_usec = (suseconds_t)(INTERRUPTION_GRACE_S * 1e6)};
    setitimer(ITIMER_REAL, &grace, NULL);
}

static void end_late(int number) {
    (void)number;
    clean_up();
    end_by(caught_signal ? caught_signal : SIGALRM);
}

/// A number of /proc/self/maps; `*text` steps behind it.
static uintptr_t read_hexadecimal(const char **text) {
    uintptr_t value = 0;
    for (;; (*text)++) {
        const char digit = **text;
        if (digit >= '0' && digit <= '9')
            value = 16 * value + (uintptr_t)(digit - '0');
        else if (digit >= 'a' && digit <= 'f')
            value = 16 * value + (uintptr_t)(digit - 'a' + 10);
        else
            return value;
    }
}

/// The path in a line of /proc/self/maps, if the address is in its range and it is a file's.
static const char *path_at(const char *line, uintptr_t address) {
    const char *next = line;
    const uintptr_t begin = read_hexadecimal(&next);
    if (*next++ != '-') return NULL;
    const uintptr_t end = read_hexadecimal(&next);
    return address >= begin && address < end ? strchr(next, '/') : NULL;
}

/// Finds the mapped file that an address lies in; its name is in `line`. NULL where the system does not tell.
static const char *find_mapped(uintptr_t address, char line[LINE_BYTES]) {
    const int maps = open("/proc/self/maps", O_RDONLY | O_CLOEXEC);
    if (maps < 0) return NULL;
    char block[1024];
    const char *found = NULL;
    size_t length = 0;
    ssize_t got;
    while (!found && (got = read(maps, block, sizeof block)) > 0)
        for (ssize_t i = 0; i < got && !found; i++) {
            if (block[i] != '\n') {
                if (length < LINE_BYTES - 1) line[length++] = block[i];
                continue;
            }
            line[length] = 0;
            length = 0;
            found = path_at(line, address);
        }
    close(maps);
    return found;
}

static void put(const char *text) {
    size_t left = strlen(text);
    while (left) {
        const ssize_t written = write(STDERR_FILENO, text, left);
        if (written <= 0) return;
        text += written;
        left -= (size_t)written;
    }
}

static void end_by_cut(int number, siginfo_t *facts, void *machine) {
    (void)machine;
    // Several threads may meet the end at once: the first one speaks for all.
    static atomic_flag met = ATOMIC_FLAG_INIT;
    while (atomic_flag_test_and_set(&met)) pause();
    char line[LINE_BYTES];
    const char *path = facts->si_code == BUS_ADRERR ? find_mapped((uintptr_t)facts->si_addr, line) : NULL;
    clean_up();
    if (!path) {
        end_by(number);
        return;
    }
    put("ewa: ");
    put(path);
    put(": was cut short by another program while it was read\n");
    _exit(EXIT_FAILURE);
}

void interruption_start(void) {
    static const int numbers[] = {SIGINT, SIGTERM, SIGHUP};
    struct sigaction action = {.sa_handler = catch_signal, .sa_flags = (int)SA_RESETHAND};
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        struct sigaction inherited;
        if (sigaction(numbers[i], NULL, &inherited) == 0 && inherited.sa_handler != SIG_IGN)
            sigaction(numbers[i], &action, NULL);
    }
    struct sigaction late = {.sa_handler = end_late};
    sigemptyset(&late.sa_mask);
    sigaction(SIGALRM, &late, NULL);
    struct sigaction cut = {.sa_sigaction = end_by_cut, .sa_flags = SA_SIGINFO};
    sigemptyset(&cut.sa_mask);
    sigaction(SIGBUS, &cut, NULL);
}

int interruption_signal(void) { return caught_signal; }

void interruption_obey(void) {
    if (caught_signal) end_by(caught_signal);
}
