// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Copies of sets of Gaussians on the device, with their levels, which stay there from frame to frame.
#ifndef EWA_SRC_GL_GAUSSIAN_SETS_H
#define EWA_SRC_GL_GAUSSIAN_SETS_H

#include "gl/memory.h"
#include "volume/splat_colors.h"

/// As many packets as buffers have room for; those that they do not need are no buffers.
typedef struct ewa_gl_splat_page {
    ewa_gl_buffer packets, harmonics, colors, lanes;
    uint64_t colors_serial, lanes_serial; ///< of what is there; 0: nothing is
} ewa_gl_splat_page;

/// How a frame shows a set.
typedef struct ewa_gl_splat_look {
    const ewa_splats *splats;       ///< with the lanes that are shown
    const ewa_splat_colors *colors; ///< in place of its own; NULL: these
} ewa_gl_splat_look;

/// A set that is there.
typedef struct ewa_gl_splat_set {
    const ewa_splat_packet *packets; ///< the host's: with the serial it tells sets of all contexts apart
    uint64_t serial, used, size_bytes; ///< `used`: ewa_gl_splat_sets.frame when it was last asked for
    uint32_t page_packets, page_count; ///< packets of all pages but the last
    ewa_buffer pages;                  ///< ewa_gl_splat_page
} ewa_gl_splat_set;

/// All that are there. Zero-initialise.
typedef struct ewa_gl_splat_sets {
    ewa_buffer items, staging; ///< ewa_gl_splat_set; bytes on their way
    uint32_t count, next;
    uint32_t page_packets; ///< at most, of a page; 0: as many as fit
    uint64_t kept_bytes;   ///< copies that the last frame did not use are kept up to so many; 0: a default
    uint64_t frame, size_bytes;
} ewa_gl_splat_sets;

/// Begins a frame: what the one before did not use may go.
void ewa_gl_splat_sets_start(ewa_gl *device, ewa_gl_splat_sets *sets);

/// Returns the index of a set, copied when it is not there; it stays during the frame. Errors: EWA_ERROR_MEMORY, EWA_ERROR_UNSUPPORTED.
ewa_status ewa_gl_splat_sets_get(ewa_gl *device, ewa_gl_splat_sets *sets, const ewa_splats *splats, uint32_t *index);

/// Returns a page of a set, with colours and lanes as a frame shows it. Errors: EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_ERROR_UNSUPPORTED.
ewa_status ewa_gl_splat_sets_look(ewa_gl *device, ewa_gl_splat_sets *sets, uint32_t set, uint32_t page_number,
                                  const ewa_gl_splat_look *look, const ewa_gl_splat_page **page);

static inline const ewa_gl_splat_set *ewa_gl_splat_sets_at(const ewa_gl_splat_sets *sets, uint32_t index) {
    return (const ewa_gl_splat_set *)sets->items.data + index;
}

/// Frees them all; of a device that is gone, what the host has of them.
void ewa_gl_splat_sets_free(ewa_context *context, ewa_gl_splat_sets *sets, bool there);

#endif
