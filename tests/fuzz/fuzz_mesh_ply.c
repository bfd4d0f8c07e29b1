// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target of meshes in PLY files: any bytes; what is read besides vertices can be written in every
// encoding and reads back as many faces.
#include "fuzz_mesh.h"

#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    int errors = 0;
    if (!size_bytes) return 0;
    ewa_context *context = fuzz_context(1, 0, &errors);
    ewa_model model;
    ewa_status status = ewa_model_load_memory(context, bytes, size_bytes, "input.ply", NULL,
                                              EWA_MODEL_POINTS | EWA_MODEL_ELEMENTS, NULL, &model);
    fuzz_require((status == EWA_OK) == (model.points != NULL), "points on success only");
    fuzz_require((status == EWA_OK) == (errors == 0), "a message on failure only");
    for (int encoding = 0; status == EWA_OK && model.elements && encoding < 3; encoding++) {
        char path[64];
        snprintf(path, sizeof path, "/tmp/ewa-fuzz-mesh-%ld.ply", (long)getpid());
        WITH_DEFAULTS(ewa_cloud_save_options, options);
        options.ply_encoding = (ewa_ply_encoding)encoding;
        options.elements = model.elements;
        ewa_model back;
        // The vertices may become more properties than a file can have.
        if (ewa_cloud_save(model.points, path, &options) != EWA_OK) break;
        fuzz_require(ewa_model_load(context, path, EWA_MODEL_POINTS | EWA_MODEL_ELEMENTS, NULL, &back) ==
                         EWA_OK,
                     "what was written can be read");
        fuzz_require(ewa_elements_face_count(back.elements) == ewa_elements_face_count(model.elements),
                     "as many faces");
        fuzz_require(ewa_cloud_point_count(back.points) == ewa_cloud_point_count(model.points),
                     "as many vertices");
        ewa_model_free(&back);
        unlink(path);
    }
    ewa_model_free(&model);
    errors = 0;
    status =
        ewa_model_load_memory(context, bytes, size_bytes, "input.ply", NULL, EWA_MODEL_MESH, NULL, &model);
    fuzz_require((status == EWA_OK) == (errors == 0), "a message on failure only");
    if (status == EWA_OK && model.mesh.triangle_count) fuzz_check_mesh(&model.mesh);
    ewa_model_free(&model);
    ewa_context_destroy(&context);
    return 0;
}
