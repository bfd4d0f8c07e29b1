// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which points share a packet: sixteen neighbours along the Morton curve, fewer where the curve jumps too
// far.
#ifndef EWA_SRC_SURFACE_PACKET_ORDER_H
#define EWA_SRC_SURFACE_PACKET_ORDER_H

#include "surface/surfel.h"

/// In the lanes of a packet behind its last point.
#define EWA_NO_POINT UINT32_MAX

/// How far a surfel may lie from its packet's centre, in sigmas: in single precision, with two roundings, its
/// place is off by 2^-9 sigma at most. A closed surface of 10^9 points has no packet as wide.
#define EWA_PACKET_REACH 32768.0

/// Points by lanes: point[16 p + lane] of packet p.
typedef struct ewa_packet_order {
    uint32_t *points;
    size_t room; ///< numbers that `points` has room for
    uint32_t packet_count;
} ewa_packet_order;

/// Orders the points that can be drawn, as `drawable` says of each, along the curve; points that it does not
/// tell apart by all that is drawn of them. Full packets but for the last one.
///
/// - count: of the reader's points; < 2^32 - 16; `drawable_count` of them can be drawn
/// - box: of these, in the numbers of the stream
/// - room: NULL, or ewa_morton_room_bytes(count) that are free meanwhile
///
/// Free with ewa_packet_order_free(), whatever the status. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_packet_order_make(ewa_context *context, const ewa_surfel_reader *reader, uint32_t count,
                                 const uint8_t *drawable, uint32_t drawable_count, const ewa_bounds *box,
                                 void *room, ewa_packet_order *order);

/// Divides the packets that `wide` marks before each jump along the curve, so that all surfels are within
/// EWA_PACKET_REACH of their packet's centre; where that would take more than a quarter more packets, the
/// reach becomes larger. Errors: EWA_ERROR_MEMORY (the order is unchanged), EWA_ERROR_LIMIT.
ewa_status ewa_packet_order_split(ewa_context *context, const ewa_surfel_reader *reader, const uint8_t *wide,
                                  ewa_packet_order *order);

void ewa_packet_order_free(ewa_context *context, ewa_packet_order *order);

#endif
