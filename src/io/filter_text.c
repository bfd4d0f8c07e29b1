// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Filters from text: "classification=2,6 and intensity>100".
#include "base/base.h"
#include "ewa/image.h"
#include "ewa/select.h"
#include "io/number.h"
#include "io/text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static ewa_text trimmed(const char *from, const char *to) {
    while (from < to && ewa_is_blank(*from)) from++;
    while (to > from && ewa_is_blank(to[-1])) to--;
    return (ewa_text){from, (size_t)(to - from)};
}

/// Reads all of a text as a finite number.
static bool read_number(ewa_text text, double *number) {
    const char *end = text.chars + text.length;
    return text.length && ewa_number_read_f64(text.chars, end, number) == end && isfinite(*number);
}

static ewa_status add_range(ewa_filter_term *term, double low, double high,
                            char problem[EWA_OPTION_TEXT_BYTES]) {
    if (term->range_count == EWA_FILTER_RANGES)
        return ewa_text_wrong(problem, "'%s' has more than %d numbers", term->name, EWA_FILTER_RANGES);
    term->ranges[term->range_count++] = (ewa_filter_range){.low = low, .high = high};
    return EWA_OK;
}

/// Adds a class by its name.
static ewa_status add_class(ewa_filter_term *term, ewa_text word, char problem[EWA_OPTION_TEXT_BYTES]) {
    static const struct {
        const char *word;
        double low, high;
    } groups[] = {{"vegetation", 3, 5}, {"noise", 7, 7}, {"noise", 18, 18}};
    ewa_status status = EWA_OK;
    bool found = false;
    for (size_t i = 0; i < sizeof groups / sizeof groups[0] && status == EWA_OK; i++) {
        if (!ewa_text_is_any_case(word, groups[i].word)) continue;
        found = true;
        status = add_range(term, groups[i].low, groups[i].high, problem);
    }
    char name[EWA_CLASS_NAME_BYTES], quote[EWA_QUOTE_BYTES];
    uint32_t code;
    if (found) return status;
    if (word.length < sizeof name) {
        memcpy(name, word.chars, word.length);
        name[word.length] = 0;
        if (ewa_class_find(name, &code)) return add_range(term, code, code, problem);
    }
    return ewa_text_wrong(problem, "%s is neither a number nor a class (ground, building, low vegetation, water, noise, ...)",
                          ewa_quote(word, quote));
}

/// Adds "7", "1..2", "..5", "3.." or "ground".
static ewa_status add_value(ewa_filter_term *term, ewa_text value, char problem[EWA_OPTION_TEXT_BYTES]) {
    const char *end = value.chars + value.length;
    char quote[EWA_QUOTE_BYTES];
    double low = -INFINITY, high = INFINITY;
    if (!value.length) return ewa_text_wrong(problem, "a number behind '%s' is missing", term->name);
    for (const char *at = value.chars; at + 1 < end; at++) {
        if (at[0] != '.' || at[1] != '.') continue;
        const ewa_text first = trimmed(value.chars, at), last = trimmed(at + 2, end);
        const bool good = (first.length || last.length) && (!first.length || read_number(first, &low)) &&
                          (!last.length || read_number(last, &high)) && low <= high;
        if (!good) return ewa_text_wrong(problem, "%s is not a range LOW..HIGH", ewa_quote(value, quote));
        return add_range(term, low, high, problem);
    }
    if (read_number(value, &low)) return add_range(term, low, low, problem);
    return add_class(term, value, problem);
}

static ewa_status add_values(ewa_filter_term *term, ewa_text values, char problem[EWA_OPTION_TEXT_BYTES]) {
    const char *at = values.chars, *end = values.chars + values.length;
    for (;;) {
        const char *comma = at < end ? memchr(at, ',', (size_t)(end - at)) : NULL;
        EWA_TRY(add_value(term, trimmed(at, comma ? comma : end), problem));
        if (!comma) return EWA_OK;
        at = comma + 1;
    }
}

/// Sets the range of "<", "<=", ">" or ">=".
static ewa_status set_bound(ewa_filter_term *term, bool below, bool open, ewa_text value,
                            char problem[EWA_OPTION_TEXT_BYTES]) {
    char quote[EWA_QUOTE_BYTES];
    double number;
    if (!read_number(value, &number))
        return ewa_text_wrong(problem, "'%s': %s is not a number", term->name, ewa_quote(value, quote));
    term->range_count = 1;
    term->ranges[0] = (ewa_filter_range){.low = below ? -INFINITY : number,
                                         .high = below ? number : INFINITY,
                                         .low_open = open && !below,
                                         .high_open = open && below};
    return EWA_OK;
}

static ewa_status read_term(ewa_text text, ewa_filter_term *term, char problem[EWA_OPTION_TEXT_BYTES]) {
    char quote[EWA_QUOTE_BYTES];
    const char *end = text.chars + text.length, *at = text.chars;
    while (at < end && *at != '=' && *at != '!' && *at != '<' && *at != '>') at++;
    const ewa_text name = trimmed(text.chars, at);
    if (!name.length || name.length >= EWA_NAME_BYTES)
        return ewa_text_wrong(problem, "%s: the name of an attribute is missing or too long", ewa_quote(text, quote));
    *term = (ewa_filter_term){.range_count = 0};
    memcpy(term->name, name.chars, name.length);
    const char sign = at < end ? *at++ : 0;
    const bool equal = at < end && *at == '=';
    at += equal;
    if (!sign || (sign == '!' && !equal))
        return ewa_text_wrong(problem, "%s: a comparison (= != < <= > >=) is missing", ewa_quote(text, quote));
    const ewa_text value = trimmed(at, end);
    term->outside = sign == '!';
    return sign == '<' || sign == '>' ? set_bound(term, sign == '<', !equal, value, problem)
                                      : add_values(term, value, problem);
}

/// Returns the begin of the next "and" between blanks, `end` when there is none.
static const char *find_and(const char *at, const char *end) {
    for (at++; at + 4 < end; at++)
        if (ewa_is_blank(at[-1]) && ewa_text_is_any_case((ewa_text){at, 3}, "and") && ewa_is_blank(at[3]))
            return at;
    return end;
}

ewa_status ewa_filter_add(ewa_filter *filter, const char *text, char problem[EWA_OPTION_TEXT_BYTES]) {
    if (!filter || !text) return EWA_ERROR_ARGUMENT;
    const uint32_t count = filter->term_count;
    const char *end = text + strlen(text);
    ewa_status status = EWA_OK;
    for (const char *at = text, *stop; status == EWA_OK; at = stop + 3) {
        stop = at < end ? find_and(at, end) : end;
        if (filter->term_count == EWA_FILTER_TERMS) {
            status = ewa_text_wrong(problem, "there are more than %d conditions", EWA_FILTER_TERMS);
            break;
        }
        status = read_term(trimmed(at, stop), &filter->terms[filter->term_count], problem);
        filter->term_count += status == EWA_OK;
        if (stop == end) break;
    }
    if (status != EWA_OK) filter->term_count = count;
    return status;
}

/// Writes a number, or nothing where a range has no end.
static size_t write_end(double number, char text[EWA_NUMBER_BYTES]) {
    return isfinite(number) ? ewa_number_write_f64(number, text) : 0;
}

static void write_range(const ewa_filter_range *range, char text[2 * EWA_NUMBER_BYTES + 3]) {
    char low[EWA_NUMBER_BYTES], high[EWA_NUMBER_BYTES];
    const int low_bytes = (int)write_end(range->low, low), high_bytes = (int)write_end(range->high, high);
    if (range->low == range->high)
        snprintf(text, 2 * EWA_NUMBER_BYTES + 3, "%.*s", low_bytes, low);
    else
        snprintf(text, 2 * EWA_NUMBER_BYTES + 3, "%.*s..%.*s", low_bytes, low, high_bytes, high);
}

bool ewa_filter_write(const ewa_filter *filter, char *text, size_t size_bytes) {
    if (!filter || (!text && size_bytes)) return false;
    size_t used = 0;
    if (size_bytes) *text = 0;
    for (uint32_t t = 0; t < filter->term_count; t++) {
        const ewa_filter_term *term = &filter->terms[t];
        const ewa_filter_range *first = term->ranges;
        char range[2 * EWA_NUMBER_BYTES + 3];
        // Only a single bound can be open.
        const char *sign = first->low_open ? ">" : first->high_open ? "<" : term->outside ? "!=" : "=";
        for (uint32_t r = 0; r < term->range_count; r++) {
            write_range(&term->ranges[r], range);
            if (*sign == '<') memmove(range, range + 2, strlen(range) - 1);
            if (*sign == '>') range[strlen(range) - 2] = 0;
            const int length = snprintf(text + used, size_bytes - used, "%s%s%s%s",
                                        t && !r ? " and "
                                        : r     ? ","
                                                : "",
                                        r ? "" : term->name, r ? "" : sign, range);
            if (length < 0 || (size_t)length >= size_bytes - used) return false;
            used += (size_t)length;
        }
    }
    return true;
}
