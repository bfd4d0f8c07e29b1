// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Rows of a frame on their way to the paper's pipeline: the packets that they see as runs of vertices, and what programs see
// of views and lights.
#ifndef EWA_SRC_GL_RASTER_BAND_H
#define EWA_SRC_GL_RASTER_BAND_H

#include "gl/memory.h"
#include "surface/tile.h"

/// A packet of a band as vertices have it.
typedef struct ewa_raster_packet {
    float base_px[2]; ///< where its slope is in the band
    float slope[2];
    float rest[2], depth, pad; ///< ewa_packet_places
    uint32_t form;             ///< of its colours
    uint32_t lanes;            ///< a bit per surfel | those that section planes cut << 16
    uint32_t own;              ///< a bit per surfel that has clip lines of its own
    uint32_t first_line;       ///< of them, among those of all surfels
} ewa_raster_packet;

/// Neighbouring packets that are drawn at once.
typedef struct ewa_raster_run {
    uint32_t source, page;
    uint32_t first, count; ///< packets of the page
    uint32_t record;       ///< of the first, in ewa_raster_band.packets
    bool near;             ///< some surfels may be drawn by pixel rays
} ewa_raster_run;

/// Rows of the picture. Zero-initialise.
typedef struct ewa_raster_band {
    uint32_t first_row_px, end_row_px;
    ewa_buffer packets, runs, live;
    uint32_t packet_count, run_count;
    uint64_t surfel_count;
} ewa_raster_band;

/// Uniform blocks; src/gl/shaders/raster_scene.glsl and raster_surface.glsl tell the forms.
typedef struct ewa_raster_view {
    float rotation[3][4], focal[4], zoomed[4], kernel[4], depth[4], point[4], sums[4], place[4], contour[4];
    float sections[EWA_MAX_SECTION_PLANES][4];
    uint32_t flags[4];
} ewa_raster_view;

typedef struct ewa_raster_resolve {
    float scales[4], units[4], material[4], background[4], rays[4], to_world[3][4];
    float toward[EWA_MAX_LIGHTS][4], light[EWA_MAX_LIGHTS][4];
    float material_units[4], reflection[4], environment_from_camera[3][4];
    uint32_t flags[4], levels[EWA_MAX_ENVIRONMENT_LEVELS][4];
} ewa_raster_resolve;

enum {
    EWA_RASTER_VIEW_STRIDE = 512, ///< bytes between views of sources
    EWA_RASTER_TRANSLUCENT =
        512 ///< in ewa_raster_view.flags, beside those of ewa_gl_view: surfels have opacities
};

/// Lists the packets that the rows see. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_raster_band_start(ewa_context *context, ewa_raster_band *band, const ewa_tile_job *job,
                                 uint32_t first_row_px, uint32_t end_row_px);
void ewa_raster_band_free(ewa_context *context, ewa_raster_band *band);

/// What programs see of a source, or of the frame, in a band.
void ewa_raster_view_set(ewa_raster_view *to, const ewa_view *from, const ewa_tile_job *job,
                         const ewa_raster_band *band);
void ewa_raster_resolve_set(ewa_raster_resolve *to, const ewa_tile_job *job, const ewa_raster_band *band);

#endif
