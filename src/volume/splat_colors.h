// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours of splats in place of those of their harmonics, which stand for numbers.
#ifndef EWA_SRC_VOLUME_SPLAT_COLORS_H
#define EWA_SRC_VOLUME_SPLAT_COLORS_H

#include "ewa/mixture.h"
#include "volume/splats.h"

/// Display values, for each packet of a set and of its levels.
typedef struct ewa_splat_colors {
    ewa_context *context;
    uint64_t serial; ///< another for each of them
    size_t packet_count;
    float (*colors)[3][EWA_SPLAT_LANES];
} ewa_splat_colors;

/// Makes a cloud of splats, as ewa_gaussians_to_cloud() does of a set: of the set's own in the order of their packets, or with
/// `levels` of every lane of what stands for them. The caller destroys `*cloud`. Errors: EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_splats_to_cloud(const ewa_splats *splats, bool levels, ewa_cloud **cloud);

/// Makes colours of "color", three bytes, of such clouds; `levels` is NULL for a set that has none. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_splat_colors_create(const ewa_splats *splats, const ewa_cloud *own, const ewa_cloud *levels,
                                   ewa_splat_colors **colors);

/// Frees colours; sets `*colors` to NULL; accepts a pointer to NULL.
void ewa_splat_colors_destroy(ewa_splat_colors **colors);

/// Copies a packet with other colours, without a harmonic beyond the constant one.
void ewa_splat_colors_apply(const ewa_splat_colors *colors, const ewa_splat_packet *packets, size_t packet,
                            ewa_splat_packet *painted);

/// ewa_mixture_render() with other colours for each set, NULL: its own; `colors` may be NULL.
ewa_status ewa_mixture_draw(ewa_gaussian_renderer *renderer, const ewa_mixture *mixture, const ewa_splat_colors *const *colors,
                            const ewa_camera *camera, const ewa_gaussian_options *options, const ewa_frame *frame,
                            ewa_gaussian_stats *stats);

#endif
