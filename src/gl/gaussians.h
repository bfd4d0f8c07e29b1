// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Frames of Gaussians on the device: by centres, to the processor's bytes (src/volume/gaussian_*.h).
#ifndef EWA_SRC_GL_GAUSSIANS_H
#define EWA_SRC_GL_GAUSSIANS_H

#include "gl/choice.h"
#include "gl/compute.h"
#include "gl/gaussian_programs.h"
#include "gl/gaussian_sets.h"
#include "gl/sort.h"
#include "volume/gaussian_backend.h"

/// Buffers of the device, by what they hold; shaders/gaussian_*.glsl tell the forms.
typedef enum ewa_gl_gaussian_buffer {
    EWA_GL_SPLAT_FRAME,
    EWA_GL_SPLAT_VIEWS,
    EWA_GL_SPLAT_SEGMENTS,
    EWA_GL_SPLAT_COUNTS,
    EWA_GL_SLOT_KEYS, ///< of all splats, [slot]
    EWA_GL_SLOT_NUMBERS,
    EWA_GL_SPLAT_RECORDS, ///< of what is visible
    EWA_GL_SPLAT_BOXES,
    EWA_GL_DEPTH_KEYS, ///< twice, sorted to and fro
    EWA_GL_DEPTH_NUMBERS = EWA_GL_DEPTH_KEYS + 2,
    EWA_GL_BLOCK_SUMS = EWA_GL_DEPTH_NUMBERS + 2,
    EWA_GL_TILE_KEYS,
    EWA_GL_TILE_NUMBERS = EWA_GL_TILE_KEYS + 2,
    EWA_GL_SPLAT_SURFACES = EWA_GL_TILE_NUMBERS + 2,
    EWA_GL_SPLAT_RESULT,
    EWA_GL_SPLAT_READBACK,
    EWA_GL_SPLAT_BUFFERS
} ewa_gl_gaussian_buffer;

/// What decides how long frames take.
typedef struct ewa_gl_gaussian_kind {
    uint64_t splat_count, pixel_count;
    bool with_depth, normals, among;
} ewa_gl_gaussian_kind;

typedef struct ewa_gl_gaussians {
    ewa_context *context;
    ewa_renderer *surfaces; ///< whose device it is
    ewa_gl *device;         ///< of the last frame; NULL: there was none, and nothing is on it
    ewa_gl_arithmetic arithmetic;
    ewa_gl_gaussian_programs programs;
    ewa_gl_sorter sorter;
    ewa_gl_splat_sets sets;
    ewa_gl_buffer buffers[EWA_GL_SPLAT_BUFFERS];
    uint32_t visible_mark, pair_mark; ///< what there is room for
    ewa_gl_times times;
    ewa_buffer views, segments, uses, staging;
    ewa_gl_choice choice; ///< of EWA_BACKEND_AUTO
    ewa_gl_gaussian_kind kind;
    char remark[160];
    double splat_s; ///< that compositing takes for each splat, by the frame before
    bool watched;   ///< the system ends programs that take long
    bool exact;     ///< the device gives the processor's bits
    bool chooses;   ///< the faster draws
    bool measured;  ///< what the processor takes for the frame counts
    bool refused;   ///< the device does not draw frames of this kind; `remark` says why
} ewa_gl_gaussians;

/// Draws a frame on the device, which is entered. Errors: EWA_ERROR_LIMIT, EWA_ERROR_MEMORY (it does not fit), EWA_ERROR_UNSUPPORTED.
ewa_status ewa_gl_gaussians_draw(ewa_gl_gaussians *of, const ewa_gaussian_job *job, ewa_gaussian_stats *stats);

/// Frees what is on the device, if it is still there.
void ewa_gl_gaussians_reset(ewa_gl_gaussians *of, bool there);

#endif
