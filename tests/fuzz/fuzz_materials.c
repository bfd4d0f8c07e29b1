// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target: any bytes as a material table. What is read can be drawn with.
#include "fuzz.h"
#include "image/material.h"
#include "io/mesh/materials.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    ewa_context *context = fuzz_context(1, 0, NULL);
    ewa_material materials[EWA_MAX_MATERIALS];
    uint32_t count;
    const ewa_status status = ewa_materials_read(context, "fuzz", bytes, size_bytes, materials, &count);
    if ((status == EWA_OK) != (count > 0)) abort();
    for (uint32_t i = 0; i < count; i++)
        if (ewa_material_check(context, "fuzz", i, &materials[i]) != EWA_OK) abort();
    ewa_context_destroy(&context);
    return 0;
}
