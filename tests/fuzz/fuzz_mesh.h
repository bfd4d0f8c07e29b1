// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the fuzz targets of mesh readers share: any bytes may be given; what is read is a mesh or points whose
// numbers hold, and can be sampled.
#ifndef EWA_TESTS_FUZZ_MESH_H
#define EWA_TESTS_FUZZ_MESH_H

#include "ewa/ewa.h"
#include "fuzz.h"
#include "io/mesh/formats.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/// Looks at all numbers of a mesh, and samples it when it is small.
static inline void fuzz_check_mesh(const ewa_mesh *mesh) {
    for (uint64_t i = 0; i < 3 * (uint64_t)mesh->triangle_count; i++)
        fuzz_require(mesh->triangles[i] < mesh->vertex_count, "triangles have vertices");
    for (uint32_t t = 0; mesh->material_count && t < mesh->triangle_count; t++)
        fuzz_require(mesh->triangle_materials[t] < mesh->material_count, "triangles have materials");
    for (uint32_t m = 0; m < mesh->material_count; m++)
        fuzz_require(mesh->materials[m].texture < mesh->material_count, "materials have textures");
    for (uint64_t v = 0; mesh->colors && v < 4 * (uint64_t)mesh->vertex_count; v++)
        fuzz_require(!isnan(mesh->colors[v]), "colours are numbers");
    bool closed;
    fuzz_require(ewa_mesh_is_closed(mesh, &closed) == EWA_OK, "open or closed");
    if (mesh->triangle_count > 64) return;
    WITH_DEFAULTS(ewa_mesh_sample_options, options);
    options.point_count = 32;
    options.texture_filter = EWA_TEXTURE_NEAREST;
    ewa_cloud *cloud = NULL;
    const ewa_status status = ewa_mesh_sample(mesh, &options, &cloud);
    fuzz_require((status == EWA_OK) == (cloud != NULL), "points on success only");
    ewa_cloud_destroy(&cloud);
}

/// Tries a reader on bytes.
static inline int fuzz_mesh(const uint8_t *bytes, size_t size_bytes, const char *path,
                            ewa_status (*read)(ewa_mesh_build *build)) {
    int errors = 0;
    ewa_context *context = fuzz_context(1, 0, &errors);
    const ewa_mesh_source source = {context, "input", path, bytes, size_bytes};
    ewa_mesh_build build;
    ewa_mesh_build_open(&source, &build);
    ewa_status status = read(&build);
    fuzz_require((status == EWA_OK) == (errors == 0), "a message on failure only");
    ewa_cloud *points = NULL;
    ewa_mesh mesh = {0};
    if (status == EWA_OK) {
        status = ewa_mesh_build_points(&build, &points);
        fuzz_require((status == EWA_OK) == (points != NULL), "points on success only");
        errors = 0;
        ewa_elements *elements = NULL;
        status = ewa_mesh_build_elements(&build, &elements);
        fuzz_require((status == EWA_OK) == (errors == 0), "a message on failure only");
        fuzz_require(status == EWA_OK || !elements, "elements on success only");
        ewa_elements_free(&elements);
        errors = 0;
        status = ewa_mesh_build_mesh(&build, &mesh);
        fuzz_require((status == EWA_OK) == (mesh.positions != NULL), "a mesh on success only");
        fuzz_require((status == EWA_OK) == (errors == 0), "a message on failure only");
        if (status == EWA_OK) fuzz_check_mesh(&mesh);
    }
    ewa_mesh_free(&mesh);
    ewa_cloud_destroy(&points);
    ewa_mesh_build_close(&build);
    ewa_context_destroy(&context);
    return 0;
}

#endif
