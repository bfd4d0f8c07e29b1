// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What detection hands to the writing of surfels.
#ifndef EWA_SRC_EDGES_FEATURES_H
#define EWA_SRC_EDGES_FEATURES_H

#include "cloud/neighbours.h"
#include "edges/feature_fit.h"
#include "ewa/prepare.h"

/// What was detected, by place.
typedef struct feature_result {
    const ewa_neighbours *neighbours;
    const uint32_t *slot;        ///< [place]: index into models, UINT32_MAX: none
    const feature_model *models; ///< relative to their place, world units
    const float *spacing;        ///< [place], world units
    double noise;                ///< in spacings
} feature_result;

/// Support radii within which a line is looked for: stretched supports are larger, others are not cut by it.
#define FEATURE_REACH 1.3

/// Writes the streams; adds to `counts`. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_feature_write(ewa_cloud *cloud, const ewa_feature_options *options,
                             const feature_result *result, ewa_feature_counts *counts);

#endif
