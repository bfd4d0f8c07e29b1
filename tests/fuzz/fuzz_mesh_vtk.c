// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target of the reader of VTK's meshes: any bytes.
#include "fuzz_mesh.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    return fuzz_mesh(bytes, size_bytes, NULL, ewa_mesh_read_vtk);
}
