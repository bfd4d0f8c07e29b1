// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where Gaussians are, for framing.
#include "base/base.h"
#include "ewa/gaussian.h"

#include <math.h>

enum { CORNERS = 8 };

/// Opacities from there on make a place worth showing.
static const float SEEN = 0.1f;

/// Standard deviations of a Gaussian that belong to what is framed.
static const float REACH = 2;

static bool is_shown(const ewa_gaussians *set, const ewa_bounds *core, size_t number) {
    for (size_t k = 0; k < 3; k++) {
        const double at = set->origin[k] + (double)set->centers[3 * number + k];
        if (!(at >= core->low_world[k] && at <= core->high_world[k])) return false;
    }
    return set->opacities[number] >= SEEN;
}

ewa_status ewa_gaussians_outline(const ewa_gaussians *set, const ewa_bounds *core, ewa_cloud **cloud) {
    if (!set || !set->context || !core || !cloud) return EWA_ERROR_ARGUMENT;
    *cloud = NULL;
    uint64_t count = 0;
    for (size_t i = 0; i < set->count; i++) count += is_shown(set, core, i);
    const uint64_t corners = count ? 0 : CORNERS;
    ewa_cloud *made = NULL;
    void *data = NULL, *reach = NULL;
    ewa_status status = ewa_cloud_create(set->context, count + corners, &made);
    if (status == EWA_OK) status = ewa_cloud_add(made, EWA_POSITION, EWA_F64, 3, &data);
    if (status == EWA_OK) status = ewa_cloud_add(made, EWA_RADIUS, EWA_F32, 1, &reach);
    if (status != EWA_OK) {
        ewa_cloud_destroy(&made);
        return status;
    }
    double *positions = data;
    float *radii = reach;
    for (size_t i = 0; i < set->count; i++) {
        if (!is_shown(set, core, i)) continue;
        for (size_t k = 0; k < 3; k++) *positions++ = set->origin[k] + (double)set->centers[3 * i + k];
        const float *scales = set->scales + 3 * i;
        *radii++ = REACH * fmaxf(fmaxf(scales[0], scales[1]), scales[2]);
    }
    for (uint64_t i = 0; i < corners; i++) *radii++ = 0;
    for (uint64_t i = 0; i < corners; i++)
        for (int k = 0; k < 3; k++) *positions++ = i >> k & 1 ? core->high_world[k] : core->low_world[k];
    *cloud = made;
    return EWA_OK;
}
