// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Moving numbers between the records of a file and the streams of a cloud.
#ifndef EWA_SRC_RECORDS_H
#define EWA_SRC_RECORDS_H

#include "ewa/cloud.h"

/// What is moved: `component_count` (1 to 4) adjacent numbers per record.
typedef struct ewa_move {
    ewa_type from_type;
    ewa_type to_type; ///< from_type, EWA_F32 or EWA_F64, or EWA_U8 which clamps integers to [0, 255]
    uint32_t component_count;
    bool swap; ///< the source has its bytes in the other order
} ewa_move;

/// Moves the numbers of `count` records that lie `from_stride_bytes` apart to places `to_stride_bytes` apart.
/// Nothing has to be aligned. Numbers whose type stays keep their bits.
void ewa_move_numbers(const ewa_move *move, uint8_t *to, size_t to_stride_bytes, const uint8_t *from,
                      size_t from_stride_bytes, size_t count);

#endif
