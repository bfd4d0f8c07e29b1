// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Homogeneous coordinates (math.md section 1).
#ifndef EWA_MATH_H
#define EWA_MATH_H

#include "ewa/base.h"

#endif
