// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Averages of the parts of pixels by the device, so that they need not be read back.
#ifndef EWA_SRC_GL_AVERAGES_H
#define EWA_SRC_GL_AVERAGES_H

#include "gl/compute.h"
#include "gl/result.h"

/// Makes the program that averages a band the one in use, for so many groups. Errors: as ewa_gl_variant_get().
ewa_status ewa_gl_averages_use(ewa_gl_compute *gl, const ewa_gl_result *result, const ewa_tile_job *job, ewa_gl_rows rows,
                            uint64_t *group_count);

#endif
