// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Eye-dome lighting by the device, of a picture that is drawn in one band.
#ifndef EWA_SRC_GL_EYE_DOME_H
#define EWA_SRC_GL_EYE_DOME_H

#include "gl/compute.h"

/// The pass over a band: that of the frame if the band is all of it, else NULL: the host lights what bands have drawn.
const ewa_eye_dome_pass *ewa_gl_eye_dome_of(const ewa_gl_compute *gl, const ewa_tile_job *job, ewa_gl_rows rows);

/// Makes the pass's program the one in use, for so many groups. Errors: as ewa_gl_variant_get().
ewa_status ewa_gl_eye_dome_use(ewa_gl_compute *gl, const ewa_eye_dome *eye_dome, uint64_t *group_count);

#endif
