// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The rate of blending: squares drawn over each other into floats, as the raster pipeline does.
#include "rates.h"

static const char head[] = "#version 330 core\n";

static const char vertex_source[] =
    "uniform vec2 size_px;\n"
    "uniform float side_px;\n"
    "void main() {\n"
    "    uint h = uint(gl_InstanceID) * 2654435761u;\n"
    "    h ^= h >> 15; h *= 2246822519u; h ^= h >> 13;\n"
    "    vec2 low = floor(vec2(float(h & 0xffffu), float(h >> 16)) / 65536.0 * (size_px - side_px));\n"
    "    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));\n"
    "    gl_Position = vec4((low + corner * side_px) / size_px * 2.0 - 1.0, 0.0, 1.0);\n"
    "}\n";

static const char fragment_source[] = "out vec4 color;\n"
                                      "void main() { color = vec4(0.001, 0.002, 0.003, 0.004); }\n";

static void draw(void *user) {
    const GLsizei *count = user;
    glClear(GL_COLOR_BUFFER_BIT);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, *count);
}

static ewa_status make(ewa_gl *device, GLuint *program) {
    const char *vertex = vertex_source, *fragment = fragment_source;
    const ewa_gl_stage stages[] = {{GL_VERTEX_SHADER, head, &vertex, 1},
                                   {GL_FRAGMENT_SHADER, head, &fragment, 1}};
    return ewa_gl_program_make(device, "blending", stages, 2, program);
}

ewa_status probe_blending(ewa_gl *device, int bits, uint32_t splat_count, double *gpx_s) {
    GLuint program = 0, texture = 0, target = 0, vertices = 0;
    const ewa_status status = make(device, &program);
    if (status != EWA_OK) return status;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, bits == 32 ? GL_RGBA32F : GL_RGBA16F, PROBE_WIDTH_PX, PROBE_HEIGHT_PX, 0,
                 GL_RGBA, GL_FLOAT, NULL);
    glGenFramebuffers(1, &target);
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    glGenVertexArrays(1, &vertices);
    glBindVertexArray(vertices);
    glUseProgram(program);
    glUniform2f(glGetUniformLocation(program, "size_px"), PROBE_WIDTH_PX, PROBE_HEIGHT_PX);
    glUniform1f(glGetUniformLocation(program, "side_px"), PROBE_SPLAT_PX);
    glViewport(0, 0, PROBE_WIDTH_PX, PROBE_HEIGHT_PX);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    GLsizei count = (GLsizei)splat_count;
    const double took_s = probe_time(device, draw, &count);
    *gpx_s = 1e-9 * splat_count * PROBE_SPLAT_PX * PROBE_SPLAT_PX / took_s;
    glDisable(GL_BLEND);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteVertexArrays(1, &vertices);
    glDeleteFramebuffers(1, &target);
    glDeleteTextures(1, &texture);
    glDeleteProgram(program);
    return ewa_gl_check(device, "blending");
}
