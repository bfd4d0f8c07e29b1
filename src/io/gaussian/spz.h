// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// SPZ: what its reader and writer share.
//
// Based on: Niantic Labs, "spz", README, versions 1 to 4, and its extension SPZ_ADOBE_coordinate_system.
#ifndef EWA_SRC_SPZ_H
#define EWA_SRC_SPZ_H

#include "io/gaussian/gaussian.h"

enum {
    EWA_SPZ_MAGIC = 0x5053474e, ///< "NGSP"
    EWA_SPZ_HEAD_BYTES = 16,    ///< of versions 1 to 3, packed with what follows
    EWA_SPZ_OPEN_BYTES = 32,    ///< of version 4, not packed
    EWA_SPZ_ANTIALIASED = 1,    ///< flags
    EWA_SPZ_EXTENDED = 2,
    EWA_SPZ_STREAMS = 6,
};

/// A type of extension: the axes that the numbers are in.
#define EWA_SPZ_AXES 0xadbe0003u

/// Where a file's numbers lie, in their order there.
enum {
    EWA_SPZ_CENTERS,
    EWA_SPZ_OPACITIES,
    EWA_SPZ_COLORS,
    EWA_SPZ_SCALES,
    EWA_SPZ_ROTATIONS,
    EWA_SPZ_HARMONICS
};

typedef struct ewa_spz_header {
    uint32_t version, count, sh_degree, fraction_bits, flags;
    uint32_t stream_count, table_at; ///< of version 4
} ewa_spz_header;

/// Colours of the constant harmonic are stored with this, so that some beyond [0, 1] fit.
#define EWA_SPZ_COLOR 0.15

/// Bytes per Gaussian of a stream.
uint32_t ewa_spz_stream_bytes(const ewa_spz_header *header, uint32_t stream);

/// Unpacks the streams of a file into one block, `*bytes` of `*size_bytes` for ewa_release(); stream k begins
/// at `at[k]`. `*axes` gets the coordinate system that the file names; 0: none. Errors: EWA_ERROR_FORMAT,
/// EWA_ERROR_UNSUPPORTED, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_spz_unpack(const ewa_gaussian_source *source, ewa_spz_header *header, uint32_t *axes,
                          uint8_t **bytes, size_t *size_bytes, size_t at[EWA_SPZ_STREAMS]);

#endif
