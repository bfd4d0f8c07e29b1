// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Text with numbers, the same in every locale.
#ifndef EWA_SRC_BASE_FORMAT_H
#define EWA_SRC_BASE_FORMAT_H

#include <stdarg.h>
#include <stddef.h>

/// As snprintf() and vsnprintf(), but the point of a number is a point whatever locale the program has chosen. Conversions are
/// those of C99 without long double, wide characters and %n; another one ends the text.
int ewa_format(char *text, size_t text_bytes, const char *format, ...) __attribute__((format(printf, 3, 4)));
int ewa_format_list(char *text, size_t text_bytes, const char *format, va_list arguments) __attribute__((format(printf, 3, 0)));

#endif
