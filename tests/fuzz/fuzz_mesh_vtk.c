// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target of the readers of VTK's meshes, legacy and XML: any bytes.
#include "fuzz_mesh.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    const bool xml = ewa_mesh_is_vtk_xml(bytes, size_bytes);
    return fuzz_mesh(bytes, size_bytes, NULL, xml ? ewa_mesh_read_vtk_xml : ewa_mesh_read_vtk);
}
