// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Numbers of VTK's files as bytes: legacy ones, which are big-endian, and those of XML.
#ifndef EWA_SRC_MESH_VTK_NUMBER_H
#define EWA_SRC_MESH_VTK_NUMBER_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/// A type of numbers.
typedef struct ewa_vtk_type {
    const char *name;
    uint32_t bytes; ///< 1, 2, 4 or 8
    char kind;      ///< f, i, u
} ewa_vtk_type;

/// The number that the first bytes are.
static inline double ewa_vtk_number(const ewa_vtk_type *type, const uint8_t *bytes, bool big_endian) {
    const uint32_t count = type->bytes, unused = 64 - 8 * count;
    uint64_t bits = 0;
    for (uint32_t i = 0; i < count; i++) bits = bits << 8 | bytes[big_endian ? i : count - 1 - i];
    if (type->kind == 'u') return (double)bits;
    if (type->kind == 'i') return (double)((int64_t)(bits << unused) >> unused);
    const uint32_t half = (uint32_t)bits;
    float single;
    double number;
    memcpy(&single, &half, sizeof single);
    memcpy(&number, &bits, sizeof number);
    return count == 4 ? (double)single : number;
}

#endif
