// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The normal equations of photographs, A' W A and A' W rest, added up photograph by photograph.
#ifndef EWA_SRC_PHOTOS_NORMAL_H
#define EWA_SRC_PHOTOS_NORMAL_H

#include "photos/parts.h"

/// Rows of the matrix, EWA_GRADIENT_BLOCK_ROWS of them; in a row, the points in the order in which they were met.
typedef struct ewa_normal_block {
    uint32_t *starts; ///< [rows + 1]; NULL: nothing is there
    ewa_photo_entry *entries;
    uint32_t capacity; ///< of the entries
} ewa_normal_block;

typedef struct ewa_normal {
    ewa_context *context;
    uint32_t count; ///< points
    ewa_normal_block *blocks;
    double *sides; ///< [count][EWA_PHOTO_CHANNELS]
    struct ewa_normal_room *rooms; ///< [worker]
    uint32_t worker_count;
} ewa_normal;

/// Makes equations of zeros. What there is after a failure is freed like the rest. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_normal_make(ewa_context *context, uint32_t count, ewa_normal *normal);
void ewa_normal_free(ewa_normal *normal);

/// Adds a photograph: the weight of each pixel, and that times what is missing of each channel. The same for every number
/// of threads. Errors: EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_normal_add(ewa_normal *normal, const ewa_photo_view *view, const double *weight, const double *rest);

/// Returns the median of the diagonal's numbers but for zeros, within a sixteenth of an octave; 0: all are.
double ewa_normal_median(const ewa_normal *normal);

#endif
