// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From the cells of a line to the numbers of attributes.
#ifndef EWA_SRC_TEXT_PARSE_H
#define EWA_SRC_TEXT_PARSE_H

#include "io/cloud/text_table.h"

/// What is done with the cell of a column.
typedef enum ewa_text_action {
    EWA_TEXT_LEAVE = 0, ///< it is not looked at
    EWA_TEXT_POSITION,  ///< F64, less `shift`
    EWA_TEXT_F32,
    EWA_TEXT_F64,
    EWA_TEXT_WHOLE, ///< a whole number in the range of `type`
    EWA_TEXT_SHARE, ///< U16: times `scale`, rounded, clamped
} ewa_text_action;

typedef struct ewa_text_target {
    ewa_text_action action;
    ewa_type type;
    bool missing_is_zero; ///< of WHOLE: what is not there is 0, else damage
    uint32_t attribute;   ///< of the prototype
    uint32_t offset_bytes;
    int64_t shift;
    double scale;
} ewa_text_target;

/// What ewa_text_read_chunk() knows: `target` per column.
typedef struct ewa_text_table {
    ewa_text_layout layout;
    const char *text; ///< begin of the whole text
    const ewa_text_target *targets;
    bool counts; ///< lines of one whole number say how many points follow
} ewa_text_table;

/// Reads lines of a chunk (ewa_rows_read_chunk); `format` is an ewa_text_table.
void ewa_text_read_chunk(const void *format, const ewa_rows_chunk *chunk, uint64_t maximum,
                         const ewa_cloud_sink *sinks, uint64_t first, ewa_rows_result *result);

#endif
