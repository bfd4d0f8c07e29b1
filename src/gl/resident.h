// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Copies of surfels on the device, which stay there from frame to frame.
#ifndef EWA_SRC_GL_RESIDENT_H
#define EWA_SRC_GL_RESIDENT_H

#include "gl/memory.h"
#include "surface/packets.h"

/// Packets [first, first + count) of some surfels, and beside them what not all surfels have.
typedef struct ewa_gl_page {
    ewa_gl_buffer packets, attributes, bounds;
    uint32_t first, count;
    int32_t opacities_at, curvatures_at, materials_at; ///< words of `attributes`; -1: there are none
    int32_t clips_at;                                  ///< of `bounds` (shaders/cull.glsl), likewise
} ewa_gl_page;

/// Surfels that are there.
typedef struct ewa_gl_resident {
    uint64_t serial; ///< ewa_surfels.serial
    uint64_t size_bytes;
    uint64_t used; ///< ewa_gl_residents.frame when it was last asked for
    uint32_t page_count;
    ewa_gl_page *pages;
} ewa_gl_resident;

/// All that are there. Zero-initialise.
typedef struct ewa_gl_residents {
    ewa_buffer items; ///< ewa_gl_resident
    uint32_t count;
    uint32_t page_packets; ///< at most, of a page; 0: as many as fit
    uint64_t frame, size_bytes;
} ewa_gl_residents;

/// Begins a frame: what the one before did not use may go.
void ewa_gl_residents_start(ewa_gl *device, ewa_gl_residents *residents);

/// Returns the pages of surfels, copied when they are not there; they stay during the frame. Errors: EWA_ERROR_MEMORY,
/// EWA_ERROR_UNSUPPORTED.
ewa_status ewa_gl_residents_get(ewa_gl *device, ewa_gl_residents *residents, const ewa_surfels *surfels,
                                uint32_t *index);

static inline const ewa_gl_resident *ewa_gl_residents_at(const ewa_gl_residents *residents, uint32_t index) {
    return (const ewa_gl_resident *)residents->items.data + index;
}

/// Frees them all; of a lost device, whose objects went with it, what the host has of them.
void ewa_gl_residents_free(ewa_gl *device, ewa_gl_residents *residents);

#endif
