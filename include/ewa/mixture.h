// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures of all that lets light through, in one order of depth: sets of trained Gaussians and volumes, over
// opaque surfaces.
#ifndef EWA_MIXTURE_H
#define EWA_MIXTURE_H

#include "ewa/gaussian_render.h"
#include "ewa/volume_render.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Volumes of a mixture, at most.
enum { EWA_MAX_MIXED_VOLUMES = 64 };

/// A volume of a mixture.
typedef struct ewa_mixed_volume {
    ewa_volume_renderer *renderer; ///< of the same context; each volume of a mixture has one of its own
    const ewa_voxels *voxels;
    /// How it is drawn, NULL: the defaults. Its background, its surfaces and its section planes are not used: those
    /// of the mixture are.
    const ewa_volume_options *options;
    ewa_volume_stats *stats; ///< what it took, written; NULL: not wanted
} ewa_mixed_volume;

/// What is drawn together; borrowed during the call.
typedef struct ewa_mixture {
    const ewa_splats *const *splats; ///< [splats_count] sets of Gaussians
    uint32_t splats_count;
    uint32_t volume_count;           ///< at most EWA_MAX_MIXED_VOLUMES
    const ewa_mixed_volume *volumes; ///< [volume_count]
} ewa_mixture;

/// Draws Gaussians and volumes, front to back in every pixel: a Gaussian by its depth in the order of `options`
/// (ewa_gaussian_order), of a volume each depth unit (ewa_volume_options.depth_unit) by its middle. What is
/// linear is mixed linearly: voxels with each other and with what is behind all; the Gaussians' colours, which
/// are display values, with the display values of that mean. So a mixture of one set is that set's picture
/// (ewa_gaussian_render(), the same bytes), and one of one volume that of the volume, but for rounding and the
/// depth, which is that of the unit's middle. `options` (NULL: the defaults) are those of the Gaussians, and
/// their background, surfaces and sections are the picture's; planes as in ewa_gaussian_render(). The same
/// bytes for every number of threads and every instruction set; of volumes and sets that share a depth those
/// named first are in front. `stats` (may be NULL) counts Gaussians. Implements docs/math.md section 12,
/// mixtures. Errors: EWA_ERROR_ARGUMENT (camera, options, levels, more than EWA_MAX_MIXED_VOLUMES, a renderer
/// twice or of another context), EWA_ERROR_LIMIT (more than 2^26 Gaussians together),
/// EWA_ERROR_MEMORY, EWA_CANCELLED. Layers of volumes need memory while tiles are drawn: with an allocator of
/// the caller's these are drawn by the calling thread alone.
EWA_API ewa_status ewa_mixture_render(ewa_gaussian_renderer *renderer, const ewa_mixture *mixture,
                                      const ewa_camera *camera, const ewa_gaussian_options *options,
                                      const ewa_frame *frame, ewa_gaussian_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
