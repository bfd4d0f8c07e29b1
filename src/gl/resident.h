// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Copies of surfels on the device, which stay there from frame to frame. Those of many surfels share a page, so that a
// frame takes as many dispatches for a thousand nodes of an octree as for one cloud.
#ifndef EWA_SRC_GL_RESIDENT_H
#define EWA_SRC_GL_RESIDENT_H

#include "gl/memory.h"
#include "surface/packets.h"

/// Streams of attributes of packets, each in a buffer of its own.
typedef enum ewa_gl_stream {
    EWA_GL_PACKETS,
    EWA_GL_BOUNDS, ///< what culling reads (shaders/cull.glsl)
    EWA_GL_OPACITIES,
    EWA_GL_CURVATURES,
    EWA_GL_MATERIALS,
    EWA_GL_CLIP_MASKS,
    EWA_GL_STREAMS
} ewa_gl_stream;

/// Packets [first, first + count).
typedef struct ewa_gl_range {
    uint32_t first, count;
} ewa_gl_range;

/// As many packets as a buffer has room for. Streams that none of them has are no buffers.
typedef struct ewa_gl_page {
    ewa_gl_buffer streams[EWA_GL_STREAMS];
    uint32_t capacity, piece_count, hole_count;
    ewa_buffer holes; ///< ewa_gl_range: where there is room, in order, apart from each other
} ewa_gl_page;

/// Packets of some surfels from `first` on, which lie in a page from `at` on.
typedef struct ewa_gl_piece {
    uint32_t page, at, first, count;
} ewa_gl_piece;

/// Surfels that are there.
typedef struct ewa_gl_resident {
    uint64_t serial;    ///< ewa_surfels.serial
    uint64_t used;      ///< ewa_gl_residents.frame when it was last asked for
    uint32_t streams;   ///< bit per ewa_gl_stream that not all have, and they do
    uint32_t piece_count;
    ewa_buffer pieces;  ///< ewa_gl_piece
} ewa_gl_resident;

/// All that are there. Zero-initialise.
typedef struct ewa_gl_residents {
    ewa_buffer items, pages, staging; ///< ewa_gl_resident, ewa_gl_page, words on their way
    uint32_t count, page_count;
    uint32_t next;         ///< where the search for surfels begins
    uint32_t page_packets; ///< at most, of a page; 0: as many as fit
    uint64_t kept_bytes;   ///< copies that the last frame did not use are kept up to so many; 0: a default
    uint64_t frame, packet_count, capacity; ///< packets, and what there is room for
} ewa_gl_residents;

/// Begins a frame: what the one before did not use may go.
void ewa_gl_residents_start(ewa_gl *device, ewa_gl_residents *residents);

/// Returns the index of surfels, copied when they are not there; they stay during the frame. Errors: EWA_ERROR_MEMORY,
/// EWA_ERROR_UNSUPPORTED.
ewa_status ewa_gl_residents_get(ewa_gl *device, ewa_gl_residents *residents, const ewa_surfels *surfels,
                                uint32_t *index);

static inline const ewa_gl_resident *ewa_gl_residents_at(const ewa_gl_residents *residents, uint32_t index) {
    return (const ewa_gl_resident *)residents->items.data + index;
}

static inline const ewa_gl_page *ewa_gl_residents_page(const ewa_gl_residents *residents, uint32_t page) {
    return (const ewa_gl_page *)residents->pages.data + page;
}

/// Frees them all, after which it is as at the start; of a lost device, whose objects went with it, what the host has of them.
void ewa_gl_residents_free(ewa_gl *device, ewa_gl_residents *residents);

#endif
