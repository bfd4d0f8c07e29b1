// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the passes of a frame take by the device's own clock.
#ifndef EWA_SRC_GL_TIMES_H
#define EWA_SRC_GL_TIMES_H

#include "gl/variant.h"
#include "surface/backend.h"

enum { EWA_GL_MAX_MARKS = 64 };

/// Marks in what the device is told. Zero-initialise.
typedef struct ewa_gl_times {
    GLuint queries[EWA_GL_MAX_MARKS];
    uint8_t passes[EWA_GL_MAX_MARKS]; ///< ewa_gl_pass of what came before the mark
    uint32_t count;
    double seconds[EWA_GL_PASSES];
} ewa_gl_times;

/// Begins a frame, then its parts: nothing is known of what came before. The device is entered.
void ewa_gl_times_start(ewa_gl_times *times);
void ewa_gl_times_resume(ewa_gl_times *times);

/// Ends what the device was told of a pass since the mark before. Marks beyond EWA_GL_MAX_MARKS since ewa_gl_times_resume() are
/// left out.
void ewa_gl_times_mark(ewa_gl_times *times, ewa_gl_pass pass);

/// Adds up what was marked. After ewa_gl_wait(), so that it waits for nothing.
void ewa_gl_times_read(ewa_gl_times *times);

/// Sets the times of ewa_render_stats' stages; all 0 where the device has no clock.
void ewa_gl_times_tell(const ewa_gl_times *times, ewa_render_stats *stats);

void ewa_gl_times_free(ewa_gl_times *times);

#endif
