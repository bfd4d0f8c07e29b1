// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Rates of compute programs.
#include "rates.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { RUNS = 5, THREADS = 64, TILE_PX = 16, TILES = PROBE_WIDTH_PX / TILE_PX * (PROBE_HEIGHT_PX / TILE_PX) };
enum { CHANNELS = 7, PIXELS = PROBE_WIDTH_PX * PROBE_HEIGHT_PX, FMA_STEPS = 1024, FMA_CHAINS = 8 };

static const char head[] = "#version 430 core\n";

static const char fma_source[] =
    "layout(local_size_x = 64) in;\n"
    "layout(std430, binding = 0) writeonly buffer Results { float results[]; };\n"
    "uniform float by;\n"
    "void main() {\n"
    "    NUMBER a[8];\n"
    "    NUMBER factor = NUMBER(by), half_ = NUMBER(0.5);\n"
    "    for (int k = 0; k < 8; k++) a[k] = NUMBER(gl_LocalInvocationID.x + uint(k));\n"
    "    for (int i = 0; i < 1024; i++) {\n"
    "        a[0] = fma(a[0], factor, half_); a[1] = fma(a[1], factor, half_); a[2] = fma(a[2], factor, half_);\n"
    "        a[3] = fma(a[3], factor, half_); a[4] = fma(a[4], factor, half_); a[5] = fma(a[5], factor, half_);\n"
    "        a[6] = fma(a[6], factor, half_); a[7] = fma(a[7], factor, half_);\n"
    "    }\n"
    "    NUMBER sum = NUMBER(0);\n"
    "    for (int k = 0; k < 8; k++) sum += a[k];\n"
    "    results[gl_GlobalInvocationID.x & 4095u] = float(sum);\n"
    "}\n";

/// Splat i is somewhere in tile i / per_tile, cut at its sides; it adds seven whole numbers to each of its pixels.
static const char splat_source[] =
    "layout(local_size_x = 256) in;\n"
    "layout(std430, binding = 0) buffer Sums { uint sums[]; };\n"
    "uniform uint per_tile, first_tile;\n"
    "uvec2 place(uint i) { uint h = i * 2654435761u; h ^= h >> 15; h *= 2246822519u; h ^= h >> 13;\n"
    "                      return uvec2(h & 15u, h >> 4 & 15u); }\n"
    "uint weight(vec2 d) { float r2 = dot(d, d); float e = fma(r2, 0.0039, -0.0937);\n"
    "                      e = fma(r2, e, 0.5); e = fma(r2, -e, 1.0); return uint(max(e, 0.0) * 4096.0); }\n"
    "uint slot(uint tile, uvec2 p, uint c) {\n"
    "    return (c * 5120u + tile) * 256u + p.y * 16u + p.x; }\n"
    "shared uint data[7 * 256];\n"
    "void main() {\n"
    "    uint thread = gl_LocalInvocationID.x, tile = first_tile + gl_WorkGroupID.x, first = tile * "
    "per_tile;\n"
    "#if WAY == 0\n"
    "    uvec2 me = uvec2(thread & 15u, thread >> 4);\n"
    "    uint own[7] = uint[7](0u, 0u, 0u, 0u, 0u, 0u, 0u);\n"
    "    for (uint done = 0u; done < per_tile; done += 256u) {\n"
    "        barrier();\n"
    "        uvec2 at = place(first + done + thread);\n"
    "        data[thread] = at.x | at.y << 16;\n"
    "        barrier();\n"
    "        uint count = min(256u, per_tile - done);\n"
    "        for (uint i = 0u; i < count; i++) {\n"
    "            ivec2 d = ivec2(me) - ivec2(data[i] & 0xffffu, data[i] >> 16);\n"
    "            if (max(abs(d.x), abs(d.y)) > 2) continue;\n"
    "            uint w = weight(vec2(d));\n"
    "            for (uint c = 0u; c < 7u; c++) own[c] += w * (c + 1u);\n"
    "        }\n"
    "    }\n"
    "    for (uint c = 0u; c < 7u; c++) atomicAdd(sums[slot(tile, me, c)], own[c]);\n"
    "#else\n"
    "#if WAY == 1\n"
    "    for (uint c = 0u; c < 7u; c++) data[c * 256u + thread] = 0u;\n"
    "    barrier();\n"
    "#endif\n"
    "    for (uint i = thread; i < per_tile; i += 256u) {\n"
    "        ivec2 at = ivec2(place(first + i)), low = max(at - 2, 0), high = min(at + 2, 15);\n"
    "        for (int y = low.y; y <= high.y; y++)\n"
    "            for (int x = low.x; x <= high.x; x++) {\n"
    "                uint w = weight(vec2(ivec2(x, y) - at));\n"
    "                for (uint c = 0u; c < 7u; c++)\n"
    "#if WAY == 1\n"
    "                    atomicAdd(data[c * 256u + uint(y * 16 + x)], w * (c + 1u));\n"
    "#else\n"
    "                    atomicAdd(sums[slot(tile, uvec2(x, y), c)], w * (c + 1u));\n"
    "#endif\n"
    "            }\n"
    "    }\n"
    "#if WAY == 1\n"
    "    barrier();\n"
    "    for (uint c = 0u; c < 7u; c++)\n"
    "        atomicAdd(sums[slot(tile, uvec2(thread & 15u, thread >> 4), c)], data[c * 256u + thread]);\n"
    "#endif\n"
    "#endif\n"
    "}\n";

double probe_time(ewa_gl *device, probe_work *work, void *user) {
    GLuint query = 0;
    glGenQueries(1, &query);
    double min_s = INFINITY;
    for (int run = -1; run < RUNS; run++) {
        if (ewa_gl_wait(device, "the probe") != EWA_OK) return INFINITY;
        const double start_s = ewa_now_s();
        glBeginQuery(GL_TIME_ELAPSED, query);
        work(user);
        glEndQuery(GL_TIME_ELAPSED);
        if (ewa_gl_wait(device, "the probe") != EWA_OK) return INFINITY;
        const double wall_s = ewa_now_s() - start_s;
        GLuint64 ns = 0;
        glGetQueryObjectui64v(query, GL_QUERY_RESULT, &ns);
        // Software counts what it was told and not what it did.
        const double took_s = ns && !device->facts.software ? 1e-9 * (double)ns : wall_s;
        if (run >= 0 && took_s < min_s) min_s = took_s;
    }
    glDeleteQueries(1, &query);
    return min_s;
}

/// A dispatch, and the buffer that is cleared before it.
typedef struct dispatch_work {
    GLuint program, group_count;
    const ewa_gl_buffer *cleared; ///< NULL: none
} dispatch_work;

static void dispatch(void *user) {
    const dispatch_work *work = user;
    if (work->cleared) ewa_gl_buffer_fill(work->cleared, work->cleared->size_bytes, 0);
    glUseProgram(work->program);
    glDispatchCompute(work->group_count, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

static ewa_status make(ewa_gl *device, const char *first, const char *source, GLuint *program) {
    const char *pieces[] = {first, source};
    const ewa_gl_stage stage = {GL_COMPUTE_SHADER, head, pieces, 2};
    return ewa_gl_program_make(device, "probe", &stage, 1, program);
}

/// The rate of fma() in floats or doubles.
static ewa_status measure_fma(ewa_gl *device, const ewa_gl_buffer *buffer, const char *number, double *tflops) {
    GLuint program = 0;
    const ewa_status status = make(device, number, fma_source, &program);
    if (status != EWA_OK) return status;
    glProgramUniform1f(program, glGetUniformLocation(program, "by"), 0.999f);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer->name);
    // Drivers end what takes seconds.
    enum { MIN_GROUPS = 1 << 8, MAX_GROUPS = 1 << 16 };
    dispatch_work work = {program, MIN_GROUPS, NULL};
    double took_s = probe_time(device, dispatch, &work);
    while (took_s < 0.02 && work.group_count < MAX_GROUPS &&
           work.group_count < device->facts.group_count / 2) {
        work.group_count *= 2;
        took_s = probe_time(device, dispatch, &work);
    }
    *tflops = 2e-12 * FMA_STEPS * FMA_CHAINS * THREADS * work.group_count / took_s;
    glDeleteProgram(program);
    return ewa_gl_check(device, "the rate of fma()");
}

static ewa_status measure_ways(ewa_gl *device, const ewa_gl_buffer *sums, probe_rates *rates) {
    const uint32_t per_tile = rates->splat_count / TILES;
    const size_t size_bytes = (size_t)CHANNELS * PIXELS * sizeof(uint32_t);
    uint8_t *first = ewa_allocate(device->context, 2, size_bytes);
    if (!first) return EWA_ERROR_MEMORY;
    ewa_status status = EWA_OK;
    rates->ways_agree = true;
    for (int way = 0; way < PROBE_WAYS && status == EWA_OK; way++) {
        static const char *const ways[] = {"#define WAY 0\n", "#define WAY 1\n", "#define WAY 2\n"};
        GLuint program = 0;
        status = make(device, ways[way], splat_source, &program);
        if (status != EWA_OK) break;
        glProgramUniform1ui(program, glGetUniformLocation(program, "per_tile"), per_tile);
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, sums->name);
        dispatch_work work = {program, TILES, sums};
        rates->way_ms[way] = 1e3 * probe_time(device, dispatch, &work);
        glDeleteProgram(program);
        glBindBuffer(GL_COPY_READ_BUFFER, sums->name);
        glGetBufferSubData(GL_COPY_READ_BUFFER, 0, (GLsizeiptr)size_bytes, first + (way ? size_bytes : 0));
        if (way) rates->ways_agree &= memcmp(first, first + size_bytes, size_bytes) == 0;
        status = ewa_gl_check(device, "adding up");
    }
    ewa_release(device->context, first, 2, size_bytes);
    return status;
}

static ewa_status measure_readback(ewa_gl *device, const ewa_gl_buffer *buffer, probe_rates *rates) {
    const size_t size_bytes = (size_t)PIXELS * 4;
    void *to = ewa_allocate(device->context, 1, size_bytes);
    if (!to) return EWA_ERROR_MEMORY;
    double min_s = INFINITY;
    for (int run = -1; run < RUNS; run++) {
        const double start_s = ewa_now_s();
        glBindBuffer(GL_COPY_READ_BUFFER, buffer->name);
        glGetBufferSubData(GL_COPY_READ_BUFFER, 0, (GLsizeiptr)size_bytes, to);
        const double took_s = ewa_now_s() - start_s;
        if (run >= 0 && took_s < min_s) min_s = took_s;
    }
    ewa_release(device->context, to, 1, size_bytes);
    rates->readback_ms = 1e3 * min_s, rates->readback_mb = 1e-6 * (double)size_bytes;
    return ewa_gl_check(device, "reading back");
}

ewa_status probe_measure(ewa_gl *device, probe_rates *rates) {
    enum { MILLION = 1 << 20, SOFTWARE = 1 << 16 };
    *rates = (probe_rates){.splat_count = device->facts.software ? SOFTWARE : MILLION};
    rates->splat_count -= rates->splat_count % TILES;
    ewa_gl_buffer sums = {0};
    ewa_status status =
        ewa_gl_buffer_reserve(device, &sums, "the probe", (uint64_t)CHANNELS * PIXELS * sizeof(uint32_t));
    if (status == EWA_OK) status = measure_fma(device, &sums, "#define NUMBER float\n", &rates->fma_tflops);
    if (status == EWA_OK) status = measure_fma(device, &sums, "#define NUMBER double\n", &rates->double_tflops);
    if (status == EWA_OK) status = measure_ways(device, &sums, rates);
    if (status == EWA_OK) status = measure_readback(device, &sums, rates);
    if (status == EWA_OK) status = probe_latencies(device, &sums, rates);
    if (status == EWA_OK) status = probe_blending(device, 32, rates->splat_count, &rates->blend32_gpx_s);
    if (status == EWA_OK) status = probe_blending(device, 16, rates->splat_count, &rates->blend16_gpx_s);
    if (!device->lost) ewa_gl_buffer_free(&sums);
    return status;
}
