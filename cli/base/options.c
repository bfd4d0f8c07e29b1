// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Options: finding them in the tables, reading and checking their values.
#include "cli/base/options.h"
#include "cli/base/bytes.h"

#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "ewa/image.h"

enum { MAX_WORD = 64, MAX_SIDE_PX = 65536 };

static const cli_option common_table[] = {
    {"threads", OPTION_INTEGER, offsetof(common_arguments, threads), "N", "[0, 256]",
     .help = "worker threads; 0: one per processor. The result does not depend on it"},
    {"max-memory", OPTION_OF(ewa_limits, offsetof(common_arguments, limits), max_memory_bytes),
     .help = "memory that may be held at a time, with what decoders take: 512M, 8G; 0: three quarters of the machine's"},
    {"max-seconds", OPTION_OF(ewa_limits, offsetof(common_arguments, limits), max_seconds),
     .help = "give up after this time; 0: never"},
    {"named-files", OPTION_CHOICE, offsetof(common_arguments, named_files), "WHERE", "below|anywhere|none",
     .help = "open files that a file or folder names where they are below its own folder, anywhere, or not at all"},
    {"untrusted", OPTION_FLAG, offsetof(common_arguments, untrusted),
     .help = "for files from anyone: 1 GiB and other small limits, no file that another names, no helper programs"},
    {"progress", OPTION_TOGGLE, offsetof(common_arguments, progress),
     .help = "draw a progress bar on standard error, or do not", .absent = "on a terminal"},
    {"quiet", OPTION_FLAG, offsetof(common_arguments, quiet), .help = "print errors only", .letter = 'q',
     .excludes = "verbose"},
    {"verbose", OPTION_FLAG, offsetof(common_arguments, verbose),
     .help = "say what is done and how long it takes", .letter = 'v'},
    {"help", OPTION_FLAG, offsetof(common_arguments, help), .help = "print this help", .letter = 'h'},
};

const option_group common_options = OPTION_GROUP("Running", common_table);

__attribute__((format(printf, 2, 3))) static bool wrong(char message[OPTION_ERROR_BYTES], const char *format,
                                                        ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, OPTION_ERROR_BYTES, format, arguments);
    va_end(arguments);
    return false;
}

bool options_fine(const char *problem, char message[OPTION_ERROR_BYTES]) {
    return !problem || wrong(message, "%s", problem);
}

/// Reads a finite number that ends at `*end`.
static bool read_number(const char *text, double *number, const char **end) {
    if (isspace((unsigned char)text[0])) return false;
    char *stop;
    *number = strtod(text, &stop);
    *end = stop;
    return stop != text && isfinite(*number);
}

/// Whether a number lies in an interval of the table, such as "(0, 4]" or "[0, inf)".
static bool in_range(double number, const char *range) {
    char *middle;
    const double low = strtod(range + 1, &middle);
    char *close;
    const double high = strtod(middle + 1, &close);
    const bool above = range[0] == '(' ? number > low : number >= low;
    return above && (*close == ')' ? number < high : number <= high);
}

static bool parse_number(const cli_option *option, const char *text, double *number,
                         char message[OPTION_ERROR_BYTES]) {
    const char *end;
    double read;
    if (!read_number(text, &read, &end) || *end)
        return wrong(message, "--%s: '%.80s' is not a number", option->key, text);
    if (option->range && !in_range(read, option->range))
        return wrong(message, "--%s: %g is outside %s", option->key, read, option->range);
    *number = read;
    return true;
}

static bool parse_integer(const cli_option *option, const char *text, int64_t *number,
                          char message[OPTION_ERROR_BYTES]) {
    enum { EXACT_BITS = 53 }; // of whole numbers in double precision
    char *end;
    errno = 0;
    long long read = strtoll(text, &end, 10);
    bool whole = end != text && !*end && !isspace((unsigned char)text[0]) && errno != ERANGE;
    double power;
    const char *stop;
    // 1e7 is one, too.
    if (!whole && !text[strspn(text, "+-.0123456789eE")] && read_number(text, &power, &stop) && !*stop &&
        fabs(power) <= (double)(1LL << EXACT_BITS) && power == floor(power)) {
        read = (long long)power;
        whole = strpbrk(text, "eE");
    }
    if (!whole)
        return wrong(message, "--%s: '%.80s' is not a whole number", option->key, text);
    if (option->range && !in_range((double)read, option->range))
        return wrong(message, "--%s: %lld is outside %s", option->key, read, option->range);
    *number = read;
    return true;
}

/// Reads the direction of an axis.
static bool read_axis(const char *text, option_vector *vector) {
    static const char names[] = "xyzXYZ";
    const char *letter = *text == '+' || *text == '-' ? text + 1 : text;
    const char *name = *letter ? strchr(names, *letter) : NULL;
    if (!name || letter[1]) return false;
    *vector = (option_vector){.count = 3};
    vector->values[(name - names) % 3] = *text == '-' ? -1 : 1;
    return true;
}

static bool parse_vector(const cli_option *option, const char *text, option_vector *vector,
                         char message[OPTION_ERROR_BYTES]) {
    if (option->axes && read_axis(text, vector)) return true;
    option_vector read = {.count = 0};
    for (const char *next = text;; next++) {
        double number;
        if (read.count == option->high || !read_number(next, &number, &next) || (*next && *next != ',')) {
            read.count = 0;
            break;
        }
        if (option->range && !in_range(number, option->range))
            return wrong(message, "--%s: %g is outside %s", option->key, number, option->range);
        read.values[read.count++] = number;
        if (!*next) break;
    }
    if (read.count < option->low || read.count == 0)
        return wrong(message, "--%s: '%.80s' is %s%s%s", option->key, text, option->axes ? "neither " : "not ",
                     option->axes ? "three numbers x,y,z " : option->value, option->axes ? "nor an axis, x, y or z, -y" : "");
    *vector = read;
    return true;
}

static bool parse_one_more(const cli_option *option, const char *text, option_vectors *vectors,
                           char message[OPTION_ERROR_BYTES]) {
    if (vectors->count == OPTION_VECTORS_MAX)
        return wrong(message, "--%s: given more than %d times", option->key, OPTION_VECTORS_MAX);
    if (!parse_vector(option, text, &vectors->each[vectors->count], message)) return false;
    vectors->count++;
    return true;
}

static bool parse_bounds(const cli_option *option, const char *text, option_bounds *bounds,
                         char message[OPTION_ERROR_BYTES]) {
    option_bounds read = {.given = true};
    const char *next = text;
    bool good = true;
    for (int i = 0; i < 2 && good; i++) {
        good = read_number(next, &read.values[i], &next);
        read.percent[i] = good && *next == '%';
        next += read.percent[i];
        good = good && *next == (i == 0 ? ',' : 0);
        next += good;
        if (good && read.percent[i] && !in_range(read.values[i], "[0, 100]"))
            return wrong(message, "--%s: %g%% is outside [0, 100]", option->key, read.values[i]);
    }
    if (!good) return wrong(message, "--%s: '%.80s' is not %s", option->key, text, option->value);
    *bounds = read;
    return true;
}

static bool parse_color(const cli_option *option, const char *text, option_color *color,
                        char message[OPTION_ERROR_BYTES]) {
    return ewa_color_read(text, color->rgba) ||
           wrong(message, "--%s: '%s' is not r,g,b[,a] in [0, 1], #rrggbb, white, black, gray or transparent",
                 option->key, text);
}

void option_color_linear(const option_color *color, float linear[4]) {
    for (int c = 0; c < 3; c++) linear[c] = ewa_linear_from_srgb((float)color->rgba[c]);
    linear[3] = (float)color->rgba[3];
}

static bool parse_size(const cli_option *option, const char *text, option_size *size,
                       char message[OPTION_ERROR_BYTES]) {
    char *end = NULL;
    unsigned long long width = 0, height = 0;
    if (isdigit((unsigned char)text[0])) width = strtoull(text, &end, 10);
    if (end && (*end == 'x' || *end == ',') && isdigit((unsigned char)end[1]))
        height = strtoull(end + 1, &end, 10);
    if (!end || *end || height == 0 || width == 0)
        return wrong(message, "--%s: '%.80s' is not WxH", option->key, text);
    if (width > MAX_SIDE_PX || height > MAX_SIDE_PX)
        return wrong(message, "--%s: %s is over %dx%d pixels", option->key, text, MAX_SIDE_PX, MAX_SIDE_PX);
    *size = (option_size){(uint32_t)width, (uint32_t)height, true};
    return true;
}

/// Index of a word of `length` bytes in "first|second"; -1 when it is none of them.
static int find_choice(const char *choices, const char *text, size_t length) {
    int index = 0;
    for (const char *word = choices; word; index++) {
        const size_t word_length = strcspn(word, "|");
        if (word_length == length && memcmp(word, text, length) == 0) return index;
        word = word[word_length] ? word + word_length + 1 : NULL;
    }
    return -1;
}

static bool parse_choice(const cli_option *option, const char *text, const char *choices, int *choice,
                         char message[OPTION_ERROR_BYTES]) {
    const int index = find_choice(choices, text, strlen(text));
    if (index < 0) return wrong(message, "--%s: '%.80s' is not one of %s", option->key, text, choices);
    *choice = index;
    return true;
}

static bool parse_set(const cli_option *option, const char *text, uint32_t *set,
                      char message[OPTION_ERROR_BYTES]) {
    uint32_t read = 0;
    for (const char *word = text;;) {
        const size_t length = strcspn(word, ",");
        const int index = find_choice(option->range, word, length);
        if (index < 0)
            return wrong(message, "--%s: '%.*s' is not one of %s", option->key,
                         (int)(length < 80 ? length : 80), word, option->range);
        read |= 1u << index;
        if (!word[length]) break;
        word += length + 1;
    }
    *set = read;
    return true;
}

const ewa_option *options_library(const cli_option *option) {
    return ewa_option_find(option->table, option->member);
}

bool options_counts_bytes(const ewa_option *option) {
    return option->type == EWA_OPTION_U64 && option->unit && strcmp(option->unit, "bytes") == 0;
}

void options_write_range(const ewa_option *option, char range[EWA_OPTION_TEXT_BYTES]) {
    char low[BYTES_TEXT_BYTES], high[BYTES_TEXT_BYTES];
    ewa_option_range(option, range);
    if (!options_counts_bytes(option) || !isfinite(option->maximum)) return;
    bytes_write((uint64_t)option->minimum, low);
    bytes_write((uint64_t)option->maximum, high);
    snprintf(range, EWA_OPTION_TEXT_BYTES, "%s[%s, %s]", option->limits & EWA_OPTION_OR_ZERO ? "0 or " : "", low, high);
}

void options_name_value(const cli_option *option, char text[EWA_OPTION_TEXT_BYTES]) {
    const ewa_option *of = options_library(option);
    if (option->value || option->range)
        snprintf(text, EWA_OPTION_TEXT_BYTES, "%s", option->value ? option->value : option->range);
    else if (of && options_counts_bytes(of))
        snprintf(text, EWA_OPTION_TEXT_BYTES, "SIZE");
    else if (of && (of->words || of->type == EWA_OPTION_BOOL))
        ewa_option_range(of, text);
    else if (of)
        for (size_t i = 0; i <= strlen(of->unit ? of->unit : "N"); i++)
            text[i] = (char)toupper((unsigned char)(of->unit ? of->unit : "N")[i]);
    else
        snprintf(text, EWA_OPTION_TEXT_BYTES, "%s", option->kind == OPTION_ON_OFF ? "on|off" : "");
}

static bool parse_library(const cli_option *option, const char *text, void *member,
                          char message[OPTION_ERROR_BYTES]) {
    const ewa_option *of = options_library(option);
    char problem[EWA_OPTION_TEXT_BYTES], number[BYTES_TEXT_BYTES];
    uint64_t bytes;
    if (options_counts_bytes(of) && bytes_read(text, &bytes)) {
        char range[EWA_OPTION_TEXT_BYTES];
        options_write_range(of, range);
        const bool zero = bytes == 0 && of->limits & EWA_OPTION_OR_ZERO;
        if (!zero && !((double)bytes >= of->minimum && (double)bytes <= of->maximum))
            return wrong(message, "--%s: %.80s is outside %s", option->key, text, range);
        snprintf(number, sizeof number, "%" PRIu64, bytes);
        text = number;
    }
    if (ewa_option_set(of, (char *)member - of->offset, text, problem) == EWA_OK) return true;
    return wrong(message, "--%s: %s", option->key, problem);
}

static bool parse_filter(const cli_option *option, const char *text, ewa_filter *filter,
                         char message[OPTION_ERROR_BYTES]) {
    char problem[EWA_OPTION_TEXT_BYTES];
    return ewa_filter_add(filter, text, problem) == EWA_OK ||
           wrong(message, "--%s: %s", option->key, problem);
}

static bool parse_frames(const cli_option *option, const char *text, film_part *part,
                         char message[OPTION_ERROR_BYTES]) {
    char problem[PART_ERROR_BYTES];
    return part_add(part, text, problem) || wrong(message, "--%s: %s", option->key, problem);
}

/// Whether a value is the word that stands for a default that is worked out.
static bool is_default_word(const cli_option *option, const char *value) {
    static const char *const words[] = {"auto", "none", "all"};
    bool is = false;
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) is = is || strcmp(value, words[i]) == 0;
    const size_t length = strlen(value);
    return is && option->absent && strncmp(option->absent, value, length) == 0 &&
           (!option->absent[length] || option->absent[length] == ':');
}

/// Gives a member its default again, as if the option had not been written before.
static bool restore_default(const cli_command *command, const cli_option *option, char *arguments,
                            char message[OPTION_ERROR_BYTES]) {
    static const size_t bytes_by_kind[] = {
        [OPTION_FLAG] = sizeof(bool),
        [OPTION_TOGGLE] = sizeof(int),
        [OPTION_ON_OFF] = sizeof(bool),
        [OPTION_NUMBER] = sizeof(double),
        [OPTION_INTEGER] = sizeof(int64_t),
        [OPTION_TEXT] = sizeof(char *),
        [OPTION_OUTPUT] = sizeof(char *),
        [OPTION_OUTPUTS] = sizeof(char *),
        [OPTION_CHOICE] = sizeof(int),
        [OPTION_VECTOR] = sizeof(option_vector),
        [OPTION_VECTORS] = sizeof(option_vectors),
        [OPTION_BOUNDS] = sizeof(option_bounds),
        [OPTION_COLOR] = sizeof(option_color),
        [OPTION_SIZE] = sizeof(option_size),
        [OPTION_FRAMES] = sizeof(film_part),
        [OPTION_FILTER] = sizeof(ewa_filter),
        [OPTION_SET] = sizeof(uint32_t),
        [OPTION_LIBRARY] = sizeof(double), // the only type of those whose default is worked out
    };
    char *defaults = malloc(command->arguments_bytes);
    if (!defaults) return wrong(message, "out of memory for the options of %s", command->name);
    options_default(command, defaults);
    memcpy(arguments + option->offset, defaults + option->offset, bytes_by_kind[option->kind]);
    free(defaults);
    return true;
}

static bool parse_value(const cli_option *option, const char *text, void *member,
                        char message[OPTION_ERROR_BYTES]) {
    int choice = 0;
    switch (option->kind) {
    case OPTION_NUMBER:
        return parse_number(option, text, member, message);
    case OPTION_INTEGER:
        return parse_integer(option, text, member, message);
    case OPTION_VECTOR:
        return parse_vector(option, text, member, message);
    case OPTION_VECTORS:
        return parse_one_more(option, text, member, message);
    case OPTION_BOUNDS:
        return parse_bounds(option, text, member, message);
    case OPTION_COLOR:
        return parse_color(option, text, member, message);
    case OPTION_SIZE:
        return parse_size(option, text, member, message);
    case OPTION_CHOICE:
        return parse_choice(option, text, option->range, member, message);
    case OPTION_SET:
        return parse_set(option, text, member, message);
    case OPTION_FRAMES:
        return parse_frames(option, text, member, message);
    case OPTION_FILTER:
        return parse_filter(option, text, member, message);
    case OPTION_LIBRARY:
        return parse_library(option, text, member, message);
    case OPTION_ON_OFF:
        if (!parse_choice(option, text, "off|on", &choice, message)) return false;
        *(bool *)member = choice == 1;
        return true;
    case OPTION_TEXT:
    case OPTION_OUTPUT:
    case OPTION_OUTPUTS:
        if (!*text) return wrong(message, "--%s: the value is empty", option->key);
        *(const char **)member = text;
        return true;
    case OPTION_FLAG:
    case OPTION_TOGGLE:
        break;
    }
    return wrong(message, "--%s: takes no value", option->key);
}

static bool name_is(const char *names, const char *word, size_t length) {
    while (names && *names) {
        const size_t name_length = strcspn(names, " ");
        if (name_length == length && memcmp(names, word, length) == 0) return true;
        names += name_length;
        names += strspn(names, " ");
    }
    return false;
}

const cli_option *options_at(const cli_command *command, size_t index) {
    const option_group *const *group = command->groups;
    for (; *group && index >= (*group)->count; group++) index -= (*group)->count;
    if (*group) return &(*group)->options[index];
    return index < common_options.count ? &common_options.options[index] : NULL;
}

/// Index of the option whose long name has `length` bytes; `*negated` is set for the --no- form of a toggle.
/// OPTION_COUNT_MAX: none.
static size_t find_long(const cli_command *command, const char *name, size_t length, bool *negated) {
    const cli_option *option;
    for (size_t i = 0; (option = options_at(command, i)); i++) {
        *negated = false;
        if (name_is(option->key, name, length) || name_is(option->aliases, name, length)) return i;
        *negated = true;
        if (option->kind == OPTION_TOGGLE && length > 3 && memcmp(name, "no-", 3) == 0 &&
            name_is(option->key, name + 3, length - 3))
            return i;
    }
    return OPTION_COUNT_MAX;
}

static size_t find_letter(const cli_command *command, char letter) {
    const cli_option *option;
    for (size_t i = 0; (option = options_at(command, i)); i++)
        if (option->letter == letter) return i;
    return OPTION_COUNT_MAX;
}

/// Edits between two words: insertions, deletions, exchanges, swaps of neighbours, each 1 (Damerau 1964, by
/// the recurrence of optimal string alignment).
static size_t edit_distance(const char *a, const char *b) {
    size_t rows[3][MAX_WORD + 1];
    const size_t a_length = strlen(a), b_length = strlen(b);
    if (a_length > MAX_WORD || b_length > MAX_WORD) return MAX_WORD;
    for (size_t j = 0; j <= b_length; j++) rows[0][j] = j;
    for (size_t i = 1; i <= a_length; i++) {
        size_t *row = rows[i % 3], *above = rows[(i + 2) % 3], *two_above = rows[(i + 1) % 3];
        row[0] = i;
        for (size_t j = 1; j <= b_length; j++) {
            size_t best = above[j - 1] + (a[i - 1] != b[j - 1]);
            if (above[j] + 1 < best) best = above[j] + 1;
            if (row[j - 1] + 1 < best) best = row[j - 1] + 1;
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped && two_above[j - 2] + 1 < best) best = two_above[j - 2] + 1;
            row[j] = best;
        }
    }
    return rows[a_length % 3][b_length];
}

const char *options_nearest(const char *word, size_t count, const char *const *names) {
    const char *nearest = NULL;
    size_t minimum = strlen(word) / 3 + 2;
    for (size_t i = 0; i < count; i++) {
        const size_t distance = edit_distance(word, names[i]);
        if (distance < minimum) {
            minimum = distance;
            nearest = names[i];
        }
    }
    return nearest;
}

static bool unknown_option(const cli_command *command, const char *name, size_t length,
                           char message[OPTION_ERROR_BYTES]) {
    char word[MAX_WORD + 1];
    snprintf(word, sizeof word, "%.*s", (int)(length < MAX_WORD ? length : MAX_WORD), name);
    const char *keys[OPTION_COUNT_MAX];
    size_t key_count = 0;
    const cli_option *option;
    while (key_count < OPTION_COUNT_MAX && (option = options_at(command, key_count)))
        keys[key_count++] = option->key;
    const char *nearest = options_nearest(word, key_count, keys);
    if (nearest) return wrong(message, "--%s: no such option; did you mean --%s?", word, nearest);
    return wrong(message, "--%s: no such option; see 'ewa %s --help'", word, command->name);
}

/// Takes one option at `words[*index]`, which is noted in `given`; moves the index over a value that is a
/// word of its own.
static bool take_option(const cli_command *command, size_t count, const char *const *words, size_t *index,
                        char *arguments, bool given[OPTION_COUNT_MAX], char message[OPTION_ERROR_BYTES]) {
    const char *word = words[*index], *value = NULL;
    size_t found;
    bool negated = false;
    if (word[1] == '-') {
        const char *equals = strchr(word, '=');
        const size_t length = equals ? (size_t)(equals - word) - 2 : strlen(word + 2);
        found = find_long(command, word + 2, length, &negated);
        if (found == OPTION_COUNT_MAX) return unknown_option(command, word + 2, length, message);
        if (equals) value = equals + 1;
    } else {
        found = find_letter(command, word[1]);
        if (found == OPTION_COUNT_MAX)
            return wrong(message, "%.80s: no such option; see 'ewa %s --help'", word, command->name);
        if (word[2]) value = word + 2;
    }
    const cli_option *option = options_at(command, found);
    given[found] = true;
    void *member = arguments + option->offset;
    if (option->kind == OPTION_FLAG || option->kind == OPTION_TOGGLE) {
        if (value) return wrong(message, "--%s: takes no value", option->key);
        if (option->kind == OPTION_FLAG)
            *(bool *)member = true;
        else
            *(int *)member = negated ? 0 : 1;
        return true;
    }
    if (!value) {
        if (*index + 1 == count) {
            char name[EWA_OPTION_TEXT_BYTES];
            options_name_value(option, name);
            return wrong(message, "--%s: its value (%s) is missing", option->key, name);
        }
        value = words[++*index];
    }
    given[found] = !is_default_word(option, value);
    if (!given[found]) return restore_default(command, option, arguments, message);
    return parse_value(option, value, member, message);
}

/// Writes the next of the keys in `*keys` and moves on; false at their end.
static bool next_key(const char **keys, char key[MAX_WORD + 1]) {
    if (!*keys || !**keys) return false;
    const size_t length = strcspn(*keys, " ");
    snprintf(key, MAX_WORD + 1, "%.*s", (int)length, *keys);
    *keys += length;
    *keys += strspn(*keys, " ");
    return true;
}

/// Whether the option of a key was given; one that the command does not have was not.
static bool key_given(const cli_command *command, const bool given[OPTION_COUNT_MAX], const char *key) {
    const cli_option *option;
    for (size_t i = 0; (option = options_at(command, i)); i++)
        if (given[i] && strcmp(option->key, key) == 0) return true;
    return false;
}

/// Checks what the tables say of options beside each other.
static bool check_together(const cli_command *command, const bool given[OPTION_COUNT_MAX],
                           char message[OPTION_ERROR_BYTES]) {
    const cli_option *option;
    for (size_t i = 0; (option = options_at(command, i)); i++) {
        if (!given[i]) continue;
        char key[MAX_WORD + 1], all[OPTION_ERROR_BYTES / 2] = "";
        for (const char *keys = option->excludes; next_key(&keys, key);)
            if (key_given(command, given, key))
                return wrong(message, "--%s and --%s exclude each other", option->key, key);
        bool satisfied = !option->needs;
        for (const char *keys = option->needs; next_key(&keys, key);) {
            satisfied = satisfied || key_given(command, given, key);
            const size_t used = strlen(all);
            snprintf(all + used, sizeof all - used, "%s--%s", used ? " or " : "", key);
        }
        if (!satisfied) return wrong(message, "--%s needs %s", option->key, all);
    }
    return true;
}

void options_default(const cli_command *command, void *arguments) {
    memset(arguments, 0, command->arguments_bytes);
    ((common_arguments *)arguments)->progress = -1;
    if (command->set_defaults) command->set_defaults(arguments);
}

bool options_parse(const cli_command *command, size_t count, const char *const *words, const char **operands,
                   void *arguments, char message[OPTION_ERROR_BYTES]) {
    common_arguments *common = arguments;
    common->operands = operands;
    common->words = words;
    common->word_count = count;
    bool only_operands = false, given[OPTION_COUNT_MAX] = {false};
    for (size_t i = 0; i < count; i++) {
        const char *word = words[i];
        if (only_operands || word[0] != '-' || !word[1]) {
            operands[common->operand_count++] = word;
        } else if (strcmp(word, "--") == 0) {
            only_operands = true;
        } else if (!take_option(command, count, words, &i, arguments, given, message)) {
            return false;
        }
        if (common->help) return true;
    }
    for (size_t i = 0; i < common->operand_count; i++)
        if (!operands[i][0]) return wrong(message, "%s: a file name is empty", command->name);
    if (common->operand_count < command->low_operands)
        return wrong(message, "%s: an input is missing; usage: ewa %s %s", command->name, command->name,
                     command->operands);
    if (common->operand_count > command->high_operands)
        return wrong(message, "%s: '%.80s' is one operand too many; usage: ewa %s %s", command->name,
                     operands[command->high_operands], command->name, command->operands);
    return check_together(command, given, message) && (!command->check || command->check(arguments, message));
}
