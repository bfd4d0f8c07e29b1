// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Order of points along the Z-order (Morton) curve, at any scale.
#ifndef EWA_SRC_CLOUD_MORTON_H
#define EWA_SRC_CLOUD_MORTON_H

#include "ewa/cloud.h"

enum {
    /// split_level of two points that no grid tells apart: they are at the same place, or share a cell with
    /// so few
    /// others that no finer grid was laid.
    EWA_MORTON_SAME = 0x7fff,
};

/// Orders `count` points along the Z-order curve: `order` gets their indices.
///
/// The grid has 2^21 cubic cells along the longest edge of the bounds. Points that share a cell with many
/// others are ordered by a finer grid over their own bounds, and so on, so that a far outlier or a dense
/// cluster costs nothing but time in proportion. Points at the same place, and the few in one cell of the
/// last grid, keep the order of the input; those with a coordinate that is not finite come last.
///
/// - position: three components, any type
/// - count: points; < 2^32
/// - order: `count` indices
/// - split_level: NULL, or `count` numbers: entry i > 0 is the depth of the smallest cell that holds the
///   points at places i - 1 and i of the order, coarsest 0. Cutting a run where the level is lowest cuts it at
///   the cell's middle.
/// - finite_count: NULL, or receives the number of points with finite coordinates
///
/// The result does not depend on the number of threads. Errors: EWA_ERROR_MEMORY. Needs 24 bytes per point
/// meanwhile. Based on G. M. Morton, "A computer oriented geodetic data base and a new technique in file
/// sequencing", 1966.
ewa_status ewa_morton_order(ewa_context *context, const ewa_attribute *position, uint32_t count,
                            uint32_t *order, uint16_t *split_level, uint32_t *finite_count);

/// Codes places, three finite numbers each, on the first grid that an order in `box` is by, whose upper bits are its larger cells: points come in
/// the order of their codes, those of one code in that of finer grids.
void ewa_morton_codes(ewa_context *context, const ewa_bounds *box, const float *places, uint32_t count, uint64_t *codes);

/// Bytes of the room that ewa_morton_order_in() sorts in.
size_t ewa_morton_room_bytes(uint32_t count);

/// The same for callers that know more.
///
/// - box: of the positions that matter, in the numbers of the stream; others are ordered somehow
/// - room: NULL, or ewa_morton_room_bytes() aligned to 8 that are free meanwhile, so that memory that will be
///   needed later is touched once only
ewa_status ewa_morton_order_in(ewa_context *context, const ewa_attribute *position, uint32_t count,
                               const ewa_bounds *box, void *room, uint32_t *order, uint16_t *split_level);

#endif
