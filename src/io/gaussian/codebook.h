// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Few numbers, and few vectors, that stand for many.
#ifndef EWA_SRC_CODEBOOK_H
#define EWA_SRC_CODEBOOK_H

#include "base/base.h"

enum { EWA_CODES = 256 };

/// Reads number `index` of many. Any thread.
typedef float ewa_number_take(const void *data, size_t index);

/// Finds numbers, ascending, such that each of `count` > 0 ones is near to one of them.
/// Errors: EWA_ERROR_MEMORY.
ewa_status ewa_codebook_make(ewa_context *context, ewa_number_take *take, const void *data, size_t count, float codes[EWA_CODES]);

/// Returns the code that is nearest to a number.
uint8_t ewa_codebook_find(const float codes[EWA_CODES], float number);

/// Few vectors for many, and which stands for each.
typedef struct ewa_palettes {
    uint32_t size;     ///< numbers of a vector, at most EWA_PALETTE_SIZE
    uint32_t count;    ///< of palettes, at most `room`
    uint32_t room, vector_count;
    float *numbers;    ///< `size` per palette
    uint16_t *labels;  ///< the palette of each vector
} ewa_palettes;

enum { EWA_PALETTE_SIZE = 45, EWA_MAX_PALETTES = 1 << 16 };

/// Finds at most `room` palettes for `vector_count` vectors, of which one begins every `stride` floats. Free with
/// ewa_palettes_free(), also after a failure. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_palettes_make(ewa_context *context, const float *vectors, size_t stride, uint32_t vector_count, uint32_t size,
                             uint32_t room, ewa_palettes *palettes);
void ewa_palettes_free(ewa_context *context, ewa_palettes *palettes);

#endif
