// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The reference compiler of GLSL takes the programs of the compute pipeline: what it refuses some driver will, too. It also makes
// SPIR-V for Vulkan of them, by its relaxed rules, as they are. Skipped where there is none (Debian: glslang-tools).
#include "check.h"
#include "gl/gaussian_programs.h"
#include "gl/shaders.h"
#include "gl/volume.h"
#include "gl/sort.h"

#include <stdlib.h>
#include <unistd.h>

enum { NUMBERS = 8 };

static char folder[] = "/tmp/ewa_shaders_XXXXXX";

static void write_program(const char *path, const char *head, const char *const *pieces, uint32_t count) {
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(head, file);
    for (uint32_t i = 0; i < count; i++) fputs(pieces[i], file);
    assert_int_equal(fclose(file), 0);
}

/// Compiles all programs of the folder, and removes them where they pass.
static void compile(void) {
    char command[512];
    snprintf(command, sizeof command,
             "cd %s && { glslangValidator *.comp >log 2>&1 && for program in *.comp; do "
             "glslangValidator -R -V --amb --target-env vulkan1.2 -o vulkan.spv $program >log 2>&1 || exit 1; "
             "done; } || { grep -h ERROR log; exit 1; }; rm *",
             folder);
    assert_int_equal(system(command), 0);
}

static const ewa_gl_arithmetic arithmetics[] = {{true, true, true, true}, {.fused = false}};

TEST(test_passes) {
    // Normals, depth, materials, opacity, clip lines, near surfels, fine sums, rays.
    static const bool all[][NUMBERS] = {{0}, {1, 1, 1, 1, 1, 1, 1, 1}, {1, 0, 0, 0, 0, 1, 0, 0}, {0, 1, 0, 1, 1, 0, 0, 0},
                                        {1, 0, 1, 0, 0, 0, 1, 1}};
    for (size_t a = 0; a < 2; a++)
        for (int pass = EWA_GL_CULL; pass <= EWA_GL_AVERAGES; pass++)
            for (size_t k = 0; k < (pass < EWA_GL_VISIBILITY ? 1 : sizeof all / sizeof all[0]); k++) {
                const bool *with = all[k];
                const ewa_gl_variant v = {.pass = (uint8_t)pass,
                                          .tile_px = 8,
                                          .with_normals = with[0],
                                          .with_depth = with[1],
                                          .with_materials = with[2],
                                          .with_opacity = with[3],
                                          .with_clips = with[4],
                                          .with_nears = with[5],
                                          .with_fine = with[6],
                                          .rays = with[7],
                                          .channel_count = 14};
                ewa_gl_source source;
                ewa_gl_variant_write(&arithmetics[a], &v, &source);
                char path[128];
                snprintf(path, sizeof path, "%s/%d_%zu_%zu.comp", folder, pass, a, k);
                write_program(path, source.head, source.pieces, source.piece_count);
            }
    compile();
}

TEST(test_gaussians) {
    for (int a = 0; a < 2; a++)
        for (int pass = 0; pass < EWA_GL_SPLAT_PASSES; pass++)
            for (int detail = 0; detail < EWA_GL_SPLAT_DETAILS; detail++) {
                ewa_gl_source source;
                char path[128];
                ewa_gl_gaussian_program_write(&arithmetics[a], (ewa_gl_gaussian_pass)pass, (ewa_gl_gaussian_detail)detail, &source);
                snprintf(path, sizeof path, "%s/%d_%d_%d.comp", folder, pass, a, detail);
                write_program(path, source.head, source.pieces, source.piece_count);
            }
    compile();
}

TEST(test_sort) {
    for (uint32_t stage = 0; stage < EWA_GL_SORT_STAGES; stage++) {
        ewa_gl_source source;
        char path[128];
        ewa_gl_sort_write(stage, &source);
        snprintf(path, sizeof path, "%s/%u.comp", folder, stage);
        write_program(path, source.head, source.pieces, source.piece_count);
    }
    compile();
}

TEST(test_volumes) {
    for (int a = 0; a < 2; a++)
        for (int program = 0; program < EWA_GL_VOLUME_PROGRAMS; program++) {
            ewa_gl_source source;
            char path[128];
            ewa_gl_volume_program_write(&arithmetics[a], (ewa_gl_volume_program)program, &source);
            snprintf(path, sizeof path, "%s/%d_%d.comp", folder, program, a);
            write_program(path, source.head, source.pieces, source.piece_count);
        }
    compile();
}

TEST(test_selftest) {
    for (int native = 0; native < 2; native++) {
        char head[EWA_GL_HEAD_BYTES + 32], path[128];
        const size_t at = ewa_gl_head_write(&arithmetics[0], head);
        snprintf(head + at, sizeof head - at, "#define NATIVE %d\n", native);
        snprintf(path, sizeof path, "%s/%d.comp", folder, native);
        write_program(path, head, (const char *const[]){ewa_shader_wide, ewa_shader_selftest}, 2);
    }
    compile();
}

int main(void) {
    if (system("command -v glslangValidator >/dev/null") != 0) {
        printf("skipped: there is no glslangValidator\n");
        return 77;
    }
    if (!mkdtemp(folder)) return 1;
    const int failed = RUN_TESTS(NULL, NULL);
    if (!failed) rmdir(folder);
    return failed;
}
