// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Signs of normals that agree along a surface.
#ifndef EWA_SRC_ESTIMATE_ORIENT_H
#define EWA_SRC_ESTIMATE_ORIENT_H

#include "estimate/local.h"

/// What is to be oriented; all arrays by place.
typedef struct orient_input {
    const ewa_neighbours *neighbours; ///< visits not ended
    const uint32_t (*links)[LOCAL_GRAPH_DEGREE];
    const float *spacing; ///< world units
} orient_input;

/// Flips normals (3 floats per place) so that they agree along the graph of links, and outward where a
/// connected part of the graph is closed; open parts face along the axis that their mean normal is closest
/// to. Errors: EWA_ERROR_MEMORY, EWA_CANCELLED. The result does not depend on the
/// number of threads. Takes 12 bytes per place meanwhile.
ewa_status ewa_orient_propagate(ewa_context *context, const orient_input *input, float *normals);

#endif
