// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The programs of the compute pipeline, each made when a frame first needs it.
#ifndef EWA_SRC_GL_VARIANT_H
#define EWA_SRC_GL_VARIANT_H

#include "gl/program.h"

typedef enum ewa_gl_pass {
    EWA_GL_CULL,
    EWA_GL_SETUP,
    EWA_GL_DIVIDE,
    EWA_GL_FILL,
    EWA_GL_VISIBILITY,
    EWA_GL_SUMS,
    EWA_GL_FIRST_SURFACE,
    EWA_GL_EDGES,
    EWA_GL_PICTURE,
    EWA_GL_EYE_DOME,
    EWA_GL_AVERAGES,
    EWA_GL_PASSES
} ewa_gl_pass;

/// What a program is made for; all that it does not depend on is 0.
typedef struct ewa_gl_variant {
    uint8_t pass, tile_px;
    uint8_t with_normals, with_depth, with_materials, with_opacity, with_clips, with_nears, with_fine, rays;
    uint8_t channel_count;
} ewa_gl_variant;

/// What the arithmetic of a device has to be helped with.
typedef struct ewa_gl_arithmetic {
    bool fused;   ///< fma() rounds once
    bool divides; ///< a / b is correctly rounded
    bool roots;   ///< sqrt() is
    bool double_quotients; ///< a / b of doubles is
} ewa_gl_arithmetic;

enum { EWA_GL_MAX_VARIANTS = 48 };

/// Programs that are there. Zero-initialise, then set `arithmetic`.
typedef struct ewa_gl_variants {
    ewa_gl_arithmetic arithmetic;
    uint32_t count, oldest;
    ewa_gl_variant made[EWA_GL_MAX_VARIANTS];
    GLuint programs[EWA_GL_MAX_VARIANTS];
} ewa_gl_variants;

enum { EWA_GL_HEAD_BYTES = 4096, EWA_GL_MAX_PIECES = 10 };

/// The text of a program: a head, then pieces that the library has.
typedef struct ewa_gl_source {
    char head[EWA_GL_HEAD_BYTES + 512];
    const char *pieces[EWA_GL_MAX_PIECES];
    uint32_t piece_count;
} ewa_gl_source;

/// What a pass is called.
const char *ewa_gl_pass_name(ewa_gl_pass pass);

void ewa_gl_variant_write(const ewa_gl_arithmetic *arithmetic, const ewa_gl_variant *variant, ewa_gl_source *source);

/// Returns a program that the variants keep until many others have been asked for. Errors: as ewa_gl_program_make().
ewa_status ewa_gl_variant_get(ewa_gl *device, ewa_gl_variants *variants, const ewa_gl_variant *wanted,
                              GLuint *program);

void ewa_gl_variants_free(ewa_gl_variants *variants);

/// Writes the head of a program of the pipeline: version, arithmetic and constants, to `head` of at least
/// EWA_GL_HEAD_BYTES; returns how many bytes without the end.
size_t ewa_gl_head_write(const ewa_gl_arithmetic *arithmetic, char *head);

#endif
