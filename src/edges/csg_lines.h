// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sets of clip lines in the plane of a disc: what they leave of it, and what two of them have in common.
#ifndef EWA_SRC_EDGES_CSG_LINES_H
#define EWA_SRC_EDGES_CSG_LINES_H

#include "ewa/homogeneous.h"

/// Up to two lines a u + b v + c >= 0, u and v in standard deviations, which have to hold both, or either.
typedef struct ewa_line_set {
    ewa_vec3 line[2];
    uint32_t count;
    bool either;
} ewa_line_set;

/// What may be left of a disc after lines.
typedef enum ewa_disc_share { EWA_DISC_NONE, EWA_DISC_PART, EWA_DISC_ALL } ewa_disc_share;

/// Distance of the centre from a line, in standard deviations, positive on the side that is kept.
double ewa_line_depth(ewa_vec3 line);

/// What one line leaves of the disc of radius `cutoff`.
ewa_disc_share ewa_line_share(ewa_vec3 line, double cutoff);

/// Removes the lines that decide nothing within the disc of radius `cutoff`; says what is left of it.
ewa_disc_share ewa_lines_prune(ewa_line_set *lines, double cutoff);

/// Whether the centre is so far beyond the lines that little of the kernel is left: 1.8 standard deviations.
bool ewa_lines_beyond(const ewa_line_set *lines);

/// Whether no place of the disc is in both sets: each alternative of the one has a line that parts it from
/// each of the other.
bool ewa_lines_exclude(const ewa_line_set *a, const ewa_line_set *b, double cutoff);

/// Joins two sets that both have to hold; false when they are more than two lines, of which the two that cut
/// the most remain, an either-pair standing for the one that cuts less.
bool ewa_lines_join(const ewa_line_set *a, const ewa_line_set *b, ewa_line_set *joined);

#endif
