// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The state of the compute pipeline.
#ifndef EWA_SRC_GL_COMPUTE_H
#define EWA_SRC_GL_COMPUTE_H

#include "gl/band.h"
#include "gl/resident.h"
#include "gl/selftest.h"
#include "gl/times.h"
#include "surface/backend.h"
#include "surface/job.h"

/// Buffers of the device, by what they hold; src/gl/shaders tell the forms.
typedef enum ewa_gl_buffer_kind {
    EWA_GL_BAND,
    EWA_GL_VIEWS,
    EWA_GL_RESOLVE,
    EWA_GL_MATERIALS,
    EWA_GL_ENVIRONMENT,
    EWA_GL_PAIRS,
    EWA_GL_PLACES,
    EWA_GL_WORDS,
    EWA_GL_MASKS,
    EWA_GL_RECORDS,
    EWA_GL_COUNTS,
    EWA_GL_LIST,
    EWA_GL_UNITS,
    EWA_GL_NEARS,
    EWA_GL_CLIPS,
    EWA_GL_CLIPPED,
    EWA_GL_NEAREST,
    EWA_GL_PASSED,
    EWA_GL_OPEN,
    EWA_GL_SUM_WORDS,
    EWA_GL_BACK_FACING,
    EWA_GL_CUT,
    EWA_GL_SETTLED,
    EWA_GL_BEHIND,
    EWA_GL_CODES,
    EWA_GL_PLANES,
    EWA_GL_BUFFERS
} ewa_gl_buffer_kind;

/// The order of -infinity among keys (scene.glsl).
#define EWA_GL_NEVER 0x007fffffu

typedef struct ewa_gl_compute {
    ewa_context *context;
    ewa_gl *device;
    ewa_gl_variants variants;
    ewa_gl_verdict verdict;
    ewa_gl_residents residents;
    ewa_gl_buffer buffers[EWA_GL_BUFFERS];
    ewa_gl_times times;
    ewa_gl_band band;
    ewa_job_room room;
    ewa_buffer views, indices, page_packets; ///< of sources
    uint64_t environment_serial;             ///< of what EWA_GL_ENVIRONMENT holds; 0: nothing
    uint32_t tile_px, unit_splats;
} ewa_gl_compute;

/// Whether a device has what the pipeline needs, and how it calculates. Errors: EWA_ERROR_MEMORY,
/// EWA_ERROR_UNSUPPORTED (too small, its compiler's words, or it is lost).
ewa_status ewa_gl_try(ewa_gl *device, ewa_gl_verdict *verdict);

/// As ewa_backend has them.
ewa_status ewa_gl_compute_create(ewa_context *context, void **state);
void ewa_gl_compute_destroy(ewa_context *context, void *state);
ewa_status ewa_gl_compute_draw(void *state, const ewa_render_job *frame, ewa_render_stats *stats);

#endif
