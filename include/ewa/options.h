// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the options of every call are, as tables: type, range, default, unit and meaning of each member.
// Defaults, checks, the program's options and their help, and bindings to other languages come from them.
//
// Every ewa_..._options begins with struct_size, which ewa_..._options_init() sets to the caller's sizeof. A
// library takes the smaller struct of an older header, whose missing members have their defaults, and the
// larger one of a newer header as long as the members that it does not know are zero; else
// EWA_ERROR_UNSUPPORTED.
#ifndef EWA_OPTIONS_H
#define EWA_OPTIONS_H

#include "ewa/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/// What a member is, and how it reads as text.
typedef enum ewa_option_type {
    EWA_OPTION_BOOL = 0,   ///< bool: on or off
    EWA_OPTION_CHOICE = 1, ///< an enumeration that counts from 0: one of `words`
    EWA_OPTION_U32 = 2,    ///< uint32_t
    EWA_OPTION_U64 = 3,    ///< uint64_t
    EWA_OPTION_F32 = 4,    ///< float
    EWA_OPTION_F64 = 5,    ///< double
} ewa_option_type;

/// What a range is beside the numbers from its minimum to its maximum.
enum {
    EWA_OPTION_ABOVE = 1u << 0,   ///< the minimum itself is not allowed
    EWA_OPTION_BELOW = 1u << 1,   ///< the maximum itself is not allowed
    EWA_OPTION_OR_ZERO = 1u << 2, ///< zero is allowed too; `help` says what it stands for
};

/// One member of a struct of options.
typedef struct ewa_option {
    const char *name;
    ewa_option_type type;
    size_t offset;           ///< of the member
    double minimum, maximum; ///< of numbers, each of an array; infinite: no limit, but finite
    uint32_t limits;         ///< EWA_OPTION_* bits
    uint32_t count;          ///< length of an array; 0: none
    double initial;          ///< the default, as a number
    const double *initials;  ///< of an array whose defaults differ; NULL: all have `initial`
    const char *unit;        ///< of numbers: "px"; NULL: none
    const char *words;       ///< of a choice: "first|second"; of integers: all that are allowed; else NULL
    const char *help;        ///< what it means, without a full stop
} ewa_option;

/// The members of a struct that are numbers, choices or switches; pointers and nested structs are not in it.
typedef struct ewa_option_table {
    const char *name; ///< of the struct
    const ewa_option *options;
    size_t option_count;
    size_t struct_size;
} ewa_option_table;

/// Those of ewa_context_options and its limits; each other header has its own.
EWA_API extern const ewa_option_table ewa_context_options_table;
EWA_API extern const ewa_option_table ewa_limits_table;

enum { EWA_OPTION_TEXT_BYTES = 256 };

/// Returns the option of that name, NULL when the table has none. Any thread.
EWA_API const ewa_option *ewa_option_find(const ewa_option_table *table, const char *name);

/// Writes what values an option may have: "(0, 4]", "0 or [1, 256]", "first|second", "on|off". Any thread.
EWA_API void ewa_option_range(const ewa_option *option, char text[EWA_OPTION_TEXT_BYTES]);

/// Writes the value that the struct at `options` has, as ewa_option_set() reads it. Any thread.
EWA_API void ewa_option_get(const ewa_option *option, const void *options, char text[EWA_OPTION_TEXT_BYTES]);

/// Sets a member of the struct at `options` from text: a number, a word, the numbers of an array separated by
/// commas; the same in every locale. What is wrong with the text ("5 is outside (0, 4]") goes to `problem`,
/// which may be NULL; then the member is unchanged. Any thread. Errors: EWA_ERROR_ARGUMENT.
EWA_API ewa_status ewa_option_set(const ewa_option *option, void *options, const char *text,
                                  char problem[EWA_OPTION_TEXT_BYTES]);

/// Reads a colour, sRGB and straight alpha, [0, 1]: "white", "black", "gray", "grey", "transparent", "#f80", "#ff8800",
/// either with a further digit or two for alpha, or 3 or 4 numbers "r,g,b[,a]". False: it is none; `srgba` is unchanged.
/// Any thread.
EWA_API bool ewa_color_read(const char *text, double srgba[4]);

#ifdef __cplusplus
}
#endif
#endif
