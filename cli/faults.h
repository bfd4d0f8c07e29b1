// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Points of which some number is none: how many, and what to say of them.
#ifndef EWA_CLI_FAULTS_H
#define EWA_CLI_FAULTS_H

#include "session.h"

/// Points of a cloud by what is wrong with them, each under the first that applies; colours apart.
typedef struct cloud_faults {
    uint64_t position_count; ///< coordinates not finite
    uint64_t normal_count;   ///< normal zero or not finite
    uint64_t radius_count;   ///< radius zero, negative or not finite
    uint64_t axis_count;     ///< tangent axis zero or not finite
    uint64_t color_count;    ///< colour not finite
} cloud_faults;

/// Counts the faults of a cloud.
void faults_count(const ewa_cloud *cloud, cloud_faults *faults);

/// Says which points of a cloud are left out of its surfels, and which colours are not the file's. Returns
/// false after reporting that nothing can be drawn.
bool faults_report(cli_session *session, const ewa_cloud *cloud, const ewa_surfels_info *surfels);

#endif
