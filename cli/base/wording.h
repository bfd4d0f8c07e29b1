// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The wording of advice in messages of the library: it names its members and functions, the program its options and
// commands.
#ifndef EWA_CLI_WORDING_H
#define EWA_CLI_WORDING_H

#include <stddef.h>

/// Writes a message of the library with what the program calls things, cut to `size_bytes`.
void wording_of_program(const char *message, char *to, size_t size_bytes);

#endif
