// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Averages of the parts of pixels by the device.
#include "gl/averages.h"

ewa_status ewa_gl_averages_use(ewa_gl_compute *gl, const ewa_gl_result *result, const ewa_tile_job *job, ewa_gl_rows rows,
                            uint64_t *group_count) {
    enum { SIDE_PX = 8 }; // of a group
    enum { FINER, MEANS_AT };
    const ewa_gl_variant v = {.pass = EWA_GL_AVERAGES};
    GLuint program = 0;
    EWA_TRY(ewa_gl_variant_get(gl->device, &gl->variants, &v, &program));
    glUseProgram(program);
    glUniform1ui(FINER, result->finer);
    const ewa_gl_plane *planes = result->planes;
    glUniform4i(MEANS_AT, (GLint)planes[EWA_GL_COLORS].mean_at, (GLint)planes[EWA_GL_DEPTHS].mean_at,
                (GLint)planes[EWA_GL_NORMALS].mean_at, (GLint)planes[EWA_GL_COVERAGES].mean_at);
    const uint32_t width_px = job->tiles.width_px / result->finer, height_px = (rows.end_px - rows.first_px) / result->finer;
    *group_count = (uint64_t)((width_px + SIDE_PX - 1) / SIDE_PX) * ((height_px + SIDE_PX - 1) / SIDE_PX);
    return EWA_OK;
}
