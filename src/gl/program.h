// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Programs for the device, from pieces of source that the library carries (src/gl/shaders).
#ifndef EWA_SRC_GL_PROGRAM_H
#define EWA_SRC_GL_PROGRAM_H

#include "gl/device.h"

/// One stage of a program: its kind (GL_COMPUTE_SHADER, ...) and its sources, which are put together after `head`.
typedef struct ewa_gl_stage {
    GLenum kind;
    const char *head; ///< #version and #define lines
    const char *const *pieces;
    uint32_t piece_count;
} ewa_gl_stage;

/// Makes a program that the caller deletes; `name` is for messages. Errors: EWA_ERROR_UNSUPPORTED (the driver's words).
ewa_status ewa_gl_program_make(ewa_gl *device, const char *name, const ewa_gl_stage *stages,
                               uint32_t stage_count, GLuint *program);

/// Runs the program in use in so many groups, which it numbers through. What follows may read all that it wrote.
void ewa_gl_program_run(ewa_gl *device, uint64_t group_count);

#endif
