// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Numbers of VTK's files as bytes: legacy ones, which are big-endian, and those of XML.
#ifndef EWA_SRC_MESH_VTK_NUMBER_H
#define EWA_SRC_MESH_VTK_NUMBER_H

#include "ewa/base.h"
#include "image/srgb.h"

#include <math.h>
#include <string.h>

/// A type of numbers.
typedef struct ewa_vtk_type {
    const char *name;
    uint32_t bytes; ///< 1, 2, 4 or 8
    char kind;      ///< f, i, u
} ewa_vtk_type;

/// The type that numbers are read as: the same, doubles for whole ones of eight bytes, which they are exact for up to 2^53.
static inline ewa_type ewa_vtk_kept_type(const ewa_vtk_type *type) {
    const bool is_signed = type->kind == 'i';
    if (type->bytes == 8) return EWA_F64;
    if (type->kind == 'f') return EWA_F32;
    if (type->bytes == 4) return is_signed ? EWA_I32 : EWA_U32;
    if (type->bytes == 2) return is_signed ? EWA_I16 : EWA_U16;
    return is_signed ? EWA_I8 : EWA_U8;
}

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

/// The linear colour of four numbers, sRGB and alpha, of which 1 / `scale` is the brightest; what is none, or beyond, is an end of the range.
static inline void ewa_vtk_color(const double numbers[4], double scale, float color[4]) {
    for (int c = 0; c < 4; c++) {
        const double share = fmin(fmax(numbers[c] * scale, 0), 1);
        color[c] = (float)(c < 3 ? ewa_srgb_decode(share) : share);
    }
}

#endif
