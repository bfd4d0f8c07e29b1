// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The programs of Gaussians, each made when a frame first needs it.
#ifndef EWA_SRC_GL_GAUSSIAN_PROGRAMS_H
#define EWA_SRC_GL_GAUSSIAN_PROGRAMS_H

#include "gl/variant.h"

typedef enum ewa_gl_gaussian_pass {
    EWA_GL_SPLATS_PROJECT,
    EWA_GL_SPLATS_COUNT, ///< tiles of blocks of splats, the sums of these, of splats, splats in tiles
    EWA_GL_SPLATS_SUM,
    EWA_GL_SPLATS_START,
    EWA_GL_SPLATS_LIST,
    EWA_GL_SPLATS_DRAW,
    EWA_GL_SPLAT_PASSES
} ewa_gl_gaussian_pass;

/// What of splats records have, each with all before.
typedef enum ewa_gl_gaussian_detail {
    EWA_GL_SPLATS_BARE, ///< the ellipse
    EWA_GL_SPLATS_DEEP, ///< how rays pass them
    EWA_GL_SPLATS_FLAT, ///< dots of 2D Gaussians
    EWA_GL_SPLATS_DEEP_AMONG, ///< the same, among surfaces or section planes
    EWA_GL_SPLATS_FLAT_AMONG,
    EWA_GL_SPLAT_DETAILS
} ewa_gl_gaussian_detail;

/// Vectors of 16 bytes of a record.
static const uint32_t ewa_gl_record_parts[EWA_GL_SPLAT_DETAILS] = {3, 6, 7, 6, 7};

/// Zero-initialise.
typedef struct ewa_gl_gaussian_programs {
    GLuint programs[EWA_GL_SPLAT_PASSES][EWA_GL_SPLAT_DETAILS];
} ewa_gl_gaussian_programs;

void ewa_gl_gaussian_program_write(const ewa_gl_arithmetic *arithmetic, ewa_gl_gaussian_pass pass,
                                   ewa_gl_gaussian_detail detail, ewa_gl_source *source);

/// Makes a pass's program the one in use. Errors: as ewa_gl_program_make().
ewa_status ewa_gl_gaussian_program_use(ewa_gl *device, ewa_gl_gaussian_programs *programs, const ewa_gl_arithmetic *arithmetic,
                                       ewa_gl_gaussian_pass pass, ewa_gl_gaussian_detail detail);

void ewa_gl_gaussian_programs_free(ewa_gl_gaussian_programs *programs);

#endif
