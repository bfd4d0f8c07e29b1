// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The state of the compute pipeline.
#ifndef EWA_SRC_GL_COMPUTE_H
#define EWA_SRC_GL_COMPUTE_H

#include "gl/host_records.h"
#include "gl/resident.h"
#include "gl/selftest.h"
#include "gl/times.h"
#include "surface/backend.h"
#include "surface/job.h"

/// Buffers of the device, by what they hold; src/gl/shaders tell the forms.
typedef enum ewa_gl_buffer_kind {
    EWA_GL_BAND,
    EWA_GL_VIEWS,
    EWA_GL_PLACEMENTS,
    EWA_GL_SEGMENTS,
    EWA_GL_RESOLVE,
    EWA_GL_ENVIRONMENT,
    EWA_GL_COUNTS,
    EWA_GL_PAIRS,
    EWA_GL_RECORDS,
    EWA_GL_HOST_REQUESTS,
    EWA_GL_TILES,
    EWA_GL_LIST,
    EWA_GL_UNITS,
    EWA_GL_RANGES,
    EWA_GL_NEARS,
    EWA_GL_CLIPS,
    EWA_GL_NEAREST,
    EWA_GL_SUM_WORDS,
    EWA_GL_BACK_FACING,
    EWA_GL_CUT,
    EWA_GL_SURFACES,
    EWA_GL_RESULT,
    EWA_GL_READBACK,
    EWA_GL_BUFFERS
} ewa_gl_buffer_kind;

/// The order of -infinity among keys (band.glsl).
#define EWA_GL_NEVER 0x007fffffu

/// How many items buffers have room for; what a frame found too few is raised, and stays.
typedef struct ewa_gl_marks {
    uint32_t pairs, requests, list, units;
    uint32_t rounds; ///< over edges
} ewa_gl_marks;

/// A band of rows, from a multiple of EWA_FIELD_PX.
typedef struct ewa_gl_rows {
    uint32_t first_px, end_px;
} ewa_gl_rows;

/// A frame, and how many rows of it the device has room for.
typedef struct ewa_gl_fit {
    uint32_t width_px, height_px, rows_px;
    uint64_t splat_count;
} ewa_gl_fit;

/// A page that a frame draws from: its segments [first, end), and how many groups of invocations cull them.
typedef struct ewa_gl_page_use {
    uint32_t page, first, end, group_count;
} ewa_gl_page_use;

/// What came of a band's frame.
typedef struct ewa_gl_outcome {
    uint64_t broken, drawn; ///< pixels without a colour; records in tiles
    uint64_t kept_packets;  ///< that some field of the picture has
    bool lit;               ///< the device has put eye-dome lighting on it
} ewa_gl_outcome;

typedef struct ewa_gl_compute {
    ewa_context *context;
    ewa_gl *device;
    ewa_gl_variants variants;
    ewa_gl_verdict verdict;
    ewa_gl_residents residents;
    ewa_gl_buffer buffers[EWA_GL_BUFFERS];
    ewa_gl_marks marks;
    ewa_gl_fit fit; ///< of the last frame
    ewa_gl_times times;
    ewa_gl_host_records host_records;
    ewa_job_room room;
    ewa_buffer views, placements, indices; ///< of sources
    ewa_buffer segments, uses;             ///< of the frame: ewa_gl_segment, ewa_gl_page_use
    uint32_t use_count;
    uint64_t environment_serial;           ///< of what EWA_GL_ENVIRONMENT holds; 0: nothing
    double surfel_s; ///< that the longest stage takes for each surfel, by the frame before
    bool watched;    ///< the system ends programs that take long
    bool needs_host;  ///< the last band asked the host for something: the next is likely to
    bool unfinished; ///< a band ended early: its sums are not back at their start
    uint32_t tile_px, unit_splats, min_parts;
    uint32_t edge_units; ///< of a tile that a dispatch over edges takes, at most
    uint32_t finer;   ///< parts of a pixel along each side that the device averages; 1: none
    ewa_buffer parts; ///< of pixels, or their averages
} ewa_gl_compute;

/// Whether a device has what the pipeline needs, and how it calculates. Errors: EWA_ERROR_MEMORY,
/// EWA_ERROR_UNSUPPORTED (too small, its compiler's words, or it is lost).
ewa_status ewa_gl_try(ewa_gl *device, ewa_gl_verdict *verdict);

/// Draws rows of a frame whose sources the device has. Errors: EWA_ERROR_LIMIT, EWA_ERROR_MEMORY (fewer rows may fit),
/// EWA_ERROR_UNSUPPORTED, EWA_CANCELLED.
ewa_status ewa_gl_band_draw(ewa_gl_compute *gl, const ewa_tile_job *job, ewa_gl_rows rows, ewa_gl_outcome *outcome);

/// Sets what an info says of a device and of its last frame.
void ewa_gl_describe_device(const ewa_gl *device, const ewa_gl_verdict *verdict, ewa_renderer_info *info);

/// The device of a state of ewa_backend_auto, which is opened where it is not yet; NULL: it draws by the processor alone, and
/// `*remark` says why.
ewa_gl_compute *ewa_gl_auto_device(void *state, const char **remark);

/// As ewa_backend has them.
ewa_status ewa_gl_compute_create(ewa_context *context, void **state);
void ewa_gl_compute_destroy(ewa_context *context, void *state);
ewa_status ewa_gl_compute_draw(void *state, const ewa_render_job *frame, ewa_render_stats *stats);

#endif
