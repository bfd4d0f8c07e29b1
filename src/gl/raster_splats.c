// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Splats as instanced boxes: four vertices each, their attributes those of a surfel and of its packet.
#include "gl/raster_splats.h"

#include <stddef.h>

enum {
    CORNERS = 4,
    SURFEL_ATTRIBUTES = 5,
    PACKET_ATTRIBUTES = 3,
    MATERIAL = SURFEL_ATTRIBUTES + PACKET_ATTRIBUTES,
    PACKETS_PER_WAIT = 1 << 16 // so that a slow device does not count as hung
};

/// Where a run's surfels and packets are.
static void set_attributes(const ewa_raster *raster, const ewa_tile_job *job, const ewa_raster_run *run) {
    static const struct {
        GLint count;
        GLenum kind;
        bool whole;
        size_t at;
    } forms[SURFEL_ATTRIBUTES + PACKET_ATTRIBUTES] = {
        {4, GL_FLOAT, false, offsetof(ewa_raster_surfel, x)},
        {2, GL_SHORT, true, offsetof(ewa_raster_surfel, oct_x)},
        {2, GL_UNSIGNED_SHORT, true, offsetof(ewa_raster_surfel, angle)},
        {4, GL_UNSIGNED_SHORT, true, offsetof(ewa_raster_surfel, red)},
        {1, GL_FLOAT, false, offsetof(ewa_raster_surfel, curvature)},
        {4, GL_FLOAT, false, offsetof(ewa_raster_packet, base_px)},
        {3, GL_FLOAT, false, offsetof(ewa_raster_packet, rest)},
        {4, GL_UNSIGNED_INT, true, offsetof(ewa_raster_packet, form)},
    };
    const uint32_t *indices = raster->indices.data;
    const ewa_raster_resident *resident = ewa_raster_residents_at(&raster->residents, indices[run->source]);
    glBindBuffer(GL_ARRAY_BUFFER, resident->pages[run->page].surfels.name);
    for (GLuint i = 0; i < SURFEL_ATTRIBUTES + PACKET_ATTRIBUTES; i++) {
        const bool of_packet = i >= SURFEL_ATTRIBUTES;
        if (i == SURFEL_ATTRIBUTES) glBindBuffer(GL_ARRAY_BUFFER, raster->packets.name);
        const GLsizei stride = of_packet ? sizeof(ewa_raster_packet) : sizeof(ewa_raster_surfel);
        const size_t first = of_packet ? run->record : (size_t)run->first * EWA_PACKET_LANES;
        const void *at = (const void *)(first * (size_t)stride + forms[i].at);
        glEnableVertexAttribArray(i);
        glVertexAttribDivisor(i, of_packet ? EWA_PACKET_LANES : 1);
        if (forms[i].whole)
            glVertexAttribIPointer(i, forms[i].count, forms[i].kind, stride, at);
        else
            glVertexAttribPointer(i, forms[i].count, forms[i].kind, GL_FALSE, stride, at);
    }
    const GLuint materials = resident->pages[run->page].materials.name;
    if (materials) {
        glBindBuffer(GL_ARRAY_BUFFER, materials);
        glEnableVertexAttribArray(MATERIAL);
        glVertexAttribDivisor(MATERIAL, 1);
        glVertexAttribIPointer(MATERIAL, 1, GL_UNSIGNED_BYTE, 1,
                               (const void *)((size_t)run->first * EWA_PACKET_LANES));
    } else {
        glDisableVertexAttribArray(MATERIAL);
        glVertexAttribI4ui(MATERIAL, job->sources[run->source].surfels->material, 0, 0, 1);
    }
    glActiveTexture(GL_TEXTURE0 + EWA_PICTURE_OTHER);
    glBindTexture(GL_TEXTURE_2D, resident->lines);
    glBindBufferRange(GL_UNIFORM_BUFFER, 0, raster->view_blocks.name,
                      (GLintptr)run->source * EWA_RASTER_VIEW_STRIDE, sizeof(ewa_raster_view));
}

static void set_int(GLuint program, const char *name, int32_t value) {
    glUniform1i(glGetUniformLocation(program, name), value);
}

ewa_status ewa_raster_draw_splats(ewa_raster *raster, const ewa_tile_job *job, ewa_raster_pass pass,
                                  bool is_back, bool behind, bool whole) {
    const ewa_raster_form plain = job->view.raycast ? EWA_RASTER_RAYCAST : EWA_RASTER_ELLIPSES;
    const ewa_raster_run *runs = raster->band.runs.data;
    uint64_t told = 0; // packets that the device has not been waited for
    glBindVertexArray(raster->vertices);
    for (int near = 0; near < 2; near++) {
        GLuint program = 0;
        for (uint32_t i = 0; i < raster->band.run_count; i++) {
            if (near && !runs[i].near) continue;
            if (pass == EWA_RASTER_VISIBILITY && !job->sources[runs[i].source].hides) continue;
            if (!program) {
                EWA_TRY(ewa_raster_splat_program(raster->device, &raster->programs, pass,
                                                 near ? EWA_RASTER_NEAR : plain, job->with_clips, &program));
                glUseProgram(program);
                set_int(program, "back_facing_only",
                        pass == EWA_RASTER_VISIBILITY || pass == EWA_RASTER_SINGLE ? -1 : is_back);
                set_int(program, "behind", behind);
                set_int(program, "whole", whole);
                // Nothing is nearer than 2^-24 of the scene's size.
                glUniform1f(glGetUniformLocation(program, "depth_unit"),
                            job->view.orthographic ? job->view.depth_scale : 0x1p-24f);
            }
            set_attributes(raster, job, &runs[i]);
            glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, CORNERS, (GLsizei)(runs[i].count * EWA_PACKET_LANES));
            told += runs[i].count;
            if (told < PACKETS_PER_WAIT) continue;
            EWA_TRY(ewa_gl_wait(raster->device, "splats"));
            told = 0;
        }
    }
    return ewa_gl_check(raster->device, "splats");
}
