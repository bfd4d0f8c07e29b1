// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The programs of Gaussians. Constants go to them as bits, as in variant.c.
#include "gl/gaussian_programs.h"
#include "gl/shaders.h"
#include "volume/gaussian_view.h"

#include <stdio.h>
#include <string.h>

static const struct {
    const char *name;
    float value;
} constants[] = {
    {"SHORTEST_SCALE", 1e-12f},
    {"SHORTEST_OFFSET2", 1e-36f},
    {"SHORTEST_AREA", 1e-24f},
    {"SHORTEST_LENGTH", 1e-18f},
    {"FAINTEST", 1e-30f},
    {"TWO_LN_2", 1.38629436f},
    {"HALF_LOG2_E", -0.721347520f},
    {"DOT_CUTOFF2", (float)EWA_GAUSSIAN_DOT_CUTOFF * EWA_GAUSSIAN_DOT_CUTOFF},
    {"MIN_DOT_CUTOFF", 1e-3f},
    {"MIN_KEPT", (float)EWA_GAUSSIAN_MIN_KEPT},
    {"MAX_ALPHA", (float)EWA_GAUSSIAN_MAX_ALPHA},
    {"NEAR_REACHES", (float)EWA_GAUSSIAN_NEAR},
    {"THINNEST", 1e-30f},
    {"LITTLE", 2e-6f},
    {"LEAST", 1e-6f},
    {"WIDEST", 1e-30f},
    {"FARTHEST_PX", 1e9f},
    {"NO_DOT_PX", 1e15f},
    {"MARK_SLACK", 3.51f},
    {"CURVE_LOWEST", 0x1p-100f},
    {"CURVE_HIGHEST", 0x1p100f},
    {"CURVE_ENCODE", 1 / 2.4f},
    {"CURVE_UNSCALE", 1 / 1.055f},
    {"CURVE_UNSHIFT", 0.055f / 1.055f},
    {"CURVE_UNSLOPE", 1 / 12.92f},
};

void ewa_gl_gaussian_program_write(const ewa_gl_arithmetic *arithmetic, ewa_gl_gaussian_pass pass,
                                   ewa_gl_gaussian_detail detail, ewa_gl_source *source) {
    const bool projects = pass == EWA_GL_SPLATS_PROJECT, draws = pass == EWA_GL_SPLATS_DRAW;
    size_t at = ewa_gl_head_write(arithmetic, source->head);
    for (size_t i = 0; i < sizeof constants / sizeof constants[0]; i++) {
        uint32_t bits;
        memcpy(&bits, &constants[i].value, sizeof bits);
        at += (size_t)snprintf(source->head + at, sizeof source->head - at, "#define %s uintBitsToFloat(0x%08xu)\n",
                               constants[i].name, (unsigned)bits);
    }
    snprintf(source->head + at, sizeof source->head - at, "#define DEEP %d\n#define DOTS %d\n#define AMONG %d\n#define STAGE %d\n",
             detail >= EWA_GL_SPLATS_DEEP, detail == EWA_GL_SPLATS_FLAT || detail == EWA_GL_SPLATS_FLAT_AMONG,
             detail >= EWA_GL_SPLATS_DEEP_AMONG, projects || draws ? 0 : (int)pass - EWA_GL_SPLATS_COUNT);
    const char *const pieces[] = {ewa_shader_wide, ewa_shader_scan, ewa_shader_gaussian_frame,
                                  draws ? ewa_shader_codes : NULL, draws ? ewa_shader_share_below : NULL,
                                  projects ? ewa_shader_gaussian_project : draws ? ewa_shader_gaussian_draw : ewa_shader_gaussian_list};
    source->piece_count = 0;
    for (size_t i = 0; i < sizeof pieces / sizeof pieces[0]; i++)
        if (pieces[i]) source->pieces[source->piece_count++] = pieces[i];
}

static ewa_status make(ewa_gl *device, const ewa_gl_arithmetic *arithmetic, ewa_gl_gaussian_pass pass,
                       ewa_gl_gaussian_detail detail, GLuint *program) {
    static const char *const names[] = {[EWA_GL_SPLATS_PROJECT] = "Gaussians",  [EWA_GL_SPLATS_COUNT] = "tiles of Gaussians",
                                        [EWA_GL_SPLATS_SUM] = "sums of tiles",  [EWA_GL_SPLATS_START] = "starts of lists",
                                        [EWA_GL_SPLATS_LIST] = "lists of tiles", [EWA_GL_SPLATS_DRAW] = "compositing"};
    ewa_gl_source source;
    ewa_gl_gaussian_program_write(arithmetic, pass, detail, &source);
    const ewa_gl_stage stage = {GL_COMPUTE_SHADER, source.head, source.pieces, source.piece_count};
    return ewa_gl_program_make(device, names[pass], &stage, 1, program);
}

ewa_status ewa_gl_gaussian_program_use(ewa_gl *device, ewa_gl_gaussian_programs *programs, const ewa_gl_arithmetic *arithmetic,
                                       ewa_gl_gaussian_pass pass, ewa_gl_gaussian_detail detail) {
    // Records are the same among surfaces.
    if (pass == EWA_GL_SPLATS_PROJECT && detail >= EWA_GL_SPLATS_DEEP_AMONG) detail -= EWA_GL_SPLATS_DEEP_AMONG - EWA_GL_SPLATS_DEEP;
    GLuint *program = &programs->programs[pass][pass == EWA_GL_SPLATS_PROJECT || pass == EWA_GL_SPLATS_DRAW ? detail : 0];
    if (!*program) EWA_TRY(make(device, arithmetic, pass, detail, program));
    glUseProgram(*program);
    return EWA_OK;
}

void ewa_gl_gaussian_programs_free(ewa_gl_gaussian_programs *programs) {
    for (int pass = 0; pass < EWA_GL_SPLAT_PASSES; pass++)
        for (int detail = 0; detail < EWA_GL_SPLAT_DETAILS; detail++)
            if (programs->programs[pass][detail]) glDeleteProgram(programs->programs[pass][detail]);
    memset(programs, 0, sizeof *programs);
}
