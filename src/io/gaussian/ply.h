// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the two forms of PLY with Gaussians share.
#ifndef EWA_SRC_GAUSSIAN_PLY_H
#define EWA_SRC_GAUSSIAN_PLY_H

#include "io/cloud/ply.h"
#include "io/gaussian/gaussian.h"

/// Whether a file is PLY whose header, which can be read, fits.
bool ewa_gaussians_ply_probe(const ewa_gaussian_source *source, bool (*fits)(const ewa_ply_header *header),
                             ewa_status *status);

/// Steps `*at` over the elements before one, whose records are there then. Errors: EWA_ERROR_FORMAT.
ewa_status ewa_gaussians_ply_skip_to(const ewa_ply_source *ply, const ewa_ply_header *header,
                                     const ewa_ply_element *element, uint64_t *at);

/// Reads the records of an element at `*at` into a sink. Errors: EWA_ERROR_FORMAT, EWA_CANCELLED.
ewa_status ewa_gaussians_ply_read_element(const ewa_ply_source *ply, const ewa_ply_header *header,
                                          const ewa_ply_element *element, const ewa_ply_sink *sink,
                                          uint64_t *at);

/// Reads the header of a PLY of 3DGS or 2DGS; `*count` gets its Gaussians where they can be read in pieces (binary, centres in floats), else 0.
/// Errors: EWA_ERROR_FORMAT, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_gaussians_ply_pieces(const ewa_gaussian_source *source, ewa_ply_header *header, uint64_t *count);

/// Reads Gaussians [first, first + count), of which there are some, as ewa_gaussians_load() does; the header then says what the piece is. The
/// caller frees the set. Errors: as ewa_gaussians_load().
ewa_status ewa_gaussians_ply_piece(const ewa_gaussian_source *source, ewa_ply_header *header, uint64_t first, uint32_t count,
                                   ewa_gaussians *set, ewa_gaussian_facts *facts);

#endif
