// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Options from text and as text.
#include "base/base.h"
#include "base/format.h"
#include "base/options.h"
#include "io/number.h"
#include "io/text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_NUMBERS = 16 };

/// A value in both forms: doubles do not have every integer.
typedef struct option_value {
    double number;
    int64_t integer;
} option_value;

/// Reads a whole number, also one with an exponent: 1e7, 2.5e3; those up to 2^53, which doubles have exactly. NULL: none.
static const char *read_whole(const char *text, const char *end, int64_t *value) {
    const char *after = ewa_number_read_i64(text, end, value);
    if (after && (after == end || !strchr(".eE", *after))) return after;
    double number;
    after = ewa_number_read_f64(text, end, &number);
    if (!after || !(fabs(number) <= 0x1p53) || number != floor(number)) return NULL;
    *value = (int64_t)number;
    return memchr(text, 'e', (size_t)(after - text)) || memchr(text, 'E', (size_t)(after - text)) ? after : NULL;
}

/// Reads one of the option's words, or a number, which ends at a comma or at the end of the text.
static ewa_status read_value(const ewa_option *option, const char **text, option_value *value,
                             char problem[EWA_OPTION_TEXT_BYTES]) {
    const char *end = *text + strlen(*text), *word, *after;
    const size_t length = strcspn(*text, ",");
    size_t word_length;
    char range[EWA_OPTION_TEXT_BYTES];
    for (uint32_t i = 0; ewa_option_word(option, i, &value->number, &word, &word_length); i++) {
        if (word_length != length || memcmp(word, *text, length) != 0) continue;
        value->integer = (int64_t)value->number;
        *text += length;
        return EWA_OK;
    }
    ewa_option_range(option, range);
    if (option->words || option->type == EWA_OPTION_BOOL)
        return ewa_text_wrong(problem, "'%.80s' is not one of %s", *text, option->words ? option->words : "off|on");
    const bool whole = option->type == EWA_OPTION_U32 || option->type == EWA_OPTION_U64;
    if (whole) {
        after = read_whole(*text, end, &value->integer);
        value->number = after ? (double)value->integer : NAN;
    } else {
        after = ewa_number_read_f64(*text, end, &value->number);
    }
    if (!after || !isfinite(value->number) || (*after && !(option->count && *after == ',')))
        return ewa_text_wrong(problem, "'%.80s' is not a%s number", *text, whole ? " whole" : "");
    if (!ewa_option_allows(option, value->number)) {
        char number[32];
        ewa_format(number, sizeof number, "%g", value->number);
        return whole ? ewa_text_wrong(problem, "%" PRId64 " is outside %s", value->integer, range)
                     : ewa_text_wrong(problem, "%s is outside %s", number, range);
    }
    *text = after;
    return EWA_OK;
}

ewa_status ewa_option_set(const ewa_option *option, void *options, const char *text,
                          char problem[EWA_OPTION_TEXT_BYTES]) {
    if (!option || !options || !text) return EWA_ERROR_ARGUMENT;
    option_value values[MAX_NUMBERS];
    const uint32_t count = option->count ? option->count : 1;
    const char *next = text;
    for (uint32_t i = 0; i < count; i++) {
        EWA_TRY(read_value(option, &next, &values[i], problem));
        if (*next != (i + 1 < count ? ',' : 0))
            return ewa_text_wrong(problem, "'%.80s' is not %u numbers separated by commas", text, count);
        next += i + 1 < count;
    }
    for (uint32_t i = 0; i < count; i++) {
        const uint64_t integer = (uint64_t)values[i].integer;
        if (option->type == EWA_OPTION_U64)
            memcpy((char *)options + option->offset + i * sizeof integer, &integer, sizeof integer);
        else
            ewa_option_put(option, options, i, values[i].number);
    }
    return EWA_OK;
}

void ewa_option_get(const ewa_option *option, const void *options, char text[EWA_OPTION_TEXT_BYTES]) {
    const uint32_t count = option->count ? option->count : 1;
    size_t used = 0;
    for (uint32_t i = 0; i < count; i++) {
        char number[EWA_NUMBER_BYTES];
        const double value = ewa_option_number(option, options, i);
        const char *from = number, *word;
        size_t length;
        double word_value;
        if (option->type == EWA_OPTION_U64) {
            uint64_t integer;
            memcpy(&integer, (const char *)options + option->offset + i * sizeof integer, sizeof integer);
            length = (size_t)snprintf(number, sizeof number, "%" PRIu64, integer);
        } else if (option->type <= EWA_OPTION_CHOICE &&
                   ewa_option_word(option, (uint32_t)value, &word_value, &word, &length)) {
            from = word;
        } else {
            length = option->type == EWA_OPTION_F32 ? ewa_number_write_f32((float)value, number)
                                                    : ewa_number_write_f64(value, number);
        }
        used += (size_t)snprintf(text + used, EWA_OPTION_TEXT_BYTES - used, "%s%.*s", i ? "," : "",
                                 (int)length, from);
    }
}

/// Reads "f80", "ff8800", or with alpha "f80c", "ff8800cc".
static bool read_hex(const char *digits, double srgba[4]) {
    const size_t length = strlen(digits), per_channel = length > 4 ? 2 : 1;
    if (length < 3 || length == 5 || length == 7 || length > 8 ||
        strspn(digits, "0123456789abcdefABCDEF") != length)
        return false;
    srgba[3] = 1;
    for (size_t c = 0; c * per_channel < length; c++) {
        const char pair[3] = {digits[c * per_channel], digits[c * per_channel + per_channel - 1], 0};
        unsigned value;
        if (sscanf(pair, "%2x", &value) != 1) return false;
        srgba[c] = value / 255.0;
    }
    return true;
}

bool ewa_color_read(const char *text, double srgba[4]) {
    static const struct {
        const char *name;
        double srgba[4];
    } names[] = {{"white", {1, 1, 1, 1}},
                 {"black", {0, 0, 0, 1}},
                 {"gray", {0.5, 0.5, 0.5, 1}},
                 {"grey", {0.5, 0.5, 0.5, 1}},
                 {"transparent", {0, 0, 0, 0}}};
    double found[4] = {0, 0, 0, 1};
    if (!text) return false;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (strcmp(text, names[i].name) == 0) return memcpy(srgba, names[i].srgba, sizeof found);
    if (*text == '#') return read_hex(text + 1, found) && memcpy(srgba, found, sizeof found);
    const char *end = text + strlen(text);
    uint32_t count = 0;
    for (const char *at = text; count < 4; at++) {
        at = ewa_number_read_f64(at, end, &found[count]);
        if (!at || !(found[count] >= 0 && found[count] <= 1)) return false;
        count++;
        if (at == end) return count >= 3 && memcpy(srgba, found, sizeof found);
        if (*at != ',') return false;
    }
    return false;
}
