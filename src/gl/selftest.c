// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The trial of a device's arithmetic: two small programs over numbers that are hard to round. OpenGL lets a device round a
// quotient, a root and fma() as it likes, and forbids little; so what it does is found out, not asked for.
#include "gl/selftest.h"
#include "gl/memory.h"
#include "gl/shaders.h"
#include "gl/tuning.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define WIDE_PORTABLE
#include "wide/wide_functions.h"

enum { COUNT = 1 << 14, WORDS = 10, SINGLES = 8, GROUP = 64, LANES = 16 };

/// As selftest.glsl has them.
typedef struct numbers {
    float a, b, c, n, m, x, e, s;
} numbers;

typedef struct trial_memory {
    numbers inputs[COUNT];
    uint32_t results[COUNT][WORDS];
    float wanted[COUNT][WORDS];
} trial_memory;

static uint64_t next_random(uint64_t *state) {
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

/// A number with random digits and an exponent in [-range, range].
static float any_number(uint64_t *state, int range) {
    const uint64_t bits = next_random(state);
    const float digits = 1 + (float)(bits & 0x7fffff) * 0x1p-23f;
    const int exponent = (int)((bits >> 32) % (uint64_t)(2 * range + 1)) - range;
    return ldexpf(bits >> 63 ? -digits : digits, exponent);
}

/// Sets n / m to less than 2^-20 of the last place from half-way between two numbers: n 2^25 = middle m - rest, for a middle
/// of 25 digits.
static void set_middle_quotient(uint64_t *state, numbers *v) {
    const uint32_t m = (uint32_t)(next_random(state) % (1u << 23)) | 1u << 23 | 1u;
    uint32_t inverse = m; // modulo 2^3, then twice as many digits each time
    for (int i = 0; i < 4; i++) inverse *= 2 - m * inverse;
    const uint32_t mask = (1u << 25) - 1;
    uint32_t rest = 1;
    while ((inverse * rest & mask) < 1u << 24) rest += 2;
    const uint64_t product = (uint64_t)(inverse * rest & mask) * m;
    v->m = (float)m, v->n = (float)((product - rest) >> 25);
}

static numbers any_numbers(uint64_t *state, uint32_t kind) {
    enum { KINDS = 4, FAR = 30, NEAR = 3 };
    const int range = kind & KINDS ? FAR : NEAR;
    numbers v = {.a = any_number(state, range), .b = any_number(state, range), .c = any_number(state, range)};
    v.n = any_number(state, range), v.m = fabsf(any_number(state, range));
    v.x = fabsf(any_number(state, 2 * range));
    v.e = any_number(state, 6);
    v.s = (float)(next_random(state) >> 40) * 0x1p-24f;
    switch (kind % KINDS) {
    case 1: // what is left where nearly all cancels
        v.c = -(v.a * v.b);
        break;
    case 2: { // a product half-way between two numbers, and next to nothing beside it
        const float first = (float)(next_random(state) % 1300 | 1u) + 4096,
                    second = (float)(next_random(state) % 1300 | 1u) + 4096;
        v.a = first, v.b = second, v.c = v.c < 0 ? -0x1p-30f : 0x1p-30f;
        break;
    }
    case 3:
        set_middle_quotient(state, &v);
        break;
    default:
        break;
    }
    return v;
}

/// Whether two results agree; numbers without all digits and beyond all are left to the device.
static bool agree(uint32_t bits, float wanted) {
    if (wanted != 0 && !isnormal(wanted)) return true;
    uint32_t wanted_bits;
    memcpy(&wanted_bits, &wanted, sizeof wanted_bits);
    return bits == wanted_bits;
}

static bool all_agree(const trial_memory *memory, uint32_t word) {
    for (uint32_t i = 0; i < COUNT; i++)
        if (!agree(memory->results[i][word], memory->wanted[i][word])) return false;
    return true;
}

/// Whether the words of a double agree.
static bool agree_double(const uint32_t words[2], double wanted) {
    const uint64_t bits = (uint64_t)words[1] << 32 | words[0];
    return memcmp(&bits, &wanted, sizeof bits) == 0;
}

/// Sets which of a device's own operations are correctly rounded, and whether it has numbers below the normal ones. Returns what else is wrong, that nothing helps; NULL: nothing.
static const char *evaluate_own(trial_memory *memory, ewa_gl_arithmetic *own, bool *subnormals) {
    bool doubles = true;
    *subnormals = own->double_quotients = true;
    for (uint32_t i = 0; i < COUNT; i++) {
        const numbers *v = &memory->inputs[i];
        const double product = (double)v->a * (double)v->b, sum = product + (double)v->c;
        float *wanted = memory->wanted[i];
        wanted[0] = fmaf(v->a, v->b, v->c), wanted[1] = v->n / v->m, wanted[2] = sqrtf(v->x);
        wanted[3] = v->a * v->b + v->c, wanted[4] = (float)((double)v->a * ((double)v->b + (double)v->n * 0x1p-30));
        const double quotient = ((double)v->b + (double)v->n * 0x1p-30) / ((double)v->a + (double)v->m * 0x1p-30);
        doubles &= agree_double(&memory->results[i][5], sum);
        own->double_quotients &= agree_double(&memory->results[i][7], quotient);
        const float small = v->s * 0x1p-126f;
        *subnormals &= memcmp(&memory->results[i][9], &small, sizeof small) == 0;
    }
    own->fused = all_agree(memory, 0), own->divides = all_agree(memory, 1), own->roots = all_agree(memory, 2);
    if (!all_agree(memory, 3)) return "sum of a product"; // made one operation, although it is `precise`
    return doubles && all_agree(memory, 4) ? NULL : "double precision";
}

/// Numbers `member` of sixteen inputs.
static wf take(const numbers *inputs, size_t member) {
    float lanes[LANES];
    for (int i = 0; i < LANES; i++) memcpy(&lanes[i], (const char *)&inputs[i] + member, sizeof lanes[i]);
    return wf_load(lanes);
}

#define TAKE(member) take(inputs, offsetof(numbers, member))

/// Names the first operation of the pipeline that differs; NULL: none does.
static const char *find_difference(trial_memory *memory) {
    for (uint32_t i = 0; i < COUNT; i += LANES) {
        const numbers *inputs = &memory->inputs[i];
        const wf x = TAKE(x), s = TAKE(s);
        const wf wanted[SINGLES] = {wf_fma(TAKE(a), TAKE(b), TAKE(c)),
                                  wf_div(TAKE(n), TAKE(m)),
                                  wf_sqrt(x),
                                  wf_reciprocal(x),
                                  wf_inverse_root(x),
                                  wf_log2(x),
                                  wf_exp2(TAKE(e)),
                                  wf_odd_product(s, s)};
        for (int w = 0; w < SINGLES; w++) {
            float lanes[LANES];
            wf_store(lanes, wanted[w]);
            for (uint32_t k = 0; k < LANES; k++) memory->wanted[i + k][w] = lanes[k];
        }
    }
    static const char *const names[SINGLES] = {
        "fma",          "division",  "square root", "reciprocal",
        "inverse root", "logarithm", "power of 2",  "product rounded to odd"};
    for (uint32_t w = 0; w < SINGLES; w++)
        if (!all_agree(memory, w)) return names[w];
    for (uint32_t i = 0; i < COUNT; i++) {
        const numbers *v = &memory->inputs[i];
        double a = (double)v->a + (double)v->n * 0x1p-30, b = (double)v->b + (double)v->m * 0x1p-30;
        double c = i & 1 ? -(a * b) : (double)v->c + (double)v->x * 0x1p-30;
        if ((i & 3) == 2) // half-way between two numbers, but for next to nothing
            a = 1 + 0x1p-30, b = 1 - 0x1p-30, c = 0x1p53 + 2 * (double)floorf(v->s * 0x1p20f);
        const bool divides = (i & 7) == 5;
        const double result = divides ? ((double)v->c + (double)v->x * 0x1p-30) / b : fma(a, b, c);
        if (!agree_double(&memory->results[i][SINGLES], result)) return divides ? "division of doubles" : "fma of doubles";
    }
    return NULL;
}

/// Runs the program over all inputs.
static ewa_status run(ewa_gl *device, const ewa_gl_arithmetic *arithmetic, bool native,
                      const ewa_gl_buffer *inputs, const ewa_gl_buffer *results, trial_memory *memory) {
    char head[EWA_GL_HEAD_BYTES + 32];
    const size_t at = ewa_gl_head_write(arithmetic, head);
    snprintf(head + at, sizeof head - at, "#define NATIVE %d\n", native);
    static const char *const pieces[] = {ewa_shader_wide, ewa_shader_selftest};
    const ewa_gl_stage stage = {GL_COMPUTE_SHADER, head, pieces, 2};
    GLuint program = 0;
    EWA_TRY(ewa_gl_program_make(device, "self-test", &stage, 1, &program));
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, inputs->name);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, results->name);
    glUseProgram(program);
    glDispatchCompute(COUNT / GROUP, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    ewa_status status = ewa_gl_wait(device, "the self-test");
    if (status == EWA_OK) {
        glBindBuffer(GL_COPY_READ_BUFFER, results->name);
        glGetBufferSubData(GL_COPY_READ_BUFFER, 0, sizeof memory->results, memory->results);
        status = ewa_gl_check(device, "the self-test");
    }
    glUseProgram(0);
    glDeleteProgram(program);
    return status;
}

/// The device's own operations, then those that the pipeline will use.
static ewa_status evaluate(ewa_gl *device, const ewa_gl_buffer *inputs, const ewa_gl_buffer *results,
                           trial_memory *memory, ewa_gl_verdict *verdict) {
    ewa_gl_arithmetic *use = &verdict->arithmetic;
    EWA_TRY(run(device, use, true, inputs, results, memory));
    verdict->differs = evaluate_own(memory, &verdict->own, &verdict->subnormals);
    *use = verdict->own;
    if (ewa_gl_tuning_is("arith", "emulated")) *use = (ewa_gl_arithmetic){.fused = false};
    if (ewa_gl_tuning_is("arith", "close")) *use = (ewa_gl_arithmetic){true, true, true, true};
    if (!verdict->differs) {
        EWA_TRY(run(device, use, false, inputs, results, memory));
        verdict->differs = find_difference(memory);
        verdict->exact = !verdict->differs;
    }
    return EWA_OK;
}

ewa_status ewa_gl_selftest(ewa_gl *device, ewa_gl_verdict *verdict) {
    *verdict = (ewa_gl_verdict){.exact = false};
    trial_memory *memory = ewa_allocate(device->context, 1, sizeof *memory);
    if (!memory) return EWA_ERROR_MEMORY;
    uint64_t state = 1;
    for (uint32_t i = 0; i < COUNT; i++) memory->inputs[i] = any_numbers(&state, i);
    ewa_gl_buffer inputs = {0}, results = {0};
    ewa_status status =
        ewa_gl_buffer_put(device, &inputs, "the self-test", memory->inputs, sizeof memory->inputs);
    if (status == EWA_OK)
        status = ewa_gl_buffer_reserve(device, &results, "the self-test", sizeof memory->results);
    if (status == EWA_OK) status = evaluate(device, &inputs, &results, memory, verdict);
    if (!device->lost) {
        ewa_gl_buffer_free(&inputs);
        ewa_gl_buffer_free(&results);
    }
    ewa_release(device->context, memory, 1, sizeof *memory);
    return status;
}
