// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The pictures that the paper's pipeline draws into.
#ifndef EWA_SRC_GL_RASTER_TARGETS_H
#define EWA_SRC_GL_RASTER_TARGETS_H

#include "gl/device.h"

/// Pictures of the device.
typedef enum ewa_raster_picture {
    EWA_PICTURE_NEAREST, ///< R32F: largest key of z + eps
    EWA_PICTURE_PASSED,  ///< R32F: keys below are wanted
    EWA_PICTURE_COLOR,   ///< RGBA32F: sums of colour, weight
    EWA_PICTURE_NORMAL,  ///< RGBA32F: sums of normal, depth
    EWA_PICTURE_CUT,     ///< RGBA32F: of what clip lines cut: kept weight, whole weight, direction
    EWA_PICTURE_OPACITY, ///< R32F: sums of weight times opacity
    EWA_PICTURE_COLOR_BACK,
    EWA_PICTURE_NORMAL_BACK,
    EWA_PICTURE_OPACITY_BACK,
    EWA_PICTURE_COMPOSED, ///< RGBA32F: premultiplied
    EWA_PICTURE_FIRST_CUT,
    EWA_PICTURE_OTHER,      ///< no picture of these, but where programs see clip lines or the environment
    EWA_PICTURE_MATERIAL,   ///< RGBA32F: sums of ambient, diffuse, specular, shininess
    EWA_PICTURE_REFLECTION, ///< R32F
    EWA_PICTURE_MATERIAL_BACK,
    EWA_PICTURE_REFLECTION_BACK,
    EWA_PICTURE_DEPTH,    ///< of EWA_RASTER_SINGLE
    EWA_PICTURE_PLANES,   ///< RGBA32F: normal, depth
    EWA_PICTURE_COVERAGE, ///< R32F
    EWA_PICTURE_CODES,    ///< RGBA8
    EWA_PICTURE_FLOATS,   ///< RGBA32F: over the background
    EWA_PICTURE_MEANS,    ///< RGBA32F: of parts of pixels, and so the next
    EWA_PICTURE_MEAN_PLANES,
    EWA_PICTURE_MEAN_COVERAGE,
    EWA_PICTURES
} ewa_raster_picture;

/// Frame buffers.
typedef enum ewa_raster_target {
    EWA_TARGET_NEAREST,
    EWA_TARGET_SUMS,
    EWA_TARGET_BACK_FACING, ///< with the cuts of EWA_TARGET_SUMS
    EWA_TARGET_MATERIAL,
    EWA_TARGET_MATERIAL_BACK,
    EWA_TARGET_COMPOSED,
    EWA_TARGET_PASSED,
    EWA_TARGET_FIRST_CUT,
    EWA_TARGET_PLANES,
    EWA_TARGET_PICTURE,
    EWA_TARGET_MEANS,
    EWA_TARGETS
} ewa_raster_target;

/// The key of what is nowhere: below that of anything.
#define EWA_RASTER_NEVER (-3e38)

/// Pictures of one size, and the frame buffers that draw into them. Zero-initialise.
typedef struct ewa_raster_targets {
    GLuint pictures[EWA_PICTURES], targets[EWA_TARGETS];
    uint32_t width_px, height_px;
    uint32_t made; ///< bit per picture
} ewa_raster_targets;

/// Makes the pictures that are wanted, a bit for each, of a size, and their frame buffers. Errors:
/// EWA_ERROR_MEMORY, EWA_ERROR_UNSUPPORTED (they cannot be drawn into).
ewa_status ewa_raster_targets_reserve(ewa_gl *device, ewa_raster_targets *targets, uint32_t width_px,
                                      uint32_t height_px, uint32_t wanted);
void ewa_raster_targets_free(ewa_raster_targets *targets);

#endif
