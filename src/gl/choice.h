// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which of processor and device draws the frames of a scene, where nobody says: both draw some, then the faster.
#ifndef EWA_SRC_GL_CHOICE_H
#define EWA_SRC_GL_CHOICE_H

#include "base/base.h"

/// Frames of a scene until both are measured. The first is the processor's, so that a single picture waits for no device; the
/// next gives the device its data and programs; then one for each counts.
enum { EWA_GL_FIRST, EWA_GL_WARM_UP, EWA_GL_MEASURE_CPU, EWA_GL_MEASURE, EWA_GL_DECIDED };

/// What was measured of a kind of frame, and what follows from it. Zero-initialise.
typedef struct ewa_gl_choice {
    int step;
    double cpu_s, gl_s;
    bool by_gl; ///< the faster is
} ewa_gl_choice;

/// Whether the device is to draw the next frame.
bool ewa_gl_choice_takes_gl(const ewa_gl_choice *choice);

/// Notes what a frame took, and decides after the last, of which `remark` tells then.
void ewa_gl_choice_learn(ewa_gl_choice *choice, bool by_gl, double took_s, char *remark, size_t remark_bytes);

/// Leaves all further frames to the processor.
void ewa_gl_choice_leave(ewa_gl_choice *choice);

/// Whether one count is more than twice the other.
bool ewa_gl_far_apart(uint64_t a, uint64_t b);

#endif
