// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target: any bytes as a file of Gaussians, the form by their content; those of no form as .splat or .ksplat. What
// is read is in order, can be made into surfels, and be moved.
#include "fuzz_mesh.h"

static void check_set(ewa_gaussians *set) {
    const uint32_t numbers = 3 * (set->sh_degree + 1) * (set->sh_degree + 1);
    fuzz_require(set->count > 0 && set->sh_degree <= EWA_MAX_SH_DEGREE, "there are Gaussians");
    for (size_t i = 0; i < set->count; i++) {
        float norm2 = 0, sum = 0;
        for (size_t k = 0; k < 4; k++) norm2 += set->rotations[4 * i + k] * set->rotations[4 * i + k];
        fuzz_require(norm2 > 0.999f && norm2 < 1.001f, "quaternions are unit ones");
        for (size_t k = 0; k < 3; k++) {
            sum += 0 * set->centers[3 * i + k];
            fuzz_require(set->scales[3 * i + k] >= 0 && isfinite(set->scales[3 * i + k]),
                         "scales are lengths");
        }
        for (size_t k = 0; k < numbers; k++) sum += 0 * set->harmonics[i * numbers + k];
        fuzz_require(sum == 0, "numbers are finite");
        fuzz_require(set->opacities[i] >= 0 && set->opacities[i] <= 1, "opacities are shares");
    }
    ewa_cloud *cloud = NULL;
    const ewa_status status = ewa_gaussians_to_cloud(set, &cloud);
    fuzz_require((status == EWA_OK) == (cloud != NULL), "surfels on success only");
    ewa_cloud_destroy(&cloud);
    static const double turn[16] = {0, -2, 0, 1, 1, 0, 0, 2, 0, 0.5, 1, 3, 0, 0, 0, 1};
    fuzz_require(ewa_gaussians_transform(set, turn) == EWA_OK, "sets can be moved");
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    static const char *const names[] = {"input", "input.splat", "input.ksplat"};
    for (int n = 0; n < 3; n++) {
        int errors = 0;
        ewa_context *context = fuzz_context(1, 0, &errors);
        ewa_gaussians set;
        ewa_gaussian_facts facts;
        const ewa_status status =
            ewa_gaussians_load_memory(context, bytes, size_bytes, names[n], NULL, &set, &facts);
        fuzz_require((status == EWA_OK) == (errors == 0), "a message on failure only");
        fuzz_require((status == EWA_OK) == (set.centers != NULL), "a set on success only");
        if (status == EWA_OK) check_set(&set);
        ewa_gaussians_free(&set);
        ewa_context_destroy(&context);
    }
    return 0;
}
