// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How a person likes to work: lines of the viewer's commands.
#include "preferences.h"
#include "kept_text.h"

#include <stdio.h>
#include <string.h>

static const kept_text kept = {"XDG_CONFIG_HOME", ".config", "view"};

static const char *const names[] = {"navigation", "budget_ms", "reduce", "animate"};
enum { NAME_COUNT = sizeof names / sizeof names[0] };

static bool take_line(void *user, const char *line) {
    char name[EWA_OPTION_TEXT_BYTES];
    int value_at = 0;
    if (strncmp(line, "keys ", 5) == 0) (void)viewer_do(user, line);
    if (sscanf(line, "set %127s %n", name, &value_at) != 1 || !value_at) return true;
    for (int i = 0; i < NAME_COUNT; i++)
        if (strcmp(name, names[i]) == 0) (void)viewer_setting_set(user, name, line + value_at);
    return true;
}

static void write_lines(const viewer *shown, char lines[PREFERENCES_BYTES]) {
    size_t used = 0;
    char chosen[VIEWER_TEXT_BYTES];
    const viewer_action *action;
    for (uint32_t i = 0; (action = viewer_action_at(i)) && used < PREFERENCES_BYTES; i++)
        if (viewer_action_choice(shown, action, chosen)) used += (size_t)snprintf(lines + used, PREFERENCES_BYTES - used, "%s\n", chosen);
    for (int i = 0; i < NAME_COUNT && used < PREFERENCES_BYTES; i++) {
        char value[EWA_OPTION_TEXT_BYTES];
        if (viewer_setting_get(shown, names[i], value))
            used += (size_t)snprintf(lines + used, PREFERENCES_BYTES - used, "set %s %s\n", names[i], value);
    }
}

void preferences_read(viewer *shown, char lines[PREFERENCES_BYTES]) {
    kept_text_read(&kept, take_line, shown);
    write_lines(shown, lines);
}

void preferences_write(const viewer *shown, const char *lines) {
    char now[PREFERENCES_BYTES];
    write_lines(shown, now);
    if (strcmp(now, lines) != 0) kept_text_write(&kept, now);
}
