// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// EWA_GL_TUNING in the environment, for tests.
#include "gl/tuning.h"

#include <stdlib.h>
#include <string.h>

/// Returns what follows "name=", or NULL.
static const char *find(const char *name) {
    const char *text = getenv("EWA_GL_TUNING");
    const size_t length = strlen(name);
    for (const char *at = text; at && *at; at = strchr(at, ' ')) {
        while (*at == ' ') at++;
        if (strncmp(at, name, length) == 0 && at[length] == '=') return at + length + 1;
    }
    return NULL;
}

uint64_t ewa_gl_tuning(const char *name, uint64_t otherwise) {
    const char *value = find(name);
    return value ? strtoull(value, NULL, 10) : otherwise;
}

bool ewa_gl_tuning_is(const char *name, const char *word) {
    const char *value = find(name);
    const size_t length = strlen(word);
    return value && strncmp(value, word, length) == 0 && (value[length] == ' ' || !value[length]);
}
