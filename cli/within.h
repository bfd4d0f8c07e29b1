// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Opaque surfaces among what lets light through: their planes, and what is seen past their antialiased edges.
#ifndef EWA_CLI_WITHIN_H
#define EWA_CLI_WITHIN_H

#include "ewa/ewa.h"

/// Of the size of the last frame: the surfaces, all of what lets light through, what of it is before the
/// surfaces, zeros. Zero-initialise.
typedef struct within_planes {
    ewa_image surface, surface_depth, past, front, nothing;
} within_planes;

/// Makes them in the size of a camera's picture. Errors: as ewa_image_create().
ewa_status within_make(ewa_context *context, const ewa_camera *camera, within_planes *planes);

void within_free(within_planes *planes);

/// Puts what is seen past the surfaces' edges behind them, or the background where no surface is: from `past`
/// and `front`, which were drawn.
void within_fill_edges(within_planes *planes, const float background[4]);

#endif
