// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the stages of a frame take by the device's own clock.
#ifndef EWA_SRC_GL_TIMES_H
#define EWA_SRC_GL_TIMES_H

#include "gl/device.h"
#include "surface/backend.h"

/// Stages of ewa_render_stats.
typedef enum ewa_gl_time {
    EWA_GL_TIME_BIN,
    EWA_GL_TIME_SETUP,
    EWA_GL_TIME_VISIBILITY,
    EWA_GL_TIME_ACCUMULATE,
    EWA_GL_TIME_EDGES,
    EWA_GL_TIME_RESOLVE,
    EWA_GL_TIME_COUNT
} ewa_gl_time;

enum { EWA_GL_MAX_MARKS = 64 };

/// Marks in what the device is told. Zero-initialise.
typedef struct ewa_gl_times {
    GLuint queries[EWA_GL_MAX_MARKS];
    uint8_t stages[EWA_GL_MAX_MARKS]; ///< of what came before the mark
    uint32_t count;
    double seconds[EWA_GL_TIME_COUNT];
} ewa_gl_times;

/// Begins a frame, then its parts: nothing is known of what came before. The device is entered.
void ewa_gl_times_start(ewa_gl_times *times);
void ewa_gl_times_resume(ewa_gl_times *times);

/// Ends a stage: what the device was told since the mark before. Marks beyond EWA_GL_MAX_MARKS since ewa_gl_times_resume() are
/// left out.
void ewa_gl_times_mark(ewa_gl_times *times, ewa_gl_time stage);

/// Adds up what was marked. After ewa_gl_wait(), so that it waits for nothing.
void ewa_gl_times_read(ewa_gl_times *times);

/// Sets the stages' times of a frame; all 0 where the device has no clock.
void ewa_gl_times_tell(const ewa_gl_times *times, ewa_render_stats *stats);

void ewa_gl_times_free(ewa_gl_times *times);

#endif
