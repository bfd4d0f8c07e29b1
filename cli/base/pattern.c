// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Names of files: suffixes, and the place of a number. The pattern is the user's and never reaches printf.
#include "cli/base/pattern.h"
#include "cli/base/path.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

bool path_has_suffix(const char *path, const char *suffixes) {
    const size_t length = strlen(path);
    const char *name = path_file_name(path);
    for (const char *suffix = suffixes; *suffix;) {
        const size_t suffix_length = strcspn(suffix, "|");
        const bool stream = suffix_length == 1 && suffix[0] == '-';
        const bool whole = suffix[0] != '.';
        if (stream ? strcmp(path, "-") == 0
                   : (whole ? strlen(name) == suffix_length : length > suffix_length) &&
                         strncasecmp(path + length - suffix_length, suffix, suffix_length) == 0)
            return true;
        suffix += suffix_length;
        suffix += *suffix == '|';
    }
    return false;
}

/// What follows a percent sign.
typedef struct conversion {
    size_t length; ///< of its text without the percent sign; 0: none that is allowed
    int width;
    bool zeros;  ///< filled with zeros, else with blanks
    bool number; ///< false: a percent sign
} conversion;

static conversion read_conversion(const char *text) {
    conversion read = {.length = 0};
    if (text[0] == '%') return (conversion){.length = 1};
    size_t at = 0;
    if (text[at] == '0') {
        read.zeros = true;
        at++;
    }
    if (text[at] >= '1' && text[at] <= '9') read.width = text[at++] - '0';
    if (text[at] != 'd' || (read.zeros && !read.width)) return read;
    read.length = at + 1;
    read.number = true;
    return read;
}

bool pattern_is_numbered(const char *path) {
    int numbers = 0;
    for (const char *at = path; (at = strchr(at, '%'));) {
        const conversion found = read_conversion(at + 1);
        if (!found.length) return false;
        numbers += found.number;
        at += 1 + found.length;
    }
    return numbers == 1;
}

bool pattern_expand(const char *path, uint64_t number, size_t text_bytes, char *text) {
    size_t used = 0;
    while (*path && used < text_bytes) {
        const conversion found = *path == '%' ? read_conversion(path + 1) : (conversion){.length = 0};
        if (found.number)
            used += (size_t)snprintf(text + used, text_bytes - used, found.zeros ? "%0*" PRIu64 : "%*" PRIu64,
                                     found.width, number);
        else
            text[used++] = *path;
        path += 1 + found.length;
    }
    if (used >= text_bytes) return false;
    text[used] = 0;
    return true;
}
