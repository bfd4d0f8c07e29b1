// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The programs of the paper's pipeline, each made when a frame first needs it: OpenGL 3.3, nothing that ES 3.0 lacks.
#include "gl/raster_programs.h"
#include "gl/program.h"
#include "gl/raster_targets.h"
#include "gl/shaders.h"
#include "base/format.h"
#include "image/environment.h"
#include "surface/packet.h"
#include "surface/semantics.h"

#include <stdio.h>

enum { HEAD_BYTES = 2048 };

/// What programs are told before their pieces: constants of semantics.h.
static size_t write_head(char *head) {
    const struct {
        const char *name;
        double value;
    } constants[] = {
        {"NEVER", EWA_RASTER_NEVER},
        {"BILLBOARD", EWA_BILLBOARD},
        {"NEAR_RATIO", EWA_NEAR_RATIO},
        {"FLAT", EWA_FLAT},
        {"SINGULAR", EWA_SINGULAR},
        {"MIN_AREA", EWA_MIN_AREA},
        {"MIN_SPLAT", EWA_MIN_SPLAT},
        {"INVERSE_TWO_PI", EWA_INVERSE_TWO_PI},
        {"EDGE_ON", EWA_EDGE_ON},
        {"FREE_RADII", EWA_FREE_RADII},
        {"FREE_DEPTH", EWA_FREE_DEPTH},
        {"GRAZING_TOLERANCE", EWA_GRAZING_TOLERANCE},
        {"CONTOUR_WIDTH", EWA_CONTOUR_WIDTH},
        {"CONTOUR_REACH", EWA_CONTOUR_REACH},
        {"CONTOUR_CONCAVE", EWA_CONTOUR_CONCAVE},
        {"MIN_KEY", EWA_MIN_KEY},
        {"PER_CUT", 1 / EWA_CUT},
        {"EDGES_OPPOSE", EWA_EDGES_OPPOSE},
        {"EDGES_SLOPE", 1 / (EWA_EDGES_AGREE - EWA_EDGES_OPPOSE)},
        {"SHADED_NORMAL", EWA_SHADED_NORMAL},
    };
    size_t at = (size_t)snprintf(
        head, HEAD_BYTES,
        "#version 330 core\n#define MAX_LIGHTS %d\n#define MAX_LEVELS %d\n#define MAX_MATERIALS %d\n",
        EWA_MAX_LIGHTS, EWA_MAX_ENVIRONMENT_LEVELS, EWA_MAX_MATERIALS);
    for (size_t i = 0; i < sizeof constants / sizeof constants[0]; i++)
        at += (size_t)ewa_format(head + at, HEAD_BYTES - at, "const float %s = %.9e;\n", constants[i].name,
                               constants[i].value);
    return at;
}

/// Says which blocks and pictures the program's names stand for.
static void bind_names(GLuint program) {
    static const char *const blocks[] = {"ViewBlock", "ResolveBlock", "MaterialBlock"};
    static const struct {
        const char *name;
        GLint unit;
    } maps[] = {{"nearest_map", EWA_PICTURE_NEAREST},
                {"passed_map", EWA_PICTURE_PASSED},
                {"color_map", EWA_PICTURE_COLOR},
                {"normal_map", EWA_PICTURE_NORMAL},
                {"cut_map", EWA_PICTURE_CUT},
                {"opacity_map", EWA_PICTURE_OPACITY},
                {"color_back_map", EWA_PICTURE_COLOR_BACK},
                {"normal_back_map", EWA_PICTURE_NORMAL_BACK},
                {"opacity_back_map", EWA_PICTURE_OPACITY_BACK},
                {"composed_map", EWA_PICTURE_COMPOSED},
                {"first_cut_map", EWA_PICTURE_FIRST_CUT},
                {"line_map", EWA_PICTURE_OTHER},
                {"environment_map", EWA_PICTURE_OTHER},
                {"material_map", EWA_PICTURE_MATERIAL},
                {"reflection_map", EWA_PICTURE_REFLECTION},
                {"material_back_map", EWA_PICTURE_MATERIAL_BACK},
                {"reflection_back_map", EWA_PICTURE_REFLECTION_BACK},
                {"floats_map", EWA_PICTURE_FLOATS},
                {"planes_map", EWA_PICTURE_PLANES},
                {"coverage_map", EWA_PICTURE_COVERAGE}};
    for (GLuint i = 0; i < sizeof blocks / sizeof blocks[0]; i++) {
        const GLuint index = glGetUniformBlockIndex(program, blocks[i]);
        if (index != GL_INVALID_INDEX) glUniformBlockBinding(program, index, i);
    }
    glUseProgram(program);
    for (size_t i = 0; i < sizeof maps / sizeof maps[0]; i++)
        glUniform1i(glGetUniformLocation(program, maps[i].name), maps[i].unit);
}

ewa_status ewa_raster_splat_program(ewa_gl *device, ewa_raster_programs *programs, ewa_raster_pass pass,
                                    ewa_raster_form form, bool with_clips, GLuint *program) {
    GLuint *made = &programs->splats[pass][form][with_clips];
    *program = *made;
    if (*made) return EWA_OK;
    static const char *const names[] = {[EWA_RASTER_VISIBILITY] = "visibility",
                                        [EWA_RASTER_SUMS] = "sums",
                                        [EWA_RASTER_MATERIALS] = "materials",
                                        [EWA_RASTER_SINGLE] = "nearest splats"};
    const bool single = pass == EWA_RASTER_SINGLE;
    char head[HEAD_BYTES + 256];
    const size_t at = write_head(head);
    snprintf(head + at, sizeof head - at,
             "#define PASS %d\n#define SINGLE %d\n#define WITH_CLIPS %d\n#define RAYS %d\n#define NEAR %d\n",
             (int)(single ? EWA_RASTER_SUMS : pass) + 1, single, with_clips, form == EWA_RASTER_RAYCAST,
             form == EWA_RASTER_NEAR);
    const char *vertex[6] = {ewa_shader_raster_scene, ewa_shader_raster_project, ewa_shader_raster_payload};
    uint32_t count = 3;
    if (with_clips) vertex[count++] = ewa_shader_raster_lines;
    if (form == EWA_RASTER_NEAR) vertex[count++] = ewa_shader_raster_near;
    vertex[count++] = ewa_shader_raster_vertex;
    static const char *const fragment[] = {ewa_shader_raster_scene, ewa_shader_raster_splat};
    const ewa_gl_stage stages[] = {{GL_VERTEX_SHADER, head, vertex, count},
                                   {GL_FRAGMENT_SHADER, head, fragment, 2}};
    EWA_TRY(ewa_gl_program_make(device, names[pass], stages, 2, made));
    *program = *made;
    bind_names(*made);
    return EWA_OK;
}

ewa_status ewa_raster_stage_program(ewa_gl *device, ewa_raster_programs *programs, ewa_raster_stage stage,
                                    bool with_clips, GLuint *program) {
    GLuint *made = &programs->stages[stage][with_clips];
    *program = *made;
    if (*made) return EWA_OK;
    static const char *const names[] = {
        [EWA_RASTER_COMPOSE] = "surface", [EWA_RASTER_PLANES] = "planes",
        [EWA_RASTER_CUT] = "cut edges",   [EWA_RASTER_PEEL] = "what lies behind",
        [EWA_RASTER_BROKEN] = "colours",  [EWA_RASTER_PICTURE] = "picture",
        [EWA_RASTER_AVERAGE] = "averages"};
    char head[HEAD_BYTES + 256];
    const size_t at = write_head(head);
    snprintf(head + at, sizeof head - at, "#define STAGE %d\n#define WITH_CLIPS %d\n", (int)stage,
             with_clips);
    static const char *const vertex[] = {ewa_shader_raster_cover};
    static const char *const fragment[] = {ewa_shader_raster_surface};
    const ewa_gl_stage stages[] = {{GL_VERTEX_SHADER, head, vertex, 1},
                                   {GL_FRAGMENT_SHADER, head, fragment, 1}};
    EWA_TRY(ewa_gl_program_make(device, names[stage], stages, 2, made));
    *program = *made;
    bind_names(*made);
    return EWA_OK;
}

void ewa_raster_programs_free(ewa_raster_programs *programs) {
    for (int clips = 0; clips < 2; clips++) {
        for (int pass = 0; pass < EWA_RASTER_PASSES; pass++)
            for (int form = 0; form < EWA_RASTER_FORMS; form++)
                if (programs->splats[pass][form][clips]) glDeleteProgram(programs->splats[pass][form][clips]);
        for (int stage = 0; stage < EWA_RASTER_STAGES; stage++)
            if (programs->stages[stage][clips]) glDeleteProgram(programs->stages[stage][clips]);
    }
}
