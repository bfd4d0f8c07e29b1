// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Names of files: suffixes, and the place of a number, such as name_%04d.png.
#ifndef EWA_CLI_BASE_PATTERN_H
#define EWA_CLI_BASE_PATTERN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Whether a name ends in one of the suffixes, which are separated by '|', or is the one without a dot in front;
/// - does for standard input or output.
bool path_has_suffix(const char *path, const char *suffixes);

/// Whether a path holds exactly one number: %d, %4d or %04d with a width of 1 to 9; %% stands for a percent
/// sign, nothing else may follow one.
bool pattern_is_numbered(const char *path);

/// Writes the path with number `number` to `text`; false when it is longer than `text_bytes` allows.
bool pattern_expand(const char *path, uint64_t number, size_t text_bytes, char *text);

#endif
