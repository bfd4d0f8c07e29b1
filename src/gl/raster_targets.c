// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The pictures that the paper's pipeline draws into.
#include "gl/raster_targets.h"

enum { MAX_ATTACHED = 4 }; ///< as ES 3.0 promises

/// How a picture is kept.
static const struct {
    GLint inner;
    GLenum format, kind;
} forms[EWA_PICTURES] = {
    [EWA_PICTURE_NEAREST] = {GL_R32F, GL_RED, GL_FLOAT},
    [EWA_PICTURE_PASSED] = {GL_R32F, GL_RED, GL_FLOAT},
    [EWA_PICTURE_COLOR] = {GL_RGBA32F, GL_RGBA, GL_FLOAT},
    [EWA_PICTURE_NORMAL] = {GL_RGBA32F, GL_RGBA, GL_FLOAT},
    [EWA_PICTURE_CUT] = {GL_RGBA32F, GL_RGBA, GL_FLOAT},
    [EWA_PICTURE_OPACITY] = {GL_R32F, GL_RED, GL_FLOAT},
    [EWA_PICTURE_COLOR_BACK] = {GL_RGBA32F, GL_RGBA, GL_FLOAT},
    [EWA_PICTURE_NORMAL_BACK] = {GL_RGBA32F, GL_RGBA, GL_FLOAT},
    [EWA_PICTURE_OPACITY_BACK] = {GL_R32F, GL_RED, GL_FLOAT},
    [EWA_PICTURE_COMPOSED] = {GL_RGBA32F, GL_RGBA, GL_FLOAT},
    [EWA_PICTURE_FIRST_CUT] = {GL_RGBA32F, GL_RGBA, GL_FLOAT},
    [EWA_PICTURE_OTHER] = {0, 0, 0},
    [EWA_PICTURE_MATERIAL] = {GL_RGBA32F, GL_RGBA, GL_FLOAT},
    [EWA_PICTURE_REFLECTION] = {GL_R32F, GL_RED, GL_FLOAT},
    [EWA_PICTURE_MATERIAL_BACK] = {GL_RGBA32F, GL_RGBA, GL_FLOAT},
    [EWA_PICTURE_REFLECTION_BACK] = {GL_R32F, GL_RED, GL_FLOAT},
    [EWA_PICTURE_DEPTH] = {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT},
    [EWA_PICTURE_PLANES] = {GL_RGBA32F, GL_RGBA, GL_FLOAT},
    [EWA_PICTURE_COVERAGE] = {GL_R32F, GL_RED, GL_FLOAT},
    [EWA_PICTURE_CODES] = {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE},
    [EWA_PICTURE_FLOATS] = {GL_RGBA32F, GL_RGBA, GL_FLOAT},
    [EWA_PICTURE_MEANS] = {GL_RGBA32F, GL_RGBA, GL_FLOAT},
    [EWA_PICTURE_MEAN_PLANES] = {GL_RGBA32F, GL_RGBA, GL_FLOAT},
    [EWA_PICTURE_MEAN_COVERAGE] = {GL_R32F, GL_RED, GL_FLOAT},
};

enum { NOTHING = -1 };

/// What each frame buffer has at its outputs.
static const int attached[EWA_TARGETS][MAX_ATTACHED] = {
    [EWA_TARGET_NEAREST] = {EWA_PICTURE_NEAREST, NOTHING, NOTHING, NOTHING},
    [EWA_TARGET_SUMS] = {EWA_PICTURE_COLOR, EWA_PICTURE_NORMAL, EWA_PICTURE_CUT, EWA_PICTURE_OPACITY},
    [EWA_TARGET_BACK_FACING] = {EWA_PICTURE_COLOR_BACK, EWA_PICTURE_NORMAL_BACK, EWA_PICTURE_CUT,
                                EWA_PICTURE_OPACITY_BACK},
    [EWA_TARGET_MATERIAL] = {EWA_PICTURE_MATERIAL, EWA_PICTURE_REFLECTION, NOTHING, NOTHING},
    [EWA_TARGET_MATERIAL_BACK] = {EWA_PICTURE_MATERIAL_BACK, EWA_PICTURE_REFLECTION_BACK, NOTHING, NOTHING},
    [EWA_TARGET_COMPOSED] = {EWA_PICTURE_COMPOSED, NOTHING, NOTHING, NOTHING},
    [EWA_TARGET_PASSED] = {EWA_PICTURE_PASSED, NOTHING, NOTHING, NOTHING},
    [EWA_TARGET_FIRST_CUT] = {EWA_PICTURE_FIRST_CUT, NOTHING, NOTHING, NOTHING},
    [EWA_TARGET_PLANES] = {EWA_PICTURE_PLANES, EWA_PICTURE_COVERAGE, NOTHING, NOTHING},
    [EWA_TARGET_PICTURE] = {EWA_PICTURE_CODES, EWA_PICTURE_FLOATS, NOTHING, NOTHING},
    [EWA_TARGET_MEANS] = {EWA_PICTURE_MEANS, EWA_PICTURE_MEAN_PLANES, EWA_PICTURE_MEAN_COVERAGE, NOTHING},
};

void ewa_raster_targets_free(ewa_raster_targets *targets) {
    glDeleteFramebuffers(EWA_TARGETS, targets->targets);
    glDeleteTextures(EWA_PICTURES, targets->pictures);
    *targets = (ewa_raster_targets){0};
}

static ewa_status make_picture(ewa_gl *device, ewa_raster_targets *targets, int picture) {
    EWA_TRY(ewa_gl_check(device, "pictures"));
    glGenTextures(1, &targets->pictures[picture]);
    glBindTexture(GL_TEXTURE_2D, targets->pictures[picture]);
    glTexImage2D(GL_TEXTURE_2D, 0, forms[picture].inner, (GLsizei)targets->width_px,
                 (GLsizei)targets->height_px, 0, forms[picture].format, forms[picture].kind, NULL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    EWA_TRY(ewa_gl_check(device, "pictures"));
    targets->made |= 1u << picture;
    return EWA_OK;
}

/// Makes or remakes the frame buffer of the pictures that are there; nothing where there are none.
static ewa_status make_target(ewa_gl *device, ewa_raster_targets *targets, int target) {
    GLenum outputs[MAX_ATTACHED];
    uint32_t some = 0;
    if (!targets->targets[target]) glGenFramebuffers(1, &targets->targets[target]);
    glBindFramebuffer(GL_FRAMEBUFFER, targets->targets[target]);
    for (uint32_t i = 0; i < MAX_ATTACHED; i++) {
        const int picture = attached[target][i];
        outputs[i] = GL_NONE;
        if (picture == NOTHING || !(targets->made >> picture & 1)) continue;
        outputs[i] = GL_COLOR_ATTACHMENT0 + i;
        some++;
        glFramebufferTexture2D(GL_FRAMEBUFFER, outputs[i], GL_TEXTURE_2D, targets->pictures[picture], 0);
    }
    if (!some) return EWA_OK;
    if (target == EWA_TARGET_SUMS && targets->made >> EWA_PICTURE_DEPTH & 1)
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D,
                               targets->pictures[EWA_PICTURE_DEPTH], 0);
    glDrawBuffers(MAX_ATTACHED, outputs);
    const GLenum state = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (state == GL_FRAMEBUFFER_COMPLETE) return EWA_OK;
    return ewa_fail(device->context, EWA_ERROR_UNSUPPORTED,
                    "OpenGL: %s cannot draw into pictures of floats (0x%x)", device->facts.renderer,
                    (unsigned)state);
}

ewa_status ewa_raster_targets_reserve(ewa_gl *device, ewa_raster_targets *targets, uint32_t width_px,
                                      uint32_t height_px, uint32_t wanted) {
    if (width_px > targets->width_px || height_px > targets->height_px) {
        ewa_raster_targets_free(targets);
        targets->width_px = width_px, targets->height_px = height_px;
    }
    if ((targets->made & wanted) == wanted) return EWA_OK;
    ewa_status status = EWA_OK;
    for (int i = 0; i < EWA_PICTURES && status == EWA_OK; i++)
        if (wanted >> i & 1 && !(targets->made >> i & 1)) status = make_picture(device, targets, i);
    for (int i = 0; i < EWA_TARGETS && status == EWA_OK; i++) status = make_target(device, targets, i);
    if (status == EWA_OK) status = ewa_gl_check(device, "pictures");
    if (status != EWA_OK) ewa_raster_targets_free(targets);
    return status;
}
