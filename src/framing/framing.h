// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a framing is made of.
#ifndef EWA_SRC_FRAMING_H
#define EWA_SRC_FRAMING_H

#include "ewa/framing.h"

struct ewa_framing {
    ewa_context *context;
    ewa_bounds box; ///< of the points to show
    double middle_world[3];
    double (*offsets)[3]; ///< of sampled points inside the box, from its middle
    double *rims_world;   ///< how far their discs reach beyond them, as far as that is usual
    float (*normals)[3];  ///< of the same points; NULL: they have none
    size_t count, room;   ///< of all
    bool trimmed;         ///< a few far points are outside the box
};

/// Makes a framing of no points with room for so many. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_framing_make(ewa_context *context, size_t room, ewa_framing **framing);

/// Length of a box' diagonal.
double ewa_framing_diagonal(const ewa_bounds *box);

#endif
