// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The programs of the compute pipeline. Constants go to them as bits, so that no compiler's decimals matter.
#include "gl/variant.h"
#include "gl/shaders.h"
#include "image/environment.h"
#include "surface/pipeline.h"
#include "surface/semantics.h"

#include <stdio.h>
#include <string.h>

/// Largest slope of a ray, near the camera plane.
#define RAY_LIMIT (1 / (float)EWA_NEAR_RATIO)

/// Constants of the shaders.
static const struct {
    const char *name;
    float value;
} constants[] = {
    {"TINY", 0x1p-40f},
    {"MIN_NORMAL", 0x1p-126f},
    {"MIN_POWER", 0x1p-90f},
    {"ALMOST_ONE", 0x1.fffffep-1f},
    {"LARGEST", 0x1.fffffep127f},
    {"MIN_KEY_OF_ALL", -3e38f},
    {"UNIT_OCT", 1.0f / 32767.0f},
    {"BILLBOARD", EWA_BILLBOARD},
    {"UNIT_ANGLE", 1.0f / 32768.0f},
    {"UNIT_U16", 1.0f / 65535.0f},
    {"UNIT_CONE", 1.0f / EWA_CONE_AXIS},
    {"UNIT_SINE", 1.0f / EWA_CONE_SINE},
    {"ROUNDING", 0x1p-20f},
    {"SHORTEST2", 0x1p-120f},
    {"NEAR_RATIO", (float)EWA_NEAR_RATIO},
    {"RAY_LIMIT2", RAY_LIMIT * RAY_LIMIT},
    {"FLAT", (float)EWA_FLAT},
    {"SINGULAR", (float)EWA_SINGULAR},
    {"MIN_AREA", (float)EWA_MIN_AREA},
    {"MIN_SPLAT", (float)EWA_MIN_SPLAT},
    {"INVERSE_TWO_PI", (float)EWA_INVERSE_TWO_PI},
    {"TWO_PI", (float)(1 / EWA_INVERSE_TWO_PI)},
    {"EDGE_ON2", (float)(EWA_EDGE_ON * EWA_EDGE_ON)},
    {"FREE_RADII", (float)EWA_FREE_RADII},
    {"FREE_DEPTH", (float)EWA_FREE_DEPTH},
    {"GRAZING_TOLERANCE", (float)EWA_GRAZING_TOLERANCE},
    {"CONTOUR_WIDTH", (float)EWA_CONTOUR_WIDTH},
    {"CONTOUR_REACH", (float)EWA_CONTOUR_REACH},
    {"CONTOUR_CONCAVE", (float)EWA_CONTOUR_CONCAVE},
    {"MIN_KEY", (float)EWA_MIN_KEY},
    {"TANGENT_KEY", 1 - 1 / (float)16},
    {"FINE_SCALE", 4096},
    {"FINE_UNIT", 1.0f / 4096},
    {"PER_CUT", (float)(1 / EWA_CUT)},
    {"EDGES_OPPOSE", (float)EWA_EDGES_OPPOSE},
    {"EDGES_SLOPE", (float)(1 / (EWA_EDGES_AGREE - EWA_EDGES_OPPOSE))},
    {"SHADED_NORMAL", (float)EWA_SHADED_NORMAL},
    {"CURVE_OFFSET", 0.5f - 255 * 0.055f},
    {"LINE_SLOPE", 255 * 12.92f},
};

size_t ewa_gl_head_write(const ewa_gl_arithmetic *arithmetic, char *head) {
    size_t at = (size_t)snprintf(head, EWA_GL_HEAD_BYTES,
                                 "#version 430 core\n#define FUSED %d\n#define DIVIDES %d\n#define ROOTS %d\n#define DOUBLE_QUOTIENTS %d\n"
                                 "#define MAX_LIGHTS %d\n#define MAX_LEVELS %d\n#define MERGED_SURFACES %d\n"
                                 "#define MAX_MATERIALS %d\n#define MAX_SECTIONS %d\n#define CONE_BITS %d\n"
                                 "#define CONE_AXIS %d\n#define CONE_SINE %du\n#define RADIUS_SHIFT %d\n#define EYE_DOME_REACH %d\n",
                                 arithmetic->fused, arithmetic->divides, arithmetic->roots, arithmetic->double_quotients, EWA_MAX_LIGHTS,
                                 EWA_MAX_ENVIRONMENT_LEVELS, EWA_MERGED_SURFACES, EWA_MAX_MATERIALS,
                                 EWA_MAX_SECTION_PLANES, EWA_CONE_BITS, EWA_CONE_AXIS, EWA_CONE_SINE, EWA_RADIUS_SHIFT,
                                 EWA_EYE_DOME_REACH);
    for (size_t i = 0; i < sizeof constants / sizeof constants[0]; i++) {
        uint32_t bits;
        memcpy(&bits, &constants[i].value, sizeof bits);
        at += (size_t)snprintf(head + at, EWA_GL_HEAD_BYTES - at,
                               "#define %s uintBitsToFloat(0x%08xu)\n", constants[i].name,
                               (unsigned)bits);
    }
    return at;
}

const char *ewa_gl_pass_name(ewa_gl_pass pass) {
    static const char *const names[EWA_GL_PASSES] = {[EWA_GL_CULL] = "culling",
                                                     [EWA_GL_SETUP] = "set-up",
                                                     [EWA_GL_DIVIDE] = "units",
                                                     [EWA_GL_FILL] = "lists",
                                                     [EWA_GL_VISIBILITY] = "visibility",
                                                     [EWA_GL_SUMS] = "accumulation",
                                                     [EWA_GL_FIRST_SURFACE] = "first surface",
                                                     [EWA_GL_EDGES] = "edges",
                                                     [EWA_GL_PICTURE] = "picture",
                                                     [EWA_GL_EYE_DOME] = "eye-dome lighting",
                                                     [EWA_GL_AVERAGES] = "averages"};
    return names[pass];
}

void ewa_gl_variant_write(const ewa_gl_arithmetic *arithmetic, const ewa_gl_variant *v, ewa_gl_source *source) {
    enum { COMMON = 2, OWN = EWA_GL_MAX_PIECES - COMMON };
    static const char *const pieces[][OWN] = {
        [EWA_GL_CULL] = {ewa_shader_scene, ewa_shader_packet, ewa_shader_cull},
        [EWA_GL_SETUP] = {ewa_shader_scene, ewa_shader_packet, ewa_shader_setup},
        [EWA_GL_DIVIDE] = {ewa_shader_divide},
        [EWA_GL_FILL] = {ewa_shader_scene, ewa_shader_fill},
        [EWA_GL_VISIBILITY] = {ewa_shader_scene, ewa_shader_splat, ewa_shader_masks, ewa_shader_passes},
        [EWA_GL_SUMS] = {ewa_shader_scene, ewa_shader_splat, ewa_shader_masks, ewa_shader_sums, ewa_shader_passes},
        [EWA_GL_FIRST_SURFACE] = {ewa_shader_sums, ewa_shader_surface},
        [EWA_GL_EDGES] = {ewa_shader_scene, ewa_shader_splat, ewa_shader_masks, ewa_shader_sums, ewa_shader_passes, ewa_shader_surface,
                          ewa_shader_edges},
        [EWA_GL_PICTURE] = {ewa_shader_sums, ewa_shader_codes, ewa_shader_surface},
        [EWA_GL_EYE_DOME] = {ewa_shader_codes, ewa_shader_eye_dome},
        [EWA_GL_AVERAGES] = {ewa_shader_average},
    };
    static const int pass_numbers[] = {[EWA_GL_VISIBILITY] = 1,
                                       [EWA_GL_SUMS] = 2,
                                       [EWA_GL_FIRST_SURFACE] = 3,
                                       [EWA_GL_EDGES] = 4,
                                       [EWA_GL_PICTURE] = 5,
                                       [EWA_GL_EYE_DOME] = 6,
                                       [EWA_GL_AVERAGES] = 7};
    const size_t at = ewa_gl_head_write(arithmetic, source->head);
    snprintf(source->head + at, sizeof source->head - at,
             "#define PASS %d\n#define TILE_PX %d\n#define CHANNELS %d\n#define WITH_NORMAL %d\n"
             "#define WITH_DEPTH %d\n#define DEPTH_CHANNEL %du\n#define WITH_MATERIAL %d\n"
             "#define WITH_OPACITY %d\n#define WITH_CLIPS %d\n#define WITH_NEARS %d\n#define WITH_FINE %d\n#define RAYS %d\n",
             pass_numbers[v->pass], v->tile_px, v->channel_count, v->with_normals, v->with_depth,
             v->with_normals ? 7 : 4, v->with_materials, v->with_opacity, v->with_clips, v->with_nears, v->with_fine,
             v->rays);
    source->pieces[0] = ewa_shader_wide, source->pieces[1] = ewa_shader_band;
    source->piece_count = COMMON;
    for (int i = 0; i < OWN && pieces[v->pass][i]; i++) source->pieces[source->piece_count++] = pieces[v->pass][i];
}

static ewa_status make(ewa_gl *device, const ewa_gl_variants *variants, const ewa_gl_variant *v, GLuint *program) {
    ewa_gl_source source;
    ewa_gl_variant_write(&variants->arithmetic, v, &source);
    const ewa_gl_stage stage = {GL_COMPUTE_SHADER, source.head, source.pieces, source.piece_count};
    return ewa_gl_program_make(device, ewa_gl_pass_name((ewa_gl_pass)v->pass), &stage, 1, program);
}

ewa_status ewa_gl_variant_get(ewa_gl *device, ewa_gl_variants *variants, const ewa_gl_variant *wanted,
                              GLuint *program) {
    for (uint32_t i = 0; i < variants->count; i++)
        if (memcmp(&variants->made[i], wanted, sizeof *wanted) == 0) {
            *program = variants->programs[i];
            return EWA_OK;
        }
    EWA_TRY(make(device, variants, wanted, program));
    uint32_t place = variants->count;
    if (place == EWA_GL_MAX_VARIANTS) {
        place = variants->oldest++ % EWA_GL_MAX_VARIANTS;
        glDeleteProgram(variants->programs[place]);
    } else {
        variants->count++;
    }
    variants->made[place] = *wanted;
    variants->programs[place] = *program;
    return EWA_OK;
}

void ewa_gl_variants_free(ewa_gl_variants *variants) {
    for (uint32_t i = 0; i < variants->count; i++) glDeleteProgram(variants->programs[i]);
    variants->count = variants->oldest = 0;
}
