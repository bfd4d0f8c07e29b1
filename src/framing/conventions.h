// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What is up in the files of a kind, for all kinds, in one place: docs/framing.md.
#ifndef EWA_SRC_FRAMING_CONVENTIONS_H
#define EWA_SRC_FRAMING_CONVENTIONS_H

#include "ewa/framing.h"

/// The axis that a convention has up: 1 y, 2 z; 0: none.
int ewa_up_axis_of(ewa_up_convention convention);

/// Up in sets of Gaussians whose file says nothing else: right, down, front, as the cameras that took the pictures.
extern const double ewa_up_of_gaussians[3];

/// Up in volumes: those of scanners stand on z.
extern const double ewa_up_of_volumes[3];

#endif
