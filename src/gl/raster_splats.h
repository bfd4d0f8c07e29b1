// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Splats as instanced boxes.
#ifndef EWA_SRC_GL_RASTER_SPLATS_H
#define EWA_SRC_GL_RASTER_SPLATS_H

#include "gl/raster.h"

/// Draws the splats of the band: front-facing ones, back-facing ones (`is_back`), or all
/// (visibility). `behind`: only those beyond EWA_PICTURE_PASSED. `whole`: whatever EWA_PICTURE_NEAREST says.
ewa_status ewa_raster_draw_splats(ewa_raster *raster, const ewa_tile_job *job, ewa_raster_pass pass,
                                  bool is_back, bool behind, bool whole);

#endif
