// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Removal of points that are far from everything.
#ifndef EWA_SRC_ESTIMATE_OUTLIERS_H
#define EWA_SRC_ESTIMATE_OUTLIERS_H

#include "ewa/prepare.h"

/// Replaces the cloud by one without what ewa_cloud_mark_outliers() finds by options that have been looked at. All streams are kept.
/// The cloud stays as it is when nothing is to be removed, and on failure. Errors: EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_remove_outliers(ewa_cloud **cloud, const ewa_estimate_options *options);

#endif
