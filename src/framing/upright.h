// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which way is up in a cloud, and from where it is looked at when nobody says: docs/framing.md.
#ifndef EWA_SRC_FRAMING_UPRIGHT_H
#define EWA_SRC_FRAMING_UPRIGHT_H

#include "ewa/framing.h"

/// Chooses by the positions of some points alone, in any order: `offsets` from
/// `middle_world`. Cheap: a few passes over the points.
ewa_upright ewa_upright_choose(size_t count, const double (*offsets)[3], const double middle_world[3],
                               ewa_up_convention convention);

/// Has a body that shows its inside to the front, and its outside to the back, seen from the back: an open shell, as a
/// mask is. `normals` are those of the points and point outward, if any of them do.
void ewa_upright_turn_to_outside(size_t count, const double (*offsets)[3], const float (*normals)[3],
                                 ewa_upright *chosen);

#endif
