// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Normals of what a depth camera saw, where its noise is larger than the neighbourhoods that they were measured from.
#ifndef EWA_SRC_ESTIMATE_NOISE_H
#define EWA_SRC_ESTIMATE_NOISE_H

#include "cloud/neighbours.h"
#include "estimate/sight.h"

typedef struct noise_input {
    const ewa_neighbours *neighbours;
    uint32_t place_count;
    const sight_grid *grid; ///< one eye of all points; not given: the world's origin, if it can be one
    double world_origin[3]; ///< of the world, relative to the cloud's origin
    double radius_scale;    ///< of discs, in spacings
} noise_input;

/// What is turned and widened, by place but for the radii.
typedef struct noise_output {
    float *normals;  ///< 3 each, unit
    uint8_t *strewn; ///< NULL, or how little each place is part of a surface: nothing where a plane was found
    float *radii;    ///< NULL, or by point: not less than closes the samples of the plane that was found
} noise_output;

/// Finds planes around places in pictures of inverse depth, whose noise is alike everywhere and to which planes are planes; as
/// large ones as the noise explains what is left. Does nothing where nobody saw all points from one side, or without noise.
/// `*turned` gets the number of places with new normals. Workers share the places; the same bytes for any number of them.
/// Errors: EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_noise_smooth(ewa_context *context, const noise_input *input, const noise_output *output, uint64_t *turned);

#endif
