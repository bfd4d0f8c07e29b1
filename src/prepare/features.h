// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What detection hands to the writing of surfels.
#ifndef EWA_SRC_PREPARE_FEATURES_H
#define EWA_SRC_PREPARE_FEATURES_H

#include "cloud/neighbours.h"
#include "ewa/prepare.h"
#include "prepare/feature_fit.h"

/// A clip line of the active plane in world units: keep across . (x - place) + distance >= 0 for x on the
/// plane.
typedef struct feature_line {
    double across[3]; ///< unit, in the plane, towards what is kept
    double distance;  ///< from the place's foot on the plane; negative beyond the line
} feature_line;

/// Finds the lines that bound plane `active` of a model within `reach` of the foot of a place; returns how
/// many, the nearest first. `either`: one of two lines holds, not both.
uint32_t ewa_feature_lines(const feature_model *model, uint32_t active, const double place[3], double reach,
                           feature_line lines[2], bool *either);

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
