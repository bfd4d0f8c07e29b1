// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What other parts of the library share about triangle meshes.
#ifndef EWA_SRC_CLOUD_MESH_H
#define EWA_SRC_CLOUD_MESH_H

#include "ewa/mesh.h"

/// Gives each of `count` places (x, y, z) the number of the first one that is equal to it: `weld` gets one
/// number per place. Zeros of both signs are equal, and so are equal bits that are no number. Errors:
/// EWA_ERROR_MEMORY.
ewa_status ewa_mesh_weld(ewa_context *context, const double *positions, uint32_t count, uint32_t *weld);

#endif
