// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa convert for Gaussians: to another form of them, moved.
#include "cli/convert/convert_gaussians.h"
#include "cli/input/gaussian_files.h"

#include <math.h>
#include <string.h>

bool convert_gaussians_is_named(const char *path) {
    const ewa_gaussian_format format = ewa_gaussians_format_of(path);
    return format != EWA_GAUSSIANS_NONE && format != EWA_GAUSSIANS_PLY;
}

static bool is_inside(const ewa_gaussians *set, size_t number, const double *corners_world) {
    for (size_t k = 0; k < 3; k++) {
        const double at = set->origin[k] + (double)set->centers[3 * number + k];
        const double a = corners_world[k], b = corners_world[3 + k];
        if (!(at >= fmin(a, b) && at <= fmax(a, b))) return false;
    }
    return true;
}

/// Leaves those of a set whose centres lie in a box.
static ewa_status crop(ewa_gaussians *set, const double *corners_world) {
    uint32_t kept = 0;
    for (size_t i = 0; i < set->count; i++) kept += is_inside(set, i, corners_world);
    ewa_gaussians part;
    const ewa_status status = ewa_gaussians_create(set->context, kept, set->sh_degree, &part);
    if (status != EWA_OK) return status;
    part.flat = set->flat, part.antialiased = set->antialiased;
    memcpy(part.origin, set->origin, sizeof part.origin);
    const size_t harmonics = 3 * (size_t)(set->sh_degree + 1) * (set->sh_degree + 1);
    size_t to = 0;
    for (size_t i = 0; i < set->count; i++) {
        if (!is_inside(set, i, corners_world)) continue;
        memcpy(part.centers + 3 * to, set->centers + 3 * i, 3 * sizeof(float));
        memcpy(part.scales + 3 * to, set->scales + 3 * i, 3 * sizeof(float));
        memcpy(part.rotations + 4 * to, set->rotations + 4 * i, 4 * sizeof(float));
        part.opacities[to] = set->opacities[i];
        memcpy(part.harmonics + harmonics * to++, set->harmonics + harmonics * i, harmonics * sizeof(float));
    }
    ewa_gaussians_free(set);
    *set = part;
    return EWA_OK;
}

bool convert_gaussians(cli_session *session, const char *from, const char *to,
                       const ewa_gaussians_save_options *options, const double *corners_world,
                       const double (*matrices)[16], uint32_t count) {
    ewa_gaussians set;
    ewa_gaussian_facts facts;
    ewa_gaussians_save_options chosen = *options;
    if (!gaussian_files_load(session, from, &set, &facts)) return false;
    memcpy(chosen.up_world, facts.up_world, sizeof chosen.up_world);
    ewa_status status = corners_world ? crop(&set, corners_world) : EWA_OK;
    if (status == EWA_OK && !set.count) {
        session_fail(session, "%s: no Gaussian has its centre in the box of --crop", from);
        ewa_gaussians_free(&set);
        return false;
    }
    for (uint32_t i = 0; i < count && status == EWA_OK; i++)
        status = ewa_gaussians_transform(&set, matrices[i]);
    session->subject = to;
    if (status == EWA_OK) status = ewa_gaussians_save(&set, to, &chosen);
    if (status != EWA_OK)
        session_failed(session, status);
    else
        session_say(session, "%s: %u Gaussians written (%s)", to, set.count,
                    ewa_gaussian_format_name(ewa_gaussians_format_of(to)));
    ewa_gaussians_free(&set);
    return status == EWA_OK;
}
