// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sorting by Morton codes.
#ifndef EWA_SRC_LOD_CODES_H
#define EWA_SRC_LOD_CODES_H

#include "base/base.h"

/// A code and the place where it was.
typedef struct ewa_coded {
    uint64_t code;
    uint32_t index;
} ewa_coded;

/// Sorts by code, then index; all codes agree in the bits from `bits` on; `spare` has room for as many. The same result
/// for every number of threads.
void ewa_codes_sort(ewa_context *context, ewa_coded *items, ewa_coded *spare, uint32_t count, uint32_t bits);

#endif
