// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What other parts of the library share about streams of positions.
#ifndef EWA_SRC_CLOUD_H
#define EWA_SRC_CLOUD_H

#include "ewa/cloud.h"

ewa_context *ewa_cloud_context(const ewa_cloud *cloud);

/// Gives a cloud the origin, the grid and the notes of another. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_cloud_follow(ewa_cloud *cloud, const ewa_cloud *source);

/// Makes a cloud of no points with the attributes, the origin, the grid and the notes of another. Errors:
/// EWA_ERROR_MEMORY.
ewa_status ewa_cloud_like(const ewa_cloud *cloud, ewa_cloud **like);

/// Whether two clouds have the same attributes in the same order.
bool ewa_cloud_is_alike(const ewa_cloud *a, const ewa_cloud *b);

/// Whether ewa_cloud_find_scalar() finds what a word means. Reports nothing.
bool ewa_cloud_has_scalar(const ewa_cloud *cloud, const char *word);

/// Whether two names of attributes are the same but for case, underscores, and the "scalar_" that some programs put before:
/// ewa_cloud_find_scalar() takes one for the other.
bool ewa_attribute_names_agree(const char *a, const char *b);

/// Names of strengths of light, of which a few mirrors give numbers far above all others: the usual ones first; NULL beyond the last.
const char *ewa_signal_name(uint32_t index);

/// Whether an attribute is one of these.
bool ewa_attribute_is_signal(const char *name);

/// Whether points without an attribute are drawn as if they had a number of it, which is then all that merged clouds
/// need to tell of them. Sets the number, 0 where there is none.
bool ewa_cloud_absent_number(const char *name, double *number);

/// Leaves only the first points; their memory stays until the cloud is destroyed.
void ewa_cloud_truncate(ewa_cloud *cloud, uint64_t point_count);

/// Measures the box of the finite ones among `count` positions (three components, any type); adds no origin.
void ewa_position_measure(ewa_context *context, const ewa_attribute *position, uint64_t count,
                          ewa_bounds *bounds);

#endif
