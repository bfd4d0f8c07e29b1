// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A file of trained Gaussians, resident, and where they are.
#include "gaussian_scene.h"
#include "gaussian_files.h"

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

/// Where the Gaussians of the core are, or its corners when none of them is worth showing.
static ewa_status make_outline(const ewa_gaussians *set, gaussian_scene *scene) {
    const ewa_bounds *core = &scene->info.core;
    uint64_t count = 0;
    for (size_t i = 0; i < set->count; i++) count += is_shown(set, core, i);
    const uint64_t corners = count ? 0 : CORNERS;
    void *data = NULL, *reach = NULL;
    ewa_status status = ewa_cloud_create(set->context, count + corners, &scene->outline);
    if (status == EWA_OK) status = ewa_cloud_add(scene->outline, EWA_POSITION, EWA_F64, 3, &data);
    if (status == EWA_OK) status = ewa_cloud_add(scene->outline, EWA_RADIUS, EWA_F32, 1, &reach);
    if (status != EWA_OK) return status;
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
    return EWA_OK;
}

bool gaussian_scene_load(cli_session *session, const char *path, gaussian_scene *scene) {
    ewa_gaussians set;
    ewa_gaussian_facts facts;
    scene->path = path;
    if (!gaussian_files_load(session, path, &set, &facts)) return false;
    scene->up_axis = gaussian_files_up_axis(&facts);
    ewa_status status = ewa_splats_create(&set, &scene->splats);
    if (status == EWA_OK) {
        ewa_splats_describe(scene->splats, &scene->info);
        status = make_outline(&set, scene);
    }
    ewa_gaussians_free(&set);
    if (status != EWA_OK) session_failed(session, status);
    return status == EWA_OK;
}

void gaussian_scene_free(gaussian_scene *scene) {
    ewa_splats_destroy(&scene->splats);
    ewa_cloud_destroy(&scene->outline);
}
