// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Eye-dome lighting by the device.
#include "gl/eye_dome.h"

const ewa_eye_dome_pass *ewa_gl_eye_dome_of(const ewa_gl_compute *gl, const ewa_tile_job *job, ewa_gl_rows rows) {
    const bool whole = rows.first_px == 0 && rows.end_px == job->tiles.height_px;
    return gl->room.with_eye_dome && whole ? &gl->room.eye_dome : NULL;
}

ewa_status ewa_gl_eye_dome_use(ewa_gl_compute *gl, const ewa_eye_dome *eye_dome, uint64_t *group_count) {
    enum { SIDE_PX = 8 }; // of a group
    enum { BACKGROUND, INVERSE_HEIGHT, EXPONENT, IS_ORTHOGRAPHIC, WITH_BYTES };
    const ewa_gl_variant v = {.pass = EWA_GL_EYE_DOME};
    GLuint program = 0;
    EWA_TRY(ewa_gl_variant_get(gl->device, &gl->variants, &v, &program));
    glUseProgram(program);
    glUniform4fv(BACKGROUND, 1, eye_dome->background);
    glUniform1f(INVERSE_HEIGHT, eye_dome->inverse_height);
    glUniform1f(EXPONENT, eye_dome->exponent);
    glUniform1ui(IS_ORTHOGRAPHIC, eye_dome->orthographic);
    glUniform1ui(WITH_BYTES, eye_dome->rgba8 != NULL);
    *group_count = (uint64_t)((eye_dome->width_px + SIDE_PX - 1) / SIDE_PX) * ((eye_dome->height_px + SIDE_PX - 1) / SIDE_PX);
    return EWA_OK;
}
