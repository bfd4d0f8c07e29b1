// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Whole-number coordinates: points on the grid of the file, nodes whose sides are powers of two of its steps,
// so that which node a point is in is exact, and the same for whoever reads the file.
#ifndef EWA_SRC_LOD_LATTICE_H
#define EWA_SRC_LOD_LATTICE_H

#include "ewa/cloud.h"
#include "io/octree.h"

enum {
    EWA_CODE_LEVELS = 21, ///< cells per axis that codes tell apart, as a power of two
    EWA_PAGE_BITS = 7,    ///< a node has 2^7 cells along each axis: one point or surfel of its own in each
    EWA_PAGE_POINTS = 1 << 16, ///< a node of more points is divided
    EWA_LATTICE_BITS = 40,     ///< of a root's side, at most
};

/// The grid of a file and its root's cube.
typedef struct ewa_lattice {
    double step_world, offset_world[3]; ///< place = offset + whole number * step
    int64_t low[3];                     ///< corner of the root, a whole number
    uint32_t bits;                      ///< the root's side is 2^bits steps
} ewa_lattice;

/// The Morton code of a place from the root's corner, in [0, 2^bits) along each axis: 3 * EWA_CODE_LEVELS bits, of each
/// level x above y above z.
static inline uint64_t ewa_spread_bits(uint64_t n) {
    n = (n | n << 32) & 0x1f00000000ffffu;
    n = (n | n << 16) & 0x1f0000ff0000ffu;
    n = (n | n << 8) & 0x100f00f00f00f00fu;
    n = (n | n << 4) & 0x10c30c30c30c30c3u;
    return (n | n << 2) & 0x1249249249249249u;
}

static inline uint64_t ewa_lattice_code(const ewa_lattice *lattice, const int64_t place[3]) {
    uint64_t cell[3];
    for (int c = 0; c < 3; c++) {
        const uint64_t from = (uint64_t)(place[c] - lattice->low[c]);
        cell[c] = lattice->bits >= EWA_CODE_LEVELS ? from >> (lattice->bits - EWA_CODE_LEVELS)
                                                   : from << (EWA_CODE_LEVELS - lattice->bits);
    }
    return ewa_spread_bits(cell[0]) << 2 | ewa_spread_bits(cell[1]) << 1 | ewa_spread_bits(cell[2]);
}

/// The part of a code that tells which cell of a level it is in.
static inline uint64_t ewa_code_prefix(uint64_t code, uint32_t level) {
    return code >> 3 * (EWA_CODE_LEVELS - level);
}

/// The key of the node of a level that a code is in.
static inline ewa_octree_key ewa_code_key(uint64_t code, uint32_t level) {
    ewa_octree_key key = {.level = (int32_t)level};
    const uint64_t prefix = ewa_code_prefix(code, level);
    for (uint32_t i = 0; i < level; i++)
        for (int c = 0; c < 3; c++) key.cell[c] |= (int32_t)(prefix >> (3 * i + (uint32_t)(2 - c)) & 1) << i;
    return key;
}

/// The first code of a node.
static inline uint64_t ewa_key_code(const ewa_octree_key *key) {
    const uint64_t cell[3] = {(uint64_t)key->cell[0], (uint64_t)key->cell[1], (uint64_t)key->cell[2]};
    const uint64_t prefix =
        ewa_spread_bits(cell[0]) << 2 | ewa_spread_bits(cell[1]) << 1 | ewa_spread_bits(cell[2]);
    return prefix << 3 * (EWA_CODE_LEVELS - (uint32_t)key->level);
}

/// World coordinate of the low corner of a node.
static inline double ewa_lattice_world(const ewa_lattice *lattice, int axis, int64_t place) {
    return lattice->offset_world[axis] + (double)place * lattice->step_world;
}

static inline double ewa_lattice_side_world(const ewa_lattice *lattice, uint32_t level) {
    return (double)((int64_t)1 << lattice->bits) * lattice->step_world / (double)((int64_t)1 << level);
}

#endif
