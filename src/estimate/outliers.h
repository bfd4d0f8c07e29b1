// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Removal of points that are far from everything.
#ifndef EWA_SRC_ESTIMATE_OUTLIERS_H
#define EWA_SRC_ESTIMATE_OUTLIERS_H

#include "ewa/cloud.h"

/// Replaces the cloud by one without the points whose mean distance to their neighbours exceeds the mean of
/// all by more than `factor` standard deviations, nor those with coordinates that are not finite. All streams
/// are kept. The cloud stays as it is when nothing is to be removed, and on failure. Errors:
/// EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_remove_outliers(ewa_cloud **cloud, uint32_t neighbour_count, double factor);

#endif
