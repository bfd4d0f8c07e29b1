// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One table per command describes its options; parsing, checking, --help and docs/cli.md are made from it.
#ifndef EWA_CLI_BASE_OPTIONS_H
#define EWA_CLI_BASE_OPTIONS_H

#include <stdio.h>

#include "cli/base/part.h"
#include "cli/base/process_group.h"
#include "ewa/options.h"
#include "ewa/select.h"

/// What ewa_color_read() reads.
#define OPTION_COLOR_HELP "sRGB numbers in [0, 1], #rrggbb, white, black, gray or transparent"

/// What the value of an option is, and the type of the member that it fills.
typedef enum option_kind {
    OPTION_FLAG,    ///< bool: given or not, no value
    OPTION_TOGGLE,  ///< int: --key 1, --no-key 0; no value
    OPTION_ON_OFF,  ///< bool: on or off
    OPTION_NUMBER,  ///< double, finite
    OPTION_INTEGER, ///< int64_t
    OPTION_TEXT,    ///< const char *, not empty
    OPTION_OUTPUT,  ///< const char *: a file that the command writes, or - for standard output
    OPTION_OUTPUTS, ///< const char *: several as NAME=FILE,...
    OPTION_CHOICE,  ///< int: index of the word in `range`
    OPTION_VECTOR,  ///< option_vector: finite numbers separated by commas
    OPTION_VECTORS, ///< option_vectors: the same, several times
    OPTION_BOUNDS,  ///< option_bounds: two numbers, each a percentile when a percent sign follows
    OPTION_COLOR,   ///< option_color
    OPTION_SIZE,    ///< option_size
    OPTION_FRAMES,  ///< film_part: N, A-B or I/N; a number and a part may both be given
    OPTION_FILTER,  ///< ewa_filter: conditions, given once or more often
    OPTION_SET,     ///< uint32_t: bits of words in `range`, separated by commas
    OPTION_LIBRARY, ///< a member of a struct of the library's options, as its table says: see OPTION_OF
} option_kind;

enum { OPTION_VECTOR_MAX = 16, OPTION_VECTORS_MAX = 8, OPTION_COUNT_MAX = 128 };

/// Numbers of a vector; count 0: not given.
typedef struct option_vector {
    double values[OPTION_VECTOR_MAX];
    uint32_t count;
} option_vector;

/// The vectors of an option in the order in which they were given.
typedef struct option_vectors {
    option_vector each[OPTION_VECTORS_MAX];
    uint32_t count;
} option_vectors;

/// Two ends of a range.
typedef struct option_bounds {
    double values[2];
    bool percent[2]; ///< the value is a percentile, in [0, 100]
    bool given;
} option_bounds;

/// sRGB and straight alpha, each in [0, 1].
typedef struct option_color {
    double rgba[4];
} option_color;

/// Writes the colour as linear light with straight alpha, as backgrounds are.
void option_color_linear(const option_color *color, float linear[4]);

typedef struct option_size {
    uint32_t width_px, height_px;
    bool given; ///< false: the default
} option_size;

/// One option. Zero and NULL members mean "none".
typedef struct cli_option {
    const char *key; ///< long name without its dashes
    option_kind kind;
    size_t offset;        ///< of the member in the arguments of the command
    const char *value;    ///< what help calls the value
    const char *range;    ///< numbers: an interval such as "(0, 4]"; choices, sets: "first|second"
    const char *help;     ///< OPTION_LIBRARY: in place of the table's
    char letter;          ///< short name
    const char *aliases;  ///< further long names, separated by blanks
    uint32_t low, high;   ///< vectors: fewest and most numbers
    bool axes;            ///< vectors of three: also an axis by its name, z, +Z, -y
    /// Help's words for a default that is worked out, "auto: from --fov"; NULL: the member's value is shown. One that
    /// begins with auto, none or all can be written out as that word, which is as if the option was not given.
    const char *absent;
    const char *excludes; ///< keys, separated by blanks, of options that may not be given beside this one
    const char *needs;    ///< keys, separated by blanks: one of these options has to be given too
    const ewa_option_table *table; ///< OPTION_LIBRARY: the struct's
    const char *member;            ///< OPTION_LIBRARY: of the struct
} cli_option;

/// Kind and place of an option that is `name` of a struct of the library's, which the arguments hold at
/// `offset`: type, range, default and help are those of the library's table.
#define OPTION_OF(type, offset, name)                                                                        \
    OPTION_LIBRARY, (offset) + offsetof(type, name), .table = &type##_table, .member = #name

/// Options under one heading.
typedef struct option_group {
    const char *title;
    const cli_option *options;
    size_t count;
} option_group;

#define OPTION_GROUP(title, table)                                                                           \
    { title, table, sizeof(table) / sizeof(table)[0] }

/// What every command's arguments begin with.
typedef struct common_arguments {
    const char *const *operands; ///< the words that are no options
    size_t operand_count;
    const char *const *words; ///< all, as they were given
    size_t word_count;
    const cli_process_group *group; ///< NULL: this process alone
    int64_t threads;
    ewa_limits limits; ///< zeros: the library's defaults
    int named_files;   ///< ewa_named_files
    bool untrusted;
    bool quiet, verbose, help;
    int progress;        ///< 1 or 0 when asked for, -1: where standard error is a terminal
    bool keep_going;     ///< of cloud_input_options
    const char *columns; ///< of cloud_input_options; NULL: as the file says
    int heights;         ///< of cloud_input_options: ewa_picture_heights
    ewa_filter filter;   ///< of cloud_input_options
} common_arguments;

/// The options of common_arguments, for the last group of each command.
extern const option_group common_options;

enum { OPTION_ERROR_BYTES = 512 };

/// A command of the program.
typedef struct cli_command {
    const char *name;
    const char *operands; ///< as in the usage line: "IN... -o OUT"
    const char *summary;  ///< one line, no full stop
    const char *details;  ///< further paragraphs of the help
    const char *examples; ///< lines to type
    size_t low_operands, high_operands;
    const option_group *const *groups; ///< without common_options; NULL after the last
    size_t arguments_bytes;            ///< of the struct that begins with common_arguments
    /// Sets what is not zero by default.
    void (*set_defaults)(void *arguments);
    /// Says in `message` what is wrong with the options together; NULL when nothing can be. Returns false
    /// then.
    bool (*check)(const void *arguments, char message[OPTION_ERROR_BYTES]);
    /// Does the work; returns the exit status.
    int (*run)(const void *arguments);
} cli_command;

/// Sets every argument of a command to its default.
void options_default(const cli_command *command, void *arguments);

/// Parses the words after the command's name into `arguments`, which holds the defaults. `operands` has room
/// for `count` words. Returns false with what is wrong, without the program's name, in `message`. A --help
/// anywhere stops the parsing and succeeds.
bool options_parse(const cli_command *command, size_t count, const char *const *words, const char **operands,
                   void *arguments, char message[OPTION_ERROR_BYTES]);

/// Writes a problem to `message`, unless it is NULL; returns whether there is none.
bool options_fine(const char *problem, char message[OPTION_ERROR_BYTES]);

/// Option `index` of a command, counted through its groups and the common one; NULL after the last.
const cli_option *options_at(const cli_command *command, size_t index);

/// The library's option behind an option of kind OPTION_LIBRARY; NULL for another kind.
const ewa_option *options_library(const cli_option *option);

/// Whether a library's option is a number of bytes, which may be written as 512M or 8G.
bool options_counts_bytes(const ewa_option *option);

/// Writes the range of a library's option; of bytes, as people write them.
void options_write_range(const ewa_option *option, char range[EWA_OPTION_TEXT_BYTES]);

/// Returns the name nearest to `word` among `count` names, NULL when none is near.
const char *options_nearest(const char *word, size_t count, const char *const *names);

/// Writes what help calls the value of an option, such as "FILE" or "on|off".
void options_name_value(const cli_option *option, char text[EWA_OPTION_TEXT_BYTES]);

#endif
