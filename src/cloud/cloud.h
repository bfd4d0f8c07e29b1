// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What other parts of the library share about streams of positions.
#ifndef EWA_SRC_CLOUD_H
#define EWA_SRC_CLOUD_H

#include "ewa/cloud.h"

ewa_context *ewa_cloud_context(const ewa_cloud *cloud);

/// Measures the box of the finite ones among `count` positions (three components, any type); adds no origin.
void ewa_position_measure(ewa_context *context, const ewa_attribute *position, uint64_t count,
                          ewa_bounds *bounds);

#endif
