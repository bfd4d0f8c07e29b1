// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Programs for the device, from pieces of source.
#include "gl/program.h"

enum { MAX_PIECES = 16, WORDS_BYTES = 1024 };

static ewa_status compile(ewa_gl *device, const char *name, const ewa_gl_stage *stage, GLuint *shader) {
    const char *sources[MAX_PIECES + 1];
    uint32_t count = 0;
    sources[count++] = stage->head;
    for (uint32_t i = 0; i < stage->piece_count && i < MAX_PIECES; i++) sources[count++] = stage->pieces[i];
    *shader = glCreateShader(stage->kind);
    glShaderSource(*shader, (GLsizei)count, sources, NULL);
    glCompileShader(*shader);
    GLint compiled = 0;
    glGetShaderiv(*shader, GL_COMPILE_STATUS, &compiled);
    if (compiled) return EWA_OK;
    char words[WORDS_BYTES] = "";
    glGetShaderInfoLog(*shader, sizeof words, NULL, words);
    return ewa_fail(device->context, EWA_ERROR_UNSUPPORTED, "OpenGL: %s does not compile '%s': %s",
                    device->facts.renderer, name, words);
}

static ewa_status link(ewa_gl *device, const char *name, GLuint program) {
    glLinkProgram(program);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked) return EWA_OK;
    char words[WORDS_BYTES] = "";
    glGetProgramInfoLog(program, sizeof words, NULL, words);
    return ewa_fail(device->context, EWA_ERROR_UNSUPPORTED, "OpenGL: %s does not link '%s': %s",
                    device->facts.renderer, name, words);
}

ewa_status ewa_gl_program_make(ewa_gl *device, const char *name, const ewa_gl_stage *stages,
                               uint32_t stage_count, GLuint *program) {
    *program = glCreateProgram();
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < stage_count && status == EWA_OK; i++) {
        GLuint shader = 0;
        status = compile(device, name, &stages[i], &shader);
        if (status == EWA_OK) glAttachShader(*program, shader);
        glDeleteShader(shader); // as soon as the program goes
    }
    if (status == EWA_OK) status = link(device, name, *program);
    if (status != EWA_OK) {
        glDeleteProgram(*program);
        *program = 0;
    }
    return status;
}

void ewa_gl_program_run(ewa_gl *device, uint64_t group_count) {
    const uint64_t most = device->facts.group_count, columns = group_count < most ? group_count : most;
    if (!group_count) return;
    glDispatchCompute((GLuint)columns, (GLuint)((group_count + columns - 1) / columns), 1);
    device->counts.dispatches++;
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}
