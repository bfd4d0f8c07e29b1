// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Structs of options by their tables: defaults, sizes, ranges.
#include "base/options.h"
#include "base/base.h"
#include "base/format.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// What is larger is no struct of options, but memory that nobody has set.
enum { MAX_BYTES = 1 << 16, NUMBER_BYTES = 32 };

static uint32_t count_of(const ewa_option *option) { return option->count ? option->count : 1; }

static size_t bytes_of(const ewa_option *option) {
    static const size_t bytes[] = {sizeof(bool),     sizeof(int),   sizeof(uint32_t),
                                   sizeof(uint64_t), sizeof(float), sizeof(double)};
    return bytes[option->type];
}

double ewa_option_number(const ewa_option *option, const void *options, uint32_t index) {
    const void *at = (const char *)options + option->offset + index * bytes_of(option);
    switch (option->type) {
    case EWA_OPTION_BOOL:
        return *(const bool *)at;
    case EWA_OPTION_CHOICE:
        return *(const int *)at;
    case EWA_OPTION_U32:
        return *(const uint32_t *)at;
    case EWA_OPTION_U64:
        return (double)*(const uint64_t *)at;
    case EWA_OPTION_F32:
        return (double)*(const float *)at;
    case EWA_OPTION_F64:
        break;
    }
    return *(const double *)at;
}

void ewa_option_put(const ewa_option *option, void *options, uint32_t index, double value) {
    void *at = (char *)options + option->offset + index * bytes_of(option);
    switch (option->type) {
    case EWA_OPTION_BOOL:
        *(bool *)at = value != 0;
        break;
    case EWA_OPTION_CHOICE:
        *(int *)at = (int)value;
        break;
    case EWA_OPTION_U32:
        *(uint32_t *)at = (uint32_t)value;
        break;
    case EWA_OPTION_U64:
        *(uint64_t *)at = (uint64_t)value;
        break;
    case EWA_OPTION_F32:
        *(float *)at = (float)value;
        break;
    case EWA_OPTION_F64:
        *(double *)at = value;
        break;
    }
}

bool ewa_option_word(const ewa_option *option, uint32_t index, double *value, const char **word,
                     size_t *length) {
    *word = option->type == EWA_OPTION_BOOL ? "off|on" : option->words;
    for (uint32_t i = 0; *word && i < index; i++) {
        *word = strchr(*word, '|');
        if (*word) ++*word;
    }
    if (!*word) return false;
    *length = strcspn(*word, "|");
    *value = option->type <= EWA_OPTION_CHOICE ? index : (double)strtoul(*word, NULL, 10);
    return true;
}

bool ewa_option_allows(const ewa_option *option, double value) {
    const char *word;
    size_t length;
    double number;
    for (uint32_t i = 0; ewa_option_word(option, i, &number, &word, &length); i++)
        if (value == number) return true;
    if (option->words || option->type == EWA_OPTION_BOOL) return false;
    if (value == 0 && option->limits & EWA_OPTION_OR_ZERO) return true;
    return (option->limits & EWA_OPTION_ABOVE ? value > option->minimum : value >= option->minimum) &&
           (option->limits & EWA_OPTION_BELOW ? value < option->maximum : value <= option->maximum);
}

/// Writes a number with 10 digits at most, "1e6" for a million times a million.
static void format_number(double value, char text[NUMBER_BYTES]) {
    ewa_format(text, NUMBER_BYTES, "%.10g", value);
    char *exponent = strpbrk(text, "e");
    if (!exponent) return;
    exponent += exponent[1] == '-' ? 2 : 1;
    const size_t skipped = strspn(exponent, "+0");
    memmove(exponent, exponent + skipped, strlen(exponent + skipped) + 1);
}

void ewa_option_range(const ewa_option *option, char text[EWA_OPTION_TEXT_BYTES]) {
    char low[NUMBER_BYTES], high[NUMBER_BYTES];
    format_number(option->minimum, low);
    format_number(option->maximum, high);
    if (option->type == EWA_OPTION_BOOL || option->words)
        snprintf(text, EWA_OPTION_TEXT_BYTES, "%s", option->words ? option->words : "on|off");
    else
        snprintf(text, EWA_OPTION_TEXT_BYTES, "%s%c%s, %s%c",
                 option->limits & EWA_OPTION_OR_ZERO ? "0 or " : "",
                 option->limits & EWA_OPTION_ABOVE ? '(' : '[', low, high,
                 option->limits & EWA_OPTION_BELOW ? ')' : ']');
}

const ewa_option *ewa_option_find(const ewa_option_table *table, const char *name) {
    for (size_t i = 0; table && name && i < table->option_count; i++)
        if (strcmp(table->options[i].name, name) == 0) return &table->options[i];
    return NULL;
}

void ewa_options_init(const ewa_option_table *table, void *options, size_t struct_size) {
    if (!options || struct_size < sizeof struct_size) return;
    memset(options, 0, struct_size);
    if (table->options[0].offset) memcpy(options, &struct_size, sizeof struct_size);
    for (size_t i = 0; i < table->option_count; i++) {
        const ewa_option *option = &table->options[i];
        if (option->offset + count_of(option) * bytes_of(option) > struct_size) continue;
        for (uint32_t k = 0; k < count_of(option); k++)
            ewa_option_put(option, options, k, option->initials ? option->initials[k] : option->initial);
    }
}

ewa_status ewa_options_check(ewa_context *context, const ewa_option_table *table, const char *what,
                             const void *options) {
    for (size_t i = 0; i < table->option_count; i++) {
        const ewa_option *option = &table->options[i];
        for (uint32_t k = 0; k < count_of(option); k++) {
            const double value = ewa_option_number(option, options, k);
            if (ewa_option_allows(option, value)) continue;
            char range[EWA_OPTION_TEXT_BYTES], index[NUMBER_BYTES] = "";
            ewa_option_range(option, range);
            if (option->count) snprintf(index, sizeof index, "[%u]", k);
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: %s%s is %.10g, allowed is %s", what,
                            option->name, index, value, range);
        }
    }
    return EWA_OK;
}

/// Whether a struct of so many bytes ends between members, as that of another header may.
static bool is_whole(const ewa_option_table *table, size_t struct_size) {
    bool whole = struct_size % sizeof struct_size == 0 && struct_size <= MAX_BYTES && table->option_count &&
                 struct_size > table->options[0].offset;
    for (size_t i = 0; i < table->option_count; i++) {
        const ewa_option *option = &table->options[i];
        const size_t end = option->offset + count_of(option) * bytes_of(option);
        whole = whole && (struct_size <= option->offset || struct_size >= end);
    }
    return whole;
}

ewa_status ewa_options_take(ewa_context *context, const ewa_option_table *table, const void *given,
                            void *chosen) {
    if (!given) return EWA_OK;
    size_t struct_size;
    memcpy(&struct_size, given, sizeof struct_size);
    if (!is_whole(table, struct_size))
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: struct_size is %zu, not %zu (not initialised?)",
                        table->name, struct_size, table->struct_size);
    for (size_t i = table->struct_size; i < struct_size; i++)
        if (((const char *)given)[i])
            return ewa_fail(
                context, EWA_ERROR_UNSUPPORTED,
                "%s: a member at byte %zu is set that this library, whose struct has %zu bytes, does "
                "not know",
                table->name, i, table->struct_size);
    memcpy(chosen, given, struct_size < table->struct_size ? struct_size : table->struct_size);
    memcpy(chosen, &table->struct_size, sizeof table->struct_size);
    return ewa_options_check(context, table, table->name, chosen);
}
