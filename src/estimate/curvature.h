// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How much the surface bends at each place, by the normals of its neighbours.
#ifndef EWA_SRC_ESTIMATE_CURVATURE_H
#define EWA_SRC_ESTIMATE_CURVATURE_H

#include "estimate/local.h"

/// What curvatures are measured by, by place.
typedef struct curvature_input {
    const ewa_neighbours *neighbours; ///< before ewa_neighbours_end_visits()
    const uint32_t (*links)[LOCAL_GRAPH_DEGREE];
    const float *normals; ///< 3 each, unit, to the sides that curvatures are to be told by; 0: none
    float *curvature;     ///< out, by point
} curvature_input;

/// Sets the signed curvature of the points at each place (ewa/cloud.h), 1 / world unit; 0 where neighbours do not tell,
/// or normals do not agree on a side. Errors: EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_curvature_measure(ewa_context *context, const curvature_input *input);

/// Takes the stream "signed_curvature" away where it is 0 throughout.
void ewa_curvature_drop_flat(ewa_cloud *cloud);

/// Sets the unit normal, that across the axes where there is none, of the first point of each place, 3 floats each; 0 where it
/// has neither.
void ewa_curvature_read_normals(const ewa_cloud *cloud, const ewa_neighbours *neighbours, float *normals);

/// Adds the stream "signed_curvature" to a cloud that has positions, and normals or axes, if it bends somewhere. Errors:
/// EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_curvature_add(ewa_cloud *cloud);

/// Whether a cloud has no curvatures, or NaN for some. Without any beside clip lines they are not wanted: surfels move at
/// contours, those that lines cut do not, and the surface between both would tear (results of CSG).
bool ewa_curvature_is_lacking(const ewa_cloud *cloud);

/// As ewa_curvature_add() of a cloud without the stream; of one that has it, measures those that are NaN, by each other.
ewa_status ewa_curvature_complete(ewa_cloud *cloud);

#endif
