// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Levels of the resident form.
#ifndef EWA_SRC_VOLUME_SPLAT_LEVELS_H
#define EWA_SRC_VOLUME_SPLAT_LEVELS_H

#include "volume/splats.h"

/// Fills the levels of all parts; `order` has the Gaussians of the splats. Errors: EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_splats_make_levels(ewa_splats *splats, const ewa_gaussians *set, const uint32_t *order);

#endif
