// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What was read of LAS and LAZ, beside what the header says of it: a writer that did not keep its header up, a file that was
// damaged, or a decoder that a compiler has broken.
#ifndef EWA_SRC_LAS_CHECK_H
#define EWA_SRC_LAS_CHECK_H

#include "io/las/las.h"

enum { EWA_LAS_RETURN_KINDS = 16 };

/// What the records that were read come to. Zero-initialise.
typedef struct ewa_las_seen {
    uint64_t count;
    uint64_t above_count;    ///< what ewa_las_unpack() returned
    int32_t low[3], high[3]; ///< whole numbers of the positions; of no meaning without records
    uint64_t by_return[EWA_LAS_RETURN_KINDS];
} ewa_las_seen;

/// ewa_las_unpack(), adding the records to what was seen.
void ewa_las_unpack_seen(const ewa_las_table *table, const uint8_t *records, uint64_t count, const ewa_cloud_sink *sinks,
                         ewa_las_seen *seen);

/// Adds what was seen elsewhere.
void ewa_las_seen_add(ewa_las_seen *seen, const ewa_las_seen *more);

/// Says where all records that were read are not as the header has them: in a warning, which points are outside of its bounds, in
/// a note, which bounds none of them reaches, and which numbers of returns are others. Nothing is said of bounds and numbers that
/// a header leaves at zero, nor where only some of the points were read.
void ewa_las_check(const ewa_cloud_source *source, const ewa_las_header *header, const ewa_las_seen *seen);

#endif
