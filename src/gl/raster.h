// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The state of the paper's pipeline.
#ifndef EWA_SRC_GL_RASTER_H
#define EWA_SRC_GL_RASTER_H

#include "gl/raster_band.h"
#include "gl/raster_programs.h"
#include "gl/raster_surfels.h"
#include "gl/raster_targets.h"
#include "surface/backend.h"
#include "surface/job.h"

enum { EWA_RASTER_ATTRIBUTES = 8 }; ///< of vertices

typedef struct ewa_raster {
    ewa_context *context;
    ewa_gl *device;
    ewa_job_room room;
    ewa_raster_residents residents;
    ewa_raster_programs programs;
    ewa_raster_targets targets;
    ewa_raster_band band;
    ewa_buffer indices, views; ///< of sources
    ewa_buffer row;            ///< of numbers on their way
    ewa_gl_buffer packets, view_blocks, resolve_block, material_block;
    GLuint vertices, query, environment;
    uint32_t finer;   ///< parts of a pixel along each side that the device averages; 1: none
    ewa_buffer parts; ///< of pixels, or their averages
} ewa_raster;

/// As ewa_backend has them.
ewa_status ewa_raster_create(ewa_context *context, void **state);
void ewa_raster_destroy(ewa_context *context, void *state);
ewa_status ewa_raster_draw(void *state, const ewa_render_job *frame, ewa_render_stats *stats);

#endif
