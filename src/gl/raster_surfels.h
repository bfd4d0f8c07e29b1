// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Surfels as rows of vertices, which stay on the device from frame to frame.
#ifndef EWA_SRC_GL_RASTER_SURFELS_H
#define EWA_SRC_GL_RASTER_SURFELS_H

#include "gl/memory.h"
#include "surface/packets.h"

/// A surfel as vertices have it (ewa_packet).
typedef struct ewa_raster_surfel {
    float x, y, z, sigma;
    int16_t oct_x, oct_y;
    uint16_t angle, ratio;
    uint16_t red, green, blue, opacity;
    float curvature; ///< per length in packets
} ewa_raster_surfel;

/// Packets [first, first + count) of some surfels.
typedef struct ewa_raster_page {
    ewa_gl_buffer surfels, materials; ///< materials: a code each; 0: all have the same
    uint32_t first, count;
} ewa_raster_page;

/// Surfels that are on the device.
typedef struct ewa_raster_resident {
    uint64_t serial, used, size_bytes;
    ewa_raster_page *pages;
    uint32_t page_count;
    GLuint lines; ///< RGBA32F: three texels for each surfel with clip lines; 0: none has
} ewa_raster_resident;

/// All that are there. Zero-initialise.
typedef struct ewa_raster_residents {
    ewa_buffer items; ///< ewa_raster_resident
    uint32_t count;
    uint64_t frame, size_bytes;
} ewa_raster_residents;

/// Begins a frame: what the one before did not use may go.
void ewa_raster_residents_start(ewa_gl *device, ewa_raster_residents *residents);

/// Returns surfels, copied when they are not there; they stay during the frame. Errors: EWA_ERROR_MEMORY,
/// EWA_ERROR_LIMIT.
ewa_status ewa_raster_residents_get(ewa_gl *device, ewa_raster_residents *residents,
                                    const ewa_surfels *surfels, uint32_t *index);

static inline const ewa_raster_resident *ewa_raster_residents_at(const ewa_raster_residents *residents,
                                                                 uint32_t index) {
    return (const ewa_raster_resident *)residents->items.data + index;
}

/// Frees the host's memory alone, when the device is lost.
void ewa_raster_residents_forget(ewa_context *context, ewa_raster_residents *residents);
void ewa_raster_residents_free(ewa_gl *device, ewa_raster_residents *residents);

#endif
