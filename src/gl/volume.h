// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volumes as compute programs, on the device that draws surfels.
#ifndef EWA_SRC_GL_VOLUME_H
#define EWA_SRC_GL_VOLUME_H

#include "gl/choice.h"
#include "gl/memory.h"
#include "gl/selftest.h"
#include "gl/times.h"
#include "gl/variant.h"
#include "gl/volume_frame.h"
#include "volume/backend.h"

/// Programs, in the order in which a frame runs them.
typedef enum ewa_gl_volume_program {
    EWA_GL_VOLUME_PLACE,
    EWA_GL_VOLUME_BUCKETS,
    EWA_GL_VOLUME_SORT,
    EWA_GL_VOLUME_DRAW,
    EWA_GL_VOLUME_PROGRAMS
} ewa_gl_volume_program;

/// Buffers, by the bindings of shaders/volume_*.glsl.
typedef enum ewa_gl_volume_buffer {
    EWA_GL_VOLUME_VIEW,
    EWA_GL_VOLUME_PAIRS,
    EWA_GL_VOLUME_TILES,
    EWA_GL_VOLUME_VOXELS, ///< none of these: `levels` are bound there
    EWA_GL_VOLUME_RECORDS,
    EWA_GL_VOLUME_RUNS,
    EWA_GL_VOLUME_BUCKET_BEGINS,
    EWA_GL_VOLUME_SORTED,
    EWA_GL_VOLUME_UNITS,
    EWA_GL_VOLUME_FILTERS,
    EWA_GL_VOLUME_COUNTS,
    EWA_GL_VOLUME_NEARS,
    EWA_GL_VOLUME_RESULT,
    EWA_GL_VOLUME_STATES,
    EWA_GL_VOLUME_PROGRESS,
    EWA_GL_VOLUME_BOUND, ///< those are bound
    EWA_GL_VOLUME_READBACK = EWA_GL_VOLUME_BOUND,
    EWA_GL_VOLUME_BUFFERS
} ewa_gl_volume_buffer;

/// The state: its own programs and buffers on the device of a renderer of surfels.
typedef struct ewa_gl_volume {
    ewa_context *context;
    const ewa_renderer *surfaces; ///< whose device it is
    ewa_gl *device;               ///< where the objects are; NULL: there are none
    ewa_gl_verdict verdict;
    GLuint programs[EWA_GL_VOLUME_PROGRAMS]; ///< 0: not made yet
    ewa_gl_buffer buffers[EWA_GL_VOLUME_BUFFERS];
    ewa_gl_buffer levels[EWA_MAX_VOLUME_LEVELS]; ///< of the voxels that `serial` is of
    bool resident[EWA_MAX_VOLUME_LEVELS];
    uint64_t serial; ///< 0: none
    bool has_filters;
    ewa_gl_volume_lists lists;
    ewa_gl_times times;
    uint32_t turns; ///< of loops, of a dispatch that draws pixels
    ewa_gl_choice choice; ///< of EWA_BACKEND_AUTO
    uint64_t chosen_voxels, chosen_pixels; ///< of the frames that it is of
} ewa_gl_volume;

void ewa_gl_volume_program_write(const ewa_gl_arithmetic *arithmetic, ewa_gl_volume_program program, ewa_gl_source *source);

#endif
