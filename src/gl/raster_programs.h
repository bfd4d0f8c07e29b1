// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The programs of the paper's pipeline, each made when a frame first needs it.
#ifndef EWA_SRC_GL_RASTER_PROGRAMS_H
#define EWA_SRC_GL_RASTER_PROGRAMS_H

#include "gl/device.h"

/// What is drawn of splats.
typedef enum ewa_raster_pass {
    EWA_RASTER_VISIBILITY, ///< the nearest z + eps, by MAX
    EWA_RASTER_SUMS,       ///< by ADD
    EWA_RASTER_MATERIALS,  ///< the same of the numbers of materials
    EWA_RASTER_SINGLE,     ///< one pass: the nearest splat, by the test of depths
    EWA_RASTER_PASSES
} ewa_raster_pass;

/// How splats are drawn.
typedef enum ewa_raster_form {
    EWA_RASTER_ELLIPSES,
    EWA_RASTER_RAYCAST, ///< the kernel of that name
    EWA_RASTER_NEAR,    ///< by pixel rays: surfels at the eye's plane
    EWA_RASTER_FORMS
} ewa_raster_form;

/// What is made of sums.
typedef enum ewa_raster_stage {
    EWA_RASTER_COMPOSE, ///< a surface, under those before it
    EWA_RASTER_PLANES,  ///< its normal, depth and coverage
    EWA_RASTER_CUT,     ///< what clip lines leave of it, for the surface behind it
    EWA_RASTER_PEEL,    ///< where more is wanted
    EWA_RASTER_BROKEN,  ///< pixels without a colour
    EWA_RASTER_PICTURE,
    EWA_RASTER_AVERAGE, ///< of parts of pixels
    EWA_RASTER_STAGES
} ewa_raster_stage;

/// Programs that are there. Zero-initialise.
typedef struct ewa_raster_programs {
    GLuint splats[EWA_RASTER_PASSES][EWA_RASTER_FORMS][2]; ///< [..][with clip lines]; 0: not yet made
    GLuint stages[EWA_RASTER_STAGES][2];
} ewa_raster_programs;

/// Returns a program, made when it is first asked for. Errors: EWA_ERROR_UNSUPPORTED.
ewa_status ewa_raster_splat_program(ewa_gl *device, ewa_raster_programs *programs, ewa_raster_pass pass,
                                    ewa_raster_form form, bool with_clips, GLuint *program);
ewa_status ewa_raster_stage_program(ewa_gl *device, ewa_raster_programs *programs, ewa_raster_stage stage,
                                    bool with_clips, GLuint *program);
void ewa_raster_programs_free(ewa_raster_programs *programs);

#endif
