// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sets of Gaussians as surfels: the plane of the two longest axes, with the colour that no direction changes.
#include "base/base.h"
#include "cloud/gaussian_merge.h"
#include "ewa/gaussian.h"
#include "image/srgb.h"

#include <math.h>
#include <string.h>

/// Where the numbers of surfels go.
typedef struct surfel_streams {
    float *position, *tangent_u, *tangent_v, *normal, *color, *opacity, *size;
} surfel_streams;

static void make_surfel(const ewa_gaussians *set, size_t i, const surfel_streams *to) {
    const float *scales = set->scales + 3 * i;
    const float *harmonics = set->harmonics + i * 3 * (size_t)(set->sh_degree + 1) * (set->sh_degree + 1);
    int shortest = 2; // also where several are: the third axis of 2D Gaussians is the normal
    for (int k = 1; k >= 0; k--)
        if (scales[k] < scales[shortest]) shortest = k;
    // In this order they are right-handed: the normal is u x v.
    const int u = (shortest + 1) % 3, v = (shortest + 2) % 3;
    double axes[9];
    ewa_gaussian_axes(set->rotations + 4 * i, axes);
    for (int k = 0; k < 3; k++) {
        to->position[3 * i + (size_t)k] = set->centers[3 * i + (size_t)k];
        to->tangent_u[3 * i + (size_t)k] = (float)(axes[3 * k + u] * (double)scales[u]);
        to->tangent_v[3 * i + (size_t)k] = (float)(axes[3 * k + v] * (double)scales[v]);
        to->normal[3 * i + (size_t)k] = (float)axes[3 * k + shortest];
        const double display = 0.5 + 0.28209479177387814 * (double)harmonics[k];
        to->color[4 * i + (size_t)k] = (float)ewa_srgb_decode(fmin(fmax(display, 0), 1));
    }
    to->color[4 * i + 3] = to->opacity[i] = set->opacities[i];
    to->size[i] = fmaxf(scales[u], scales[v]);
}

ewa_status ewa_gaussians_to_cloud(const ewa_gaussians *gaussians, ewa_cloud **cloud) {
    if (!gaussians || !gaussians->context || !cloud) return EWA_ERROR_ARGUMENT;
    *cloud = NULL;
    ewa_cloud *made = NULL;
    surfel_streams to = {.tangent_u = NULL};
    void *classes = NULL;
    ewa_status status = ewa_cloud_create(gaussians->context, gaussians->count, &made);
    if (status == EWA_OK) status = ewa_cloud_add(made, EWA_POSITION, EWA_F32, 3, (void **)&to.position);
    if (status == EWA_OK) status = ewa_cloud_add(made, EWA_NORMAL, EWA_F32, 3, (void **)&to.normal);
    if (status == EWA_OK) status = ewa_cloud_add(made, EWA_COLOR, EWA_F32, 4, (void **)&to.color);
    if (status == EWA_OK) status = ewa_cloud_add(made, EWA_TANGENT_U, EWA_F32, 3, (void **)&to.tangent_u);
    if (status == EWA_OK) status = ewa_cloud_add(made, EWA_TANGENT_V, EWA_F32, 3, (void **)&to.tangent_v);
    if (status == EWA_OK) status = ewa_cloud_add(made, "opacity", EWA_F32, 1, (void **)&to.opacity);
    if (status == EWA_OK) status = ewa_cloud_add(made, "size", EWA_F32, 1, (void **)&to.size);
    if (status == EWA_OK && gaussians->classes) status = ewa_cloud_add(made, "classification", EWA_U16, 1, &classes);
    if (status != EWA_OK) {
        ewa_cloud_destroy(&made);
        return status;
    }
    for (size_t i = 0; i < gaussians->count; i++) make_surfel(gaussians, i, &to);
    if (classes) memcpy(classes, gaussians->classes, gaussians->count * sizeof *gaussians->classes);
    ewa_cloud_set_origin(made, gaussians->origin);
    *cloud = made;
    return EWA_OK;
}
