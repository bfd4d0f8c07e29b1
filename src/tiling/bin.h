// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What each of many bins holds: tiles of a picture and what touches them, or steps of depth and what begins
// in them.
#ifndef EWA_SRC_TILING_BIN_H
#define EWA_SRC_TILING_BIN_H

#include "base/base.h"

enum { EWA_BIN_ALIGNMENT = 16 };

/// Items and the rectangles of bins that they are in. Corners are column | row << 16; `end` is beyond the
/// last column and row.
typedef struct ewa_bin_items {
    int32_t *ids, *first, *end;
} ewa_bin_items;

/// Looks at the candidates [first, first + count) and writes those that are in some bin, in their order, to
/// `items` from `first` on; returns how many there are. `first` and the room of `items` are multiples of
/// EWA_BIN_ALIGNMENT. Runs for several ranges at a time, each `worker` in one.
typedef uint32_t ewa_bin_find(const void *data, uint32_t worker, uint32_t first, uint32_t count,
                              const ewa_bin_items *items);

/// The items of each bin; memory survives from one filling to the next. Zero-initialise.
typedef struct ewa_bin_lists {
    uint32_t columns; ///< bins are numbered row by row
    const uint64_t
        *starts;         ///< [bin + 1]: a bin's items are ids[starts[bin]] to ids[starts[bin + 1]], excluded
    const uint32_t *ids; ///< in each bin in the order of the candidates
    uint64_t largest;    ///< items of the fullest bin
    uint64_t item_count; ///< candidates that are in some bin
    ewa_buffer item_buffer, count_buffer, start_buffer, id_buffer;
} ewa_bin_lists;

/// Fills `columns` x `rows` bins, each fewer than 2^16, in parallel; the result does not depend on the number
/// of workers. Errors: EWA_ERROR_MEMORY; EWA_CANCELLED, where there are many candidates.
ewa_status ewa_bin_lists_fill(ewa_context *context, ewa_bin_lists *lists, uint32_t columns, uint32_t rows,
                              uint32_t candidate_count, ewa_bin_find *find, const void *data);

/// What is to go into some lists.
typedef struct ewa_bin_request {
    ewa_bin_lists *lists;
    uint32_t candidate_count;
    ewa_bin_find *find;
    const void *data;
} ewa_bin_request;

/// Fills many sets of lists of the same bins, several at a time; `room` keeps memory from one call to the next.
/// Errors: as ewa_bin_lists_fill().
ewa_status ewa_bin_lists_fill_all(ewa_context *context, ewa_buffer *room, const ewa_bin_request *requests,
                                  uint32_t count, uint32_t columns, uint32_t rows);

void ewa_bin_lists_free(ewa_context *context, ewa_bin_lists *lists);

#endif
