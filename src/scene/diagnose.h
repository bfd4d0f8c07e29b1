// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What points turn out to be that nothing says: Gaussians, normals that are none, floats too coarse for their
// coordinates, degrees.
#ifndef EWA_SRC_SCENE_DIAGNOSE_H
#define EWA_SRC_SCENE_DIAGNOSE_H

#include "ewa/diagnosis.h"

/// Refuses columns of Gaussians without normals and radii, which would be drawn as something else.
ewa_status ewa_cloud_refuse_gaussians(const ewa_cloud *cloud);

#endif
