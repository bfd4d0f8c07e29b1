// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The loops over the pixels of splats, eight pixels at a time in double precision, written once in kernels_body.h and
// compiled per instruction set; the same bytes from each. Which splats count where is decided by the very numbers of
// src/reference/splat.c.
#ifndef EWA_SRC_ADJOINT_KERNELS_H
#define EWA_SRC_ADJOINT_KERNELS_H

#include "reference/adjoint_splat.h"
#include "wide/isa.h"

enum {
    EWA_EIGHT_LANES = 8,
    EWA_EIGHT_COLUMNS = 4, ///< a block is 4 x 2 pixels
    EWA_EIGHT_ROWS = 2,
};

/// The planes of a surface in a block: sums of the splats that face the viewer and of those that do not, what clip lines cut
/// of them, and later the cotangents of all these; the depths up to which splats count, and beyond which.
enum {
    EWA_PLANE_WEIGHT = 0, ///< of either side
    EWA_PLANE_COLOR = 1,
    EWA_PLANE_NORMAL = 4,
    EWA_PLANE_Z = 7,
    EWA_PLANE_OPACITY = 8,
    EWA_SIDE_PLANES = 9,
    EWA_PLANE_KEPT = 2 * EWA_SIDE_PLANES,
    EWA_PLANE_WHOLE,
    EWA_PLANE_INWARD,
    EWA_SUM_PLANES = EWA_PLANE_INWARD + 2,
    EWA_PLANE_BOUND = EWA_SUM_PLANES,
    EWA_PLANE_PASSED,
    EWA_PLANES,
};

/// A surface of the pixels of a tile.
typedef struct ewa_adjoint_area {
    const ewa_reference_view *view;
    int32_t x_px, y_px;         ///< of the first block
    uint32_t columns, rows;     ///< of blocks
    double *planes;             ///< [block][EWA_PLANES][EWA_EIGHT_LANES], row by row
    bool transparent;
    bool behind; ///< not the first surface
} ewa_adjoint_area;

enum { EWA_ADJOINT_LIGHTS = 3 }; ///< of filled pixels at most

/// A light; one that is not there is all 0.
typedef struct ewa_adjoint_light {
    ewa_vec3 toward_world; ///< of headlights 0
    double headlight;      ///< 1: it shines from the eye; else 0
    double color[3];
} ewa_adjoint_light;

/// How pixels that one opaque surface fills show it, and what the loss changes by them.
typedef struct ewa_adjoint_filling {
    double minimum;          ///< weight from which on they are filled
    double ambient, diffuse; ///< of the material
    double unlit;            ///< 1 without light, else 0
    ewa_adjoint_light lights[EWA_ADJOINT_LIGHTS];
    double inverse_scale;    ///< from lengths in camera space to the world's
    const float *rgba;       ///< cotangents, 4 per pixel, from the first pixel of the area on
    size_t stride_px;        ///< from row to row
    uint32_t width_px, height_px; ///< of the area, within the picture
    bool with_camera;
    double scales[EWA_CAMERA_NUMBERS]; ///< that the camera's terms are multiplied by before they are rounded
} ewa_adjoint_filling;

/// A splat at a block's pixels: its depths, and the squares of its distances there, which the sums replace by what it weighs, 0
/// where it does not count.
typedef struct ewa_adjoint_sample {
    double z[EWA_EIGHT_LANES], weight[EWA_EIGHT_LANES];
} ewa_adjoint_sample;

/// Where a splat counts in a surface. Of boxes of more than 64 blocks all bits are set, and nothing is kept.
typedef struct ewa_adjoint_visit {
    uint64_t found;  ///< a bit for each block that the splat's box touches, row by row: where it may count
    uint64_t counts; ///< where it does
    uint32_t first;  ///< of the samples of the blocks that were found; EWA_NO_SAMPLES: they are computed anew
} ewa_adjoint_visit;

#define EWA_NO_SAMPLES UINT32_MAX

/// Samples of a tile.
typedef struct ewa_adjoint_samples {
    ewa_adjoint_sample *items;
    uint32_t count, capacity;
} ewa_adjoint_samples;

/// Loops over splats and pixels.
typedef struct ewa_adjoint_kernels {
    /// Lowers the bounds to z + eps where splats count beyond what is passed, and makes their visits; returns the farthest bound
    /// of all pixels.
    double (*find)(const ewa_adjoint_area *area, const ewa_reference_splat *const *splats, uint32_t count, ewa_adjoint_samples *samples,
                   ewa_adjoint_visit *visits);

    /// Adds splats to the sums where they count up to the bounds, one after the other, and says where.
    void (*sum)(const ewa_adjoint_area *area, const ewa_reference_splat *const *splats, uint32_t count,
                const ewa_adjoint_samples *samples, ewa_adjoint_visit *visits);

    /// Adds what a splat gets of the planes, which are cotangents by now, to the first `width` of its sums: terms times
    /// `scales`, each rounded to a whole number. Depths only with `with_depth`.
    void (*gather)(const ewa_adjoint_area *area, const ewa_reference_splat *splat, const ewa_adjoint_samples *samples,
                   const ewa_adjoint_visit *visit, uint32_t width, bool with_depth, const double scales[EWA_MOMENT_COUNT],
                   int64_t sums[EWA_MOMENT_COUNT]);

    /// Ends the pixels of a first surface that it fills, showing one side and no clip line: sets cotangents of their sums in the
    /// planes, and in `camera`, if that is wanted, what directions to the eye give. Also ends pixels in which nothing is. `done` gets a bit for each lane
    /// of a block that is ended.
    void (*fill)(const ewa_adjoint_area *area, const ewa_adjoint_filling *by, uint8_t *done, double camera[EWA_CAMERA_NUMBERS]);
} ewa_adjoint_kernels;

EWA_DECLARE_VERSIONS(const ewa_adjoint_kernels, ewa_adjoint_kernels);

#endif
