// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Memory and bounds of sets of Gaussians.
#include "base/base.h"
#include "ewa/gaussian.h"

#include <math.h>
#include <string.h>

/// Floats that a Gaussian has.
static size_t harmonic_count(uint32_t sh_degree) { return 3 * (size_t)(sh_degree + 1) * (sh_degree + 1); }

ewa_status ewa_gaussians_create(ewa_context *context, uint32_t count, uint32_t sh_degree,
                                ewa_gaussians *gaussians) {
    if (!context || !gaussians) return EWA_ERROR_ARGUMENT;
    *gaussians = (ewa_gaussians){0};
    if (sh_degree > EWA_MAX_SH_DEGREE)
        return ewa_fail(context, EWA_ERROR_ARGUMENT,
                        "gaussians: spherical harmonics of degree %u, not 0 to %d", sh_degree,
                        EWA_MAX_SH_DEGREE);
    const ewa_limits *limits = ewa_context_limits(context);
    const uint64_t bytes = count * (uint64_t)sizeof(float) * (3 + 3 + 4 + 1 + harmonic_count(sh_degree));
    if (count > limits->max_points)
        return ewa_fail(context, EWA_ERROR_LIMIT, "gaussians: %u, max_points is %llu", count,
                        (unsigned long long)limits->max_points);
    EWA_TRY(ewa_memory_check(context, bytes, "%u Gaussians of degree %u", count, sh_degree));
    *gaussians = (ewa_gaussians){.context = context, .count = count, .sh_degree = sh_degree};
    gaussians->centers = ewa_allocate_zeroed(context, count, 3 * sizeof(float));
    gaussians->scales = ewa_allocate_zeroed(context, count, 3 * sizeof(float));
    gaussians->rotations = ewa_allocate_zeroed(context, count, 4 * sizeof(float));
    gaussians->opacities = ewa_allocate_zeroed(context, count, sizeof(float));
    gaussians->harmonics = ewa_allocate_zeroed(context, count, harmonic_count(sh_degree) * sizeof(float));
    if (gaussians->centers && gaussians->scales && gaussians->rotations && gaussians->opacities &&
        gaussians->harmonics)
        return EWA_OK;
    ewa_gaussians_free(gaussians);
    return EWA_ERROR_MEMORY;
}

ewa_status ewa_gaussians_add_classes(ewa_gaussians *gaussians) {
    if (!gaussians || !gaussians->context) return EWA_ERROR_ARGUMENT;
    if (gaussians->classes) return EWA_OK;
    gaussians->classes = ewa_allocate_zeroed(gaussians->context, gaussians->count, sizeof *gaussians->classes);
    return gaussians->classes ? EWA_OK : EWA_ERROR_MEMORY;
}

void ewa_gaussians_free(ewa_gaussians *gaussians) {
    if (!gaussians || !gaussians->context) return;
    ewa_context *context = gaussians->context;
    const uint32_t count = gaussians->count;
    ewa_release(context, gaussians->centers, count, 3 * sizeof(float));
    ewa_release(context, gaussians->scales, count, 3 * sizeof(float));
    ewa_release(context, gaussians->rotations, count, 4 * sizeof(float));
    ewa_release(context, gaussians->opacities, count, sizeof(float));
    ewa_release(context, gaussians->harmonics, count, harmonic_count(gaussians->sh_degree) * sizeof(float));
    ewa_release(context, gaussians->classes, count, sizeof *gaussians->classes);
    *gaussians = (ewa_gaussians){0};
}

ewa_status ewa_gaussians_keep(const ewa_gaussians *from, const uint8_t *marks, ewa_gaussians *kept) {
    if (!kept) return EWA_ERROR_ARGUMENT;
    *kept = (ewa_gaussians){0};
    if (!from || !from->context || !marks) return EWA_ERROR_ARGUMENT;
    uint32_t count = 0;
    for (uint32_t i = 0; i < from->count; i++) count += marks[i] != 0;
    EWA_TRY(ewa_gaussians_create(from->context, count, from->sh_degree, kept));
    kept->flat = from->flat, kept->antialiased = from->antialiased;
    memcpy(kept->origin, from->origin, sizeof kept->origin);
    const ewa_status status = from->classes ? ewa_gaussians_add_classes(kept) : EWA_OK;
    if (status != EWA_OK) {
        ewa_gaussians_free(kept);
        return status;
    }
    const size_t harmonics = harmonic_count(from->sh_degree);
    size_t to = 0;
    for (size_t i = 0; i < from->count; i++) {
        if (!marks[i]) continue;
        memcpy(kept->centers + 3 * to, from->centers + 3 * i, 3 * sizeof(float));
        memcpy(kept->scales + 3 * to, from->scales + 3 * i, 3 * sizeof(float));
        memcpy(kept->rotations + 4 * to, from->rotations + 4 * i, 4 * sizeof(float));
        kept->opacities[to] = from->opacities[i];
        memcpy(kept->harmonics + harmonics * to, from->harmonics + harmonics * i, harmonics * sizeof(float));
        if (from->classes) kept->classes[to] = from->classes[i];
        to++;
    }
    return EWA_OK;
}

ewa_status ewa_gaussians_measure(const ewa_gaussians *gaussians, ewa_bounds *bounds) {
    if (!gaussians || !bounds || (gaussians->count && !gaussians->centers)) return EWA_ERROR_ARGUMENT;
    *bounds = (ewa_bounds){0};
    for (uint32_t i = 0; i < gaussians->count; i++) {
        const float *center = gaussians->centers + 3 * (size_t)i;
        if (!isfinite(center[0]) || !isfinite(center[1]) || !isfinite(center[2])) continue;
        for (int a = 0; a < 3; a++) {
            const double at = gaussians->origin[a] + (double)center[a];
            if (!bounds->finite_count || at < bounds->low_world[a]) bounds->low_world[a] = at;
            if (!bounds->finite_count || at > bounds->high_world[a]) bounds->high_world[a] = at;
        }
        bounds->finite_count++;
    }
    return EWA_OK;
}
