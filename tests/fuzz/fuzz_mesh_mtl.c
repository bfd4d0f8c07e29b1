// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target of material libraries: any bytes as the library of a mesh whose material is called m.
#define _DEFAULT_SOURCE // mkdtemp
#include "fuzz_mesh.h"

#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    static char folder[] = "/tmp/ewa-fuzz-mtl-XXXXXX", library[64], mesh[64];
    static const char object[] = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                                 "usemtl m\nf 1/1 2/2 3/3\nusemtl n\nf 1/1 3/3 2/2\n";
    if (!mesh[0]) {
        fuzz_require(mkdtemp(folder) != NULL, "a folder");
        snprintf(library, sizeof library, "%s/a.mtl", folder);
        snprintf(mesh, sizeof mesh, "%s/a.obj", folder);
    }
    FILE *file = fopen(library, "wb");
    fuzz_require(file && fwrite(bytes, 1, size_bytes, file) == size_bytes, "a library");
    fclose(file);
    fuzz_mesh((const uint8_t *)object, strlen(object), mesh, ewa_mesh_read_obj);
    unlink(library);
    return 0;
}
