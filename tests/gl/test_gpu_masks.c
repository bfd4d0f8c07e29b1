// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Masks of what a splat may reach (src/gl/shaders/masks.glsl) against the exact test of each pixel, on the device: they never
// leave out a pixel that the test takes, and have hardly more; and keys are within the limits by which hidden splats are left out.
#include "check.h"
#include "gl/compute.h"
#include "gl/shaders.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { RECORDS = 2048, TILE_PX = 8, KINDS = 6 };

/// As shaders/scene.glsl has it.
typedef struct gpu_record {
    float cx, cy, xx, xy, yy, key, key_x, key_y, bound, bound_x, bound_y, key_low, red, green, blue;
    uint32_t box;
    float nx, ny, nz, peak, opacity;
    uint32_t extra, field, clip;
} gpu_record;

static const float exponent_end = 0.78f;

static const char program_text[] =
    "layout(local_size_x = 64) in;\n"
    "layout(std430, binding = 5) readonly buffer RecordBlock { Record records[]; };\n"
    "layout(std430, binding = 7) buffer ResultBlock { uint results[]; };\n"
    "void main() {\n"
    "    Record r = records[group_number() * 64u + gl_LocalInvocationID.x];\n"
    "    View view = views[0];\n"
    "    vec2 middle = vec2(r.cx, r.cy) + 63.5;\n"
    "    uint left_out = 0u, taken = 0u, in_masks = 0u, beyond = 0u;\n"
    "    for (int tile = 0; tile < 256; tile++) {\n"
    "        ivec2 origin = ivec2(tile % 16, tile / 16) * TILE_PX, from, to;\n"
    "        clip_box(r.box, origin, from, to);\n"
    "        vec2 low = vec2(origin + from) - middle, high = vec2(origin + to - 1) - middle;\n"
    "        float least = key_limit(r, low, high, -1.0), most = key_limit(r, low, high, 1.0);\n"
    "        float most_bound = bound_limit(r, low, high, has(view.flags, ORTHOGRAPHIC));\n"
    "        bool rows = has_rows(r);\n"
    "        for (int y = from.y; y < to.y; y++) {\n"
    "            uint bits = rows ? row_mask(r, float(origin.x) - middle.x, float(origin.y) - middle.y + float(y)) : 255u;\n"
    "            for (int x = from.x; x < to.x; x++) {\n"
    "                Sample s = sample_splat(r, vec2(origin + ivec2(x, y)) - 63.5, view);\n"
    "                bool has_bit = (bits >> x & 1u) != 0u;\n"
    "                taken += s.counts ? 1u : 0u;\n"
    "                in_masks += has_bit ? 1u : 0u;\n"
    "                left_out += s.counts && !has_bit ? 1u : 0u;\n"
    "                beyond += s.counts && !(least <= s.key && s.key <= most && s.bound <= most_bound) ? 1u : 0u;\n"
    "            }\n"
    "        }\n"
    "    }\n"
    "    atomicAdd(results[0], left_out);\n"
    "    atomicAdd(results[1], taken);\n"
    "    atomicAdd(results[2], in_masks);\n"
    "    atomicAdd(results[3], beyond);\n"
    "}\n";

/// An ellipse of semi-axes that kinds differ in, and a plane of keys.
static gpu_record random_record(check_random *random, int kind) {
    static const double major_px[KINDS][2] = {{0.3, 2}, {2, 8}, {8, 60}, {60, 1000}, {0.5, 100}, {0.01, 300}};
    static const double min_ratio[KINDS] = {0.5, 0.1, 0.05, 0.2, 0.001, 3e-6};
    const double major = major_px[kind][0] * pow(major_px[kind][1] / major_px[kind][0], check_uniform(random, 0, 1));
    const double minor = major * pow(min_ratio[kind], check_uniform(random, 0, 1));
    const double angle = check_uniform(random, 0, 6.283185307), c = cos(angle), s = sin(angle);
    const double h2 = kind == KINDS - 1 ? 0 : 0.25, a = 1 / (major * major + h2), b = 1 / (minor * minor + h2);
    const double reach = 64 + (kind > 2 ? 2 * major : 4);
    gpu_record r = {.cx = (float)check_uniform(random, -reach, reach), .cy = (float)check_uniform(random, -reach, reach)};
    r.xx = (float)(0.125 * (a * c * c + b * s * s)), r.yy = (float)(0.125 * (a * s * s + b * c * c));
    r.xy = (float)(0.25 * (a - b) * c * s);
    if (check_random_u64(random) % 8 == 0) r.cx = rintf(r.cx) + 0.5f, r.cy = rintf(r.cy) + 0.5f; // right on pixels
    const double z = check_uniform(random, 0.5, 20), tilt = check_uniform(random, 0, 1) / (z * (1 + major));
    r.key = (float)(1 / z), r.key_x = (float)(tilt * cos(3 * angle)), r.key_y = (float)(tilt * sin(3 * angle));
    const double tolerance = check_uniform(random, 0, 0.5), share = z / (z + tolerance);
    const bool steep = check_random_u64(random) % 2;
    r.box = 32u << 16 | 32u << 24 | (steep ? 128u : 0);
    if (steep) {
        const bool wide = check_random_u64(random) % 2;
        r.bound = (float)(wide ? 0 : share * share);
        r.bound_x = (float)(wide ? tolerance : (share - share * share) / z);
        r.bound_y = (float)(1.3 / z), r.key_low = (float)(check_uniform(random, -0.1, 0.9) / z);
    } else {
        r.bound = (float)(share * share / z + (share - share * share) / z);
        r.bound_x = (float)(share * share) * r.key_x, r.bound_y = (float)(share * share) * r.key_y;
        r.key_low = 0;
    }
    return r;
}

/// Counts for records of one kind: left out, taken, in masks, beyond the limits.
static void count(ewa_gl *device, GLuint program, const ewa_gl_buffer buffers[], const gpu_record *records,
                  uint32_t results[4]) {
    static const uint32_t none[4] = {0};
    ewa_gl_buffer_write(device, &buffers[1], 0, records, RECORDS * sizeof *records);
    ewa_gl_buffer_write(device, &buffers[2], 0, none, sizeof none);
    glUseProgram(program);
    glDispatchCompute(RECORDS / 64, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    assert_int_equal(ewa_gl_wait(device, "masks"), EWA_OK);
    glBindBuffer(GL_COPY_READ_BUFFER, buffers[2].name);
    glGetBufferSubData(GL_COPY_READ_BUFFER, 0, 4 * sizeof *results, results);
}

TEST(test_masks) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    ewa_gl *device = NULL;
    assert_int_equal(ewa_gl_open(context, &device), EWA_OK);
    ewa_gl_verdict verdict;
    assert_int_equal(ewa_gl_try(device, &verdict), EWA_OK);
    assert_int_equal(ewa_gl_enter(device), EWA_OK);
    char head[EWA_GL_HEAD_BYTES + 128];
    const size_t at = ewa_gl_head_write(&verdict.arithmetic, head);
    snprintf(head + at, sizeof head - at,
             "#define TILE_PX %d\n#define PASS 1\n#define RAYS 0\n#define WITH_CLIPS 0\n#define WITH_NEARS 0\n", TILE_PX);
    const char *const pieces[] = {ewa_shader_wide, ewa_shader_band, ewa_shader_scene, ewa_shader_splat, ewa_shader_masks,
                                  program_text};
    const ewa_gl_stage stage = {GL_COMPUTE_SHADER, head, pieces, sizeof pieces / sizeof pieces[0]};
    GLuint program = 0;
    assert_int_equal(ewa_gl_program_make(device, "masks", &stage, 1, &program), EWA_OK);
    static gpu_record records[RECORDS];
    const ewa_gl_view views[2] = {{.exponent_end = exponent_end}, {.flags = EWA_GL_ORTHOGRAPHIC}};
    const ewa_gl_band_block band = {.exponent_end = exponent_end, .group_limit = device->facts.group_count};
    ewa_gl_buffer buffers[4] = {{0}};
    assert_int_equal(ewa_gl_buffer_reserve(device, &buffers[1], "records", sizeof records), EWA_OK);
    assert_int_equal(ewa_gl_buffer_reserve(device, &buffers[2], "results", 16), EWA_OK);
    assert_int_equal(ewa_gl_buffer_put(device, &buffers[3], "band", &band, sizeof band), EWA_OK);
    check_random random = {.state = 3};
    for (int kind = 0; kind < KINDS; kind++)
        for (int orthographic = 0; orthographic < 2; orthographic++) {
            for (int i = 0; i < RECORDS; i++) records[i] = random_record(&random, kind);
            assert_int_equal(ewa_gl_buffer_put(device, &buffers[0], "views", &views[orthographic], sizeof views[0]), EWA_OK);
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffers[0].name);
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 5, buffers[1].name);
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 7, buffers[2].name);
            glBindBufferBase(GL_UNIFORM_BUFFER, 0, buffers[3].name);
            uint32_t results[4];
            count(device, program, buffers, records, results);
            print_message("kind %d: %u pixels taken, %u in masks, %u left out, %u beyond limits\n", kind, results[1], results[2],
                          results[0], results[3]);
            assert_int_equal(results[0], 0);
            assert_int_equal(results[3], 0);
            assert_true(results[1] > RECORDS);
            // Needles without a prefilter are thinner than the rounding of what tells them.
            assert_true(results[2] <= (kind == KINDS - 1 ? 3 : 1.1) * results[1]);
        }
    for (int i = 0; i < 4; i++) ewa_gl_buffer_free(&buffers[i]);
    glDeleteProgram(program);
    ewa_gl_leave(device);
    ewa_gl_close(&device);
}

int main(void) {
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    ewa_gpu_info info = {.struct_size = sizeof info};
    if (ewa_gpu_describe(context, &info) != EWA_OK || info.device_class < EWA_GPU_CLOSE) return 77;
    return RUN_TESTS(NULL, NULL);
}
