// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Types of numbers.
#include "ewa/base.h"

size_t ewa_type_bytes(ewa_type type) {
    static const uint8_t bytes[] = {4, 8, 1, 1, 2, 2, 4, 4};
    return (unsigned)type < sizeof bytes ? bytes[type] : 0;
}

const char *ewa_type_name(ewa_type type) {
    static const char *const names[] = {"float", "double", "char", "uchar", "short", "ushort", "int", "uint"};
    return (unsigned)type < sizeof names / sizeof names[0] ? names[type] : "unknown";
}
