// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Parts of a film, so that several processes draw one: a range of frames, or every n-th.
#include "cli/base/part.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

enum { MAX_FRAMES = 1000000 };

__attribute__((format(printf, 2, 3))) static bool wrong(char message[PART_ERROR_BYTES], const char *format,
                                                        ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, PART_ERROR_BYTES, format, arguments);
    va_end(arguments);
    return false;
}

/// Reads digits only, up to 999999999; returns the place after them, NULL when there are none or too many.
static const char *read_count(const char *text, uint64_t *count) {
    int digits = 0;
    for (*count = 0; text[digits] >= '0' && text[digits] <= '9' && digits < 10; digits++)
        *count = 10 * *count + (uint64_t)(text[digits] - '0');
    return digits >= 1 && digits <= 9 ? text + digits : NULL;
}

static bool add_count(film_part *part, uint64_t count, char message[PART_ERROR_BYTES]) {
    if (part->count)
        return wrong(message, "two numbers of frames, %" PRId64 " and %" PRIu64, part->count, count);
    if (count < 1 || count > MAX_FRAMES)
        return wrong(message, "%" PRIu64 " is outside [1, %d]", count, MAX_FRAMES);
    part->count = (int64_t)count;
    return true;
}

bool part_add(film_part *part, const char *text, char message[PART_ERROR_BYTES]) {
    uint64_t left = 0, right = 0;
    const char *middle = read_count(text, &left);
    if (middle && !*middle) return add_count(part, left, message);
    const char *end = middle && (*middle == '-' || *middle == '/') ? read_count(middle + 1, &right) : NULL;
    if (!end || *end)
        return wrong(message,
                     "'%.80s' is neither a number of frames, nor a range A-B, nor a part I/N, such as 2/8",
                     text);
    if (part->kind != PART_ALL) return wrong(message, "'%.80s' is a second part of the film", text);
    if (*middle == '-') {
        if (left > right) return wrong(message, "'%.80s' is empty: its first frame is after its last", text);
        part->kind = PART_RANGE;
        part->first = left;
        part->last = right;
        return true;
    }
    if (left < 1 || left > right)
        return wrong(message, "'%.80s' is no part: I/N counts the parts from 1 to N", text);
    part->kind = PART_ROBIN;
    part->index = left;
    part->parts = right;
    return true;
}

bool part_has(const film_part *part, uint64_t frame) {
    return part->kind == PART_RANGE   ? frame >= part->first && frame <= part->last
           : part->kind == PART_ROBIN ? frame % part->parts == part->index - 1
                                      : true;
}

bool part_is_beyond(const film_part *part, uint64_t count, char message[PART_ERROR_BYTES]) {
    if (part->kind != PART_RANGE || part->first < count) return false;
    wrong(message, "%" PRIu64 "-%" PRIu64 " is empty: the film has frames 0 to %" PRIu64, part->first,
          part->last, count - 1);
    return true;
}
