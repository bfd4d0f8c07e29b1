// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Structs of options by their tables: defaults, sizes, ranges.
#ifndef EWA_SRC_OPTIONS_H
#define EWA_SRC_OPTIONS_H

#include "ewa/options.h"

/// The table of a struct whose members are `rows`, that with the smallest offset first.
#define EWA_OPTION_TABLE(type, rows)                                                                         \
    { #type, rows, sizeof(rows) / sizeof(rows)[0], sizeof(type) }

/// Number `index` of a member.
double ewa_option_number(const ewa_option *option, const void *options, uint32_t index);

/// Sets number `index` of a member, which the option allows.
void ewa_option_put(const ewa_option *option, void *options, uint32_t index, double value);

/// Whether the option allows a number.
bool ewa_option_allows(const ewa_option *option, double value);

/// Number that word `index` of the option stands for; false beyond the last word. `*length` gets its bytes.
bool ewa_option_word(const ewa_option *option, uint32_t index, double *value, const char **word,
                     size_t *length);

/// Sets `struct_size` bytes to zero, struct_size (where the table's struct has one) and the defaults of all
/// members that have room in them.
void ewa_options_init(const ewa_option_table *table, void *options, size_t struct_size);

/// Checks every number of a struct of this library's size. Errors: EWA_ERROR_ARGUMENT with a message
/// "WHAT: cutoff is 5, allowed is (0, 4]".
ewa_status ewa_options_check(ewa_context *context, const ewa_option_table *table, const char *what,
                             const void *options);

/// Takes a struct from a caller, which may be that of an older or a newer header: copies what there is of
/// `given` (NULL: nothing) over `chosen`, which holds the defaults, and checks it. A member that comes new
/// must not lie in what was padding. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_UNSUPPORTED.
ewa_status ewa_options_take(ewa_context *context, const ewa_option_table *table, const void *given,
                            void *chosen);

#endif
