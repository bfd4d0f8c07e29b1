// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a frame pays beside its work: waits, dispatches, uploads, clears, programs.
#include "gl/variant.h"
#include "rates.h"

#include <stdio.h>
#include <string.h>

enum { DISPATCHES = 256, RUNS = 5 };

static const char head[] = "#version 430 core\n";

static const char empty_source[] = "layout(local_size_x = 64) in;\n"
                                   "layout(std430, binding = 0) buffer Results { uint results[]; };\n"
                                   "void main() { if (results[0] == 77u) results[1] = 1u; }\n";

/// What is done, and of what.
typedef struct work {
    const ewa_gl_buffer *buffer;
    const void *bytes;
    uint64_t size_bytes;
} work;

static void dispatch_many(void *user) {
    (void)user;
    for (int i = 0; i < DISPATCHES; i++) {
        glDispatchCompute(1, 1, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    }
}

static void upload(void *user) {
    const work *w = user;
    glBindBuffer(GL_COPY_WRITE_BUFFER, w->buffer->name);
    glBufferSubData(GL_COPY_WRITE_BUFFER, 0, (GLsizeiptr)w->size_bytes, w->bytes);
}

static void clear(void *user) {
    const work *w = user;
    ewa_gl_buffer_fill(w->buffer, w->size_bytes, 0);
}

/// The shortest wall time from one dispatch to its end.
static double measure_wait(ewa_gl *device) {
    double min_s = 1;
    for (int run = -1; run < RUNS; run++) {
        const double start_s = ewa_now_s();
        glDispatchCompute(1, 1, 1);
        if (ewa_gl_wait(device, "the probe") != EWA_OK) return 0;
        const double took_s = ewa_now_s() - start_s;
        if (run >= 0 && took_s < min_s) min_s = took_s;
    }
    return min_s;
}

/// Makes the set-up program of the pipeline as no cache has it; by the wall.
static ewa_status measure_compiler(ewa_gl *device, double *took_s) {
    const ewa_gl_arithmetic arithmetic = {true, true, true, true};
    const ewa_gl_variant variant = {.pass = EWA_GL_SETUP};
    ewa_gl_source source;
    ewa_gl_variant_write(&arithmetic, &variant, &source);
    const double start_s = ewa_now_s();
    const size_t at = strlen(source.head);
    snprintf(source.head + at, sizeof source.head - at, "#undef MIN_KEY\n#define MIN_KEY %.9f\n", start_s);
    const ewa_gl_stage stage = {GL_COMPUTE_SHADER, source.head, source.pieces, source.piece_count};
    GLuint program = 0;
    const ewa_status status = ewa_gl_program_make(device, "set-up", &stage, 1, &program);
    *took_s = ewa_now_s() - start_s;
    glDeleteProgram(program);
    return status;
}

ewa_status probe_latencies(ewa_gl *device, const ewa_gl_buffer *buffer, probe_rates *rates) {
    const char *piece = empty_source;
    const ewa_gl_stage stage = {GL_COMPUTE_SHADER, head, &piece, 1};
    GLuint program = 0;
    ewa_status status = ewa_gl_program_make(device, "nothing", &stage, 1, &program);
    if (status != EWA_OK) return status;
    work w = {.buffer = buffer, .size_bytes = (uint64_t)PROBE_WIDTH_PX * PROBE_HEIGHT_PX * 4};
    void *bytes = ewa_allocate_zeroed(device->context, 1, w.size_bytes);
    if (!bytes) return EWA_ERROR_MEMORY;
    w.bytes = bytes;
    glUseProgram(program);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer->name);
    rates->wait_ms = 1e3 * measure_wait(device);
    rates->dispatch_ms = 1e3 * probe_time(device, dispatch_many, NULL) / DISPATCHES;
    rates->upload_ms = 1e3 * probe_time(device, upload, &w);
    rates->clear_ms = 1e3 * probe_time(device, clear, &w);
    ewa_release(device->context, bytes, 1, w.size_bytes);
    glUseProgram(0);
    glDeleteProgram(program);
    double compile_s = 0;
    status = measure_compiler(device, &compile_s);
    rates->compile_ms = 1e3 * compile_s;
    return status == EWA_OK ? ewa_gl_check(device, "waiting") : status;
}
