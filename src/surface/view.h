// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Camera and options in the single-precision form that the kernels read.
#ifndef EWA_SRC_SURFACE_VIEW_H
#define EWA_SRC_SURFACE_VIEW_H

#include "homogeneous/placement.h"
#include "surface/backend.h"
#include "surface/packets.h"
#include "surface/pipeline.h"
#include "surface/shading.h"

/// What the sources of a frame share, so that what one adds to a pixel means what another does. None of it
/// depends on their order, nor, for parts of one set of surfels, on how they are cut.
typedef struct ewa_scales {
    double cutoff;
    double unit;          ///< of camera space; a power of two
    double unit_coverage; ///< q0 of the source that has the smallest; others' weights are brought down to it
    double sum;           ///< units of sums per weight; a power of two
    uint32_t terms_per_carry; ///< that no sum can overflow with
    double depth;             ///< camera space: a power of two that no depth is beyond
    double largest_color;     ///< a power of two that no number of a colour is beyond
    bool fine_colors;         ///< some are large, and others far smaller
    bool opacities;           ///< some surfels have one of their own
    bool transparent;         ///< what is behind surfaces shows through them
} ewa_scales;

/// `sources` are of one cutoff, `options` checked. Total.
ewa_scales ewa_scales_make(const ewa_frame_source *sources, uint32_t source_count, const ewa_camera *camera,
                           const ewa_render_options *options);

/// Where a source that has surfels begins, in camera space; no more than an estimate of where they do.
double ewa_scales_nearest(const ewa_scales *scales, const ewa_surfels *surfels, const ewa_camera *camera);

/// Sets the view of one source, or, for NULL, what all have in common. All arguments are checked ones.
/// Errors: EWA_ERROR_NUMERIC for a camera without a view volume.
ewa_status ewa_view_set(ewa_context *context, ewa_view *view, const ewa_frame_source *source,
                        const ewa_camera *camera, const ewa_render_options *options, const ewa_scales *scales,
                        uint32_t tile_px);

/// `material` is the code of the surfels that all have the same.
void ewa_resolve_set(ewa_resolve *resolve, uint8_t material, const ewa_camera *camera,
                     const ewa_render_options *options, const ewa_scales *scales,
                     const ewa_shading_setup *shading, const ewa_frame *frame);

/// Sets the numbers of a material in the order in which the kernels have them.
void ewa_material_numbers(const ewa_material *material, float numbers[EWA_MATERIAL_CHANNELS]);

/// Sets the record of a near or broad surfel (packet * 16 + lane) for one tile; false: not drawn.
bool ewa_near_record_set(ewa_near_record *record, const ewa_surfels *surfels, uint32_t surfel,
                         const ewa_view *view, const ewa_tile *tile);

/// Sets the clip lines of a surfel that has some (packet * 16 + lane), on the screen of a tile.
void ewa_clip_set(ewa_clip *clip, const ewa_surfels *surfels, uint32_t surfel, const ewa_view *view,
                  const ewa_tile *tile);

#endif
