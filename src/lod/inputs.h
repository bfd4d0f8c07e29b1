// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Several files of points as one stream of pieces that have the same attributes.
#ifndef EWA_SRC_LOD_INPUTS_H
#define EWA_SRC_LOD_INPUTS_H

#include "base/base.h"
#include "ewa/io.h"

enum { EWA_INPUT_PIECE_POINTS = 1 << 20 };

typedef struct ewa_inputs {
    ewa_context *context;
    const char *const *paths;
    uint32_t path_count;
    ewa_cloud_load_options options;
    ewa_cloud *prototype;  ///< attributes, grid and notes of all files together
    bool has_grid;         ///< every file has one
    double min_step_world; ///< of the grids
    uint64_t max_points;
    uint64_t keep_bytes;   ///< of pieces that are kept, so that they are decoded once: those of the first files, each whole
    ewa_cloud **kept;      ///< of the files before `kept_files`, in their order
    size_t kept_capacity_bytes;
    uint32_t kept_count, kept_files;
    uint64_t kept_bytes;
} ewa_inputs;

/// Opens every file once; `keep_bytes` of pieces may be kept from one reading to the next. Free with ewa_inputs_free(), also after
/// a failure. Errors: as ewa_cloud_reader_open(); EWA_ERROR_ARGUMENT (no positions).
ewa_status ewa_inputs_open(ewa_context *context, const char *const *paths, uint32_t path_count,
                           bool keep_going, uint64_t keep_bytes, ewa_inputs *inputs);

/// Frees what was kept.
void ewa_inputs_forget(ewa_inputs *inputs);

void ewa_inputs_free(ewa_inputs *inputs);

/// Takes a piece whose attributes are those of the prototype, in its order; its origin may be another.
typedef ewa_status ewa_piece_callback(void *user, const ewa_cloud *piece);

/// Reads all files in their order, and keeps what there is room for.
ewa_status ewa_inputs_read(ewa_inputs *inputs, const char *stage, ewa_piece_callback *take, void *user);

#endif
